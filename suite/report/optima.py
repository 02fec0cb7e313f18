"""Rows that can't be right: a path that is shorter than the shortest, or one query of two optima.

An optimum of another geometry makes any gap, and most of these look like results. Where it shows,
no table is made.
"""

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.errors import KbgaBenchError
from suite.report.rows import is_simulated
from suite.store.gap import ROUNDING

PLACE = 1e-8
"""Metres by which the length of a segment may be off, because its ends are rounded: scenes have a
grid of 1e-9 m, and float64 holds the coordinates of any place on earth to 4e-9 m."""

SEGMENTS = 100.0
"""Of a path, where nobody kept how many: more than those of planners have."""

MEND = (
    "One of its numbers is of another geometry, or was computed wrong. Run its matrix again with "
    "--force, or into a new store."
)


def check_optima(runs: pd.DataFrame) -> None:
    """Refuse rows of which one has a path below its optimum, or two have two optima of one query.

    Simulated runs are not asked: the robot that theirs are measured by may be led astray.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Raises
    ------
    KbgaBenchError
        With the first of these rows, and how to mend it.
    """
    runs = runs[~is_simulated(runs)]
    segments = np.asarray(runs["segments"].astype("float64").fillna(1.0), dtype=np.float64)
    cost, optimum = (runs[name].to_numpy(dtype=np.float64) for name in ("cost", "optimum"))
    below = np.flatnonzero(_is_below(cost, optimum, segments))
    if below.size:
        i = int(below[0])
        raise KbgaBenchError(
            f"row {_named(runs.iloc[i])}: its path has {cost[i]:.9g} m, less than the shortest, of "
            f"{optimum[i]:.9g} m ({100.0 * (cost[i] / optimum[i] - 1.0):.3g} %). {MEND}"
        )
    _check_one_optimum(runs[runs["optimum"].notna()])


def check_replans(replans: pd.DataFrame) -> None:
    """Refuse updates of simulated runs of which one has a path below its optimum.

    Parameters
    ----------
    replans : DataFrame
        As :func:`suite.store.read.read_replans` gives it.

    Raises
    ------
    KbgaBenchError
        With the first of these updates, and how to mend it.
    """
    cost, optimum = (replans[name].to_numpy(dtype=np.float64) for name in ("cost", "optimum"))
    below = np.flatnonzero(_is_below(cost, optimum, SEGMENTS))
    if below.size:
        i = int(below[0])
        row = replans.iloc[i]
        raise KbgaBenchError(
            f"row {row['key']}, update at {row['time']} s: its path has {cost[i]:.9g} m, less than "
            f"the shortest, of {optimum[i]:.9g} m. {MEND}"
        )


def _is_below(
    cost: NDArray[np.float64], optimum: NDArray[np.float64], segments: NDArray[np.float64] | float
) -> NDArray[np.bool_]:
    """Whether costs lie below optima by more than rounding; nan lies nowhere."""
    return np.asarray(cost < optimum * (1.0 - ROUNDING) - PLACE * segments, dtype=np.bool_)


def _check_one_optimum(runs: pd.DataFrame) -> None:
    """Rows of the same geometry and query were measured by the same length."""
    groups = runs.groupby(["scene", "query", "scene_hash"], sort=False)["optimum"]
    least, most = (groups.transform(what).to_numpy(dtype=np.float64) for what in ("min", "max"))
    differing = np.flatnonzero(_is_below(least, most, SEGMENTS))
    if differing.size:
        first = runs.iloc[int(differing[0])]
        same = runs[["scene", "query", "scene_hash"]] == first[["scene", "query", "scene_hash"]]
        group = runs[same.all(axis=1)]
        optima = group["optimum"].to_numpy(dtype=np.float64)
        low, high = int(optima.argmin()), int(optima.argmax())
        raise KbgaBenchError(
            f"rows {_named(group.iloc[low])} and {_named(group.iloc[high])}: the same query "
            f"has the optima {optima[low]:.9g} m and {optima[high]:.9g} m. {MEND}"
        )


def _named(row: "pd.Series[Any]") -> str:
    return f"{row['key']} ({row['scene']} / {row['query']} / {row['variant']} / seed {row['seed']})"
