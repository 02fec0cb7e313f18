"""One row again, from its own record: whether its path is the same."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import shapely
from numpy.typing import NDArray

from suite.errors import sentence
from suite.store.read import read_paths, read_runs
from suite.store.record import RunRecord


@dataclass(frozen=True, slots=True)
class Comparison:
    """A row and its repetition.

    same : whether both ended alike, with the same path bit for bit.
    must_be_same : whether the row can be repeated: its budget is not of time.
    distance : Hausdorff distance of the two paths, metres; None if one of them is missing.
    words : what a person needs to know.
    """

    same: bool
    must_be_same: bool
    distance: float | None
    words: str


def compare(store: Path, again: RunRecord) -> Comparison:
    """Compare a repeated run with its row.

    Parameters
    ----------
    store : Path
        That has the row.
    again : RunRecord
        Of the cell that :func:`suite.store.row_names.cell_of` found.
    """
    key = again.cell.key
    runs = read_runs(store)
    row = runs[runs["key"] == key].to_dict("records")[0]
    before, now = read_paths(store).get(key), again.path
    same = row["status"] == again.status and same_path(before, now)
    timed = again.cell.time_counts
    distance = None
    if before is not None and now is not None and len(before) > 1 and len(now) > 1:
        lines = (shapely.LineString(before), shapely.LineString(now))
        distance = float(shapely.hausdorff_distance(*lines))
    return Comparison(same, not timed, distance, _in_words(row, again, same, timed, distance))


def _in_words(
    row: dict[Any, Any], again: RunRecord, same: bool, timed: bool, distance: float | None
) -> str:
    if same:
        return f"the same: {again.status}, and the path is the same bit for bit."
    ends = f"{row['status']} before, {again.status} now"
    costs = (
        f"; {row['cost']:.6f} m before, {again.cost:.6f} m now"
        if (again.cost is not None and pd.notna(row["cost"]))
        else ""
    )
    apart = f"; the paths are up to {distance:.3g} m apart" if distance is not None else ""
    why = (
        "its time counts, so that is to be expected"
        if timed
        else (
            "its budget is counted, so it should be the same: another machine, version or plugin?"
        )
    )
    return f"not the same: {ends}{costs}{apart}; {sentence(why)}"


def same_path(one: NDArray[np.float64] | None, other: NDArray[np.float64] | None) -> bool:
    """Whether two paths are the same bit for bit, or both are missing."""
    if one is None or other is None:
        return one is None and other is None
    return bool(np.array_equal(one, other))
