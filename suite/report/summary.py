"""The table of everything: for each scene and planner, how often and how well it solved it."""

from typing import Any

import pandas as pd

from suite.planner import PlanStatus
from suite.report.table import Table

SUCCESSES = (str(PlanStatus.SOLVED), str(PlanStatus.INFEASIBLE))
"""A proof that there is no path, which the harness has checked, is the right answer."""

NOTE = (
    "Costs are the referee's path lengths in metres, over solved runs only; failures count in the "
    "success rate. gap: cost above the exact shortest path. SD: sample standard deviation "
    "(n - 1). gen to best, time to best: until the final path was first found, solved runs; gen "
    "total, time total: until the run stopped, all runs that ended by themselves."
)


def summary(runs: pd.DataFrame) -> pd.DataFrame:
    """Measures of each scene and planner.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read_runs` gives it.

    Returns
    -------
    DataFrame
        A row for each scene, query and planner variant, in the order of their first runs by name.
    """
    groups = runs.groupby(["scene", "query", "variant"], sort=False)
    rows = [{**_names(runs, name), **_measures(group)} for name, group in groups]
    frame = pd.DataFrame(rows, columns=None if rows else ["scene", "planner", "runs"])
    for column in ("runs", "solved"):
        if column in frame:
            frame[column] = frame[column].astype("int64")
    return frame


def summary_table(runs: pd.DataFrame, left_out: int = 0) -> Table:
    """The summary with its title and note, which counts the rows that were left out as outdated."""
    note = NOTE
    if left_out:
        note += f" Left out: {left_out} rows of scenes, settings or planners that changed since."
    return Table("summary", "Results per scene and planner", summary(runs), note)


def feasible(runs: pd.DataFrame) -> pd.DataFrame:
    """The runs that ended with a path that the referee accepted."""
    return runs[(runs["status"] == str(PlanStatus.SOLVED)) & runs["cost"].notna()]


def spread(values: "pd.Series[Any]", what: str, unit: str = "") -> dict[str, float]:
    """Mean and sample standard deviation of the values that are there, named for a table."""
    numbers = values.dropna().astype("float64")
    suffix = f" ({unit})" if unit else ""
    return {
        f"{what} mean{suffix}": float(numbers.mean()),
        f"{what} SD{suffix}": float(numbers.std(ddof=1)),
    }


def _names(runs: pd.DataFrame, name: Any) -> dict[str, str]:
    scene, query, variant = (str(part) for part in name)
    several = len(runs.loc[runs["scene"] == scene, "query"].unique()) > 1
    return {"scene": f"{scene}/{query}" if several else scene, "planner": variant}


def _measures(group: pd.DataFrame) -> dict[str, Any]:
    solved = feasible(group)
    successes = int(group["status"].isin(SUCCESSES).sum())
    others = group.loc[~group["status"].isin(SUCCESSES), "status"].value_counts().sort_index()
    return {
        "runs": len(group),
        "solved": successes,
        "success (%)": 100.0 * successes / len(group),
        "cost best": float(solved["cost"].min()),
        **spread(solved["cost"], "cost"),
        "gap mean (%)": 100.0 * float(solved["gap"].mean()),
        **spread(solved["generation_of_best"], "gen to best"),
        **spread(group["generations"], "gen total"),
        **spread(1e3 * solved["time_to_best_s"], "time to best", "ms"),
        "time total median (ms)": 1e3 * float(group["wall_s"].median()),
        **spread(1e3 * group["wall_s"], "time total", "ms"),
        "otherwise": ", ".join(f"{count} {status}" for status, count in others.items()),
    }
