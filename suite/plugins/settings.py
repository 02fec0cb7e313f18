"""The settings of a planner: from what a user wrote to its frozen dataclass.

A string is converted to the type that its field declares: it may come from the command line.
"""

import dataclasses
import typing
from collections.abc import Mapping
from typing import Any

import msgspec

from suite.errors import ContractError, PluginError, did_you_mean, sentence
from suite.planner import Planner
from suite.typed import in_words

_WORDS = {"none": None, "yes": True, "on": True, "no": False, "off": False}
"""What users write on the command line beside the words of TOML."""


def make_settings(planner_class: type[Planner], mapping: Mapping[str, Any]) -> Any:
    """Build a planner's frozen settings from what a user wrote.

    Parameters
    ----------
    planner_class : type[Planner]
    mapping : mapping from a field's name to its value
        Values as TOML gives them, or strings as ``--set key=value`` gives them; strings are
        converted to the type that the field declares.

    Returns
    -------
    planner_class.Settings

    Raises
    ------
    PluginError
        If a field is unknown, a value has the wrong type, or the settings themselves refuse it.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class WalkSettings:
    ...     step: float = 1.0
    ...     retries: int | None = 3
    >>> class Walk(Planner):
    ...     name = "walk"
    ...     Settings = WalkSettings
    >>> make_settings(Walk, {"step": "0.5", "retries": "none"})
    WalkSettings(step=0.5, retries=None)
    """
    owner = planner_class.name
    wanted = _field_types(planner_class)
    values: dict[str, Any] = {}
    for key, value in mapping.items():
        if key not in wanted:
            fields = f"It has: {', '.join(wanted)}." if wanted else "It has no settings."
            raise PluginError(f"{owner}: no setting '{key}'. {fields}{did_you_mean(key, wanted)}")
        try:
            values[key] = _converted(value, wanted[key])
        except msgspec.ValidationError as error:
            raise PluginError(
                f"{owner}: {key} is {value!r}. It must be {in_words(wanted[key])}."
            ) from error
        except TypeError as error:
            why = sentence(error)
            raise PluginError(f"{owner}: the type of {key} can't be read: {why}") from error
    try:
        return planner_class.Settings(**values)
    except (TypeError, ValueError, ContractError) as error:
        raise PluginError(f"{owner}: {error}") from error


def _field_types(planner_class: type[Planner]) -> dict[str, Any]:
    """Look up the declared type of each field that the settings take."""
    settings = planner_class.Settings
    if not dataclasses.is_dataclass(settings):
        raise PluginError(f"{planner_class.name}: {settings.__name__} is not a dataclass.")
    try:
        hints = typing.get_type_hints(settings)
    except NameError as error:
        raise PluginError(
            f"{planner_class.name}: the types of {settings.__name__} can't be read: "
            f"{sentence(error)}"
        ) from error
    return {f.name: hints[f.name] for f in dataclasses.fields(settings) if f.init}


def _converted(value: Any, wanted: Any) -> Any:
    """Convert a value to the declared type; ValidationError if it does not fit."""
    if not isinstance(value, str):
        return msgspec.convert(value, wanted)
    word = _WORDS.get(value.lower(), value)
    if word is None and type(None) in typing.get_args(wanted):
        # Before all else: every string is a str, but "none" means None where that is allowed.
        return None
    if typing.get_origin(wanted) is tuple:
        return msgspec.convert([item.strip() for item in value.split(",")], wanted, strict=False)
    try:
        return msgspec.convert(value, wanted, strict=False)
    except msgspec.ValidationError:
        return msgspec.convert(word, wanted)
