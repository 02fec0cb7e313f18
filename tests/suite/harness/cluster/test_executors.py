import multiprocessing
import os
import sys
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from types import SimpleNamespace

import dask
import numpy as np
import psutil
import pytest
from distributed import KilledWorker

from suite.errors import HarnessError
from suite.harness.cluster import executors
from suite.harness.cluster.executors import connect, new_session, record_of
from suite.harness.cluster.worker import Session, describe, run_for
from suite.harness.fork_server import Warmth
from suite.harness.matrix import Limits, load_matrix
from suite.harness.run import run_matrix
from suite.harness.single import cell_for
from suite.planner import PlanStatus
from suite.store.read import read_paths, read_runs, read_sessions
from suite.store.write import open_store
from tests.suite.commands import in_own_process
from tests.suite.harness.cluster.dask_on_loopback import START_S, Cluster, wait_until
from tests.suite.harness.records import make_cell

SEEDS = 6


@pytest.fixture
def cluster(hostile, tmp_path, monkeypatch):
    # Its processes are still starting when it is connected to.
    monkeypatch.setattr(executors, "CONNECT_S", START_S)
    monkeypatch.setattr(executors, "FIRST_WORKER_S", START_S)
    found = Cluster(tmp_path, {**os.environ, "TMPDIR": str(tmp_path)})
    yield found
    found.close()


def run(matrix, file, **options):
    with open_store(file) as store:
        run_matrix(matrix, store, **options)
    return read_runs(file).set_index("key"), read_paths(file)


def test_a_cluster_gives_the_same_rows_though_a_worker_dies(cluster, matrix_file, tmp_path):
    matrix = load_matrix(matrix_file("wanderer", "sleeper", "raises", seeds=SEEDS))
    first, _ = cluster.add_worker(), cluster.add_worker()
    killed = []

    def kill_first(progress):
        if progress.done >= 3 and not killed and first.children(recursive=True):
            first.kill()
            killed.append(progress.done)

    cluster.wait_for(2)
    with connect(cluster.address) as there:
        runs, paths = run(matrix, tmp_path / "dask.db", executor=there, on_progress=kill_first)
        assert there.slots() == 1
    assert killed
    assert killed[0] < 3 * SEEDS
    local, local_paths = run(matrix, tmp_path / "local.db", jobs=2)
    assert runs.index.tolist() == local.index.tolist()
    assert runs["status"].tolist() == local["status"].tolist()
    assert paths.keys() == local_paths.keys()
    for key, path in paths.items():
        np.testing.assert_array_equal(path, local_paths[key])
    (session,) = read_sessions(tmp_path / "dask.db")
    assert session["scheduler"] == cluster.address
    assert [worker["host"] for worker in session["workers"]] == [session["host"]]


def test_an_interruption_ends_the_runs_on_the_workers(cluster, matrix_file, tmp_path):
    worker = cluster.add_worker()
    busy = 2  # the fork server and the run
    matrix = load_matrix(matrix_file("hangs-in-c", seeds=3))

    told = []

    def interrupt(progress):
        told.append(progress.running)
        # At first the worker asks for the scene's file.
        if len(told) > 2:
            wait_until(lambda: len(family(worker)) >= busy)
            raise KeyboardInterrupt

    cluster.wait_for(1)
    with connect(cluster.address) as there, pytest.raises(KeyboardInterrupt) as interrupted:
        run(matrix, tmp_path / "s.db", executor=there, on_progress=interrupt)
    assert not getattr(interrupted.value, "__notes__", [])
    wait_until(lambda: len(family(worker)) < busy)
    assert worker.is_running()
    assert read_runs(tmp_path / "s.db").empty


def family(worker):
    """What descends from a worker and still runs."""
    return [p for p in worker.children(recursive=True) if is_of_the_server(p)]


def is_of_the_server(process):
    try:
        is_dead = process.status() == psutil.STATUS_ZOMBIE
        return not is_dead and "forkserver" in " ".join(process.cmdline())
    except psutil.Error:
        # It ended between the two questions.
        return False


def test_a_scheduler_that_is_not_there_is_an_error_before_anything_is_written(
    matrix_file, tmp_path, monkeypatch
):
    monkeypatch.setattr(executors, "CONNECT_S", 0.5)
    with pytest.raises(HarnessError, match="no dask scheduler answers at tcp://127"):
        connect("tcp://127.0.0.1:9")
    with pytest.raises(HarnessError, match="known schemes"):
        connect("nonsense://127.0.0.1:9")
    store = tmp_path / "s.db"
    command = ("run", matrix_file("wanderer"), "--store", store, "--executor", "dask")
    assert "Give --executor dask and --address together" in in_own_process(*command, code=2).err
    assert not store.exists()


