"""What the fork server does once, before its first fork: import, compile, load scenes.

The server imports this module (multiprocessing's ``set_forkserver_preload``), and the import does
the work: children then start with everything in memory. What to warm comes by an environment
variable, because nothing else reaches the server so early. No random number is drawn here.

A plugin may crash, hang or exit while it warms up. So each is tried in a fork first, with a time
limit; one that fails there stays cold, and its own runs meet, and report, the same failure.
"""

import contextlib
import gc
import json
import os
import signal
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from typing import Any

import psutil

from suite.harness.prepared import build_planner, make_ready
from suite.harness.provenance import ONE_THREAD
from suite.processes.family import adopt_orphans, kill_family, kill_group
from suite.processes.memory import MemoryWatch
from suite.processes.multiprocessing_private import (
    end_without_farewell,
    ignore_orphan_warning,
    stand_in_for_main,
)

VARIABLE = "KBGA_BENCH_WARM"
LONGEST = 100_000
"""Bytes of a variable: Linux takes 131,072. What is longer is cut, and numbered."""

POLL_S = 0.002

END_S = 10.0
"""When a server gives up to end its descendants: only one that forks without end lasts so long."""


@dataclass(frozen=True, slots=True)
class Warmth:
    """What a fork server has ready for its children.

    planners : (plugin name, settings as JSON) of each variant.
    queries : (source of the scene, name of the query).
    limit_s : what the warm-up of one planner may take, seconds.
    memory_bytes : what it may hold.
    main : name and file of the module that users started, which children must not run again.
    """

    planners: tuple[tuple[str, str], ...] = ()
    queries: tuple[tuple[str, str], ...] = ()
    limit_s: float = 300.0
    memory_bytes: int = 2_000_000_000
    main: tuple[str | None, str | None] = (None, None)

    def environment(self) -> dict[str, str]:
        """The variables that a fork server needs to be warmed so."""
        return {**_written(self), **ONE_THREAD}


@lru_cache(maxsize=4)
def _written(warmth: Warmth) -> dict[str, str]:
    """A warmth in variables, each scene once with all of its queries."""
    queries: dict[str, list[str]] = {}
    for source, query in warmth.queries:
        queries.setdefault(source, []).append(query)
    text = json.dumps(asdict(replace(warmth, queries=())) | {"queries": queries})
    cuts = range(0, len(text), LONGEST)
    return {f"{VARIABLE}_{number}": text[i : i + LONGEST] for number, i in enumerate(cuts)}


def _read() -> dict[str, Any] | None:
    """What the variables say, which are taken away; None if there are none."""
    pieces: list[str] = []
    while (piece := os.environ.pop(f"{VARIABLE}_{len(pieces)}", None)) is not None:
        pieces.append(piece)
    told: dict[str, Any] | None = json.loads("".join(pieces)) if pieces else None
    return told


def warm(wanted: Mapping[str, Any]) -> None:
    """Make ready what a :class:`Warmth`, as plain data, asks for."""
    _become_server()
    stand_in_for_main(*wanted["main"])
    for source, queries in wanted["queries"].items():
        for query in queries:
            # A scene that can't be loaded is reported by the runs that want it.
            with contextlib.suppress(Exception):
                make_ready(source, query)
    with _silence():
        for name, settings in wanted["planners"]:
            _warm_planner(name, json.loads(settings), wanted["limit_s"], wanted["memory_bytes"])
            _end_children()
    # After the plugins, because what was asked for last comes first.
    end_without_farewell(_end_children)
    # Children then leave these objects, and the pages they lie on, alone.
    gc.collect()
    gc.freeze()


def _become_server() -> None:
    """What this process must be before it meets a plugin: quiet, and answerable for its children.

    Ctrl-C is for the harness, which kills the server if it must, and so are the signals that a
    terminal or a batch system sends to the whole group. When the harness is gone, the server ends,
    and whatever still descends from it goes first.
    """
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    adopt_orphans()
    ignore_orphan_warning()


def _end_children() -> None:
    """Kill all descendants of this process; as it adopts orphans, they become its children."""
    deadline = time.monotonic() + END_S
    while time.monotonic() < deadline:
        try:
            os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return
        for child in psutil.Process().children():
            kill_group(child.pid)
            with contextlib.suppress(psutil.Error):
                child.kill()
        time.sleep(POLL_S)


def _warm_planner(
    name: str, settings: Mapping[str, Any], limit_s: float, memory_bytes: int
) -> None:
    def warm_up() -> None:
        build_planner(name, settings).warm_up()

    if _survives(warm_up, limit_s, memory_bytes):
        with contextlib.suppress(Exception, SystemExit):
            warm_up()


def _survives(action: Callable[[], None], limit_s: float, memory_bytes: int) -> bool:
    """Whether an action ends well in a process of its own, within limits."""
    pid = os.fork()
    if pid == 0:
        code = 1
        try:
            os.setsid()
            action()
            code = 0
        finally:
            # No clean-up and no exit handlers: this is a copy of the server.
            os._exit(code)
    harness = os.getppid()
    deadline = time.monotonic() + limit_s
    memory = MemoryWatch(pid, memory_bytes)
    while time.monotonic() < deadline and os.getppid() == harness and memory.excess() is None:
        done, status = os.waitpid(pid, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status) == 0
        time.sleep(POLL_S)
    kill_family(pid)
    os.waitpid(pid, 0)
    return False


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Keep what plugins print while they warm up off the terminal, where progress is shown."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    kept = [os.dup(stream) for stream in (1, 2)]
    for stream in (1, 2):
        os.dup2(nowhere, stream)
    try:
        yield
    finally:
        for stream, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nowhere)


# Only the server's own environment has it: children and their children start without.
if (wanted := _read()) is not None:
    warm(wanted)
