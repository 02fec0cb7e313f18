"""Plain data, of TOML, JSON or a command line, as values of types, and such values as plain data.

msgspec converts and checks. The words are ours: an error says what stands there, and what to give.
A field says in ``Annotated[..., Meta(description="...")]`` what it wants where its type does not.
"""

import dataclasses
import re
import typing
from collections.abc import Mapping
from enum import Enum
from typing import Any, TypeVar

import msgspec
from msgspec import inspect

from suite.errors import did_you_mean

T = TypeVar("T")


class MisfitError(ValueError):
    """Data that is not of the type that is wanted.

    keys : names and numbers that lead from the whole to the place.
    The text says what is wrong there, and what to give; the caller says where the whole comes from.
    """

    def __init__(self, keys: tuple[str | int, ...], what: str) -> None:
        super().__init__(what)
        self.keys = keys


def typed(data: Any, kind: type[T]) -> T:
    """Convert plain data to a type; strings are taken for nothing but strings.

    Parameters
    ----------
    data : what a parser gave
    kind : msgspec.Struct, dataclass, or any type that msgspec knows

    Raises
    ------
    MisfitError
        If the data is not of that type.

    Examples
    --------
    >>> typed([1, 2], tuple[float, float])
    (1.0, 2.0)
    """
    try:
        return msgspec.convert(data, kind)
    except msgspec.ValidationError as error:
        said, _, place = str(error).partition(" - at `$")
        steps = re.findall(r"\.([^.\[`]+)|\[(\d+)\]", place)
        keys = tuple(name or int(number) for name, number in steps)
        raise MisfitError(keys, _told(said, keys, data, inspect.type_info(kind))) from error


def dataclass_of(data: Mapping[str, Any], kind: type[T]) -> T:
    """Build a dataclass from the fields that are given; its own check has the last word.

    Raises
    ------
    MisfitError
        If there is no such field, or a value has another type than its field.
    """
    hints = typing.get_type_hints(kind, include_extras=True)
    wanted = [field.name for field in dataclasses.fields(kind)]  # type: ignore[arg-type]
    for key in data:
        if key not in wanted:
            raise MisfitError((), _unknown(key, wanted))
    values = {}
    for key, value in data.items():
        try:
            values[key] = typed(value, hints[key])
        except MisfitError as error:
            what = f"{key} is {shown(value)}. Give {_given(inspect.type_info(hints[key]))}."
            raise MisfitError(error.keys, what) from error
    return kind(**values)


def plain(value: Any) -> Any:
    """A value as plain data, at any depth, as JSON gives it back.

    Dataclasses and mappings become dicts, tuples and arrays lists, enumerations their values; what
    is plain already, or nothing that is known here, stays what it is.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass
    ... class WalkSettings:
    ...     steps: tuple[float, ...] = (0.5, 1.0)
    ...     retries: int | None = None
    >>> plain(WalkSettings())
    {'steps': [0.5, 1.0], 'retries': None}
    """
    if dataclasses.is_dataclass(value):
        return {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, tuple | list):
        return [plain(item) for item in value]
    if isinstance(value, Mapping):
        return {name: plain(item) for name, item in value.items()}
    # numpy is not imported for it: a command that only lists has no arrays.
    return value.tolist() if hasattr(value, "tolist") else value


SHOWN = 80
"""Characters of a value in an error: it says what stands there, and whole it may be the file."""


def shown(value: Any) -> str:
    """A value as an error shows it: on one line, and cut if it is long.

    Examples
    --------
    >>> shown("abc"), shown(list(range(1000)))[-8:]
    ("'abc'", '0, 21...')
    """
    text = " ".join(repr(value).split())
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."


def in_words(kind: Any) -> str:
    """Put a type in a user's words.

    Examples
    --------
    >>> in_words(int | None)
    'a whole number or none'
    """
    return _words(inspect.type_info(kind))


_PLAIN = {
    inspect.IntType: "a whole number",
    inspect.FloatType: "a number",
    inspect.BoolType: "true or false",
    inspect.StrType: "a string",
    inspect.NoneType: "none",
    inspect.DictType: "a table",
    inspect.StructType: "a table",
    inspect.DataclassType: "a table",
}


def _words(kind: inspect.Type) -> str:
    match kind:
        case inspect.Metadata(type=inner, extra_json_schema=extra):
            return str((extra or {}).get("description") or _words(inner))
        case inspect.UnionType(types=types):
            # None last, as one says it.
            ordered = sorted(types, key=lambda t: isinstance(t, inspect.NoneType))
            return " or ".join(_words(t) for t in ordered)
        case inspect.LiteralType(values=values):
            return "one of " + ", ".join(repr(v) for v in sorted(values, key=str))
        case inspect.EnumType(cls=cls):
            members: type[Enum] = cls
            return "one of " + ", ".join(repr(member.value) for member in members)
        case inspect.TupleType(item_types=types):
            return f"a list ({', '.join(_words(t) for t in types)})"
        case inspect.VarTupleType(item_type=item) | inspect.ListType(item_type=item):
            return f"a list ({_words(item)}, ...)"
        case inspect.CustomType(cls=cls):
            return str(cls.__name__)
    return _PLAIN.get(type(kind), "another value")


def _given(kind: inspect.Type) -> str:
    """What to give for a value that is not left out: TOML has no word for none."""
    if isinstance(kind, inspect.UnionType):
        types = tuple(t for t in kind.types if not isinstance(t, inspect.NoneType))
        return _words(inspect.UnionType(types))
    return _words(kind)


def _told(said: str, keys: tuple[str | int, ...], data: Any, kind: inspect.Type) -> str:
    """What msgspec said, with the value that stands there and the words of its type."""
    field = re.search(r"field `(.+)`", said)
    if field and "unknown" in said:
        return _unknown(field[1], list(_fields(_at(kind, keys))))
    if field:
        wanted = _fields(_at(kind, keys))[field[1]]
        return f"'{field[1]}' is missing: give {_words(wanted)}."
    for key in keys:
        data = data[key]
    names = [key for key in keys if isinstance(key, str)]
    return f"{names[-1] if names else 'it'} is {shown(data)}. Give {_given(_at(kind, keys))}."


def _unknown(key: str, known: list[str]) -> str:
    return f"unknown key '{key}'. It may have: {', '.join(known)}.{did_you_mean(key, known)}"


def _at(kind: inspect.Type, keys: tuple[str | int, ...]) -> inspect.Type:
    """The type of the place that some keys lead to; with its description, if it has one."""
    for key in keys:
        inner = _one_with(key, _bare(kind))
        if isinstance(key, str):
            kind = _fields(inner)[key]
        elif isinstance(inner, inspect.TupleType):
            kind = inner.item_types[key]
        else:
            kind = inner.item_type  # type: ignore[attr-defined]
    return kind


def _bare(kind: inspect.Type) -> list[inspect.Type]:
    """The members of a union, or the one type, without their descriptions."""
    if isinstance(kind, inspect.Metadata):
        return _bare(kind.type)
    if isinstance(kind, inspect.UnionType):
        return [bare for member in kind.types for bare in _bare(member)]
    return [kind]


def _one_with(key: str | int, kinds: list[inspect.Type]) -> inspect.Type:
    wanted = ("fields",) if isinstance(key, str) else ("item_type", "item_types")
    return next(kind for kind in kinds if any(hasattr(kind, name) for name in wanted))


def _fields(kind: inspect.Type) -> dict[str, inspect.Type]:
    inner = _one_with("", _bare(kind))
    return {field.encode_name: field.type for field in inner.fields}  # type: ignore[attr-defined]
