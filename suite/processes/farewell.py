"""The end of a command's process: it comes, whatever planners have left running in it.

Python waits for threads and child processes that were left behind, and for every exit handler. A
run of a matrix has a process that is killed; ``plan`` has not.
"""

import atexit
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from suite.processes.output import print_aside_for_good

FAREWELL_S = 10
"""What exit handlers may take in all, seconds."""


@contextmanager
def ending(say: Callable[[str], None]) -> Iterator[None]:
    """End the process when the command within exits, with the code with which it exits.

    Parameters
    ----------
    say : callable
        Told, in a sentence, of what was left running.
    """
    before = set(threading.enumerate())
    try:
        yield
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
        left = _left_running(before)
        if left:
            say(f"{left} still ran when the command was done, and ended with it.")
            _end(code)
        _hurry(code)
        # Here and not as Python exits: there it hears no signal once the handlers are done, and the
        # alarm kills a process that takes itself down on a slow machine, its work all done.
        atexit._run_exitfuncs()
        _end(code)


def _left_running(before: set[threading.Thread]) -> str:
    """What Python would wait for, in words; nothing, if there is nothing."""
    threads = sum(not t.daemon and t not in before for t in threading.enumerate())
    processes = sum(not process.daemon for process in multiprocessing.active_children())
    counts = ((threads, "thread", "threads"), (processes, "process", "processes"))
    return " and ".join(f"{n} {one if n == 1 else many}" for n, one, many in counts if n)


def _end(code: int) -> None:
    for process in multiprocessing.active_children():
        process.kill()
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError, OSError, ValueError):  # closed, or read by nobody
            stream.flush()
    os._exit(code)


def _hurry(code: int) -> None:
    """Let nothing more be said on standard output, and end what then does not end by itself."""
    print_aside_for_good()
    if hasattr(signal, "alarm"):
        signal.signal(signal.SIGALRM, lambda *_: _end(code))
        signal.alarm(FAREWELL_S)
