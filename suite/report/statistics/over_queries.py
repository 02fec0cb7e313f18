"""Maps: what the planners did on each of many queries. The query is the unit, not the run.

A query's seeds are put together first: its gap is the mean over its runs with a path, its time to
come within a gap of the optimum the median over all of them. Only then is anything said of a map.
"""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.planner import PlanStatus
from suite.report.rows import is_of_map
from suite.report.statistics.anytime import Steps, final_gaps, first_within, only
from suite.report.statistics.clock import by_the_clock

TARGETS = (0.05, 0.02, 0.01)
"""Gaps to the optimum that a time is told for."""

EQUAL = 1e-6
"""Gaps that differ by less, as a share of the optimum, are equal."""

HARDEST = 8
"""Queries that are drawn on a map: lines of more can't be told apart."""

HARDEST_RULE = (
    "those that most planners find no path for; of equals those of the largest gap of the best "
    "planner, then of the largest mean gap"
)

QUERY = ["place", "query", "variant"]
"""What a row of the measures is of."""


def only_maps(steps: Steps, *, maps: bool = True) -> Steps:
    """The runs in scenes of many queries; or all others."""
    return only(steps, (is_of_map(steps.runs) == maps).to_numpy(dtype=np.bool_))


def time_to(target: float) -> str:
    """Name of the column of the times to come within a gap, seconds.

    Examples
    --------
    >>> time_to(0.02)
    'to 2 % (s)'
    """
    return f"to {100.0 * target:g} % (s)"


def quantile(values: NDArray[np.float64], share: float) -> float:
    """The least value that such a share of the queries does not exceed: one of theirs.

    Examples
    --------
    >>> quantile(np.array([4.0, 1.0, 2.0, 3.0]), 0.5)
    2.0
    """
    return float(np.quantile(values, share, method="inverted_cdf")) if len(values) else np.nan


def query_measures(steps: Steps) -> pd.DataFrame:
    """What each planner did on each query.

    Parameters
    ----------
    steps : Steps
        In the scenes that are wanted; see :func:`only_maps`.

    Returns
    -------
    DataFrame
        A row for each place, query and variant, in the order of their first runs: runs, solved
        (with a path, or the proof that there is none), found (with a path), optimum and cost (mean,
        metres), gap (mean over those with a path; nan without any), times to the targets (medians
        over the runs that had a core, seconds: infinite where half or more never did, nan where
        nobody knows), cpu to the targets (the same over all runs), clearance and turning (means,
        metres and radians).
    """
    runs = steps.runs
    found = np.isin(np.arange(len(runs)), steps.run)
    gap = final_gaps(steps)
    frame = runs[QUERY].assign(
        runs=1,
        solved=runs["status"].isin(PlanStatus.SUCCESSES).to_numpy(dtype=np.int64),
        found=found.astype(np.int64),
        optimum=steps.optimum,
        gap=np.where(found, gap, np.nan),
        **{name: runs[name].where(found) for name in ("cost", "clearance", "turning")},
    )
    by = [frame[name] for name in QUERY]
    groups = frame.drop(columns=QUERY).groupby(by, sort=False)
    sums = groups[["runs", "solved", "found"]].sum()
    # The optimum of a query is one number, but for rounding.
    means = groups[["cost", "gap", "clearance", "turning"]].mean()
    measures = sums.assign(optimum=groups["optimum"].max()).join(means).join(_times(steps))
    return measures.reset_index()


def _times(steps: Steps) -> pd.DataFrame:
    """Medians of the times to the targets, of which infinity is one."""
    timed = by_the_clock(steps.runs)
    columns = {}
    for target in TARGETS:
        wall = first_within(steps, "wall_s", target)
        columns[time_to(target)] = np.where(timed, wall, np.nan)
        columns[f"cpu {time_to(target)}"] = first_within(steps, "cpu_s", target)
    taken = pd.DataFrame(columns)
    by = [steps.runs[name] for name in QUERY]
    # Half way between a number and infinity is infinity; nan is left out.
    return taken.groupby(by, sort=False).median()


def hardest(measures: pd.DataFrame, most: int = HARDEST) -> list[str]:
    """The hardest queries of a map; see :data:`HARDEST_RULE`.

    Parameters
    ----------
    measures : DataFrame
        Of :func:`query_measures`, of one place.
    most : int

    Returns
    -------
    list of str
        Names of queries with an optimum, the hardest first.
    """
    by_query = measures.assign(failed=measures["found"] == 0).groupby("query", sort=False)
    ranked = by_query.agg(
        failed=("failed", "sum"),
        best=("gap", "min"),
        mean=("gap", "mean"),
        optimum=("optimum", "max"),
    )
    # Where no path exists there is none to be drawn.
    ranked = ranked[ranked["optimum"].notna()]
    ranked = ranked.sort_values(["failed", "best", "mean"], ascending=False, kind="stable")
    return [str(name) for name in ranked.index[:most]]
