"""A dask scheduler and workers: real processes, on loopback, on free ports."""

import contextlib
import json
import os
import shutil
import subprocess
import sys
import time
from functools import cache

import psutil
from distributed import Client

from suite.jit import cache_folder

START_S = 300.0
"""What comes at all comes sooner, on a machine however busy."""

LOOPBACK = ("--host", "127.0.0.1", "--dashboard-address", "127.0.0.1:0", "--no-dashboard")
"""Without the second one, what is left of the dashboard listens on all interfaces."""


class Cluster:
    """A scheduler and the workers that were added. `close` ends them all, by their ids.

    folder : of files that the scheduler and the workers share.
    env : of all of them.
    """

    def __init__(self, folder, env):
        self.env = env
        self.folder = folder
        self.processes = []
        self.file = folder / "scheduler.json"
        self._start("scheduler", "--port", "0", "--scheduler-file", str(self.file))
        wait_until(lambda: self.file.exists() and self.file.stat().st_size > 0)
        self.address = json.loads(self.file.read_text())["address"]

    def add_worker(self, *arguments, machine=None, threads=1):
        """Start a worker; on a machine of its own, if one is given."""
        local = machine.folder if machine else self.folder
        join = ("--scheduler-file", str(self.file), "--nthreads", str(threads), "--no-nanny")
        join += ("--local-directory", str(local), *arguments)
        return self._start("worker", *join, machine=machine)

    def wait_for(self, workers):
        """Wait until so many are there: `connect` is less patient than a busy machine is slow."""
        with Client(self.address, timeout=START_S, set_as_default=False) as client:
            client.wait_for_workers(workers, timeout=START_S)

    def _start(self, kind, *arguments, machine=None):
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", *arguments, *LOOPBACK]
        env, folder = self.env, self.folder
        if machine is not None:
            command, env, folder = machine.command(command), env | machine.env(), machine.folder
        with (self.folder / f"{kind}-{len(self.processes)}.log").open("wb") as log:
            process = subprocess.Popen(command, env=env, cwd=folder, stdout=log, stderr=log)
        self.processes.append(process)
        return psutil.Process(process.pid)

    def close(self):
        for process in reversed(self.processes):
            end(process)


class Machine:
    """As much of a machine of its own as one machine can have.

    Its folder is home, cache, place for temporary files and current folder; machine code of other
    checkouts' kernels is there from the start. What the user has lies on a disk that it does not
    see, where the system lets us take it away.

    hidden : the user's folder.
    """

    def __init__(self, folder, hidden, *, cold=False):
        self.folder, self.hidden = folder, hidden
        self.kernels = folder / "numba"
        self.folder.mkdir(parents=True)
        if not cold:
            here = cache_folder()
            if here.exists():
                # Links, not copies: numba puts a new file in the place of an old one.
                to = self.kernels / here.parent.name / here.name
                shutil.copytree(here, to, copy_function=os.link)
        self.code_before = self.code()

    def code(self):
        """Files of machine code, each with the time when it was written."""
        return {file: file.stat().st_mtime_ns for file in self.folder.rglob("*.nbc")}

    def new_code(self):
        """Those that were written since this machine was made."""
        return dict(sorted(self.code().items() - self.code_before.items()))

    def env(self):
        home = str(self.folder)
        names = ("HOME", "XDG_CACHE_HOME", "TMPDIR")
        return dict.fromkeys(names, home) | {"NUMBA_CACHE_DIR": str(self.kernels)}

    def command(self, command):
        if not can_hide():
            return command
        covered = 'mount -t tmpfs none "$1" && shift && exec "$@"'
        return [*_UNSHARE, "sh", "-c", covered, "sh", str(self.hidden), *command]


_UNSHARE = ("unshare", "--mount", *(() if os.getuid() == 0 else ("--map-root-user",)))


@cache
def can_hide():
    """Whether a process may be given its own view of the disk here. Containers often forbid it."""
    if shutil.which("unshare") is None:
        return False
    return subprocess.run([*_UNSHARE, "sh", "-c", "mount -t tmpfs none /mnt"],
                          capture_output=True).returncode == 0  # fmt: skip


def wait_until(ready, patience_s=START_S):
    deadline = time.monotonic() + patience_s
    while not ready() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert ready()


def listening(pids):
    """(address, port) of all that living processes and their descendants listen on."""
    found = set()
    for pid in filter(psutil.pid_exists, pids):
        above = psutil.Process(pid)
        for one in (above, *above.children(recursive=True)):
            with contextlib.suppress(psutil.NoSuchProcess):
                found |= {
                    (c.laddr.ip, c.laddr.port)
                    for c in one.net_connections("inet")
                    if c.status == psutil.CONN_LISTEN
                }
    return found


def end(process):
    """End a process and all that descends from it, by their ids."""
    with contextlib.suppress(psutil.NoSuchProcess):
        above = psutil.Process(process.pid)
        for one in (*above.children(recursive=True), above):
            with contextlib.suppress(psutil.NoSuchProcess):
                one.kill()
    process.wait()
