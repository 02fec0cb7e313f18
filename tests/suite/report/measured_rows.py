"""Runs with the improvements that their planners reported, made by hand."""

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from suite.planner import Improvement
from suite.report.statistics.anytime import Steps, steps_of
from suite.store.read import read_events, read_runs
from suite.store.record import RunRecord
from suite.store.write import open_store
from tests.suite.report.study_rows import run


def measured(
    planner: str, seed: int, reports: Sequence[tuple[float, float]], **changes: Any
) -> RunRecord:
    """A run whose planner reported these costs (metres) at these times (ms); optimum 100 m.

    It ends with the last of them, or without a path if there are none. It reports a generation
    for each millisecond and ten checks.
    """
    improvements = tuple(
        Improvement(ms / 1e3, ms / 2e3, cost, int(ms), int(10 * ms)) for ms, cost in reports
    )
    cost = changes.pop("cost", reports[-1][1] if reports else None)
    ends = {"wall_s": 0.05, "cpu_s": 0.025, "generations": 50, "checks": 500}
    if reports:
        ends["time_to_best_s"] = improvements[-1].wall_s
    given = {"improvements": improvements, "planner": planner, "seed": seed}
    return run(planner, {}, cost, **ends | given | changes)


def frames_of(*records: RunRecord) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The rows and events that a store makes of these records."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "s.db"
        with open_store(file) as store:
            store.begin_session({})
            for record in records:
                store.add(record)
        return read_runs(file), read_events(file)


def steps(*records: RunRecord) -> Steps:
    """These records as step functions."""
    return steps_of(*frames_of(*records))
