"""What becomes of a matrix when something of its cluster dies or stops; all on loopback."""

import os
import signal
import subprocess
import threading

import pytest

from suite.errors import HarnessError, StoreError
from suite.harness.cluster import executors
from suite.harness.cluster.executors import connect
from suite.store.read import read_runs
from tests.suite.commands import COMMAND, hear_interrupts, in_own_process
from tests.suite.harness.cluster.dask_on_loopback import Cluster, end, wait_until

SEEDS = 20
STOPPED_S = 30.0
LIMIT_S = 300.0
"""Of a command that would hang."""
IMPATIENT = {"DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "1s"}
"""As soon as that, a scheduler that is gone is given up."""


@pytest.fixture
def cluster(hostile, tmp_path):
    found = Cluster(tmp_path, {**os.environ, "TMPDIR": str(tmp_path)})
    yield found
    found.close()


@pytest.fixture
def command(matrix_file, tmp_path):
    """The command that runs 40 runs of 0.15 s and of no time, without the place."""
    matrix = matrix_file("sleeper", "wanderer", seeds=SEEDS)
    return ("run", str(matrix), "--store", str(tmp_path / "s.db"), "--patience", "0")


@pytest.fixture
def two_workers(cluster):
    workers = [cluster.add_worker(), cluster.add_worker()]
    cluster.wait_for(2)
    return workers


def at(cluster):
    return ("--executor", "dask", "--address", cluster.address)


def rows(store):
    try:
        return len(read_runs(store))
    except StoreError:
        return 0  # not made yet


def in_the_middle(store):
    wait_until(lambda: rows(store) >= 3)
    assert rows(store) < 2 * SEEDS


@pytest.fixture
def started():
    """Start the command; what is left of it is ended."""
    processes = []

    def start(command, **env):
        processes.append(
            subprocess.Popen(
                [*COMMAND, *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                env={**os.environ, **env}, preexec_fn=hear_interrupts,
            )
        )  # fmt: skip
        return processes[-1]

    yield start
    for process in processes:
        end(process)


def all_solved_once(store):
    runs = read_runs(store)
    assert runs["status"].tolist() == ["solved"] * 2 * SEEDS
    assert runs["key"].is_unique


@pytest.mark.slow
def test_a_killed_worker_costs_no_row(cluster, two_workers, command, started, tmp_path):
    running = started((*command, *at(cluster)))
    in_the_middle(tmp_path / "s.db")
    two_workers[0].kill()
    out, err = running.communicate(timeout=LIMIT_S)
    assert running.returncode == 0, err
    assert f"{2 * SEEDS} of {2 * SEEDS} runs are in the store" in out
    all_solved_once(tmp_path / "s.db")


@pytest.mark.slow
def test_a_killed_scheduler_is_said_and_another_cluster_goes_on(
    cluster, two_workers, command, started, tmp_path
):
    store = tmp_path / "s.db"
    running = started((*command, *at(cluster)), **IMPATIENT)
    in_the_middle(store)
    end(cluster.processes[0])
    _, err = running.communicate(timeout=LIMIT_S)
    assert running.returncode == 2
    assert "the executor was lost" in err
    assert "All finished runs are kept" in err
    assert "Traceback" not in err
    kept = rows(store)
    assert 3 <= kept < 2 * SEEDS
    (tmp_path / "other").mkdir()
    other = Cluster(tmp_path / "other", cluster.env)
    try:
        other.add_worker()
        other.wait_for(1)
        again = in_own_process(*command, *at(other))
    finally:
        other.close()
    assert f"{kept} were there, {2 * SEEDS - kept} ran now, 0 of these failed" in again.out
    all_solved_once(store)


@pytest.mark.slow
def test_a_worker_that_stands_still_for_half_a_minute_costs_no_row(
    cluster, two_workers, command, started, tmp_path
):
    running = started((*command, *at(cluster)))
    in_the_middle(tmp_path / "s.db")
    two_workers[0].suspend()
    threading.Event().wait(STOPPED_S)
    assert running.poll() is None
    two_workers[0].resume()
    _, err = running.communicate(timeout=LIMIT_S)
    assert running.returncode == 0, err
    all_solved_once(tmp_path / "s.db")


@pytest.mark.slow
def test_an_interruption_ends_though_a_worker_stands_still(
    cluster, two_workers, command, started, tmp_path
):
    store = tmp_path / "s.db"
    running = started((*command, *at(cluster)))
    in_the_middle(store)
    two_workers[0].suspend()
    running.send_signal(signal.SIGINT)
    try:
        _, err = running.communicate(timeout=LIMIT_S)
    finally:
        two_workers[0].resume()
    assert running.returncode == 130, err
    assert "All finished runs are kept" in err
    assert "goes on elsewhere" in err or "go on elsewhere" in err
    again = in_own_process(*command, *at(cluster))
    assert f"{2 * SEEDS} of {2 * SEEDS} runs are in the store" in again.out
    all_solved_once(store)


def test_a_worker_that_stands_still_at_the_beginning_is_named(cluster, matrix_file, monkeypatch):
    worker = cluster.add_worker()
    cluster.wait_for(1)
    with connect(cluster.address) as there:
        monkeypatch.setattr(executors, "ANSWER_S", 0.5)
        worker.suspend()
        try:
            with pytest.raises(
                HarnessError, match=r"the worker tcp://127\.0\.0\.1:\d+ does not answer"
            ):
                there.machines(executors.new_session())
        finally:
            worker.resume()
