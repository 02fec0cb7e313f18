"""What the runs need of multiprocessing and it does not promise: all of it stands here.

Looked up in the sources of Python 3.11.7, 3.12.1, 3.13.0 and what became 3.14: the names and the
behaviour are the same in all of them. ``tests/suite/processes/test_multiprocessing_private.py``
fails where a release takes one away.
"""

import contextlib
import multiprocessing
import os
import struct
import sys
import tempfile
import threading
import types
import warnings
from collections.abc import Callable
from importlib.machinery import ModuleSpec
from multiprocessing import forkserver, resource_tracker
from multiprocessing.util import get_temp_dir
from typing import Any

MESSAGE_HEADER = struct.Struct("!i")
"""What ``Connection.send`` puts before a message of less than 2 GiB: its length. Whoever reads only
what is there, and does not wait for the rest, must know it."""

LONGEST_FOLDER = 70
"""A socket's path has at most 107 bytes on Linux and 103 on macOS, and Python adds up to 30."""

SHORT_FOLDER = "/tmp"

ORPHAN_WARNING = "forkserver: waitpid returned unexpected pid"
"""How a fork server begins to complain of each orphan that it reaps."""

# The one object that stands for the server, in the harness and in each of its children.
_server: Any = forkserver._forkserver


def server_pid() -> int | None:
    """The process of the fork server; None if there is none.

    There is no public word for it, and a server that is in the middle of its warming can be ended
    by nothing but a signal.
    """
    pid: int | None = _server._forkserver_pid
    return pid


def forget_server() -> None:
    """Wait for the end of the fork server: the next process is started by another one.

    Python's own tests do it so. The server ends by itself when no run is left that it has started.
    """
    # Its socket is gone if somebody deleted the folder for temporary files.
    with contextlib.suppress(FileNotFoundError):
        _server._stop()


def make_socket_folder() -> None:
    """See to it that a fork server's socket has a folder, whose path is not too long for one.

    Python makes one in the folder for temporary files, once, and never looks again.

    Raises
    ------
    OSError
        If none can be made.
    """
    configuration: dict[str, Any] = multiprocessing.current_process()._config  # type: ignore[attr-defined]
    known = configuration.get("tempdir")
    if known is not None and not os.path.isdir(known):  # noqa: PTH112
        try:
            # Under the same name, because it is to be deleted at the end.
            os.makedirs(known, mode=0o700)  # noqa: PTH103
        except OSError:
            tempfile.tempdir = known = configuration["tempdir"] = None
    if known is None and len(tempfile.gettempdir()) > LONGEST_FOLDER:
        before, tempfile.tempdir = tempfile.tempdir, SHORT_FOLDER
        try:
            get_temp_dir()
        finally:
            tempfile.tempdir = before


def start_tracker_quietly() -> None:
    """Start the process that remembers shared memory, if it does not run yet, with nothing to say.

    All runs have its pipe; what a planner writes into that, or forgets to free, it would tell the
    terminal at length.
    """
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        kept = os.dup(2)
    except OSError:  # closed
        kept = None
    if kept is not None:
        os.dup2(nowhere, 2)
    try:
        resource_tracker.ensure_running()
    finally:
        if kept is not None:
            os.dup2(kept, 2)
            os.close(kept)
        os.close(nowhere)


def end_without_farewell(last: Callable[[], None]) -> None:
    """Have this process end with this function when its program has ended, and with nothing else.

    No thread is waited for then, and nothing of ``atexit`` is called: those of plugins may hang.
    """

    def end() -> None:
        last()
        os._exit(0)

    threading._register_atexit(end)  # type: ignore[attr-defined]


def leave_server() -> None:
    """Close what a run has of the fork server's own pipe.

    It tells the server that somebody needs it, which is not for a run to say, and the server dies
    of what is written into it.
    """
    if _server._forkserver_alive_fd is not None:
        os.close(_server._forkserver_alive_fd)
        _server._forkserver_alive_fd = None


def parent_pipe() -> int | None:
    """A pipe that closes when the process dies that asked for this one; None if nobody asked.

    It is promised that one can wait for it, not that it is a pipe, which can send a signal, too.
    Only the asking process has its other end: the fork server in between may live on.
    """
    parent = multiprocessing.parent_process()
    return None if parent is None else int(parent.sentinel)


def ignore_orphan_warning() -> None:
    """Have this process, a fork server, say nothing of the orphans that it adopts and reaps."""
    warnings.filterwarnings("ignore", message=ORPHAN_WARNING)


def main_module() -> tuple[str | None, str | None]:
    """Name and file by which multiprocessing tells children of the module that users started."""
    module = sys.modules["__main__"]
    file = getattr(module, "__file__", None)
    name = getattr(getattr(module, "__spec__", None), "name", None)
    return name, None if file is None else os.path.normpath(os.path.abspath(file))  # noqa: PTH100


def stand_in_for_main(name: str | None, file: str | None) -> None:
    """Put an empty ``__main__`` where multiprocessing looks for the user's.

    It runs the user's script again in each child, so that what is defined there can be unpickled.
    Nothing of ours is defined there, the import costs every run, and a script without an
    ``if __name__ == "__main__"`` would start the whole benchmark again. It does not where a module
    of that name and file is there already.

    Parameters
    ----------
    name, file : str, optional
        As :func:`main_module` gives them.
    """
    module = types.ModuleType("__main__")
    module.__spec__ = None if name is None else ModuleSpec(name, None)
    if file is not None:
        module.__file__ = file
    sys.modules["__main__"] = module
