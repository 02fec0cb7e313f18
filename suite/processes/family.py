"""The end of a run's process and of all that descends from it.

A descendant may leave its process group, and lose its parent on purpose (fork, setsid, fork again).
On Linux the run's process, and above it the fork server, adopt such orphans: as long as the server
lives, whatever a run started is found below it.
"""

import contextlib
import ctypes
import os
import signal
import time
from collections.abc import Container

import psutil

PR_SET_CHILD_SUBREAPER = 36
KILL_POLL_S = 0.002

REAP_S = 5.0
"""What a killed process may take to be gone; longer only in the kernel's uninterruptible sleep."""


def adopt_orphans() -> None:
    """Become the parent of descendants that lose theirs, where the system has that (Linux)."""
    with contextlib.suppress(AttributeError, OSError):
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def has_children() -> bool:
    """Whether this process has children, or had some that it did not wait for."""
    try:
        os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        return False
    return True


def kill_family(pid: int) -> None:
    """SIGKILL for a process and all that descends from it; it is not waited for."""
    family: list[psutil.Process] = []
    # The tree is read before its root is gone.
    with contextlib.suppress(psutil.Error):
        root = psutil.Process(pid)
        family = [*root.children(recursive=True), root]
    kill_group(pid)
    for process in family:
        with contextlib.suppress(psutil.Error):
            process.kill()


def kill_group(pid: int) -> None:
    """SIGKILL for a process group."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(pid, signal.SIGKILL)


def kill_children(pid: int, timeout_s: float, but: Container[int] = ()) -> None:
    """SIGKILL for the children of a process, until it has none; it must reap them itself.

    Parameters
    ----------
    pid : int
        A process that adopts orphans: the children of a killed child come next.
    timeout_s : float
        When to give up, seconds.
    but : container of int
        Children to be left alone.
    """
    deadline = time.monotonic() + timeout_s
    with contextlib.suppress(psutil.Error):
        parent = psutil.Process(pid)
        while strangers := [child for child in parent.children() if child.pid not in but]:
            for child in strangers:
                with contextlib.suppress(psutil.Error):
                    child.kill()
            if time.monotonic() > deadline:
                return
            time.sleep(KILL_POLL_S)
