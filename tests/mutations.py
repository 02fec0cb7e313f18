"""Files that went wrong: documents and texts changed at random, each by its seed.

A document is what JSON and TOML hold: dicts, lists, strings, numbers, true, false, nothing. What is
done to one is what people, editors and programs do: something is left out, of another type, there
twice, in another order, far too large, nested, or cut in two.
"""

import copy
import datetime
import json
import math
import random
import warnings
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, TypeVar

from suite.scenes.scene import SceneWarning

T = TypeVar("T")

Place = tuple[Any, Any]
"""A dict or list, and a key or index of it."""

STRANGE: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 2**63, 10**30, 10**400, 0.5, -0.0, 1e300, 1e-300, math.nan,
    math.inf, -math.inf, "", "abc", "two\nlines", "\x00", "ü" * 300, "null", [], {}, [[]], [None],
    {"type": "Polygon"}, ["a", 1], datetime.date(2026, 1, 1),
)  # fmt: skip
DEEPEST = 40

FACTORS = (1, 1, 1, -1, 0.1, 10, 1e6, 1e12)
OFFSETS = (0, 1e-12, 1e-9, -1e-9, 1e-6, 1, 3, -50)


def mutated_document(document: Any, seed: int) -> Any:
    """A copy with one to three things changed in it."""
    rng = random.Random(seed)
    changed = copy.deepcopy(document)
    for _ in range(rng.randint(1, 3)):
        changes = rng.choice(_CHANGES)
        place = _any_place(changed, rng)
        if place is not None:
            changes(*place, rng)
    return changed


def _any_place(document: Any, rng: random.Random) -> Place | None:
    """A place at any depth: numbers are many, so that a walk from the top finds the others."""
    place: Place | None = None
    here = document
    while isinstance(here, dict | list) and here and (place is None or rng.random() < 0.8):
        place = here, rng.choice(list(here) if isinstance(here, dict) else range(len(here)))
        here = place[0][place[1]]
    return place


def _drop(holder: Any, key: Any, _: random.Random) -> None:
    del holder[key]


def _null(holder: Any, key: Any, _: random.Random) -> None:
    holder[key] = None


def _retype(holder: Any, key: Any, rng: random.Random) -> None:
    holder[key] = copy.deepcopy(rng.choice(STRANGE))


def _text(holder: Any, key: Any, _: random.Random) -> None:
    holder[key] = str(holder[key])[:1000]


def _twice(holder: Any, key: Any, rng: random.Random) -> None:
    again = copy.deepcopy(holder[key])
    if isinstance(holder, list):
        holder.insert(rng.randint(0, len(holder)), again)
    else:
        holder[f"{key}{rng.choice(['', '_', ' '])}2"] = again


def _reorder(holder: Any, _: Any, rng: random.Random) -> None:
    if isinstance(holder, list):
        rng.shuffle(holder)
    else:
        values = rng.sample(list(holder.values()), len(holder))
        holder.update(zip(holder, values, strict=True))


def _nest(holder: Any, key: Any, rng: random.Random) -> None:
    for _ in range(rng.choice([1, 2, DEEPEST])):
        holder[key] = [holder[key]] if rng.random() < 0.5 else {"of": holder[key]}


def _nudge(holder: Any, key: Any, rng: random.Random) -> None:
    value = holder[key]
    if isinstance(value, int | float) and not isinstance(value, bool):
        holder[key] = value * rng.choice(FACTORS) + rng.choice(OFFSETS)
    else:
        _retype(holder, key, rng)


def _rename(holder: Any, key: Any, rng: random.Random) -> None:
    if isinstance(holder, dict):
        holder[f"{key}s" if rng.random() < 0.5 else str(key)[:-1] or "x"] = holder.pop(key)


_CHANGES: tuple[Callable[[Any, Any, random.Random], None], ...] = (
    _drop, _null, _retype, _text, _twice, _reorder, _nest, _nudge, _nudge, _rename,
)  # fmt: skip


