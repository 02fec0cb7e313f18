"""What the harness costs beside the planners: `make harness`.

python -m tests.perf.harness results/harness [--runs 200] [--rows 10000]

Two measurements, one after the other, of one machine that does nothing else. First a run of KBGA on
`zigzag`, again and again, one at a time: how long until its row is in the store, less the time of
`plan` itself. Then a matrix of a planner that takes no time, with the command itself.
"""

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import psutil
import shapely

from suite.harness.cell import run_cell
from suite.harness.fleet import start_server
from suite.harness.isolate import run_isolated
from suite.harness.matrix import Limits
from suite.harness.provenance import provenance
from suite.harness.run import warmth_for
from suite.harness.single import cell_for
from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene
from suite.store.read import read_runs
from suite.store.record import Cell, RunRecord
from suite.store.write import Store, open_store
from tests.perf.harness_table import write

PLANNER, SCENE = "kbga", "zigzag"

PROGRAM = [sys.executable, "-c", "from suite.cli import main; main()"]

WARM_RUNS = 5
"""The first ones wait for the server to warm up."""

SAMPLE_S = 0.1

STRAIGHT_LINE = '''
import numpy as np
from suite.planner import Plan, Planner, PlanStatus

class StraightLine(Planner):
    """Goes straight on."""

    name = "straight-line"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))
'''


def measure_overhead(runs: int, folder: Path) -> dict[str, Any]:
    """Seconds of each run of KBGA: in all, of the planner, and of the parts of the rest."""
    cells = [cell_for(SCENE, PLANNER, seed=seed) for seed in range(runs + WARM_RUNS)]
    limits = Limits()
    warmth = warmth_for(cells, limits)
    start_server(warmth)
    with open_store(folder / "overhead.db") as store:
        store.begin_session(provenance("harness"))
        timed = [_timed(cell, store, lambda c: run_isolated(c, limits, warmth)) for cell in cells]
    here = [_in_this_process(cell) for cell in cells]
    return {
        "scene": SCENE,
        "planner": PLANNER,
        "runs": [run | parts for run, parts in zip(timed, here, strict=True)][WARM_RUNS:],
    }


def _timed(cell: Cell, store: Store, run: Any) -> dict[str, float]:
    begin = time.perf_counter()
    record: RunRecord = run(cell)
    came = time.perf_counter()
    store.add(record)
    end = time.perf_counter()
    assert record.wall_s is not None, record.reason
    return {"run_s": came - begin, "store_s": end - came, "plan_s": record.wall_s}


def _in_this_process(cell: Cell) -> dict[str, float]:
    """What a run does before and after `plan`, with everything loaded, as a warmed process has."""
    ready: list[float] = []
    begin = time.perf_counter()
    record = run_cell(cell, before_plan=lambda: ready.append(time.perf_counter()))
    end = time.perf_counter()
    assert record.wall_s is not None, record.reason
    return {"before_s": ready[0] - begin, "after_s": end - ready[0] - record.wall_s}


def measure_rows(rows: int, jobs: int, folder: Path) -> dict[str, Any]:
    """A matrix of a planner that takes no time, and the tables of its store, by the command."""
    matrix, store = _matrix(rows, folder), folder / "rows.db"
    environment = {**os.environ, "PYTHONPATH": _with_path(folder)}
    run = _command(
        ["run", str(matrix), "--store", str(store), "--jobs", str(jobs), "--patience", "0"],
        environment,
    )
    tables = _command(["tables", str(store)], environment)
    found = read_runs(store)
    assert len(found) == rows
    assert set(found["status"]) == {"solved"}
    return {"rows": rows, "jobs": jobs, "run": run, "tables": tables,
            "plan_s": float(found["wall_s"].median())}  # fmt: skip


def _matrix(rows: int, folder: Path) -> Path:
    """The matrix, and the scene and the distribution that it needs."""
    (folder / "straight_line.py").write_text(STRAIGHT_LINE)
    info = folder / "straight_line-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: straight-line\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[kbga_bench.planners]\nstraight-line = straight_line:StraightLine\n"
    )
    room, block = shapely.box(0, 0, 10, 10), shapely.box(4, 0, 6, 2)
    scene = make_scene("one block", room, [block], {"main": ((1, 3), (9, 3))})
    write_scene(scene, folder / "block.geojson")
    matrix = folder / "rows.toml"
    matrix.write_text(
        f'scenes = ["block.geojson"]\nseeds = {rows}\n[[planner]]\nplanner = "straight-line"\n'
    )
    return matrix


def _with_path(folder: Path) -> str:
    return os.pathsep.join(filter(None, (str(folder), os.environ.get("PYTHONPATH"))))


def _command(arguments: list[str], environment: dict[str, str]) -> dict[str, float]:
    """Seconds and most resident bytes of the process of a command, without its children."""
    begin, most = time.perf_counter(), 0
    command = subprocess.Popen([*PROGRAM, *arguments], env=environment, stdout=subprocess.DEVNULL)
    process = psutil.Process(command.pid)
    while command.poll() is None:
        try:
            most = max(most, process.memory_info().rss)
        except psutil.Error:
            break
        time.sleep(SAMPLE_S)
    assert command.wait() == 0, arguments
    return {"seconds": time.perf_counter() - begin, "most_bytes": most}


def measure(runs: int, rows: int, jobs: int) -> dict[str, Any]:
    """Everything, as plain data."""
    load = os.getloadavg()[0]
    with TemporaryDirectory() as name:
        folder = Path(name)
        return {
            "provenance": provenance("harness") | {"load_before": load},
            "overhead": measure_overhead(runs, folder),
            "rows": measure_rows(rows, jobs, folder),
        }


def main(arguments: list[str] | None = None) -> None:
    """Measure, write the results and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--runs", type=int, default=200, help="of KBGA, one at a time")
    parser.add_argument("--rows", type=int, default=10_000, help="of the planner that does nothing")
    parser.add_argument("--jobs", type=int, default=2, help="of those rows at a time")
    given = parser.parse_args(arguments)
    sys.stdout.write(write(measure(given.runs, given.rows, given.jobs), given.folder))


if __name__ == "__main__":
    main()
