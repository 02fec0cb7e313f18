"""Maps, scenes of many queries: a row for each map and planner, over its queries.

The unit is the query: its seeds are put together first, see
:mod:`suite.report.statistics.over_queries`. Query by query there is a CSV alone.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from suite.report.rows import is_blocked
from suite.report.statistics.anytime import Steps
from suite.report.statistics.clock import untimed_note
from suite.report.statistics.inference import LEVEL, Array, Interval, bootstrap, holm, signed_rank
from suite.report.statistics.over_queries import (
    EQUAL,
    TARGETS,
    only_maps,
    quantile,
    query_measures,
    time_to,
)
from suite.report.table import INFINITE, Kind, Table
from suite.report.tables.map_settings import settings_tables
from suite.report.tables.statistics import REFERENCE
from suite.report.tables.strata import strata_table
from suite.report.words import joined

NARROW = [
    "scene", "planner", "solved", "blocked", "gap median (%)", "gap mean (%)", "low (%)",
    "high (%)", "gap 90th (%)", "gap 99th (%)", "gap worst (%)", "to 5 % (ms)", "to 2 % (ms)",
    "to 1 % (ms)", "clearance (m)", "turning (rad)",
]  # fmt: skip
"""Columns that fit onto a page; blocked only where some are."""

NOTE = (
    "One row for each map, a scene of many queries, and planner. A query's seeds are averaged "
    "first. solved: how many of the queries that can be asked were solved in every run; blocked: "
    "queries that can't be asked, as a start or a goal is not free, and that count nowhere. gap: "
    "cost above the exact shortest path, over the queries with a path, so that few solved ones "
    f"flatter; low and high: {100 * LEVEL:.0f} % interval of the mean, of a bootstrap over "
    "queries; 90th, 99th: the gap that so many in a hundred queries do not exceed. clearance: "
    "distance of the path from the nearest obstacle; turning: sum of its turns; means over "
    "queries. to 5, 2, 1 %: median over the queries of the wall time to come within that of the "
    "optimum; 'never' where half of them or more never did."
)
ROWS_NOTE = (
    "success: mean over queries of the share of runs. median low and high: interval of the median. "
    "cpu: the same times of the processor."
)
LENGTHS = ("shortest fourth", "second", "third", "longest fourth")
LENGTHS_NOTE = (
    "The queries of each map with an optimum, by its length, in four parts of equally many. gap: "
    "over the queries with a path; to 2 %: median over the queries."
)
QUERY_NOTE = (
    "A row for each map, query and planner: means over its runs, of the times medians. gap, cost, "
    "clearance, turning: over the runs with a path."
)
PAIRED_NOTE = (
    "Query by query, {one} beside the planner of the row, by the mean gap of each; a query without "
    "path counts as worse than any path. better, equal, worse: how often {one} is. P({one} "
    "better): better and half of equal, with its interval of a bootstrap over queries. p: "
    "Wilcoxon's signed-rank test over the queries, corrected by Holm for all rows of this table."
)


def map_tables(
    steps: Steps, runs: pd.DataFrame, rng: np.random.Generator, reference: str | None = None
) -> list[Table]:
    """The tables of maps; none without a scene of many queries.

    Parameters
    ----------
    steps : Steps
        Of the queries that could be asked.
    runs : DataFrame
        All rows, to count the queries that can't be asked.
    rng : numpy.random.Generator
        Of the bootstraps.
    reference : str, optional
        The planner that the others are compared with; default: kbga, or else the first.
    """
    shown = only_maps(steps)
    if shown.runs.empty:
        return []
    measures = query_measures(shown)
    frame = over_queries(measures, blocked_queries(runs), rng)
    note = joined(NOTE, untimed_note(shown.runs))
    narrow = [name for name in NARROW if name != "blocked" or frame["blocked"].any()]
    maps = Table(
        "maps", "Maps: each planner over all queries", frame[narrow], note, "never",
        infinite_in=dict.fromkeys(_GAPS, INFINITE),
    )  # fmt: skip
    title = "All measures of each planner over the queries of a map"
    told = f"{note} {ROWS_NOTE}"
    rows = replace(maps, name="maps-rows", title=title, frame=frame, note=told, detail=True)
    tables = [maps, rows, *settings_tables(measures, shown.runs)]
    names = list(dict.fromkeys(measures["variant"]))
    if len(names) > 1:
        one = reference or (REFERENCE if REFERENCE in names else names[0])
        paired = compare_by_query(measures, one, rng)
        title = f"Maps: {one} against the planner of the row, query by query"
        kinds = {"Holm's p": Kind.P_VALUE}
        tables.append(Table("maps-paired", title, paired, PAIRED_NOTE.format(one=one), kinds=kinds))
    lengths = Table(
        "maps-lengths", "Maps: short and long queries apart", by_length(measures), LENGTHS_NOTE,
        "never", detail=True, infinite_in=dict.fromkeys(_GAPS, INFINITE),
    )  # fmt: skip
    strata = strata_table(shown, measures)
    by_query = Table(
        "queries", "Each planner on each query of the maps", _by_query(measures), QUERY_NOTE,
        "never", detail=True, on_page=False,
    )  # fmt: skip
    return [*tables, lengths, *([] if strata is None else [strata]), by_query]


QUANTILES = {"gap 90th (%)": 0.9, "gap 99th (%)": 0.99, "gap worst (%)": 1.0}
_GAPS = ("gap median (%)", "gap mean (%)", *QUANTILES)


def blocked_queries(runs: pd.DataFrame) -> dict[str, int]:
    """Number of queries of each scene that can't be asked.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    """
    blocked = runs[is_blocked(runs)]
    counts = blocked.groupby("scene", sort=False)["query"].nunique()
    return {str(scene): int(count) for scene, count in counts.items()}