def mutated_bytes(text: str | bytes, seed: int) -> bytes:
    """The text as bytes, with one to three things done to it."""
    rng = random.Random(seed)
    data = text if isinstance(text, bytes) else text.encode()
    for _ in range(rng.randint(1, 3)):
        data = rng.choice(_BYTES)(data, rng)
    return data


def _slice(data: bytes, rng: random.Random) -> tuple[int, int]:
    start = rng.randrange(len(data) + 1)
    return start, min(len(data), start + rng.choice([1, 2, 10, 100]))


def _cut(data: bytes, rng: random.Random) -> bytes:
    return data[: rng.randrange(len(data) + 1)]


def _without(data: bytes, rng: random.Random) -> bytes:
    start, end = _slice(data, rng)
    return data[:start] + data[end:]


def _doubled(data: bytes, rng: random.Random) -> bytes:
    start, end = _slice(data, rng)
    return data[:end] + data[start:]


def _noise(data: bytes, rng: random.Random) -> bytes:
    start, end = _slice(data, rng)
    return data[:start] + rng.randbytes(rng.choice([1, 4])) + data[end:]


def _sign(data: bytes, rng: random.Random) -> bytes:
    at = rng.randrange(len(data) + 1)
    return (
        data[:at]
        + rng.choice([b"{", b"]", b",", b'"', b"-", b"9", b"e", b"\n", b"\x00"])
        + data[at:]
    )


def _encoded(data: bytes, rng: random.Random) -> bytes:
    encoding = rng.choice(["utf-16", "utf-32", "utf-8-sig", "utf-7"])
    return data.decode(errors="replace").encode(encoding, errors="replace")


def _windows(data: bytes, _: random.Random) -> bytes:
    return data.replace(b"\n", b"\r\n")


_BYTES: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    _cut, _without, _doubled, _noise, _sign, _sign, _encoded, _windows,
)  # fmt: skip


def as_json(document: Any) -> str:
    """A document as JSON; dates, which it has not, as strings."""
    return json.dumps(document, default=str)


def as_toml(document: dict[str, Any]) -> str:
    """A document as TOML, a line for each key; what TOML has no word for is left out."""
    return "".join(f"{json.dumps(key)} = {_toml(value)}\n" for key, value in _told(document))


def _told(table: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    return ((key, value) for key, value in table.items() if value is not None)


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {_toml(v)}" for k, v in _told(value)) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(item) for item in value if item is not None) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value)
    return str(value)  # numbers and dates


def check_files(
    files: Iterable[tuple[Path, Path]],
    load: Callable[[Path], T],
    right: Callable[[T], None],
    wrong: type[Exception],
    longest: int,
) -> None:
    """Load files that went wrong: each is an error that can be read, or right, and both occur.

    Parameters
    ----------
    files : (what to load, the file that went wrong) of each.
    load : raises ``wrong`` if it can't be used; no warning but of a mended scene is let pass.
    right : looks at what was loaded.
    longest : characters of an error.
    """
    outcomes = {"error": 0, "right": 0}
    for named, bad in files:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", SceneWarning)
            try:
                found = load(named)
            except wrong as error:
                # A map's error names the map, though another file of it be the bad one.
                check_words(error, named if named.name in str(error) else bad, longest)
                outcomes["error"] += 1
            else:
                right(found)
                outcomes["right"] += 1
    # Mutations that nobody notices, or that leave nothing to be read, would test nothing.
    assert min(outcomes.values()) > 0, outcomes


def check_words(error: Exception, file: Path, longest: int) -> None:
    """A file that went wrong is named, in a line or two that can be read at a terminal."""
    message = str(error)
    assert file.name in message
    assert len(message.splitlines()) <= 2, message
    assert len(message) <= longest, message
    assert message.replace("\n", "").isprintable(), message
