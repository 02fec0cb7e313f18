"""Fixed target: what it takes to come within some gap of the optimum.

A run that never does is not dropped: it takes infinitely long, and the median is over all runs. So
a median is a number only if more than half of the runs came so near.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from suite.report.rows import maps_note
from suite.report.statistics.anytime import Steps, first_within
from suite.report.statistics.clock import by_the_clock, untimed_note
from suite.report.table import Kind, Table
from suite.report.tables.glance import SIDE_BY_SIDE, at_a_glance, planners_together
from suite.report.words import joined, of_some

TARGETS = (0.05, 0.02, 0.01, 0.001)
"""Gaps to the optimum."""

TIME = "time median (ms)"

MEASURES = {
    TIME: ("wall_s", 1e3),
    "cpu median (ms)": ("cpu_s", 1e3),
    "gen median": ("generation", 1.0),
    "checks median": ("checks", 1.0),
}
"""Columns, the clocks that they are read from, and their units."""

KINDS = {"gen median": Kind.COUNT, "checks median": Kind.COUNT}

NOTE = (
    "Medians over all runs: one that never came so near counts as infinitely long, so that "
    "'never', within the budget that they had, stands where half of the runs or more did not. gen "
    "and checks stay empty where the planner does not count them. Times are of the planner's own "
    "reports; the referee has measured its last path, and no report counts for less than that."
)
GLANCE_NOTE = (
    "k of n: how many runs came so near, where not all did. Median over all runs; 'never', within "
    "the budget that they had, where half of them or more did not."
)


def fixed_target(steps: Steps) -> pd.DataFrame:
    """What each planner takes to come within the targets, scene by scene.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    DataFrame
        A row for each scene with an optimum, planner and target: runs, how many reached it, and
        the medians of :data:`MEASURES` over all runs, infinite where half or more never did.
    """
    frames = [_of_target(steps, target) for target in TARGETS]
    frame = pd.concat(frames).sort_values(["order", "target (%)"], ascending=[True, False])
    return frame.drop(columns="order").reset_index(drop=True)


def medians(values: pd.DataFrame, names: pd.DataFrame) -> pd.DataFrame:
    """Medians of groups of runs in which infinity is a value, and nan makes nan.

    Parameters
    ----------
    values : DataFrame of float64
    names : DataFrame
        Of the same rows; what names a group.

    Returns
    -------
    DataFrame
        Indexed by the names, in the order of the groups' first rows.
    """
    by = [names[column] for column in names.columns]
    unknown = values.isna().groupby(by, sort=False).any()
    return values.groupby(by, sort=False).median().mask(unknown)


def _of_target(steps: Steps, target: float) -> pd.DataFrame:
    with_optimum = ~np.isnan(steps.optimum)
    names = steps.runs.loc[with_optimum, ["place", "variant"]]
    taken = pd.DataFrame(
        {
            name: first_within(steps, clock, target)[with_optimum] * unit
            for name, (clock, unit) in MEASURES.items()
        },
        index=names.index,
    )
    timed = by_the_clock(steps.runs)[with_optimum]
    found = medians(taken, names)
    found[TIME] = medians(taken.loc[timed, [TIME]], names[timed])[TIME]
    # The wall clock is never missing: what is finite on it was reached.
    reached = np.isfinite(taken[TIME]).groupby([names[c] for c in names], sort=False)
    counts = reached.agg(["size", "sum"])
    frame = pd.DataFrame(
        {
            "target (%)": 100.0 * target,
            "runs": counts["size"],
            "reached": counts["sum"].astype("int64"),
            "reached (%)": 100.0 * counts["sum"] / counts["size"],
            **{name: found[name] for name in MEASURES},
            "order": range(len(found)),
        }
    )
    return frame.rename_axis(["scene", "planner"]).reset_index()


def target_tables(steps: Steps) -> list[Table]:
    """The table of fixed targets: times at a glance, and all measures."""
    frame = fixed_target(steps)
    if frame.empty:
        return []
    title = "What it takes to come within a gap of the optimum"
    left_out = joined(maps_note(steps.runs), untimed_note(steps.runs))
    note = joined(NOTE, left_out)
    rows = Table(
        "fixed-target-rows", title, frame, note, infinite="never", detail=True, kinds=KINDS
    )
    if frame["scene"].nunique() > SIDE_BY_SIDE:
        return [rows]
    named = frame.assign(within=[f"{target:g} %" for target in frame["target (%)"]])
    ordered = planners_together(named, "target (%)", falling=True)
    glanced = at_a_glance(ordered, ["planner", "within"], _time)
    title = "Median time (ms) to come within a gap of the optimum"
    return [Table("fixed-target", title, glanced, joined(GLANCE_NOTE, left_out)), rows]


def _time(row: Mapping[Any, Any]) -> str:
    share = f"{row['reached']} of {row['runs']}"
    if np.isnan(row[TIME]):
        return f"contended ({share})"
    if np.isinf(row[TIME]):
        return f"never ({share})"
    return of_some(significant(row[TIME]), row["reached"], row["runs"])


def significant(value: float) -> str:
    """Three significant digits of what is below 100, and all whole ones of what is not.

    Examples
    --------
    >>> [significant(value) for value in (0.5, 99.96, 1234.5)]
    ['0.500', '100', '1234']
    """
    return f"{value:.0f}" if value >= 100.0 else f"{value:#.3g}".rstrip(".")
