"""A harness that is killed or interrupted: nothing finished is lost, nothing is left behind."""

import os
import signal
import sqlite3
import subprocess
import time
import uuid
from contextlib import closing

import numpy as np
import pytest

from suite.store.read import read_paths, read_runs
from tests.suite.commands import COMMAND, hear_interrupts, in_own_process, marked

SEEDS = 4
SAMPLE = 2
KILLS = 100
PATIENCE_S = 300.0
"""More than anybody needs, however busy the machine is."""

LATEST_S = 4.0
"""The first kills come while the server still warms up, the last ones after the end."""

moments = pytest.mark.parametrize(
    ("number", "planner"),
    [
        pytest.param(
            number,
            ("sleeper", "hangs-in-c")[number % 2],
            marks=[] if number < SAMPLE else pytest.mark.torture,
        )
        for number in range(KILLS)
    ],
)


def start(matrix, store, mark, jobs=2):
    """The command running a matrix, in a process group of its own."""
    return subprocess.Popen(
        [*COMMAND, "run", str(matrix), "--store", str(store), "--jobs", str(jobs)],
        env={**os.environ, "KBGA_TEST_MARK": mark},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=hear_interrupts,
    )


def started(matrix, store, mark):
    """The command running a matrix, once it has written 3 rows.

    All runs are begun at once: those that never end keep nobody from ending.
    """
    run = start(matrix, store, mark, jobs=2 * SEEDS)
    deadline = time.monotonic() + PATIENCE_S
    while rows_of(store) < 3 and time.monotonic() < deadline:
        time.sleep(0.02)
    return run


def rows_of(store):
    try:
        return len(read_runs(store))
    except Exception:
        return 0


def gone(mark, patience_s=PATIENCE_S):
    deadline = time.monotonic() + patience_s
    while marked(mark) and time.monotonic() < deadline:
        time.sleep(0.05)
    return not marked(mark)


def check_integrity(store):
    with closing(sqlite3.connect(store)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def check_resumed(matrix, store, before, paths):
    """Run the rest, and find every row of before as it was, and each wanted row once."""
    in_own_process("run", matrix, "--store", store, "--jobs", 4)
    after = read_runs(store).set_index("key")
    assert len(after) == 2 * SEEDS
    assert after.index.is_unique
    assert after.loc[before.index, "wall_s"].equals(before["wall_s"])
    now = read_paths(store)
    assert all(now[key].tolist() == path.tolist() for key, path in paths.items())
    check_integrity(store)


@pytest.mark.parametrize("endless", ["hangs", pytest.param("hangs-in-c", marks=pytest.mark.slow)])
def test_kill_9_in_the_middle_keeps_what_is_done_and_leaves_no_orphan(
    matrix_file, tmp_path, endless
):
    store, mark = tmp_path / "s.db", uuid.uuid4().hex
    run = started(matrix_file("wanderer", endless, seeds=SEEDS), store, mark)
    assert marked(mark)
    run.kill()
    run.communicate()
    assert gone(mark)
    before = read_runs(store).set_index("key")
    assert 3 <= len(before) <= SEEDS
    # Now they end: a limit is no part of what a row is.
    wanted = matrix_file("wanderer", endless, seeds=SEEDS, limit_s=1.0)
    check_resumed(wanted, store, before, read_paths(store))


@moments
def test_kill_9_at_any_moment_loses_no_finished_row_and_doubles_none(
    matrix_file, tmp_path, number, planner
):
    store, mark = tmp_path / "s.db", uuid.uuid4().hex
    wanted = matrix_file("wanderer", planner, seeds=SEEDS, limit_s=1.0)
    run = start(wanted, store, mark)
    time.sleep(LATEST_S * np.random.default_rng(number).random())
    run.kill()
    run.communicate()
    assert gone(mark)
    if not store.exists() or rows_of(store) == 0:
        in_own_process("run", wanted, "--store", store, "--jobs", 4)
        assert len(read_runs(store)) == 2 * SEEDS
        return
    check_integrity(store)
    check_resumed(wanted, store, read_runs(store).set_index("key"), read_paths(store))


@pytest.mark.parametrize(
    ("number", "code"),
    [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.slow)],
)
def test_who_is_asked_to_end_twice_stops_tidily_and_says_how_to_go_on(
    matrix_file, tmp_path, number, code
):
    store, mark = tmp_path / "s.db", uuid.uuid4().hex
    run = started(matrix_file("wanderer", "hangs", seeds=SEEDS), store, mark)
    os.killpg(run.pid, number)
    time.sleep(0.01)
    os.killpg(run.pid, number)
    _, stderr = run.communicate(timeout=PATIENCE_S)
    assert run.returncode == code
    assert "to go on, give the same command again" in stderr
    assert "Traceback" not in stderr
    assert gone(mark)
    assert 3 <= len(read_runs(store)) <= SEEDS
    assert set(read_runs(store)["status"]) == {"solved"}


def test_a_store_that_a_planner_deletes_is_written_anew_and_the_command_says_so(
    hostile, wall_file, tmp_path
):
    matrix, store = tmp_path / "matrix.toml", tmp_path / "s.db"
    matrix.write_text(
        f'scenes = ["{wall_file}"]\nseeds = 2\n[[planner]]\nplanner = "deletes"\n'
        f'settings = {{ pattern = "{store}*" }}\n[[planner]]\nplanner = "wanderer"\n'
    )
    told = in_own_process("run", matrix, "--store", store, "--jobs", 1).err
    assert f"kbga-bench: warning: {store}: was deleted while it was written to" in told
    assert len(read_runs(store)) == 4
    check_integrity(store)
