"""Cells and records made by hand."""

from typing import Any

import numpy as np

from suite.planner import Budget, Improvement, PlanStatus
from suite.store.record import Cell, RunRecord


def make_cell(**changes: Any) -> Cell:
    values: dict[str, Any] = {
        "scene": "zigzag",
        "scene_source": "zigzag",
        "scene_hash": "0123",
        "query": "main",
        "variant": "kbga",
        "planner": "kbga",
        "distribution": "kbga-bench",
        "version": "0.1.0",
        "settings": {"population_size": 50},
        "budget": Budget(generations=100),
        "seed": 0,
    }
    return Cell(**(values | changes))


def make_record(cell: Cell | None = None, **changes: Any) -> RunRecord:
    values: dict[str, Any] = {
        "status": PlanStatus.SOLVED,
        "cost": 156.0,
        "claimed_cost": 156.0,
        "claim_differs": False,
        "optimum": 155.0,
        "gap": 156.0 / 155.0 - 1.0,
        "generations": 80,
        "generation_of_best": 50,
        "checks": 4000,
        "wall_s": 0.05,
        "time_to_best_s": 0.03,
        "cpu_s": 0.05,
        "cpu_to_best_s": 0.03,
        "contended": False,
        "improvements": (
            Improvement(0.01, 0.01, 200.0, 1, 60),
            Improvement(0.03, 0.03, 156.0, 50, 2500),
        ),
        "trace": ({"best": 200.0, "mean": 300.0}, {"best": 156.0, "diversity": 0.5}),
        "path": np.array([[6.0, 38.0], [1 / 3, 2 / 3], [94.0, 36.0]]),
        "details": {"restarts": 2.0},
    }
    return RunRecord(cell or make_cell(), **(values | changes))
