"""Scene modifiers: a scene that is moved, grown or read otherwise, by the way its name is spelled.

``zigzag@turn=17,shift=0.37`` is zigzag turned by 17 degrees and moved 0.37 m to the right. Behind
the ``@`` stand, in any order and each at most once:

``scale=F``
    All lengths times F, about the centre of the workspace.
``turn=DEGREES``
    Counter-clockwise, about the centre of the workspace.
``shift=DX`` or ``shift=DX:DY``
    Metres, to the right and up.
``twin=SEED``
    A turn drawn uniformly from 0 to 360 degrees and shifts of up to a metre either way, the same
    for each scene. A planner that finds good paths only where walls lie well for it is found out
    by twins.

``radius=R``
    Of the robot, metres: the obstacles grow by it, after all else, and the workspace shrinks.

And of maps alone, how they are read, see :class:`suite.scenes.maps.options.MapOptions`:
``unknown=free`` or ``unknown=occupied``, ``resolution=METRES`` of a pixel, ``threshold=SHARE`` and
``simplify=METRES``.

Workspace, obstacles, starts and goals move as one: the problem stays the same, and so does its
optimum, but for the scale. Only what a planner lays over the plane itself, a lattice say, meets
the obstacles elsewhere; as it may be laid from the workspace on, it is turning that counts.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np

from suite.errors import SceneError, did_you_mean
from suite.geometry.tolerances import LARGEST
from suite.scenes.maps.options import OPTIONS, MapOptions, Unknown
from suite.scenes.maps.suffixes import MAP_SUFFIXES

SUFFIXES = (".geojson", ".json")
"""Of scene files."""
PATHS = (*SUFFIXES, *MAP_SUFFIXES)
"""Suffixes by which a name is told from a path."""
MARK = "@"
KEYS = ("turn", "shift", "scale", "twin", "radius", *OPTIONS)
FURTHEST = 1.0
"""Metres by which a twin is shifted along each axis, at the most."""

_TWINS = re.compile(r"(.*@(?:.*,)?twin=)([0-9]{1,20})\.\.([0-9]{1,20})(.*)")


@dataclass(frozen=True, slots=True)
class Modifiers:
    """How a scene is moved: scaled and turned about the centre of its workspace, then shifted.

    text : as they are spelled behind the name of the scene.
    turn : degrees, counter-clockwise.
    shift : (dx, dy), metres.
    scale : factor on lengths, above 0.
    radius : of the robot, metres.
    options : how the map is read.
    """

    text: str
    turn: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0
    radius: float = 0.0
    options: MapOptions = field(default_factory=MapOptions)

    @property
    def moves(self) -> bool:
        """Whether anything comes to lie elsewhere."""
        return (self.turn, self.shift, self.scale) != (0.0, (0.0, 0.0), 1.0)


def split_modifiers(name: str) -> tuple[str, str]:
    """The name or file of a scene, and the modifiers behind it; empty if there are none.

    A file whose own name holds an ``@`` is no scene with modifiers.

    Examples
    --------
    >>> split_modifiers("zigzag@turn=17"), split_modifiers("zigzag")
    (('zigzag', 'turn=17'), ('zigzag', ''))
    >>> split_modifiers("rooms@home/a.json@twin=3"), split_modifiers("rooms@home/a.json")
    (('rooms@home/a.json', 'twin=3'), ('rooms@home/a.json', ''))
    """
    base, mark, text = name.rpartition(MARK)
    is_path = len(Path(text).parts) > 1 or Path(text).suffix.lower() in PATHS
    if not mark or is_path or Path(name).exists():
        return name, ""
    if not text or not base:
        raise SceneError(
            f"{name}: {'a scene' if text else 'a modifier'} is missing beside the '{MARK}'. "
            f"Write it like zigzag{MARK}turn=17, or leave the '{MARK}' out."
        )
    return base, text


def parse_modifiers(text: str, where: str) -> Modifiers:
    """Read the modifiers of a scene.

    Parameters
    ----------
    text : str
        What stands behind the ``@``.
    where : str
        The whole name, for errors.

    Returns
    -------
    Modifiers
        A twin's turn and shift are added to others.

    Raises
    ------
    SceneError
        With what is wrong and how to mend it.

    Examples
    --------
    >>> found = parse_modifiers("shift=0.37,turn=17", "zigzag")
    >>> found.text, found.turn, found.shift, found.scale, found.radius
    ('shift=0.37,turn=17', 17.0, (0.37, 0.0), 1.0, 0.0)
    """
    pairs = _pairs(text, where)
    turn = _number(pairs["turn"], "turn", where) if "turn" in pairs else 0.0
    shift = _shift(pairs["shift"], where) if "shift" in pairs else (0.0, 0.0)
    scale = _above_zero(pairs["scale"], "scale", where) if "scale" in pairs else 1.0
    if "twin" in pairs:
        angle, dx, dy = _drawn(_seed(pairs["twin"], where))
        turn, shift = turn + angle, (shift[0] + dx, shift[1] + dy)
    return Modifiers(
        ",".join(f"{k}={v}" for k, v in pairs.items()),
        turn,
        shift,
        scale,
        _not_negative(pairs["radius"], "radius", where) if "radius" in pairs else 0.0,
        _options({key: value for key, value in pairs.items() if key in OPTIONS}, where),
    )


def _pairs(text: str, where: str) -> Mapping[str, str]:
    pairs: dict[str, str] = {}
    for part in text.split(","):
        key, equals, value = (piece.strip() for piece in part.partition("="))
        if key not in KEYS:
            hint = did_you_mean(key, KEYS)
            raise SceneError(f"{where}: no modifier '{key}'. It takes {', '.join(KEYS)}.{hint}")
        if not equals or not value:
            raise SceneError(f"{where}: {key} has no value. Write {_EXAMPLES[key]}.")
        if key in pairs:
            raise SceneError(f"{where}: {key} comes twice. Give it once.")
        pairs[key] = value
    return pairs


_EXAMPLES = {
    "turn": "turn=17, in degrees",
    "shift": "shift=0.37 or shift=0.37:-0.21, in metres",
    "scale": "scale=1.0137, above 0",
    "twin": "twin=3, a whole number of 0 or more",
    "radius": "radius=0.2, in metres, of 0 or more",
    "unknown": "unknown=occupied or unknown=free",
    "resolution": "resolution=0.05, metres of a pixel, above 0",
    "threshold": "threshold=0.65, the share of black from which a pixel is occupied, above 0",
    "simplify": "simplify=0.1, metres, above 0",
}


def _number(value: str, key: str, where: str) -> float:
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    if not abs(number) <= LARGEST:  # so written, NaN is refused too
        raise SceneError(f"{where}: {key} is '{value}'. Write {_EXAMPLES[key]}.")
    return number


def _shift(value: str, where: str) -> tuple[float, float]:
    parts = value.split(":")
    if len(parts) > 2:
        raise SceneError(f"{where}: shift is '{value}'. Write {_EXAMPLES['shift']}.")
    dx, dy = (_number(part, "shift", where) for part in (*parts, "0")[:2])
    return dx, dy


def _not_negative(value: str, key: str, where: str) -> float:
    number = _number(value, key, where)
    if number < 0.0:
        raise SceneError(f"{where}: {key} is '{value}'. Write {_EXAMPLES[key]}.")
    return number


def _above_zero(value: str, key: str, where: str) -> float:
    number = _number(value, key, where)
    if number <= 0.0:
        raise SceneError(f"{where}: {key} is '{value}'. Write {_EXAMPLES[key]}.")
    return number


def _options(given: Mapping[str, str], where: str) -> MapOptions:
    read: dict[str, Any] = {k: _above_zero(v, k, where) for k, v in given.items() if k != "unknown"}
    if "unknown" in given:
        try:
            read["unknown"] = Unknown(given["unknown"])
        except ValueError:
            raise SceneError(
                f"{where}: unknown is '{given['unknown']}'. Write {_EXAMPLES['unknown']}."
            ) from None
    return MapOptions(**read)


def _seed(value: str, where: str) -> int:
    if not re.fullmatch(r"[0-9]{1,20}", value):
        several = " Several at once, as in twin=1..10, are for matrices." if ".." in value else ""
        raise SceneError(f"{where}: twin is '{value}'. Write {_EXAMPLES['twin']}.{several}")
    return int(value)


def _drawn(seed: int) -> tuple[float, float, float]:
    """Degrees and the two shifts (metres) of a twin."""
    rng = np.random.default_rng([seed, crc32(b"twin")])
    angle = float(rng.uniform(0.0, 360.0))
    dx, dy = rng.uniform(-FURTHEST, FURTHEST, 2).tolist()
    return angle, dx, dy


def expand_twins(name: str) -> list[str]:
    """The names that a name with several twins stands for; any other stands for itself.

    Raises
    ------
    SceneError
        If the last twin comes before the first.

    Examples
    --------
    >>> expand_twins("zigzag@twin=1..3")
    ['zigzag@twin=1', 'zigzag@twin=2', 'zigzag@twin=3']
    >>> expand_twins("zigzag")
    ['zigzag']
    """
    found = _TWINS.fullmatch(name)
    if found is None or Path(name).exists():
        return [name]
    before, first, last, behind = found.groups()
    if int(last) < int(first):
        raise SceneError(f"{name}: its twins go from {first} to {last}. Give the lower one first.")
    return [f"{before}{seed}{behind}" for seed in range(int(first), int(last) + 1)]
