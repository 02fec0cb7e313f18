"""Discovery of planners by entry point, and the settings that users write for them.

A planner is declared in the metadata of any installed distribution::

    [project.entry-points."kbga_bench.planners"]
    straight-line = "my_package.straight:StraightLine"

Listing names reads metadata and imports nothing. A plugin that can't be imported is a row that
says so; it stops nobody else. Planners that a user names on the spot
(:mod:`suite.plugins.from_file`) stand beside the declared ones.
"""

import dataclasses
import types
import typing
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from enum import Enum
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from suite.errors import ContractError, PluginError, did_you_mean
from suite.planner import Abilities, Planner
from suite.plugins.code_hash import OURS, code_hash, files_of_entry_point, module_of
from suite.plugins.from_file import NamedPlugin, named_plugins
from suite.plugins.validation import flaw

GROUP = "kbga_bench.planners"

Source = EntryPoint | NamedPlugin

_TRUE = frozenset({"true", "yes", "on", "1"})
_FALSE = frozenset({"false", "no", "off", "0"})


@dataclasses.dataclass(frozen=True, slots=True)
class PluginInfo:
    """One line of the list of installed planners.

    name : the word under which users ask for the planner.
    distribution, version : of the package that declares it, with a hash of its code unless it is
        kbga-bench; or the file and a hash of its code; several, with commas, if it is ambiguous.
    available : whether it can be loaded.
    reason : "unavailable: ..." and why; None if it is available.
    abilities : what it can do; None if it is not available.
    """

    name: str
    distribution: str
    version: str
    available: bool
    reason: str | None = None
    abilities: Abilities | None = None


def planner_names() -> list[str]:
    """Names of all declared planners, sorted. Imports none of them.

    Examples
    --------
    >>> "visibility-graph" in planner_names()
    True
    """
    return sorted(_declared())


def load_planner(name: str) -> type[Planner]:
    """Import the planner of that name.

    Parameters
    ----------
    name : str
        As in :func:`planner_names`.

    Returns
    -------
    type[Planner]

    Raises
    ------
    PluginError
        If no planner, or more than one, has that name; if it can't be imported; if what is
        imported is not a planner of that name.
    """
    declared = _declared()
    if name not in declared:
        raise _unknown(name, declared)
    try:
        return _load(name, declared[name])
    except PluginError as error:
        raise PluginError(f"planner '{name}' is unavailable: {error}") from error.__cause__


def available_planners() -> list[PluginInfo]:
    """Import every declared planner and say of each what came of it, sorted by name."""
    return [_describe(name, points) for name, points in sorted(_declared().items())]


def planner_info(name: str) -> PluginInfo:
    """Import one planner, and no other, and say what came of it.

    Raises
    ------
    PluginError
        If no planner has that name.
    """
    declared = _declared()
    if name not in declared:
        raise _unknown(name, declared)
    return _describe(name, declared[name])


def planner_version(name: str) -> str | None:
    """Version of the distribution that declares a planner; None if there is no such planner.

    Nothing is imported; several versions, with commas, if the name is ambiguous.
    """
    points = _declared().get(name)
    return None if points is None else ", ".join(_distribution(point)[1] for point in points)


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
        except ValueError as error:
            raise PluginError(
                f"{owner}: {key} is {value!r}. It must be {_type_name(wanted[key])}."
            ) from error
    try:
        return planner_class.Settings(**values)
    except (TypeError, ValueError, ContractError) as error:
        raise PluginError(f"{owner}: {error}") from error


def settings_as_dict(settings: Any) -> dict[str, Any]:
    """Fields and values of a settings dataclass, in the order of its fields, as plain data.

    Examples
    --------
    >>> from suite.planner import NoSettings
    >>> settings_as_dict(NoSettings())
    {}
    """
    return {f.name: _plain(getattr(settings, f.name)) for f in dataclasses.fields(settings)}


def _declared() -> dict[str, list[Source]]:
    declared: dict[str, list[Source]] = defaultdict(list)
    for source in (*entry_points(group=GROUP), *named_plugins()):
        declared[source.name].append(source)
    return dict(declared)


def _unknown(name: str, declared: Iterable[str]) -> PluginError:
    installed = ", ".join(sorted(declared)) or "none"
    return PluginError(
        f"no planner '{name}'. Installed: {installed}; or give its file with --plugin."
        f"{did_you_mean(name, declared)}"
    )


def _distribution(source: Source) -> tuple[str, str]:
    if isinstance(source, NamedPlugin):
        return source.distribution, source.version
    if source.dist is None:
        return "unknown", "unknown"
    name, version = source.dist.name, source.dist.version
    if module_of(source).split(".")[0] in OURS:
        return name, version
    # Whoever works on a plugin installs it again and again with one version.
    return name, f"{version} {code_hash(files_of_entry_point(source))}"


def _load(name: str, sources: Sequence[Source]) -> type[Planner]:
    """Load the one source of a name; PluginError holds the bare reason why it can't be."""
    if len(sources) > 1:
        owners = " and ".join(_distribution(source)[0] for source in sources)
        raise PluginError(f"{owners} both declare it. {_one_of(sources)}")
    place = _place(sources[0])
    try:
        # Other people's code: whatever its import raises must not end the listing.
        found = sources[0].load()
    except PluginError:
        raise  # the plugin's own sentence, such as how to install what it needs
    except (Exception, SystemExit) as error:
        raise PluginError(f"{type(error).__name__}: {error}") from error
    wrong = flaw(found)
    if wrong is not None:
        raise PluginError(f"{place} {wrong}")
    if getattr(found, "name", None) != name:
        raise PluginError(
            f"{place} calls itself {getattr(found, 'name', None)!r}. "
            "The entry point and the attribute `name` must be the same."
        )
    planner: type[Planner] = found
    return planner


