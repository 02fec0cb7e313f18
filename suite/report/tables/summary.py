"""The summary: for each scene and planner, how often and how well it solved it.

The same three words stand in all tables. solved: the referee accepts the path, or the proof that
there is none. without path: all other runs. failed: those of these that broke and did not merely
find nothing.
"""

from typing import Any

import pandas as pd

from suite.planner import PlanStatus
from suite.report.rows import feasible, maps_note, places
from suite.report.statistics.clock import untimed_note
from suite.report.table import Kind, Table
from suite.report.words import joined

NARROW = [
    "scene",
    "planner",
    "runs",
    "solved",
    "gap median (%)",
    "gap mean (%)",
    "cost mean",
    "gen to best mean",
    "time total median (ms)",
]
"""Columns that fit into a terminal and onto a page."""

KINDS = dict.fromkeys(
    ("gen to best mean", "gen to best SD", "gen total mean", "gen total SD"), Kind.COUNT
)

WORDS = (
    "solved: with a path that the referee accepts, or with the proof that there is none. without "
    "path: all others; most end properly, at the budget or at the planner's own stop criterion "
    "(exhausted), or with the planner's refusal of the scene (refused). failed: of these, the runs "
    f"that broke ({', '.join(PlanStatus.FAILURES)}); `run --only-failed` does them again."
)

NOTE = (
    "gap: cost above the exact shortest path. cost: the referee's path length, metres; both over "
    "solved runs only. gen to best: until the final path was first found, solved runs; time total: "
    "until the run stopped, all runs that ended by themselves."
)

ROWS_NOTE = (
    "SD: sample standard deviation (n - 1). time to best: until the final path was first found, "
    "solved runs; gen total: until the run stopped, all runs that ended by themselves. otherwise: "
    "how the runs without path ended."
)


def summary(runs: pd.DataFrame) -> pd.DataFrame:
    """Measures of each scene and planner.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        A row for each scene, query and planner variant, in the order of their first runs by name.
    """
    rows = [
        {"scene": place, "planner": variant, **_measures(group)}
        for (place, variant), group in runs.groupby([places(runs), "variant"], sort=False)
    ]
    frame = pd.DataFrame(rows, columns=None if rows else ["scene", "planner", "runs"])
    for column in ("runs", "solved", "without path", "failed"):
        if column in frame:
            frame[column] = frame[column].astype("int64")
    return frame


def summary_tables(runs: pd.DataFrame, left_out: int = 0) -> list[Table]:
    """The summary in a few columns, and in all.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    left_out : int
        Rows that were left out as outdated; the note counts them.
    """
    frame = summary(runs)
    note = joined(f"{_counted(runs)} {WORDS} {NOTE}", maps_note(runs), untimed_note(runs))
    if left_out:
        note += f" Left out: {left_out} rows of scenes, settings or planners that changed since."
    narrow = frame[[name for name in NARROW if name in frame]]
    return [
        Table("summary", "Results per scene and planner", narrow, note, kinds=KINDS),
        Table("summary-rows", "All measures per scene and planner", frame, f"{note} {ROWS_NOTE}",
              detail=True, kinds=KINDS),
    ]  # fmt: skip


def _counted(runs: pd.DataFrame) -> str:
    """How the runs ended, in the words of the tables."""
    solved, failed = (
        int(runs["status"].isin(kind).sum()) for kind in (PlanStatus.SUCCESSES, PlanStatus.FAILURES)
    )
    return (
        f"{len(runs)} runs: {solved} solved, {len(runs) - solved} without path, of these {failed} "
        "failed."
    )


def spread(values: "pd.Series[Any]", what: str, unit: str = "") -> dict[str, float]:
    """Mean and sample standard deviation of the values that are there, named for a table."""
    numbers = values.dropna().astype("float64")
    suffix = f" ({unit})" if unit else ""
    return {
        f"{what} mean{suffix}": float(numbers.mean()),
        f"{what} SD{suffix}": float(numbers.std(ddof=1)),
    }


def _measures(group: pd.DataFrame) -> dict[str, Any]:
    solved = feasible(group)
    successes = int(group["status"].isin(PlanStatus.SUCCESSES).sum())
    others = (
        group.loc[~group["status"].isin(PlanStatus.SUCCESSES), "status"].value_counts().sort_index()
    )
    return {
        "runs": len(group),
        "solved": successes,
        "without path": len(group) - successes,
        "failed": int(group["status"].isin(PlanStatus.FAILURES).sum()),
        "success (%)": 100.0 * successes / len(group),
        "cost best": float(solved["cost"].min()),
        **spread(solved["cost"], "cost"),
        "gap median (%)": 100.0 * float(solved["gap"].median()),
        "gap mean (%)": 100.0 * float(solved["gap"].mean()),
        **spread(solved["generation_of_best"], "gen to best"),
        **spread(group["generations"], "gen total"),
        **spread(1e3 * solved["time_to_best_s"], "time to best", "ms"),
        "time total median (ms)": 1e3 * float(group["wall_s"].median()),
        **spread(1e3 * group["wall_s"], "time total", "ms"),
        "otherwise": ", ".join(f"{count} {status}" for status, count in others.items()),
    }
