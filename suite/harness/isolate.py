"""A run in a process of its own, with limits that hold: started, watched, killed, accounted for.

The processes come from multiprocessing's fork server, warmed once
(:mod:`suite.harness.fork_server`), so that a run does not pay for imports and compilation.
"""

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from multiprocessing import forkserver
from multiprocessing.connection import wait
from multiprocessing.context import ForkServerProcess
from typing import Any

from suite.errors import HarnessError
from suite.harness.child import PLANNING, LastMessage, run_in_child
from suite.harness.fork_server import Warmth
from suite.harness.matrix import Limits
from suite.harness.provenance import host_name
from suite.planner import PlanStatus
from suite.processes.cores import own_core
from suite.processes.family import kill_children, kill_family, kill_group
from suite.processes.memory import MemoryWatch
from suite.processes.multiprocessing_private import forget_server, main_module, server_pid
from suite.processes.pipes import GarbledError, Inbox, Tail
from suite.store.record import Cell, RunRecord

REAP_S = 5.0
"""What a killed process may take to be gone; longer only in the kernel's uninterruptible sleep."""

ANSWER_S = 0.5
"""A fork server that takes longer to start a process is still warming up."""

STARTS = 3
"""A planner that kills its parent takes the fork server away from the others: they try again."""

_CONTEXT = multiprocessing.get_context("forkserver")

# multiprocessing's bookkeeping of children polls all of them whenever one is started, and two
# threads that poll one child race for its exit code; so starting and reaping take turns. Under the
# lock, the children of the fork server are the runs in flight, and orphans of others.
_BOOKKEEPING = threading.Lock()


@dataclass(slots=True, eq=False)
class _Fleet:
    """The runs of this process that are in flight, and how often they were told to stop."""

    pids: set[int] = field(default_factory=set)
    stops: int = 0


_fleet = _Fleet()


class _StoppedError(Exception):
    """The runs in flight were killed before this one had a process."""


def run_isolated(
    cell: Cell, limits: Limits, warmth: Warmth, *, snapshots_of: Collection[int] = ()
) -> RunRecord:
    """Run one cell in a process of its own. Safe to call from several threads.

    Parameters
    ----------
    cell : Cell
    limits : Limits
        When to kill it.
    warmth : Warmth
        For the fork server, if this call is the first to need one.
    snapshots_of : collection of int
        Generations of which the record is to have snapshots; none in a measured run.

    Returns
    -------
    RunRecord
        Always: a process that hangs is TIMED_OUT, one that takes too much memory OUT_OF_MEMORY,
        one that dies CRASHED.

    Raises
    ------
    HarnessError
        If the system starts no process.
    """
    started_at = datetime.now(UTC).isoformat(timespec="seconds")
    try:
        with own_core() as core, _started(cell, warmth, core, snapshots_of) as child:
            record = _outcome(child, limits)
    except _StoppedError:
        return RunRecord(cell, PlanStatus.CRASHED, "was stopped before it began.")
    if record.host is None:
        record = replace(record, started_at=started_at, host=host_name())
    if record.status in (PlanStatus.SOLVED, PlanStatus.INFEASIBLE, PlanStatus.EXHAUSTED):
        return record
    return replace(record, stderr=child.stderr.last_lines())


def start_server(warmth: Warmth) -> None:
    """Start the fork server, if it does not run yet; it warms itself while the caller goes on."""
    with _BOOKKEEPING, _server_environment(warmth):
        forkserver.ensure_running()


def stop_server() -> None:
    """End the fork server, when no run is in flight: the next run starts another, newly warmed."""
    with _BOOKKEEPING:
        if (pid := server_pid()) is not None:
            # It may be in the middle of its warming, which can take minutes.
            kill_family(pid)
        forget_server()


def kill_running() -> None:
    """Kill all runs of this process that are in flight; their callers get CRASHED records."""
    _fleet.stops += 1
    if _BOOKKEEPING.acquire(timeout=ANSWER_S):
        _BOOKKEEPING.release()
    elif (server := server_pid()) is not None:
        kill_family(server)
    for pid in list(_fleet.pids):
        kill_family(pid)


@dataclass(slots=True, eq=False)
class _Child:
    """alone : whether the process said at its end that nothing descends from it."""

    cell: Cell
    process: ForkServerProcess
    inbox: Inbox
    stderr: Tail
    alone: bool = False

    @property
    def pid(self) -> int:
        return self.process.ident or 0

    def reap(self, timeout_s: float) -> int | None:
        """Exit code of the process, negative for a signal; None if it still runs."""
        if not wait([self.process.sentinel], timeout_s):
            return None
        with _BOOKKEEPING:
            self.process.join(0)
            return self.process.exitcode


