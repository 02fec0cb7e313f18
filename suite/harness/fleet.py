"""The processes of runs in flight: started by the warmed fork server, reaped, and killed.

multiprocessing's bookkeeping of children polls all of them whenever one is started, and two threads
that poll one child race for its exit code; so starting and reaping take turns.
"""

import contextlib
import multiprocessing
import os
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from multiprocessing import forkserver
from multiprocessing.connection import wait
from multiprocessing.context import ForkServerProcess
from typing import Any

import psutil

from suite.errors import HarnessError
from suite.harness.child import run_in_child
from suite.harness.fork_server import Warmth
from suite.plugins.own_modules import VARIABLE
from suite.processes.family import REAP_S, kill_children, kill_family, kill_group
from suite.processes.multiprocessing_private import (
    forget_server,
    main_module,
    make_socket_folder,
    server_pid,
    start_tracker_quietly,
)

ANSWER_S = 0.5
"""A fork server that takes longer to start a process is still warming up."""

WAKE_S = 1.0
"""How often it is looked whether the fork server was stopped."""

STARTS = 3
"""A planner that kills its parent takes the fork server away from the others: they try again."""

POLL_S = 0.02

_CONTEXT = multiprocessing.get_context("forkserver")


@dataclass(slots=True, eq=False)
class _Fleet:
    """The runs of this process that are in flight, and how often they were told to stop.

    named : the planners that the fork server knows by their files, as it inherits them.
    sentry : looks after the fork server; None before the first one.
    turn : held while one is started or reaped; then the children of the fork server are the runs in
        flight, and orphans of others.
    """

    pids: set[int] = field(default_factory=set)
    stops: int = 0
    named: str | None = None
    sentry: threading.Thread | None = None
    turn: threading.Lock = field(default_factory=threading.Lock)


_fleet = _Fleet()


class StoppedError(Exception):
    """The runs in flight were killed before this one had a process."""


def start_server(warmth: Warmth) -> None:
    """Start the fork server, if it does not run yet; it warms itself while the caller goes on.

    One that knows other planners by their files than this process does now is replaced, if it has
    no run in flight: its children would inherit what it knows.

    Raises
    ------
    HarnessError
        If the system starts no process.
    """
    named = os.environ.get(VARIABLE)
    if named != _fleet.named and not _fleet.pids:
        stop_server()
    with _fleet.turn, _server_environment(warmth):
        _fleet.named = named
        try:
            start_tracker_quietly()
            make_socket_folder()
            forkserver.ensure_running()
        except OSError as error:
            raise no_process(error) from error
    _post_sentry()


def stop_server() -> None:
    """End the fork server, when no run is in flight: the next run starts another, newly warmed."""
    with _fleet.turn:
        if (server := server_pid()) is not None:
            # It may be in the middle of its warming, which can take minutes.
            kill_family(server)
        forget_server()


def kill_running() -> None:
    """Kill all runs of this process that are in flight; their callers get CRASHED records."""
    _fleet.stops += 1
    if _fleet.turn.acquire(timeout=ANSWER_S):
        _fleet.turn.release()
    elif (server := server_pid()) is not None:
        kill_family(server)
    for pid in list(_fleet.pids):
        kill_family(pid)


def start(arguments: tuple[Any, ...], warmth: Warmth) -> ForkServerProcess:
    """Start the process of a run, which :func:`end` must be called for.

    Parameters
    ----------
    arguments : of :func:`suite.harness.child.run_in_child`
    warmth : Warmth
        For the fork server: the first start, and one after its death, makes a new one.

    Raises
    ------
    StoppedError
        If the runs in flight were killed meanwhile.
    HarnessError
        If the system starts no process.
    """
    _post_sentry()
    stops = _fleet.stops
    failure: Exception = OSError()
    for _ in range(STARTS):
        with _fleet.turn, _server_environment(warmth):
            if _fleet.stops != stops:
                break
            process = _CONTEXT.Process(target=run_in_child, args=arguments)
            try:
                make_socket_folder()
                process.start()
                _fleet.pids.add(process.ident or 0)
                return process
            except (EOFError, OSError) as error:
                failure, server = error, server_pid()
        _give_up_on(server, stops)
    if _fleet.stops != stops:
        raise StoppedError
    raise no_process(failure) from failure


def no_process(error: Exception) -> HarnessError:
    """What to say where the system gives a run no process, or none of the pipes that it needs."""
    why = getattr(error, "strerror", None) or "the fork server does not answer"
    file = getattr(error, "filename", None)
    return HarnessError(
        f"no process can be started for a run ({why}{f': {file}' if file else ''}). Look at the "
        "limits for processes, open files and memory and at the folder for temporary files, "
        f"{tempfile.gettempdir()}; then run the same command again: it goes on where it stopped."
    )


def _give_up_on(server: int | None, stops: int) -> None:
    """End a fork server that starts no process, its socket deleted perhaps: another one is made.

    Not before the other runs have ended that it has started, for it takes them with it.
    """
    while server is not None:
        with _fleet.turn:
            if _fleet.stops != stops or server_pid() != server:
                return
            if not _fleet.pids:
                kill_family(server)
                forget_server()
                return
        time.sleep(POLL_S)


def _post_sentry() -> None:
    """Have a thread wake the fork server when it is stopped: nobody can who waits for it."""
    if _fleet.sentry is None or not _fleet.sentry.is_alive():
        _fleet.sentry = threading.Thread(target=_keep_awake, name="sentry", daemon=True)
        _fleet.sentry.start()


def _keep_awake() -> None:
    while True:
        time.sleep(WAKE_S)
        with contextlib.suppress(psutil.Error):
            server = server_pid()
            if server is not None and psutil.Process(server).status() == psutil.STATUS_STOPPED:
                psutil.Process(server).resume()


def reap(process: ForkServerProcess, timeout_s: float = REAP_S) -> int | None:
    """Exit code of a process, negative for a signal; None if it still runs."""
    if not wait([process.sentinel], timeout_s):
        return None
    with _fleet.turn:
        process.join(0)
        return process.exitcode


def end(process: ForkServerProcess, *, is_alone: bool) -> None:
    """Kill what is left of a run, wherever it went.

    Parameters
    ----------
    process : ForkServerProcess
    is_alone : bool
        Whether it is known that nothing descends from it any more.
    """
    pid = process.ident or 0
    kill_group(pid)
    if reap(process) is None:
        kill_family(pid)
    with _fleet.turn:
        _fleet.pids.discard(pid)
        server = server_pid()
        if not is_alone and server is not None:
            kill_children(server, REAP_S, but=_fleet.pids)


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
