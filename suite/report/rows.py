"""What every table and picture asks of the rows of a store: which count, and what they are of."""

import json
from typing import Any

import pandas as pd

from suite.planner import PlanStatus

NAME = ["scene", "query", "world", "variant"]
"""What tables tell rows apart by, but for the seed."""

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


def places(runs: pd.DataFrame) -> "pd.Series[str]":
    """Where each run took place: its scene, and its query if the scene has several."""
    several = runs.groupby("scene")["query"].transform("nunique") > 1
    return runs["scene"].where(~several, runs["scene"] + "/" + runs["query"])


def settings_of(runs: pd.DataFrame, column: str = "settings") -> "pd.Series[Any]":
    """The settings of each run, or of its world, as a dict."""
    # Few different texts stand in many rows.
    parsed = {text: json.loads(text) for text in runs[column].unique()}
    return runs[column].map(parsed)