@pytest.mark.slow
def test_a_dry_run_counts_with_the_workers_of_the_cluster(cluster, matrix_file, tmp_path):
    for _ in range(3):
        cluster.add_worker()
    store = tmp_path / "s.db"
    command = ("run", matrix_file("wanderer"), "--store", store, "--dry-run")
    there = ("--executor", "dask", "--address", cluster.address)
    cluster.wait_for(3)
    assert "with 3 jobs" in in_own_process(*command, *there).out
    assert "with 5 jobs" in in_own_process(*command, *there, "--jobs", "5").out
    assert not store.exists()


def test_a_cluster_without_workers_says_how_to_start_some(cluster, monkeypatch):
    monkeypatch.setattr(executors, "FIRST_WORKER_S", 0.5)
    with pytest.raises(HarnessError, match=f"dask worker {cluster.address} --no-nanny"):
        connect(cluster.address)


def test_a_run_that_takes_its_workers_along_is_a_row():
    future = Future()
    future.set_exception(KilledWorker("run-1", SimpleNamespace(address="tcp://node7:1"), 3))
    record = record_of(future, make_cell())
    assert record.status is PlanStatus.CRASHED
    assert "tcp://node7:1" in record.reason


def test_a_cluster_that_is_lost_says_how_to_go_on():
    future = Future()
    future.cancel()
    with pytest.raises(HarnessError, match="All finished runs are kept; to go on"):
        record_of(future, make_cell())


@pytest.mark.slow
def test_a_scheduler_that_dies_ends_the_matrix_and_keeps_its_rows(cluster, matrix_file, tmp_path):
    def kill_scheduler(progress):
        if progress.done == 1:
            cluster.processes[0].kill()

    matrix = load_matrix(matrix_file("wanderer", "sleeper", seeds=SEEDS))
    cluster.add_worker()
    cluster.wait_for(1)
    patience = dask.config.set({"distributed.comm.timeouts.connect": "1s"})
    with patience, connect(cluster.address) as there, pytest.raises(HarnessError, match="was lost"):
        run(matrix, tmp_path / "s.db", executor=there, on_progress=kill_scheduler)
    assert 1 <= len(read_runs(tmp_path / "s.db")) < 2 * SEEDS


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(HarnessError, match=r"pip install kbga-bench\[dask\]"):
        connect("tcp://127.0.0.1:9")


def test_a_process_that_may_have_no_children_says_what_to_do():
    # The processes of a pool are daemonic, as the workers of a nanny are.
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        unfit = pool.apply(describe, (new_session(),))["unfit"]
    assert "dask worker --no-nanny" in unfit
    assert "DASK_DISTRIBUTED__WORKER__DAEMON=False" in unfit
    assert describe(new_session())["unfit"] is None


def test_a_worker_of_another_version_does_no_runs():
    with pytest.raises(HarnessError, match=r"the harness is 0\.0\.1"):
        run_for(Session("another", "0.0.1"), make_cell(), Limits(), Warmth())


def test_what_a_worker_lacks_is_a_row_that_says_so(hostile, wall_file, tmp_path):
    session = new_session()
    here = cell_for(str(wall_file), "wanderer", seed=0)

    def row(**changes):
        values = {name: getattr(here, name) for name in here.__slots__} | changes
        record = run_for(session, make_cell(**values), Limits(), Warmth())
        assert record.status is PlanStatus.ERROR
        assert record.host
        return record.reason

    assert f"has no planner 'nobody'. Install hostile {here.version} there" in row(planner="nobody")
    assert f"has wanderer {here.version}. Install hostile 1.1 there" in row(version="1.1")
    assert "can't be read" in row(scene_source=str(tmp_path / "elsewhere.geojson"))


def test_a_new_session_finds_scenes_as_they_are_now(hostile, wall_file, matrix_file, tmp_path):
    scene = tmp_path / "changing.geojson"
    text = wall_file.read_text()
    file = matrix_file("visibility-graph", seeds=1)
    file.write_text(file.read_text().replace(str(wall_file), scene.name))
    for height in ("7.0", "8.0"):
        scene.write_text(text.replace("7.0", height))
        with ThreadPoolExecutor(1) as pool:
            runs, _ = run(load_matrix(file), tmp_path / "s.db", executor=pool)
    assert runs["status"].tolist() == ["solved", "solved"]
    assert runs["cost"].is_unique


def test_an_executor_whose_workers_are_processes_will_do(matrix_file, tmp_path):
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        runs, _ = run(load_matrix(matrix_file("wanderer")), tmp_path / "s.db", executor=pool)
    assert runs["status"].tolist() == ["solved", "solved"]
