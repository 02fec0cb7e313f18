"""What must hold of a class before anything can be run with it: told without running any of it."""

import dataclasses
import inspect
import re
from typing import Any

from suite.planner import INTERFACE, Abilities, Planner

NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
"""What a planner may be called."""

PLAN_TAKES = ("self", "scene", "query", "budget", "rng", "recorder")


def flaw(found: Any) -> str | None:
    """Why something can't be used as a planner; None if it can.

    Parameters
    ----------
    found : Any
        What an entry point or a file led to.

    Returns
    -------
    str or None
        One sentence to be read after the thing's name, and how to mend it.

    Examples
    --------
    >>> flaw(42)
    'is not a subclass of suite.planner.Planner.'
    """
    if not (isinstance(found, type) and issubclass(found, Planner)):
        return "is not a subclass of suite.planner.Planner."
    if inspect.isabstract(found):
        return f"does not define {', '.join(sorted(found.__abstractmethods__))}."
    return _interface_flaw(found) or _signature_flaw(found) or _declaration_flaw(found)


def _interface_flaw(found: type[Planner]) -> str | None:
    if found.interface == INTERFACE:
        return None
    return (
        f"is written for version {found.interface!r} of the plugin interface; this kbga-bench has "
        f"version {INTERFACE}. Install the plugin and the kbga-bench that belong together."
    )


def _signature_flaw(found: type[Planner]) -> str | None:
    try:
        signature = inspect.signature(found.plan)
    except (TypeError, ValueError):  # a compiled method may have none
        return None
    try:
        signature.bind(*PLAN_TAKES)
    except TypeError:
        return f"has plan{signature}. It must be plan({', '.join(PLAN_TAKES)})."
    return None


def _declaration_flaw(found: type[Planner]) -> str | None:
    if not isinstance(found.abilities, Abilities):
        kind = type(found.abilities).__name__
        return f"has abilities of the type {kind}. Give a suite.planner.Abilities."
    if not (isinstance(found.Settings, type) and dataclasses.is_dataclass(found.Settings)):
        return "has Settings that are not a dataclass. Decorate them with @dataclass(frozen=True)."
    try:
        found.Settings()
    except Exception as error:  # other people's code: it may raise anything
        reason = f"{type(error).__name__}: {error}"
        return f"has Settings that can't be made without arguments ({reason}). Give all defaults."
    return None
