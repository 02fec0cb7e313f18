"""A run in a process of its own, with limits that hold: watched, killed, accounted for.

The processes come from multiprocessing's fork server, warmed once
(:mod:`suite.harness.fork_server`), so that a run does not pay for imports and compilation.
"""

import contextlib
import multiprocessing
import signal
import time
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkServerProcess
from typing import Any

from suite.harness.child import PLANNING, LastMessage
from suite.harness.fleet import StoppedError, end, no_process, reap, start
from suite.harness.fork_server import Warmth
from suite.harness.matrix import Limits
from suite.harness.provenance import host_name
from suite.planner import PlanStatus
from suite.processes.cores import own_core
from suite.processes.family import kill_family
from suite.processes.memory import MemoryWatch
from suite.processes.pipes import GarbledError, Inbox, Tail
from suite.store.record import Cell, RunRecord


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
    except StoppedError:
        return RunRecord(cell, PlanStatus.CRASHED, "was stopped before it began.")
    if record.host is None:
        record = replace(record, started_at=started_at, host=host_name())
    if record.status in PlanStatus.CLAIMABLE:
        return record
    return replace(record, stderr=child.stderr.last_lines())


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


@dataclass(frozen=True, slots=True)
class _Phase:
    """What a run does, and how long it may: it begins when this is made."""

    name: str
    patience_s: float
    began: float = field(default_factory=time.monotonic)

    @property
    def deadline(self) -> float:
        return self.began + self.patience_s


@contextlib.contextmanager
def _started(
    cell: Cell, warmth: Warmth, core: int | None, snapshots_of: Collection[int]
) -> Iterator[_Child]:
    """A process that runs the cell; it and its descendants are gone afterwards."""
    (receiver, sender), (error_reader, error_writer) = _pipe(), _pipe()
    with receiver, error_reader:
        with sender, error_writer:
            process = start((cell, sender, error_writer, core, snapshots_of), warmth)
        child = _Child(cell, process, Inbox(receiver), Tail(error_reader))
        try:
            yield child
        finally:
            end(process, is_alone=child.alone)
            child.stderr.read()  # its last words


def _pipe() -> tuple[Connection, Connection]:
    try:
        return multiprocessing.Pipe(duplex=False)
    except OSError as error:
        raise no_process(error) from error


def _outcome(child: _Child, limits: Limits) -> RunRecord:
    try:
        return _watched(child, limits)
    except EOFError:
        reason = f"the process {_end_in_words(reap(child.process))}."
        return RunRecord(child.cell, PlanStatus.CRASHED, reason)
    except GarbledError as error:
        reason = f"something wrote into the pipe that is the harness's ({error})."
        return RunRecord(child.cell, PlanStatus.ERROR, reason)


def _watched(child: _Child, limits: Limits) -> RunRecord:
    """Wait for the record, the end of the process (EOFError), or the end of our patience."""
    phase = _Phase("warm-up", limits.warm_up_s)
    memory = MemoryWatch(child.pid, limits.memory_bytes)
    pipes: list[Any] = [child.inbox.pipe, child.process.sentinel, child.stderr.pipe]
    while True:
        until = min(phase.deadline, memory.next_look)
        ready = wait(pipes, max(0.0, until - time.monotonic()))
        if child.stderr.pipe in ready and not child.stderr.read():
            pipes.remove(child.stderr.pipe)
        if child.inbox.pipe in ready:
            for message in child.inbox.read():
                if isinstance(message, LastMessage):
                    child.alone = message.alone
                    return message.record
                if message == PLANNING and phase.name == "warm-up":
                    phase = _Phase("plan", limits.run_s(child.cell))
        elif child.process.sentinel in ready:
            raise EOFError
        elif (held := memory.excess()) is not None:
            reason = f"held {held / 1e6:.0f} MB, above {limits.memory_mb:g} MB,"
            return _killed(child, PlanStatus.OUT_OF_MEMORY, f"{phase.name} {reason}")
        elif time.monotonic() >= phase.deadline:
            reason = f"took more than {phase.patience_s:g} s"
            return _killed(child, PlanStatus.TIMED_OUT, f"{phase.name} {reason}")


def _killed(child: _Child, status: PlanStatus, reason: str) -> RunRecord:
    kill_family(child.pid)
    return RunRecord(child.cell, status, f"{reason} and was killed.")


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
