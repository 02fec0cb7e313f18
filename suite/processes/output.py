"""What planners and libraries print is kept out of what a command says.

Compiled libraries complain as the process ends: nothing is to follow the last word.
"""

import atexit
import contextlib
import os
import sys
from collections.abc import Iterator
from typing import Any


def end_quietly() -> None:
    """Drop what libraries write to standard error while the interpreter is taken down.

    OMPL's bindings list "leaked" objects there, hundreds of lines that mean nothing to users and
    that no setting turns off. Errors of the program itself are written before.
    """
    atexit.register(_drop_standard_error)


@contextlib.contextmanager
def print_aside() -> Iterator[None]:
    """Let what is printed meanwhile go to standard error: standard output is the command's.

    Of the process, not only of Python's ``print``; whatever was put in the place of ``sys.stdout``
    is taken away afterwards.
    """
    mine = sys.stdout
    mine.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    try:
        yield
    finally:
        sys.stdout = mine
        mine.flush()  # what was printed by whoever had taken hold of it before
        os.dup2(kept, 1)
        os.close(kept)


def show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    """Write a warning as one line, without the line of ours that gave it.

    For ``warnings.showwarning``.
    """
    sys.stderr.write(f"kbga-bench: warning: {' '.join(str(message).split())}\n")


def _drop_standard_error() -> None:
    # Processes that never loaded such a library keep their standard error to the end.
    if "ompl" in sys.modules:
        sys.stderr.flush()
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 2)
        os.close(nowhere)
