"""What happens in the process of one run: cut off from the terminal and from its parent's death."""

import fcntl
import multiprocessing
import os
import random
import select
import signal
from collections.abc import Collection
from dataclasses import replace
from multiprocessing.connection import Connection

import numpy as np

from suite.harness.cell import run_cell
from suite.planner import Recorder
from suite.record import Cell, RunRecord

PLANNING = "planning"
"""The message that says: everything is ready, the clock starts now."""

ORPHAN_S = 3600
"""Where the kernel can't end a run whose harness died, it ends after this time."""


def run_in_child(
    cell: Cell,
    messages: "Connection[str | RunRecord, None]",
    stderr: "Connection[None, None]",
    snapshots_of: Collection[int] = (),
) -> None:
    """Run a cell and send what came of it; the target of the process of one run.

    Parameters
    ----------
    cell : Cell
    messages : Connection
        Takes PLANNING, then the RunRecord.
    stderr : Connection
        Takes what the process writes to its standard error.
    snapshots_of : collection of int
        Generations of which the record is to have snapshots.
    """
    _become_own_group()
    _redirect_output(stderr.fileno())
    _die_with_parent()
    _seed_globals(cell)
    recorder = Recorder(snapshot_of=snapshots_of.__contains__)
    record = run_cell(cell, recorder=recorder, before_plan=lambda: messages.send(PLANNING))
    messages.send(replace(record, snapshots=tuple(recorder.snapshots)))
    # Without the interpreter's farewell: destructors of a planner's libraries may hang or crash,
    # and threads that it left running would be waited for.
    os._exit(0)


def _become_own_group() -> None:
    """Out of the terminal's reach (Ctrl-C is the harness's), and killable with all descendants."""
    os.setsid()


def _redirect_output(stderr: int) -> None:
    nowhere = os.open(os.devnull, os.O_RDWR)
    os.dup2(nowhere, 0)
    os.dup2(nowhere, 1)
    os.dup2(stderr, 2)
    os.close(nowhere)


def _die_with_parent() -> None:
    """Have the kernel kill this process group when the harness dies, kill -9 included.

    The sentinel is a pipe whose other end only the harness holds. A thread that watches it would
    starve while a planner holds the GIL, and PR_SET_PDEATHSIG watches the fork server, which
    outlives the harness as long as a child does; a signal on the pipe's closing does neither.
    """
    parent = multiprocessing.parent_process()
    if parent is None or not hasattr(fcntl, "F_SETSIG"):
        signal.alarm(ORPHAN_S)
        return
    pipe = int(parent.sentinel)
    fcntl.fcntl(pipe, fcntl.F_SETOWN, -os.getpgrp())
    fcntl.fcntl(pipe, fcntl.F_SETSIG, signal.SIGKILL)
    fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)
    # It may have died before the line above.
    if select.select([pipe], [], [], 0)[0]:
        os._exit(1)


def _seed_globals(cell: Cell) -> None:
    """Give careless plugins that draw from a global generator another stream in each run.

    All children inherit the server's state: without this they would all draw the same numbers.
    """
    seed = int(cell.key[:8], 16)
    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002