def over_queries(
    measures: pd.DataFrame, blocked: dict[str, int], rng: np.random.Generator
) -> pd.DataFrame:
    """Measures of each map and planner over its queries.

    Parameters
    ----------
    measures : DataFrame
        Of :func:`suite.report.statistics.over_queries.query_measures`.
    blocked : dict from place to int
        Queries that can't be asked.
    rng : numpy.random.Generator

    Returns
    -------
    DataFrame
        A row for each place and planner, in the order of their first runs.
    """
    rows = [
        {"scene": place, "planner": variant} | _row(group, blocked.get(str(place), 0), rng)
        for (place, variant), group in measures.groupby(["place", "variant"], sort=False)
    ]
    return pd.DataFrame(rows)


def _row(group: pd.DataFrame, blocked: int, rng: np.random.Generator) -> dict[str, Any]:
    whole = int((group["solved"] == group["runs"]).sum())
    gap = 100.0 * group["gap"].dropna().to_numpy(dtype=np.float64)
    mean, median = (_interval(gap, statistic, rng) for statistic in (np.mean, np.median))
    return {
        "solved": f"{whole} of {len(group)}",
        "queries": len(group),
        "blocked": blocked,
        "with path": int((group["found"] > 0).sum()),
        "success (%)": 100.0 * float((group["solved"] / group["runs"]).mean()),
        "gap median (%)": median.estimate,
        "median low (%)": median.low,
        "median high (%)": median.high,
        "gap mean (%)": mean.estimate,
        "low (%)": mean.low,
        "high (%)": mean.high,
        **{name: quantile(gap, share) for name, share in QUANTILES.items()},
        **_times(group),
        "clearance (m)": float(group["clearance"].mean()),
        "turning (rad)": float(group["turning"].mean()),
    }


def _interval(gap: Array, statistic: Callable[..., Any], rng: np.random.Generator) -> Interval:
    if not len(gap):
        return Interval(np.nan, np.nan, np.nan)
    return bootstrap(gap[:, None], lambda scores: np.asarray(statistic(scores, axis=-1)), rng)


def _times(group: pd.DataFrame) -> dict[str, float]:
    """Medians over the queries with an optimum, ms."""
    known = group[group["optimum"].notna()]
    return {
        name.replace("(s)", "(ms)"): 1e3 * float(known[name].median())
        for prefix in ("", "cpu ")
        for name in (f"{prefix}{time_to(target)}" for target in TARGETS)
    }


