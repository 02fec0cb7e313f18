"""However a harness ends, no process outlives it: not in a run, and not while it warms up."""

import contextlib
import os
import signal
import subprocess
import sys
import time
import uuid

import psutil
import pytest

from tests.suite.commands import hear_interrupts

HARNESS = """
import sys
from suite.harness.run import run_matrix
from suite.harness.matrix import load_matrix
from suite.store.write import open_store
from pathlib import Path
with open_store(Path(sys.argv[2])) as store:
    run_matrix(load_matrix(sys.argv[1]), store, jobs=int(sys.argv[3]))
"""
PATIENCE_S = 300.0


@pytest.fixture
def marked():
    """A variable that all processes inherit, whatever they do to be forgotten."""
    return f"KBGA_TEST={uuid.uuid4().hex}"


@pytest.fixture
def harness(hostile, wall_file, tmp_path, marked):
    running = []

    def start(*planners, jobs=1):
        file = tmp_path / "matrix.toml"
        entries = "".join(f'[[planner]]\nplanner = "{name}"\n' for name in planners)
        file.write_text(f'scenes = ["{wall_file}"]\nseeds = 2\n{entries}')
        name, value = marked.split("=")
        process = subprocess.Popen(
            [sys.executable, "-c", HARNESS, file, tmp_path / "store.db", str(jobs)],
            env={**os.environ, name: value},
            stderr=subprocess.PIPE,
            start_new_session=True,
            preexec_fn=hear_interrupts,
        )
        running.append(process)
        return process

    yield start
    for process in running:
        process.kill()
        process.communicate()


def alive(marked):
    """The processes that started with this variable, wherever they are in the tree."""
    name, value = marked.split("=")
    found = []
    for process in psutil.process_iter():
        try:
            # A daemon of a daemon has the same block of variables as its first ancestor.
            if process.environ().get(name) == value and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
        except psutil.Error:
            continue
    return found


def wait_until(condition):
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.05)


def sessions(marked):
    """How many sessions: the harness's own, one for a run or a trial warm-up, one for a daemon."""
    found = set()
    for process in alive(marked):
        with contextlib.suppress(ProcessLookupError):
            found.add(os.getsid(process.pid))
    return len(found)


@pytest.mark.parametrize("planner", ["daemonizes-and-hangs", "leaves-its-session-and-hangs"])
def test_a_killed_harness_leaves_no_process_not_even_a_daemon(harness, marked, planner):
    process = harness(planner)
    wait_until(lambda: sessions(marked) == 3)
    process.kill()
    process.wait()
    wait_until(lambda: not alive(marked))


@pytest.mark.parametrize(
    ("send", "number"),
    [(os.kill, signal.SIGKILL), (os.killpg, signal.SIGTERM)],
    ids=["kill-9", "batch-system"],
)
def test_a_harness_that_is_killed_while_it_warms_up_leaves_no_process(
    harness, marked, send, number
):
    process = harness("hangs-in-warm-up")
    wait_until(lambda: sessions(marked) == 2)
    send(process.pid, number)
    process.wait()
    wait_until(lambda: not alive(marked))


@pytest.mark.parametrize("send", [os.kill, os.killpg], ids=["harness", "terminal"])
def test_ctrl_c_ends_a_harness_that_is_still_warming_up(harness, marked, send):
    process = harness("hangs-in-warm-up", jobs=2)
    wait_until(lambda: sessions(marked) == 2)
    send(process.pid, signal.SIGINT)
    # Warming up takes an hour here.
    _, said = process.communicate(timeout=PATIENCE_S)
    assert said.decode().strip().splitlines()[-1] == "KeyboardInterrupt"
    assert said.decode().count("Traceback") == 1
    wait_until(lambda: not alive(marked))
