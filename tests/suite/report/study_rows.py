"""Rows of studies, made by hand: as the store gives them, of records as the harness makes them."""

import tempfile
from pathlib import Path
from typing import Any

import pandas as pd

from suite.planner import PlanStatus
from suite.store.read import read_runs
from suite.store.record import RunRecord
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

OPTIMUM = 100.0


def run(variant: str, settings: dict[str, Any], cost: float | None, **changes: Any) -> RunRecord:
    """A run that ended with a path of this cost, or with none if it is None."""
    named = ("scene", "scene_hash", "query", "seed", "planner", "budget")
    of_cell = {name: changes.pop(name) for name in named if name in changes}
    cell = make_cell(variant=variant, settings=settings, **of_cell)
    if cost is None:
        nothing = dict.fromkeys(("cost", "gap", "time_to_best_s", "cpu_to_best_s"))
        outcome = {"status": PlanStatus.EXHAUSTED, "claimed_cost": 1000.0, "path": None} | nothing
    else:
        outcome = {"cost": cost, "claimed_cost": cost, "gap": cost / OPTIMUM - 1.0}
    always = {"optimum": OPTIMUM, "started_at": "2026-01-01T00:00:00"}
    return make_record(cell, **always | outcome | changes)


def runs_of(*records: RunRecord) -> pd.DataFrame:
    """The rows that a store makes of these records."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "s.db"
        with open_store(file) as store:
            store.begin_session({})
            for record in records:
                store.add(record)
        return read_runs(file)
