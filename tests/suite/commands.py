"""The command ``kbga-bench`` in processes of its own."""

import subprocess
import sys
from dataclasses import dataclass

COMMAND = [sys.executable, "-c", "from suite.cli import main; main()"]


@dataclass(frozen=True)
class Done:
    code: int
    out: str
    err: str


def in_own_process(*arguments, code=0, env=None):
    done = subprocess.run(
        [*COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=120, env=env
    )
    assert done.returncode == code, done.stderr
    return Done(done.returncode, done.stdout, done.stderr)
