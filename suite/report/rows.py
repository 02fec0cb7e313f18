"""What every table and picture asks of the rows of a store: which count, and what they are of."""

import json
from typing import Any

import pandas as pd

from suite.planner import PlanStatus
from suite.report.words import counted, query_label

NAME = ["scene", "query", "world", "variant"]
"""What tables tell rows apart by, but for the seed."""

QUERIES_APART = 3
"""The rule for scenes of several queries: up to so many are places of their own, each with its row
and its panel; a scene of more is one place, a map, whose queries are a sample."""

BUDGET = ["budget_wall_s", "budget_generations", "budget_checks", "budget_cpu_s"]

_VERSION = [
    "scene_hash",
    "planner",
    "version",
    "settings",
    "world_settings",
    "cold",
    *BUDGET,
]


def newest(runs: pd.DataFrame) -> pd.DataFrame:
    """The rows whose scene, planner, settings and budget are the last ones run under their names.

    A store keeps the rows of a scene, a setting or a planner that has changed since. Pooling them
    with the new ones under one name would describe neither.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        In the same order.
    """
    if runs.empty:
        return runs
    version = runs.groupby(_VERSION, dropna=False).ngroup()
    names = runs.groupby(NAME, dropna=False).ngroup()
    started = runs["started_at"].fillna("")
    last = started.groupby(names).transform("max") == started
    current = version.where(last).groupby(names).transform("last")
    return runs[version == current]


def feasible(runs: pd.DataFrame) -> pd.DataFrame:
    """The runs that ended with a path that the referee accepted."""
    return runs[(runs["status"] == str(PlanStatus.SOLVED)) & runs["cost"].notna()]


def cheapest(runs: pd.DataFrame) -> "pd.Series[Any] | None":
    """The feasible run of the lowest cost, of equal ones the first; None if none is feasible."""
    ordered = feasible(runs).sort_values("cost", kind="stable")
    return None if ordered.empty else ordered.iloc[0]


def is_simulated(runs: pd.DataFrame) -> "pd.Series[Any]":
    """Which rows are of simulated runs."""
    return runs["world"].notna()


def is_of_map(runs: pd.DataFrame) -> "pd.Series[bool]":
    """Which rows are of a scene of more queries than :data:`QUERIES_APART`: a map."""
    return runs.groupby("scene")["query"].transform("nunique") > QUERIES_APART


def places(runs: pd.DataFrame) -> "pd.Series[str]":
    """Where each run took place: its scene, and its query if the scene has a few.

    A map is one place, with all its queries; see :func:`is_of_map`.
    """
    several = runs.groupby("scene")["query"].transform("nunique") > 1
    apart = runs.loc[several & ~is_of_map(runs), ["scene", "query"]].drop_duplicates()
    short = apart["query"].map(query_label)
    # Shortened names that would be the same stay long.
    same = pd.DataFrame({"scene": apart["scene"], "short": short}).duplicated(keep=False)
    texts = apart["scene"] + "/" + short.where(~same, apart["query"])
    names = dict(zip(zip(apart["scene"], apart["query"], strict=True), texts, strict=True))
    pairs = zip(runs["scene"], runs["query"], strict=True)
    return pd.Series([names.get(pair, pair[0]) for pair in pairs], runs.index, dtype="object")


def maps_note(runs: pd.DataFrame) -> str:
    """That the rows of a map are over all its queries, as a sentence; empty if there is none."""
    maps = runs.loc[is_of_map(runs), "scene"].nunique()
    if not maps:
        return ""
    many = "a scene" if maps == 1 else "scenes"
    return (
        f"Of {counted(maps, 'map')}, {many} of many queries, the runs of all queries are put "
        "together here; the table maps takes each query as one."
    )


def with_queries_together(runs: pd.DataFrame) -> pd.DataFrame:
    """The rows with the queries of a map under one name, for tables that group by :data:`NAME`."""
    number = runs.groupby("scene")["query"].transform("nunique")
    together = number.map(lambda n: f"{n} queries")
    return runs.assign(query=runs["query"].where(~is_of_map(runs), together))


def is_blocked(runs: pd.DataFrame) -> "pd.Series[bool]":
    """Which rows are of a query that can't be asked, for its start or its goal is not free.

    Such a query was put to no planner: all of its rows are refused, for one reason, which names the
    start or the goal. It is no failure of anybody, and no table counts it.
    """
    if runs.empty:
        return pd.Series(False, index=runs.index, dtype=bool)
    query = [runs[column] for column in ("scene", "query", "scene_hash")]
    reason = runs["reason"].fillna("").astype(str)
    named = (runs["status"] == str(PlanStatus.REFUSED)) & reason.str.contains(_AN_END)
    all_so = named.groupby(query).transform("all")
    return all_so & (reason.groupby(query).transform("nunique") == 1)


_AN_END = r"\b(?:start|goal) of query\b"
"""As :attr:`suite.scenes.scene.Query.blocked` begins."""


def blocked_note(runs: pd.DataFrame) -> str:
    """How many rows and queries can't be asked, as a sentence; empty if none."""
    blocked = runs[is_blocked(runs)]
    if blocked.empty:
        return ""
    queries = len(blocked[["scene", "query", "scene_hash"]].drop_duplicates())
    return (
        f"Left out: {counted(len(blocked), 'row')} of {_queries(queries)} that can't be asked, as "
        "a start or a goal is not free."
    )


def _queries(number: int) -> str:
    return "1 query" if number == 1 else f"{number} queries"


def settings_of(runs: pd.DataFrame, column: str = "settings") -> "pd.Series[Any]":
    """The settings of each run, or of its world, as a dict."""
    # Few different texts stand in many rows.
    parsed = {text: json.loads(text) for text in runs[column].unique()}
    return runs[column].map(parsed)
