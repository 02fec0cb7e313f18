"""What planners and libraries print is kept out of what a command says.

Compiled libraries complain as the process ends: nothing is to follow the last word.
"""

import atexit
import contextlib
import io
import os
import sys
from collections.abc import Iterator
from typing import Any, TextIO

_words: list[TextIO] = []
"""Where a command speaks while standard output is kept for it; the last one counts."""


def end_quietly() -> None:
    """Drop what libraries write to standard error while the interpreter is taken down.

    OMPL's bindings list "leaked" objects there, hundreds of lines that mean nothing to users and
    that no setting turns off. Errors of the program itself are written before.
    """
    atexit.register(_drop_standard_error)


def words() -> TextIO:
    """Where a command is to write: standard output, also while others print aside."""
    return _words[-1] if _words else sys.stdout


@contextlib.contextmanager
def print_aside() -> Iterator[None]:
    """Let what is printed meanwhile go to standard error: standard output is for :func:`words`.

    Of the process, not only of Python's ``print``; whatever was put in the place of ``sys.stdout``
    is taken away afterwards.
    """
    mine: TextIO | None = sys.stdout
    if mine is None:  # closed by whoever started the process: nobody listens
        yield
        return
    mine.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    _words.append(_leading_to(kept, mine))
    try:
        yield
    finally:
        if (own := _words.pop()) is not mine:
            with contextlib.suppress(OSError):  # nobody reads it any more, as has been told then
                own.close()
        sys.stdout = mine
        mine.flush()  # what was printed by whoever had taken hold of it before
        os.dup2(kept, 1)
        os.close(kept)


def print_aside_for_good() -> None:
    """The same to the end of the process: exit handlers of libraries print, too."""
    with contextlib.suppress(AttributeError, OSError, ValueError):  # closed, or read by nobody
        sys.stdout.flush()
    with contextlib.suppress(OSError):
        os.dup2(2, 1)
    sys.stdout = sys.stderr


def _leading_to(kept: int, stream: TextIO) -> TextIO:
    """A stream that writes where another one wrote before its descriptor was redirected."""
    try:
        is_redirected = stream.fileno() == 1
    except (OSError, io.UnsupportedOperation):  # one that tests or notebooks have put there
        is_redirected = False
    if not is_redirected:
        return stream
    return open(
        kept, "w", encoding=stream.encoding, errors=stream.errors, buffering=1, closefd=False
    )


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
