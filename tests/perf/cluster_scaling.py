"""Rows per second of a matrix on 1, 2, 4 and 8 workers, and on so many threads of this process.

python -m tests.perf.cluster_scaling results/harness [--workers 1 2 4 8] [--rows 30]

Weak scaling: every worker has as many rows as in all other matrices. The planner sleeps, so that
what is measured is what the harness can hand out and take in, and not the machine's cores; the
workers are processes of this machine with one thread each.
"""

import argparse
import os
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd
import shapely

from suite.harness.cluster.executors import connect
from suite.harness.matrix import load_matrix
from suite.harness.run import run_matrix
from suite.plugins.from_file import name_plugins
from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.table import Table
from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene
from suite.store.read import read_runs
from suite.store.write import open_store
from tests.suite.harness.cluster.dask_on_loopback import Cluster

SLEEP_S = 0.5

SLEEPER = f'''
import time

import numpy as np

from suite.planner import Plan, Planner, PlanStatus


class Sleeper(Planner):
    """Sleeps, and goes straight on."""

    name = "asleep"

    def plan(self, scene, query, budget, rng, recorder):
        time.sleep({SLEEP_S})
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))
'''


def measure(numbers, rows, folder):
    """A row for each number of workers, on dask and on this machine."""
    (folder / "sleeper.py").write_text(SLEEPER)
    room = shapely.box(0, 0, 10, 10)
    write_scene(make_scene("room", room, [], {"main": ((1, 3), (9, 3))}), folder / "room.geojson")
    name_plugins([str(folder / "sleeper.py")])
    found = []
    for workers in numbers:
        found.append(_on_dask(workers, workers * rows, folder))
        found.append(_timed("local", workers, workers * rows, folder, None))
    return found


def _on_dask(workers, rows, folder):
    own = folder / f"dask-{workers}"
    own.mkdir()
    cluster = Cluster(own, dict(os.environ))
    try:
        for _ in range(workers):
            cluster.add_worker()
        cluster.wait_for(workers)
        with connect(cluster.address) as executor:
            return _timed("dask", workers, rows, folder, executor)
    finally:
        cluster.close()


def _timed(where, workers, rows, folder, executor):
    matrix = folder / "matrix.toml"
    matrix.write_text(
        f'scenes = ["room.geojson"]\nseeds = {rows}\n[[planner]]\nplanner = "asleep"\n'
    )
    store = folder / f"{where}-{workers}.db"
    times = []
    with open_store(store) as opened:
        begin = time.perf_counter()
        run_matrix(
            load_matrix(matrix), opened, jobs=workers, executor=executor,
            on_progress=lambda progress: _note(progress, times),
        )  # fmt: skip
        end = time.perf_counter()
    runs = read_runs(store)
    assert runs["status"].tolist() == ["solved"] * rows, runs["reason"].dropna().unique()
    # When the first rows come, all are awake: a fork server is warm, a worker has its files.
    rate = (rows - workers) / (times[rows - 1] - times[workers - 1])
    return {
        "executor": where,
        "workers": workers,
        "rows": rows,
        "all of it (s)": end - begin,
        "until all are awake (s)": times[workers - 1] - begin,
        "rows per second": rate,
        "of the ideal (%)": 100.0 * rate * SLEEP_S / workers,
    }


def _note(progress, times):
    """When each row came."""
    times += [time.perf_counter()] * (progress.done - len(times))


def scaling_table(measured, load):
    """The table that stands in results/harness."""
    return Table(
        "cluster-scaling",
        f"Weak scaling of the harness: a planner that sleeps {SLEEP_S} s",
        pd.DataFrame(measured),
        note="Rows per second from the row at which every worker has had one to the last. The "
        f"ideal is one row of each worker every {SLEEP_S} s. dask: scheduler and workers, one "
        "thread each, are processes of this machine; local: `--executor local` with so many jobs. "
        f"{os.cpu_count()} cores, whose load average was {load:.1f} before.",
    )


def main(arguments=None):
    """Measure, write the table and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2, 4, 8])
    parser.add_argument("--rows", type=int, default=30, help="of each worker")
    given = parser.parse_args(arguments)
    load = os.getloadavg()[0]
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        table = scaling_table(measure(given.workers, given.rows, Path(folder)), load)
    given.folder.mkdir(parents=True, exist_ok=True)
    text = render(table, TableFormat.MARKDOWN)
    (given.folder / "cluster-scaling.md").write_text(text)
    (given.folder / "cluster-scaling.csv").write_text(render(table, TableFormat.CSV))
    sys.stdout.write(text)


if __name__ == "__main__":
    main()
