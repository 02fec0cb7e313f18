"""Fixed budget: how good the best path is after so much wall time.

A run without a path yet is not dropped: its gap is infinite, and the median is over all runs.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.report.rows import maps_note
from suite.report.statistics.anytime import Steps, cost_at, on_clock
from suite.report.statistics.clock import untimed_note
from suite.report.statistics.inference import Array
from suite.report.table import Table
from suite.report.tables.glance import SIDE_BY_SIDE, at_a_glance, planners_together
from suite.report.tables.targets import medians
from suite.report.words import fixed, joined, of_some
from suite.store.gap import gaps

BUDGETS_S = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0)
"""Wall time, seconds."""

STOPPED = 0.99
"""Share of its own budget from which a run counts as stopped by it, and not by itself."""

NOTE = (
    "Medians over all runs: one without a path yet has an infinite gap, so that 'no path', among "
    "all measures 'infinite', stands where half of the runs or more had none. Where start and goal "
    "are one place, the gap of a path of any length is infinite, too. A run that ended by itself "
    "keeps its last path. Empty where a run was stopped by a budget of less wall time: nobody "
    "knows."
)


def fixed_budget(steps: Steps) -> pd.DataFrame:
    """How good each planner's paths are after each of the budgets, scene by scene.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    DataFrame
        A row for each scene with an optimum, planner and budget: runs, how many had a path, and
        the median gap over all of them, infinite where half or more had none.
    """
    steps = on_clock(steps, "wall_s")
    with_optimum = ~np.isnan(steps.optimum)
    names = steps.runs.loc[with_optimum, ["place", "variant"]]
    frames = [_after(steps, budget, with_optimum, names) for budget in BUDGETS_S]
    frame = pd.concat(frames).rename_axis(["scene", "planner"]).reset_index()
    known = frame[frame["gap median (%)"].notna()]
    known = known.sort_values(["order", "budget (ms)"]).drop(columns="order")
    return known.reset_index(drop=True)


def _after(
    steps: Steps, budget_s: float, wanted: NDArray[np.bool_], names: pd.DataFrame
) -> pd.DataFrame:
    """The rows of one budget."""
    cost = _cost(steps, budget_s)[wanted]
    gap = gaps(cost, steps.optimum[wanted])
    measured = pd.DataFrame({"gap": gap, "has path": np.isfinite(cost)}, index=names.index)
    groups = measured.groupby([names[column] for column in names], sort=False)["has path"]
    return pd.DataFrame(
        {
            "budget (ms)": 1e3 * budget_s,
            "runs": groups.size(),
            "with path": groups.sum().astype("int64"),
            "with path (%)": 100.0 * groups.mean(),
            "gap median (%)": 100.0 * medians(measured[["gap"]], names)["gap"],
            "order": range(groups.ngroups),
        }
    )


def _cost(steps: Steps, budget_s: float) -> Array:
    """Cost of each run after so much time, infinite without a path; nan if stopped before."""
    own = steps.runs["budget_wall_s"]
    stopped = (own < budget_s) & (steps.runs["wall_s"] >= STOPPED * own)
    return np.where(stopped, np.nan, cost_at(steps, "wall_s", budget_s))


def budget_tables(steps: Steps) -> list[Table]:
    """The table of fixed budgets: gaps at a glance, and all measures."""
    frame = fixed_budget(steps)
    if frame.empty:
        return []
    title = "Paths found, and their gap, after a fixed wall time"
    told = joined(NOTE, maps_note(steps.runs), untimed_note(steps.runs))
    rows = Table("fixed-budget-rows", title, frame, told, detail=True)
    if frame["scene"].nunique() > SIDE_BY_SIDE:
        return [rows]
    named = frame.assign(after=[f"{budget:g} ms" for budget in frame["budget (ms)"]])
    ordered = planners_together(named, "budget (ms)")
    glanced = at_a_glance(ordered, ["planner", "after"], _cell)
    note = f"k of n: how many runs had a path. {told}"
    title = "Median gap (%) after a fixed wall time"
    return [Table("fixed-budget", title, glanced, note), rows]


def _cell(row: Mapping[Any, Any]) -> str:
    # With start and goal in one place a path may have an infinite gap, too.
    if np.isinf(row["gap median (%)"]) and 2 * row["with path"] <= row["runs"]:
        return f"no path ({row['with path']} of {row['runs']})"
    return of_some(fixed(row["gap median (%)"]), row["with path"], row["runs"])
