"""One row again, from its own record: whether its path is the same."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import shapely
from numpy.typing import NDArray

from suite.errors import StoreError
from suite.planner import Budget
from suite.record import Cell, RunRecord, World
from suite.store import read_paths, read_runs

LEAST_DIGITS = 4
"""Of a key that is cut short: fewer name too many rows to be meant."""


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

    @property
    def as_dict(self) -> dict[str, Any]:
        """The same as plain data."""
        return asdict(self)


def cell_of(store: Path, key: str) -> Cell:
    """The cell of a row, from what the row says.

    Parameters
    ----------
    store : Path
    key : str
        Of the row, or its beginning.

    Raises
    ------
    StoreError
        If no row, or more than one, has such a key.
    """
    runs = read_runs(store)
    found = runs[runs["key"].str.startswith(key)] if len(key) >= LEAST_DIGITS else runs[:0]
    if len(found) != 1:
        many = f"{len(found)} rows begin" if len(found) else "no row begins"
        raise StoreError(
            f"{store}: {many} with '{key}'. Give more of the key, {LEAST_DIGITS} digits at least; "
            "`kbga-bench export` lists them."
        )
    return _cell(found.to_dict("records")[0])


def compare(store: Path, again: RunRecord) -> Comparison:
    """Compare a repeated run with its row.

    Parameters
    ----------
    store : Path
        That has the row.
    again : RunRecord
        Of the cell of :func:`cell_of`.
    """
    key = again.cell.key
    runs = read_runs(store)
    row = runs[runs["key"] == key].to_dict("records")[0]
    before, now = read_paths(store).get(key), again.path
    same = row["status"] == again.status and _equal(before, now)
    timed = again.cell.budget.wall_s is not None or _is_charged(again.cell)
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
    return f"not the same: {ends}{costs}{apart}; {why}."


def _equal(one: NDArray[np.float64] | None, other: NDArray[np.float64] | None) -> bool:
    if one is None or other is None:
        return one is None and other is None
    return bool(np.array_equal(one, other))


def _is_charged(cell: Cell) -> bool:
    """Whether the time that planning takes moves the world on."""
    return cell.world is not None and cell.world.settings.get("charge") == "measured"


def _cell(row: dict[Any, Any]) -> Cell:
    world = None
    if isinstance(row["world_settings"], str):
        settings = json.loads(row["world_settings"])
        world = World(row["world"], settings, bool(row["cold"]))
    counts = {name: _whole(row[f"budget_{name}"]) for name in ("generations", "checks")}
    wall_s = row["budget_wall_s"]
    names = (
        "scene", "scene_source", "scene_hash", "query", "variant", "planner", "distribution",
        "version",
    )  # fmt: skip
    return Cell(
        **{name: row[name] for name in names},
        settings=json.loads(row["settings"]),
        budget=Budget(None if pd.isna(wall_s) else float(wall_s), **counts),
        seed=int(row["seed"]),
        world=world,
        position=int(row["position"]),
    )


def _whole(value: Any) -> int | None:
    return None if pd.isna(value) else int(value)
