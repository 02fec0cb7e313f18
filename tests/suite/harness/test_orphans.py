"""However a harness ends, no process outlives it: not in a run, and not while it warms up."""

import os
import signal
import subprocess
import sys
import time
import uuid

import psutil
import pytest

HARNESS = """
import sys
from suite.harness.run import run_matrix
from suite.harness.matrix import load_matrix
from suite.store import open_store
from pathlib import Path
with open_store(Path(sys.argv[2])) as store:
    run_matrix(load_matrix(sys.argv[1]), store, jobs=2)
"""
PATIENCE_S = 30.0


@pytest.fixture
def marked():
    """A variable that all processes inherit, whatever they do to be forgotten."""
    return f"KBGA_TEST={uuid.uuid4().hex}"


@pytest.fixture
def harness(hostile, wall_file, tmp_path, marked):
    def start(*planners):
        file = tmp_path / "matrix.toml"
        entries = "".join(f'[[planner]]\nplanner = "{name}"\n' for name in planners)
        file.write_text(f'scenes = ["{wall_file}"]\nseeds = 2\n{entries}')
        name, value = marked.split("=")
        return subprocess.Popen(
            [sys.executable, "-c", HARNESS, file, tmp_path / "store.db"],
            env={**os.environ, name: value},
            stderr=subprocess.PIPE,
            start_new_session=True,
        )

    return start


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


def is_daemon(process):
    """Whether a process has let go of all its descriptors."""
    try:
        return process.num_fds() == 0
    except psutil.Error:
        return False


def is_warming(marked):
    """Whether the fork server tries a warm-up in a process, which leads a session of its own."""
    servers = [p for p in alive(marked) if "forkserver" in " ".join(p.cmdline())]
    return any(os.getsid(p.pid) == p.pid for p in servers)


def test_a_killed_harness_leaves_no_process_not_even_a_daemon(harness, marked):
    process = harness("daemonizes-and-hangs")
    wait_until(lambda: any(map(is_daemon, alive(marked))))
    process.kill()
    process.wait()
    wait_until(lambda: not alive(marked))


def test_a_harness_that_is_killed_while_it_warms_up_leaves_no_process(harness, marked):
    process = harness("hangs-in-warm-up")
    wait_until(lambda: is_warming(marked))
    process.kill()
    process.wait()
    wait_until(lambda: not alive(marked))


@pytest.mark.parametrize("send", [os.kill, os.killpg], ids=["harness", "terminal"])
def test_ctrl_c_ends_a_harness_that_is_still_warming_up(harness, marked, send):
    process = harness("hangs-in-warm-up")
    wait_until(lambda: is_warming(marked))
    began = time.monotonic()
    send(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=PATIENCE_S)
    # Warming up takes a minute here.
    assert time.monotonic() - began < PATIENCE_S
    assert said.decode().strip().splitlines()[-1] == "KeyboardInterrupt"
    assert said.decode().count("Traceback") == 1
    wait_until(lambda: not alive(marked))