def _place(source: Source) -> str:
    return source.reference if isinstance(source, NamedPlugin) else source.value


def _one_of(sources: Sequence[Source]) -> str:
    if any(isinstance(source, NamedPlugin) for source in sources):
        return "Give the one of --plugin another name, or leave it out."
    return "Uninstall one of them."


def _describe(name: str, sources: Sequence[Source]) -> PluginInfo:
    owners, versions = zip(*(_distribution(source) for source in sources), strict=True)
    distribution, version = ", ".join(owners), ", ".join(versions)
    try:
        planner = _load(name, sources)
    except PluginError as error:
        return PluginInfo(name, distribution, version, False, f"unavailable: {error}")
    return PluginInfo(name, distribution, version, True, None, planner.abilities)


def _field_types(planner_class: type[Planner]) -> dict[str, Any]:
    """Look up the declared type of each field that the settings take."""
    settings = planner_class.Settings
    if not dataclasses.is_dataclass(settings):
        raise PluginError(f"{planner_class.name}: {settings.__name__} is not a dataclass.")
    try:
        hints = typing.get_type_hints(settings)
    except NameError as error:
        raise PluginError(
            f"{planner_class.name}: the types of {settings.__name__} can't be read: {error}."
        ) from error
    return {f.name: hints[f.name] for f in dataclasses.fields(settings) if f.init}


def _converted(value: Any, wanted: Any) -> Any:
    """Convert a value to the declared type; ValueError if it does not fit."""
    origin = typing.get_origin(wanted)
    if origin in (types.UnionType, typing.Union):
        return _converted_to_any(value, typing.get_args(wanted))
    if origin is typing.Literal:
        return _converted_to_literal(value, typing.get_args(wanted))
    if origin is tuple or wanted is tuple:
        return _converted_to_tuple(value, typing.get_args(wanted))
    if wanted is type(None):
        return _converted_to_none(value)
    if wanted is bool:
        return _converted_to_bool(value)
    if wanted is int:
        return _converted_to_int(value)
    if wanted is float:
        return _converted_to_float(value)
    if isinstance(wanted, type):
        if issubclass(wanted, Enum):
            return wanted(value)
        if not isinstance(value, wanted):
            raise ValueError(wanted)
    return value


def _converted_to_any(value: Any, choices: Sequence[Any]) -> Any:
    # None first and str last: the string "none" means None, and every string is a str.
    for choice in sorted(choices, key=lambda c: (c is not type(None), c is str)):
        try:
            return _converted(value, choice)
        except ValueError:
            continue
    raise ValueError(value)


def _converted_to_literal(value: Any, choices: Sequence[Any]) -> Any:
    for choice in choices:
        if type(value) is type(choice) and value == choice:
            return choice
        if isinstance(value, str) and value == str(choice):
            return choice
    raise ValueError(value)


def _converted_to_tuple(value: Any, inner: Sequence[Any]) -> tuple[Any, ...]:
    items = [v.strip() for v in value.split(",")] if isinstance(value, str) else value
    if not isinstance(items, list | tuple):
        raise ValueError(value)
    if not inner:
        return tuple(items)
    if len(inner) == 2 and inner[1] is Ellipsis:
        inner = [inner[0]] * len(items)
    if len(inner) != len(items):
        raise ValueError(value)
    return tuple(_converted(item, kind) for item, kind in zip(items, inner, strict=True))


def _converted_to_none(value: Any) -> None:
    if value is None or (isinstance(value, str) and value.lower() == "none"):
        return
    raise ValueError(value)


def _converted_to_bool(value: Any) -> bool:
    if isinstance(value, bool):
        return value
    if isinstance(value, str) and value.lower() in _TRUE | _FALSE:
        return value.lower() in _TRUE
    raise ValueError(value)


def _converted_to_int(value: Any) -> int:
    # bool is an int to Python, but `population = true` is a mistake.
    if isinstance(value, bool) or not isinstance(value, int | str):
        raise ValueError(value)
    return int(value)


def _converted_to_float(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError(value)
    return float(value)


def _type_name(wanted: Any) -> str:
    """Put a declared type in a user's words: "a number", "a whole number or none"."""
    words = {
        int: "a whole number",
        float: "a number",
        bool: "true or false",
        str: "a string",
        type(None): "none",
    }
    if wanted in words:
        return words[wanted]
    origin, inner = typing.get_origin(wanted), typing.get_args(wanted)
    if origin in (types.UnionType, typing.Union):
        return " or ".join(_type_name(t) for t in inner)
    if origin is typing.Literal:
        return "one of " + ", ".join(repr(t) for t in inner)
    if isinstance(wanted, type) and issubclass(wanted, Enum):
        return "one of " + ", ".join(repr(m.value) for m in wanted)
    if origin is tuple:
        kinds = ", ".join("..." if t is Ellipsis else _type_name(t) for t in inner)
        return f"a list ({kinds})"
    return str(getattr(wanted, "__name__", wanted))


def _plain(value: Any) -> Any:
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, tuple | list):
        return [_plain(v) for v in value]
    if isinstance(value, Mapping):
        return {k: _plain(v) for k, v in value.items()}
    return value