def by_length(measures: pd.DataFrame) -> pd.DataFrame:
    """Each planner on the short and on the long queries of each map.

    Parameters
    ----------
    measures : DataFrame
        Of :func:`suite.report.statistics.over_queries.query_measures`.

    Returns
    -------
    DataFrame
        A row for each place, planner and fourth of the queries by the length of their optimum.
    """
    known = measures[measures["optimum"].notna()]
    lengths = known.groupby(["place", "query"], sort=False)["optimum"].max()
    rank = lengths.groupby(level="place").rank(method="first") - 1.0
    parts = len(LENGTHS) * rank // lengths.groupby(level="place").transform("size")
    named = parts.map(dict(enumerate(LENGTHS))).rename("part")
    known = known.join(named, on=["place", "query"])
    rows = [
        {
            "scene": place,
            "planner": variant,
            "queries by length": part,
            "from (m)": float(group["optimum"].min()),
            "to (m)": float(group["optimum"].max()),
            "queries": len(group),
            "with path": int((group["found"] > 0).sum()),
            "gap median (%)": 100.0 * float(group["gap"].median()),
            "gap mean (%)": 100.0 * float(group["gap"].mean()),
            "gap worst (%)": 100.0 * float(group["gap"].max()),
            "to 2 % (ms)": 1e3 * float(group[time_to(0.02)].median()),
        }
        for (place, variant, part), group in known.groupby(["place", "variant", "part"], sort=False)
    ]
    frame = pd.DataFrame(rows)
    if rows:
        order = [frame[name].map(_order(frame[name])) for name in ("scene", "planner")]
        frame = frame.iloc[np.lexsort([frame["from (m)"], *reversed(order)])]
    return frame


def _order(names: "pd.Series[str]") -> dict[str, int]:
    return {name: i for i, name in enumerate(dict.fromkeys(names))}


def compare_by_query(
    measures: pd.DataFrame, reference: str, rng: np.random.Generator
) -> pd.DataFrame:
    """The reference against each other planner, on the queries of each map that both were asked.

    Parameters
    ----------
    measures : DataFrame
        Of :func:`suite.report.statistics.over_queries.query_measures`.
    reference : str
        One of the planners.
    rng : numpy.random.Generator

    Returns
    -------
    DataFrame
        A row for each map and other planner.
    """
    known = measures[measures["optimum"].notna()]
    score = known["gap"].where(known["found"] > 0, np.inf)
    rows = []
    for place, here in known.assign(score=score).groupby("place", sort=False):
        wide = here.pivot(index="query", columns="variant", values="score")  # noqa: PD010
        for planner in dict.fromkeys(here["variant"]):
            if reference in wide and planner != reference:
                pair = wide[[reference, planner]].dropna().to_numpy(dtype=np.float64)
                rows.append({"scene": place, "planner": planner} | _paired(pair, reference, rng))
    frame = pd.DataFrame(rows)
    if rows:
        frame["Holm's p"] = holm(frame.pop("p").to_numpy(dtype=np.float64))
    return frame


def _paired(pair: Array, reference: str, rng: np.random.Generator) -> dict[str, Any]:
    """Of two columns of scores: how often the first is better, and how surely."""
    mine, other = pair.T
    same = mine == other  # never and never are equal
    difference = np.subtract(mine, other, out=np.zeros(len(mine)), where=~same)
    difference[np.abs(difference) < EQUAL] = 0.0
    wins = 0.5 * (1.0 - np.sign(difference))
    share = bootstrap(wins[:, None], lambda scores: np.asarray(scores.mean(axis=-1)), rng)
    better = f"P({reference} better)"
    return {
        "queries": len(pair),
        "better": int((difference < 0.0).sum()),
        "equal": int((difference == 0.0).sum()),
        "worse": int((difference > 0.0).sum()),
        better: share.estimate,
        f"{better} low": share.low,
        f"{better} high": share.high,
        "p": signed_rank(difference),
    }


def _by_query(measures: pd.DataFrame) -> pd.DataFrame:
    """The measures of each query, in the units of tables."""
    times = [f"{prefix}{time_to(target)}" for prefix in ("", "cpu ") for target in TARGETS]
    return pd.DataFrame(
        {
            "scene": measures["place"],
            "query": measures["query"],
            "planner": measures["variant"],
            **{name: measures[name] for name in ("runs", "solved", "found")},
            "optimum (m)": measures["optimum"],
            "cost (m)": measures["cost"],
            "gap (%)": 100.0 * measures["gap"],
            **{name.replace("(s)", "(ms)"): 1e3 * measures[name] for name in times},
            "clearance (m)": measures["clearance"],
            "turning (rad)": measures["turning"],
        }
    )