@contextlib.contextmanager
def _started(
    cell: Cell, warmth: Warmth, core: int | None, snapshots_of: Collection[int]
) -> Iterator[_Child]:
    """A process that runs the cell; it and its descendants are gone afterwards."""
    receiver, sender = _CONTEXT.Pipe(duplex=False)
    error_reader, error_writer = _CONTEXT.Pipe(duplex=False)
    with receiver, error_reader:
        with sender, error_writer:
            process = _start((cell, sender, error_writer, core, snapshots_of), warmth)
        child = _Child(cell, process, Inbox(receiver), Tail(error_reader))
        try:
            yield child
        finally:
            _end(child)


def _start(arguments: tuple[Any, ...], warmth: Warmth) -> ForkServerProcess:
    stops = _fleet.stops
    for _ in range(STARTS):
        # The first start, and one after the death of the server, makes a new server.
        with _BOOKKEEPING, _server_environment(warmth):
            if _fleet.stops != stops:
                break
            process = _CONTEXT.Process(target=run_in_child, args=arguments)
            with contextlib.suppress(EOFError, OSError):
                process.start()
                _fleet.pids.add(process.ident or 0)
                return process
    if _fleet.stops != stops:
        raise _StoppedError
    raise HarnessError(
        "no process can be started for a run. Look at the limits for processes, open files and "
        "memory, then run the same command again: it goes on where it stopped."
    )


def _end(child: _Child) -> None:
    """Kill what is left of a run, wherever it went, and take its last words."""
    kill_group(child.pid)
    if child.reap(REAP_S) is None:
        kill_family(child.pid)
    with _BOOKKEEPING:
        _fleet.pids.discard(child.pid)
        server = server_pid()
        if not child.alone and server is not None:
            kill_children(server, REAP_S, but=_fleet.pids)
    child.stderr.read()


def _outcome(child: _Child, limits: Limits) -> RunRecord:
    try:
        return _watched(child, limits)
    except EOFError:
        reason = f"the process {_end_in_words(child.reap(REAP_S))}."
        return RunRecord(child.cell, PlanStatus.CRASHED, reason)
    except GarbledError as error:
        reason = f"something wrote into the pipe that is the harness's ({error})."
        return RunRecord(child.cell, PlanStatus.ERROR, reason)


def _watched(child: _Child, limits: Limits) -> RunRecord:
    """Wait for the record, the end of the process (EOFError), or the end of our patience."""
    phase, patience_s = "warm-up", limits.warm_up_s
    deadline = time.monotonic() + patience_s
    memory = MemoryWatch(child.pid, limits.memory_bytes)
    pipes: list[Any] = [child.inbox.pipe, child.process.sentinel, child.stderr.pipe]
    while True:
        ready = wait(pipes, max(0.0, min(deadline, memory.next_look) - time.monotonic()))
        if child.stderr.pipe in ready and not child.stderr.read():
            pipes.remove(child.stderr.pipe)
        if child.inbox.pipe in ready:
            for message in child.inbox.read():
                if isinstance(message, LastMessage):
                    child.alone = message.alone
                    return message.record
                if message == PLANNING and phase == "warm-up":
                    phase, patience_s = "plan", limits.run_s(child.cell)
                    deadline = time.monotonic() + patience_s
        elif child.process.sentinel in ready:
            raise EOFError
        elif (held := memory.excess()) is not None:
            reason = f"{phase} held {held / 1e6:.0f} MB, above {limits.memory_mb:g} MB, "
            return _killed(child, PlanStatus.OUT_OF_MEMORY, reason)
        elif time.monotonic() >= deadline:
            reason = f"{phase} took more than {patience_s:g} s "
            return _killed(child, PlanStatus.TIMED_OUT, reason)


def _killed(child: _Child, status: PlanStatus, reason: str) -> RunRecord:
    kill_family(child.pid)
    return RunRecord(child.cell, status, f"{reason}and was killed.")


def _end_in_words(code: int | None) -> str:
    if code is None:
        return "closed its pipe"
    if code >= 0:
        return f"ended with exit code {code}"
    if code == -signal.SIGKILL:
        return "was ended by SIGKILL (not the harness's: perhaps the machine was out of memory)"
    try:
        return f"was ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"was ended by signal {-code}"


@contextlib.contextmanager
def _server_environment(warmth: Warmth) -> Iterator[None]:
    """The settings that a fork server started now inherits; variables are put back afterwards."""
    # The warm-up comes last: it leaves alone, for good, what is loaded by then.
    _CONTEXT.set_forkserver_preload([run_in_child.__module__, Warmth.__module__])
    # A planner that goes through sets of strings then repeats itself from one server to the next.
    salt = {"PYTHONHASHSEED": os.environ.get("PYTHONHASHSEED", "0")}
    wanted = salt | replace(warmth, main=main_module()).environment()
    before = {name: os.environ.get(name) for name in wanted}
    os.environ.update(wanted)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
