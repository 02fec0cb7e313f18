"""Nothing on the terminal after the last word: compiled libraries complain as the process ends."""

import atexit
import os
import sys


def end_quietly() -> None:
    """Drop what libraries write to standard error while the interpreter is taken down.

    OMPL's bindings list "leaked" objects there, hundreds of lines that mean nothing to users and
    that no setting turns off. Errors of the program itself are written before.
    """
    atexit.register(_drop_standard_error)


def _drop_standard_error() -> None:
    # Processes that never loaded such a library keep their standard error to the end.
    if "ompl" in sys.modules:
        sys.stderr.flush()
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 2)
        os.close(nowhere)
