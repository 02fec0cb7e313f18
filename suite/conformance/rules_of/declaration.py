"""Rules about what a planner declares: nothing is run for them."""

import dataclasses
import pickle
from collections.abc import Set
from typing import Any

from suite.conformance.finding import Answer, Finding
from suite.conformance.subject import Subject
from suite.errors import PluginError
from suite.planner import Budget
from suite.plugins.settings import make_settings
from suite.plugins.validation import NAME, flaw
from suite.typed import plain


def is_a_planner(subject: Subject) -> Answer:
    """It is a subclass of Planner with a plan of the right signature, for this interface."""
    wrong = flaw(subject.planner_class)
    if wrong is None:
        return None
    return Finding(
        f"{getattr(subject.planner_class, '__name__', subject.planner_class)} {wrong}",
        "a class as suite/planner.py describes it",
        "Do as the sentence says; suite/planner.py is the whole interface.",
    )


def name_is_well_formed(subject: Subject) -> Answer:
    """Its name is of lower-case letters, digits and single hyphens."""
    name: Any = getattr(subject.planner_class, "name", None)
    if isinstance(name, str) and NAME.fullmatch(name):
        return None
    return Finding(
        f"the name is {name!r}",
        "a string of lower-case letters, digits and single hyphens that begins with a letter",
        "Change `name`, and the entry point with it: users type it, and tables and files have it.",
    )


def abilities_are_known(subject: Subject) -> Answer:
    """The budgets that it says it keeps are budgets."""
    known = {field.name for field in dataclasses.fields(Budget)}
    budgets: Any = subject.planner_class.abilities.budgets
    if not isinstance(budgets, Set):
        found = f"abilities.budgets is {budgets!r}"
    elif budgets <= known:
        return None
    else:
        found = f"abilities.budgets has {', '.join(sorted(map(repr, budgets - known)))}"
    return Finding(
        found,
        f"a frozenset of some of {', '.join(sorted(known))}",
        "Name there the fields of suite.planner.Budget that plan obeys, and nothing else.",
    )


def settings_are_frozen(subject: Subject) -> Answer:
    """Its Settings are a frozen dataclass."""
    parameters: Any = getattr(subject.planner_class.Settings, "__dataclass_params__", None)
    if parameters is not None and parameters.frozen:
        return None
    return Finding(
        f"{subject.planner_class.Settings.__name__} can be written to",
        "a dataclass with frozen=True",
        "Write @dataclass(frozen=True): a row states the settings that it was made with.",
    )


def settings_come_back(subject: Subject) -> Answer:
    """Its settings survive the way through a matrix and a row: plain data that make them again."""
    given = subject.settings or subject.planner_class.Settings()
    settings, told = subject.planner_class(given).settings, plain(given)
    if told and settings is not given:
        return _lost(told, "the planner's own are others, whatever it is built with")
    try:
        made = make_settings(subject.planner_class, told)
    except PluginError as error:
        return _lost(told, str(error))
    return None if made == settings else _lost(told, f"they come back as {plain(made)}")


def _lost(told: Any, what: str) -> Finding:
    return Finding(
        f"the settings {told}: {what}",
        "settings that equal those made from their own fields",
        "Give each field a type of numbers, strings, booleans, tuples of these, or None, and let "
        "__post_init__ accept what it has made.",
    )


def pickles(subject: Subject) -> Answer:
    """Its class and settings can be pickled: that is how they reach other processes."""
    wanted = (subject.planner_class, subject.build().settings)
    try:
        back = pickle.loads(pickle.dumps(wanted))
    except Exception as error:  # pickle raises whatever a class's own hooks raise
        return _unpicklable(f"{type(error).__name__}: {error}")
    return None if back == wanted else _unpicklable("they come back as something else")


def _unpicklable(what: str) -> Finding:
    return Finding(
        f"class and settings do not go through pickle: {what}",
        "the same class and equal settings",
        "Define both at the top of a module, and keep locks, files and functions out of settings.",
    )
