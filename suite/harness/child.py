"""What happens in the process of one run: cut off from the terminal and from its parent's death."""

import contextlib
import fcntl
import os
import select
import signal
import traceback
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection

from suite.harness.cell import run_cell
from suite.planner import PlanStatus, Recorder
from suite.processes.family import adopt_orphans, has_children
from suite.processes.multiprocessing_private import leave_server, parent_pipe
from suite.processes.pipes import TooLongError, send
from suite.processes.random_state import seed_globals
from suite.store.record import Cell, RunRecord

PLANNING = "planning"
"""The message that says: everything is ready, the clock starts now."""

ORPHAN_S = 3600
"""Where the kernel can't end a run whose harness died, it ends after this time."""


@dataclass(frozen=True, slots=True, eq=False)
class LastMessage:
    """The last message of a process.

    alone : whether nothing descends from the process that would outlive it.
    """

    record: RunRecord
    alone: bool


def run_in_child(
    cell: Cell,
    messages: "Connection[str | LastMessage, None]",
    stderr: "Connection[None, None]",
    core: int | None,
    snapshots_of: Collection[int] = (),
) -> None:
    """Run a cell and send what came of it; the target of the process of one run.

    Parameters
    ----------
    cell : Cell
    messages : Connection
        Takes PLANNING, then the LastMessage.
    stderr : Connection
        Takes what the process writes to its standard error.
    core : int, optional
        The processor to stay on.
    snapshots_of : collection of int
        Generations of which the record is to have snapshots.
    """
    process = os.getpid()
    _become_own_group()
    _redirect_output(stderr.fileno())
    stderr.close()
    _die_with_parent()
    _pin(core)
    # All children inherit the server's state: careless plugins would all draw the same numbers.
    seed_globals(int(cell.key, 16))
    recorder = Recorder(snapshot_of=snapshots_of.__contains__)
    record = _record(cell, recorder, lambda: messages.send(PLANNING))
    # A planner that forks may come back twice.
    if os.getpid() == process:
        record = replace(record, snapshots=tuple(recorder.snapshots))
        _send_last(messages, LastMessage(record, alone=not has_children()))
    # Without the interpreter's farewell: destructors of a planner's libraries may hang or crash,
    # and threads that it left running would be waited for.
    os._exit(0)


def _send_last(messages: "Connection[str | LastMessage, None]", last: LastMessage) -> None:
    try:
        send(messages, last)
    except TooLongError as error:
        reason = f"its record is too large ({error}): shorten the path, or report less."
        record = RunRecord(last.record.cell, PlanStatus.ERROR, reason)
        send(messages, replace(last, record=record))


def _record(cell: Cell, recorder: Recorder, before_plan: Callable[[], None]) -> RunRecord:
    try:
        return run_cell(cell, recorder=recorder, before_plan=before_plan)
    except BaseException as error:
        # KeyboardInterrupt too: nobody is at the keyboard of this process, a planner raised it.
        reason = "".join(traceback.format_exception_only(error)).strip()
        return RunRecord(cell, PlanStatus.ERROR, reason)


def _become_own_group() -> None:
    """Out of the terminal's reach (Ctrl-C is the harness's), and killable with all descendants."""
    os.setsid()
    # The fork server ignores them.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    adopt_orphans()
    leave_server()


def _pin(core: int | None) -> None:
    # A processor can be taken away from this process after the harness looked.
    with contextlib.suppress(OSError):
        if core is not None:
            os.sched_setaffinity(0, {core})


def _redirect_output(stderr: int) -> None:
    nowhere = os.open(os.devnull, os.O_RDWR)
    os.dup2(nowhere, 0)
    os.dup2(nowhere, 1)
    os.dup2(stderr, 2)
    os.close(nowhere)


def _die_with_parent() -> None:
    """Have the kernel kill this process group when the harness dies, kill -9 included.

    A thread that watches the harness's pipe would starve while a planner holds the GIL, and
    PR_SET_PDEATHSIG watches the fork server, which outlives the harness as long as a child does; a
    signal on the pipe's closing does neither.
    """
    pipe = parent_pipe()
    if pipe is None or not hasattr(fcntl, "F_SETSIG"):
        signal.alarm(ORPHAN_S)
        return
    fcntl.fcntl(pipe, fcntl.F_SETOWN, -os.getpgrp())
    fcntl.fcntl(pipe, fcntl.F_SETSIG, signal.SIGKILL)
    fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)
    # It may have died before the line above.
    if select.select([pipe], [], [], 0)[0]:
        os._exit(1)
