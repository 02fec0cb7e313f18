"""A report of 100,000 rows: what it may cost."""

import resource
import subprocess

import pytest

from suite.planner import Improvement
from suite.store.write import open_store
from tests.suite.commands import COMMAND
from tests.suite.harness.records import make_cell, make_record
from tests.suite.report.html.stores import SESSION

SCENES = ("unstructured", "maze", "zigzag", "double_u", "clustered")
ROWS = 100_000
GIB = 2**30


@pytest.mark.slow
def test_it_needs_little_memory_and_stays_small(tmp_path):
    planners, steps = 10, 10
    with open_store(tmp_path / "s.db") as store:
        store.begin_session(SESSION)
        for number in range(ROWS):
            seed, rest = divmod(number, len(SCENES) * planners)
            cell = make_cell(
                scene=SCENES[rest % len(SCENES)],
                scene_source=SCENES[rest % len(SCENES)],
                variant=f"planner {rest // len(SCENES)}",
                seed=seed,
            )
            last = 156.0 + (seed * 7919 % 1000) / 100
            times = [0.001 * (i + 1) * (1 + seed % 7) for i in range(steps)]
            found = [
                Improvement(time, time, last + 5.0 * (steps - 1 - i), i, 100 * i)
                for i, time in enumerate(times)
            ]
            store.add(make_record(cell, cost=last, gap=last / 155 - 1, improvements=tuple(found)))
    out = tmp_path / "s.html"
    command = [*COMMAND, "report", str(tmp_path / "s.db"), "-o", str(out)]
    subprocess.run(command, check=True)
    kibibytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    assert kibibytes * 1024 < 1.5 * GIB
    assert out.stat().st_size < 10e6
