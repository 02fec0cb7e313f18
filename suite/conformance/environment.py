"""Who set an environment variable: a planner, or a library as it was imported.

What a library sets as it is imported is not for a planner's author to mend, and is set but once. It
is the planner's when its own code does it, or calls a function that does.
"""

import os
import sys
from types import FrameType
from typing import Any

from suite.plugins.own_modules import package_of

EVENTS = ("os.putenv", "os.unsetenv")
IMPORTER = "<frozen importlib"

_writes: list[tuple[str, bool]] = []
"""(name, whether a library set it as it was imported) of each variable that was written."""

_planners: set[str] = set()
"""The packages of the planners that are looked at."""


def watch(planner: type[Any]) -> None:
    """Take note, from now on, of who writes variables; a planner's own code is told from others."""
    if not _planners:
        sys.addaudithook(_note)
    _planners.add(package_of(planner.__module__))


def writes() -> int:
    """How many variables have been written so far."""
    return len(_writes)


def set_by_imports(first: int, last: int) -> set[str]:
    """The variables that nobody but libraries wrote, as they were imported, between two counts."""
    wrote = {name for name, _ in _writes[first:last]}
    return wrote - {name for name, by_import in _writes[first:last] if not by_import}


def _note(event: str, arguments: tuple[Any, ...]) -> None:
    if event in EVENTS:
        _writes.append((os.fsdecode(arguments[0]), _is_import_of_others(sys._getframe())))


def _is_import_of_others(frame: FrameType | None) -> bool:
    """Whether, of what goes on, an import is nearer than the planner's own code."""
    while frame is not None:
        if package_of(frame.f_globals.get("__name__", "")) in _planners:
            return False
        if frame.f_code.co_filename.startswith(IMPORTER):
            return True
        frame = frame.f_back
    return False
