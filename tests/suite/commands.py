"""The command ``kbga-bench`` in processes of its own."""

import signal
import subprocess
import sys
from dataclasses import dataclass

import psutil

COMMAND = [sys.executable, "-c", "from suite.cli import main; main()"]


@dataclass(frozen=True)
class Done:
    code: int
    out: str
    err: str


def in_own_process(*arguments, code=0, env=None):
    done = subprocess.run(
        [*COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=600, env=env
    )
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    return Done(done.returncode, done.stdout, done.stderr)


def hear_interrupts():
    """In a new process, before its program: let Ctrl-C end it.

    What a shell runs in the background ignores it, children included: nobody would be tested.
    """
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def marked(mark):
    """Processes that descend from a command with KBGA_TEST_MARK, wherever they hang now."""
    found = []
    for process in psutil.process_iter():
        try:
            # A daemon of a daemon has the same block of variables as its first ancestor.
            ours = process.environ().get("KBGA_TEST_MARK") == mark
            if ours and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
        except psutil.Error:
            continue
    return found
