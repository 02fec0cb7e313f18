"""The cells of rows, from what the rows of a store say of them."""

import json
from collections.abc import Mapping
from typing import Any

import pandas as pd

from suite.planner import Budget
from suite.record import Cell, World

_SAME_NAME = (
    "scene", "scene_source", "scene_hash", "query", "variant", "planner", "distribution", "version",
)  # fmt: skip
"""Fields of a cell that are columns of a row as they are."""


def stored_cell(row: Mapping[Any, Any]) -> Cell:
    """The cell of a row.

    Parameters
    ----------
    row : mapping
        One of :func:`suite.store.read_runs`.
    """
    world = None
    if isinstance(row["world_settings"], str):
        settings = json.loads(row["world_settings"])
        world = World(row["world"], settings, bool(row["cold"]))
    counts = {name: _whole(row[f"budget_{name}"]) for name in ("generations", "checks")}
    wall_s, cpu_s = (_seconds(row.get(f"budget_{name}")) for name in ("wall_s", "cpu_s"))
    return Cell(
        **{name: row[name] for name in _SAME_NAME},
        settings=json.loads(row["settings"]),
        budget=Budget(wall_s, cpu_s=cpu_s, **counts),
        seed=int(row["seed"]),
        world=world,
        position=int(row["position"]),
    )


def _seconds(value: Any) -> float | None:
    return None if value is None or pd.isna(value) else float(value)


def _whole(value: Any) -> int | None:
    return None if pd.isna(value) else int(value)
