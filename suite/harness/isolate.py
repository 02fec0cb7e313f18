"""A run in a process of its own, with limits that hold: started, watched, killed, accounted for.

The processes come from multiprocessing's fork server, warmed once (:mod:`suite.harness.warm`), so
that a run does not pay for imports and compilation.
"""

import contextlib
import multiprocessing
import multiprocessing.forkserver
import os
import pickle
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from multiprocessing.connection import Connection, wait
from typing import Any

import psutil

from suite.harness.child import run_in_child
from suite.harness.machine import host_name
from suite.harness.matrix import Limits
from suite.harness.warm import Warmth
from suite.planner import PlanStatus
from suite.record import Cell, RunRecord

STDERR_LINES = 20
STDERR_BYTES = 16_384
REAP_S = 5.0
"""What a killed process may take to be gone; longer only in the kernel's uninterruptible sleep."""

_CONTEXT = multiprocessing.get_context("forkserver")

# multiprocessing's bookkeeping of children polls all of them whenever one is started, and two
# threads that poll one child race for its exit code; so starting and reaping take turns.
_BOOKKEEPING = threading.Lock()

_running: set[int] = set()


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
        Always: a process that hangs is TIMED_OUT, one that dies is CRASHED.
    """
    started_at = datetime.now(UTC).isoformat(timespec="seconds")
    with _started(cell, warmth, snapshots_of) as child:
        record = _watch(child, limits)
    if record.status in (PlanStatus.TIMED_OUT, PlanStatus.CRASHED):
        record = replace(record, started_at=started_at, host=host_name())
    if record.status in (PlanStatus.SOLVED, PlanStatus.INFEASIBLE, PlanStatus.EXHAUSTED):
        return record
    return replace(record, stderr=child.stderr.last_lines())


def start_server(warmth: Warmth) -> None:
    """Start the fork server, if it does not run yet; it warms itself while the caller goes on."""
    with _BOOKKEEPING, _server_environment(warmth):
        multiprocessing.forkserver.ensure_running()


def kill_running() -> None:
    """Kill all runs of this process that are in flight; their callers get CRASHED records."""
    for pid in list(_running):
        _kill(pid)


@dataclass(frozen=True, slots=True, eq=False)
class _Child:
    cell: Cell
    process: Any
    messages: "Connection[None, str | RunRecord]"
    stderr: "_Tail"

    def reap(self, timeout_s: float) -> int | None:
        """Exit code of the process, negative for a signal; None if it still runs."""
        if not wait([self.process.sentinel], timeout_s):
            return None
        with _BOOKKEEPING:
            self.process.join(0)
            code: int | None = self.process.exitcode
            return code


class _Tail:
    """The last part of what a process writes to its standard error."""

    def __init__(self, pipe: "Connection[Any, Any]") -> None:
        self.pipe = pipe
        self._blocks: deque[bytes] = deque()
        self._size = 0
        os.set_blocking(pipe.fileno(), False)

    def read(self) -> bool:
        """Take what is there; False at the end of the file."""
        try:
            block = os.read(self.pipe.fileno(), STDERR_BYTES)
        except BlockingIOError:
            return True
        self._blocks.append(block)
        self._size += len(block)
        while self._size - len(self._blocks[0]) > STDERR_BYTES:
            self._size -= len(self._blocks.popleft())
        return bool(block)

    def last_lines(self) -> str:
        text = b"".join(self._blocks)[-STDERR_BYTES:].decode(errors="replace")
        return "\n".join(text.splitlines()[-STDERR_LINES:])


@contextlib.contextmanager
def _started(cell: Cell, warmth: Warmth, snapshots_of: Collection[int]) -> Iterator[_Child]:
    """A process that runs the cell; it and its descendants are gone afterwards."""
    receiver, sender = _CONTEXT.Pipe(duplex=False)
    error_reader, error_writer = _CONTEXT.Pipe(duplex=False)
    with receiver, error_reader:
        # The first start, and one after the death of the server, makes a new server.
        with sender, error_writer, _BOOKKEEPING, _server_environment(warmth):
            process = _CONTEXT.Process(
                target=run_in_child, args=(cell, sender, error_writer, snapshots_of)
            )
            process.start()
        pid: int = process.ident or 0
        _running.add(pid)
        child = _Child(cell, process, receiver, _Tail(error_reader))
        try:
            yield child
        finally:
            _kill_group(pid)
            if child.reap(REAP_S) is None:
                _kill(pid)
            _running.discard(pid)


def _watch(child: _Child, limits: Limits) -> RunRecord:
    """Wait for the record, the end of the process, or the end of our patience."""
    phase, patience_s = "warm-up", limits.warm_up_s
    deadline = time.monotonic() + patience_s
    pipes: list[Any] = [child.messages, child.process.sentinel, child.stderr.pipe]
    while True:
        ready = wait(pipes, max(0.0, deadline - time.monotonic()))
        if child.stderr.pipe in ready and not child.stderr.read():
            pipes.remove(child.stderr.pipe)
        if child.messages in ready:
            message = _receive(child)
            if isinstance(message, RunRecord):
                return message
            if message is None:
                return _crashed(child)
            phase, patience_s = "plan", limits.run_s(child.cell)
            deadline = time.monotonic() + patience_s
        elif child.process.sentinel in ready:
            return _crashed(child)
        elif time.monotonic() >= deadline:
            _kill(child.process.pid)
            reason = f"{phase} took more than {patience_s:g} s and was killed."
            return RunRecord(child.cell, PlanStatus.TIMED_OUT, reason)


def _receive(child: _Child) -> str | RunRecord | None:
    """One message; None at the end of the pipe, or if something else was written into it."""
    try:
        message: str | RunRecord = child.messages.recv()
    except (EOFError, OSError, pickle.UnpicklingError):
        return None
    return message


def _crashed(child: _Child) -> RunRecord:
    code = child.reap(REAP_S)
    child.stderr.read()
    return RunRecord(child.cell, PlanStatus.CRASHED, f"the process {_end_in_words(code)}.")


def _end_in_words(code: int | None) -> str:
    if code is None:
        return "closed its pipe"
    if code >= 0:
        return f"ended with exit code {code}"
    try:
        return f"was ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"was ended by signal {-code}"


def _kill(pid: int) -> None:
    """SIGKILL for a process and all that descends from it."""
    family: list[psutil.Process] = []
    # A descendant may have left the process group: the tree is read before its root is gone.
    with contextlib.suppress(psutil.Error):
        root = psutil.Process(pid)
        family = [*root.children(recursive=True), root]
    _kill_group(pid)
    for process in family:
        with contextlib.suppress(psutil.Error):
            process.kill()


def _kill_group(pid: int) -> None:
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(pid, signal.SIGKILL)


def _main_module() -> tuple[str | None, str | None]:
    """Name and file of the module that this process was started with."""
    module = sys.modules["__main__"]
    file = getattr(module, "__file__", None)
    name = getattr(getattr(module, "__spec__", None), "name", None)
    return name, None if file is None else os.path.normpath(os.path.abspath(file))  # noqa: PTH100


@contextlib.contextmanager
def _server_environment(warmth: Warmth) -> Iterator[None]:
    """The settings that a fork server started now inherits; variables are put back afterwards."""
    _CONTEXT.set_forkserver_preload([Warmth.__module__])
    wanted = replace(warmth, main=_main_module()).environment()
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
