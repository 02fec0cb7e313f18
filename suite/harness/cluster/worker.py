"""What a process on another machine does for a harness: its runs, and what it is asked of itself.

A worker may serve several harnesses, one after the other or at the same time. Each calls itself a
:class:`Session`; nobody ends the runs of another one.
"""

import multiprocessing
import threading
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from enum import Enum
from typing import Any

from suite.errors import HarnessError
from suite.harness.cluster.luggage import Luggage, Unpacked, unpack
from suite.harness.fleet import kill_running, stop_server
from suite.harness.fork_server import Warmth
from suite.harness.isolate import run_isolated
from suite.harness.matrix import Limits
from suite.harness.provenance import host_name, package_version, provenance
from suite.planner import PlanStatus
from suite.plugins.discovery import planner_version
from suite.plugins.from_file import hand_on, named_plugins
from suite.store.record import Cell, RunRecord

DISTRIBUTION = "kbga-bench"


@dataclass(frozen=True, slots=True)
class Session:
    """A harness that runs one matrix, once.

    key : tells it from all others.
    version : of the suite that it is.
    has_luggage : whether its runs need files that a worker must be sent first.
    """

    key: str
    version: str | None
    has_luggage: bool = False


class Answer(Enum):
    """What a worker may answer instead of a record."""

    SEND_LUGGAGE = "send luggage"
    """It is new to the session: the run is to be given to it again, with all files."""


@dataclass(slots=True, eq=False)
class _Desk:
    """What this process does, and for whom.

    sessions : by the keys of all that had runs here, what came with them.
    in_flight : number of runs, by the key of the session.
    versions : of planners' distributions, as they were when the last new session began.
    """

    sessions: dict[str, Unpacked] = field(default_factory=dict)
    in_flight: Counter[str] = field(default_factory=Counter)
    versions: dict[str, str | None] = field(default_factory=dict)


_desk = _Desk()
_lock = threading.Lock()


def run_for(
    session: Session, cell: Cell, limits: Limits, warmth: Warmth, luggage: Luggage | None = None
) -> RunRecord | Answer:
    """Run a cell here, as :func:`suite.harness.isolate.run_isolated` does, for a harness elsewhere.

    Parameters
    ----------
    session : Session
        Who wants it.
    cell, limits, warmth : as there.
    luggage : Luggage, optional
        Files of the session, if this worker asked for them.

    Returns
    -------
    RunRecord or Answer
        An ERROR if the planner is not here, or is another version than the cell says, or if there
        is no place for the luggage.

    Raises
    ------
    HarnessError
        If this process can do no runs at all, or none of this session.
    """
    with _lock:
        if session.key not in _desk.sessions:
            if session.has_luggage and luggage is None:
                return Answer.SEND_LUGGAGE
            _check_fit(session)
            try:
                unpacked = unpack(luggage or Luggage())
            except HarnessError as error:
                return _failed(cell, f"{host_name()}: {error}")
            _begin(session, unpacked)
        unpacked = _desk.sessions[session.key]
        _desk.in_flight[session.key] += 1
    with _at_work(session):
        reason = _lack(cell)
        if reason is not None:
            return _failed(cell, reason)
        here = replace(cell, scene_source=unpacked.source(cell.scene_source))
        return replace(run_isolated(here, limits, unpacked.warmth(warmth)), cell=cell)


def _failed(cell: Cell, reason: str) -> RunRecord:
    now = datetime.now(UTC).isoformat(timespec="seconds")
    return RunRecord(cell, PlanStatus.ERROR, reason, host=host_name(), started_at=now)


def describe(session: Session) -> dict[str, Any]:
    """What machine and versions these are; under ``unfit`` why there can be no runs, or None."""
    return {**provenance(""), "unfit": _unfit(session)}


def end_session(session: Session) -> int:
    """Kill the runs of a session that are in flight here, if no other session has any.

    Returns
    -------
    int
        How many are still in flight: ask again.
    """
    with _lock:
        if set(_desk.in_flight) == {session.key}:
            kill_running()
        return _desk.in_flight[session.key]


@contextmanager
def _at_work(session: Session) -> Iterator[None]:
    """A run that is counted as in flight already, and not any more afterwards."""
    try:
        yield
    finally:
        with _lock:
            _desk.in_flight[session.key] -= 1
            # Without keys that count nothing.
            _desk.in_flight += Counter()


def _check_fit(session: Session) -> None:
    reason = _unfit(session)
    if reason is not None:
        raise HarnessError(reason)


def _begin(session: Session, unpacked: Unpacked) -> None:
    """Prepare for a session that is new here: planners and scenes may have changed since."""
    if not _desk.in_flight.total():
        stop_server()
        hand_on(unpacked.plugins)
    elif not set(unpacked.plugins) <= set(named_plugins()):
        # The fork server that they share was started with those of the others.
        raise HarnessError(
            f"a worker on {host_name()} runs another matrix, with other files for --plugin. Start "
            "this one when that has ended, or give it workers of its own."
        )
    _desk.sessions[session.key] = unpacked
    _desk.versions.clear()


def _unfit(session: Session) -> str | None:
    """Why this process can do no runs for a session; None if it can."""
    version = package_version(DISTRIBUTION)
    if version != session.version:
        return (
            f"{host_name()} has {DISTRIBUTION} {version}, the harness is {session.version}. "
            "Install the same on both."
        )
    if multiprocessing.current_process().daemon:
        return (
            f"a worker on {host_name()} is a daemonic process, which may have no children, and "
            "every run is a process. Start it with `dask worker --no-nanny`, or with "
            "DASK_DISTRIBUTED__WORKER__DAEMON=False in its environment."
        )
    return None


def _lack(cell: Cell) -> str | None:
    """What this machine lacks to run a cell; None if nothing. Scenes are looked at by the run."""
    if cell.planner not in _desk.versions:
        _desk.versions[cell.planner] = planner_version(cell.planner)
    found = _desk.versions[cell.planner]
    wanted = f"{cell.distribution} {cell.version}"
    if found is None:
        return f"{host_name()} has no planner '{cell.planner}'. Install {wanted} there."
    if found != cell.version:
        return f"{host_name()} has {cell.planner} {found}. Install {wanted} there."
    return None
