"""Stores for the report, filled by real runs in this process."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from suite.harness.cell import run_cell
from suite.harness.single import cell_for
from suite.harness.snapshots import chosen_generations
from suite.planner import PlanStatus, Recorder
from suite.store.record import Cell, RunRecord
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

SESSION = {
    "matrix": "mine",
    "started_at": "2026-01-01T00:00:00+00:00",
    "host": "somewhere",
    "cpu": "a processor",
    "cores": 2,
    "python": "3.11.0",
    "versions": {"numpy": "2.0.0"},
    "git": {"commit": "0123456789abcdef", "dirty": True},
}
TRACEBACK = "Traceback (most recent call last):\n  ...\nValueError: <b>no</b> & no"


def write_store(file: Path, records: Iterable[RunRecord] = (), wanted: Iterable[Cell] = ()) -> Path:
    """A store of these records; those that have snapshots have them in it too.

    As on an idle machine: the tests run beside each other, and the report would leave out rows that
    had no core.
    """
    with open_store(file) as store:
        store.begin_session(SESSION)
        for record in records:
            store.add(record if record.contended is None else replace(record, contended=False))
            store.add_snapshots(record.cell.key, record.snapshots)
        store.want("mine", wanted)
    return file


def ran(scene: str | Path, planner: str, seed: int = 0) -> RunRecord:
    """A real run; of planners with a population with snapshots."""
    recorder = Recorder(snapshot_of=chosen_generations(100).__contains__)
    record = run_cell(cell_for(str(scene), planner, seed=seed), recorder=recorder)
    assert record.status is not PlanStatus.ERROR, record.reason
    return replace(record, snapshots=tuple(recorder.snapshots))


def failed(status: PlanStatus = PlanStatus.ERROR, reason: str = TRACEBACK, **cell) -> RunRecord:
    """A run that ended badly, made by hand."""
    nothing = dict.fromkeys(
        (
            "cost",
            "gap",
            "optimum",
            "claimed_cost",
            "time_to_best_s",
            "cpu_to_best_s",
            "path",
            "claim_differs",
        )
    )
    return make_record(
        make_cell(**cell), **nothing, status=status, reason=reason, improvements=(), trace=()
    )


def some_store(file: Path) -> Path:
    """Two scenes, three planners, three seeds; one planner fails once, two runs were not done."""
    records = [
        ran(scene, planner, seed)
        for scene in ("zigzag", "double_u")
        for planner in ("kbga", "visibility-graph")
        for seed in range(3)
    ]
    hash_of_zigzag = records[0].cell.scene_hash
    bad = failed(variant="bad-planner", planner="bad-planner", scene_hash=hash_of_zigzag)
    left = [make_cell(variant="never-run", seed=seed) for seed in range(2)]
    return write_store(file, [*records, bad], [bad.cell, *left])
