"""What a family draws: obstacles, start and goal, in a square room that is not turned yet."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Polygon

SIDE = 100.0
"""Of the room, metres: that of the paper's scenes."""

ROOM = shapely.box(0.0, 0.0, SIDE, SIDE)

Place = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Draft:
    """An instance before it is turned.

    obstacles : polygons in the room, with holes where they surround free space.
    start, goal : metres.
    """

    obstacles: Sequence[Polygon]
    start: Place
    goal: Place


def around(free: Iterable[Polygon]) -> list[Polygon]:
    """The walls around rooms and passages: all of the room that is not free."""
    return polygons_of(ROOM.difference(shapely.union_all(list(free))))


def within_room(obstacles: Iterable[Polygon]) -> list[Polygon]:
    """Obstacles that may overlap and stick out of the room, as polygons that do neither."""
    return polygons_of(ROOM.intersection(shapely.union_all(list(obstacles))))


def polygons_of(area: shapely.Geometry) -> list[Polygon]:
    """The polygons of an area, from left to right; what has none is left out."""
    parts = [part for part in shapely.get_parts(area) if isinstance(part, Polygon)]
    return sorted((part for part in parts if part.area > 0.0), key=lambda part: part.bounds)


def bar(places: Sequence[Place] | NDArray[np.float64], width: float) -> Polygon:
    """A bent bar of a width (metres) along places (n, 2), its ends and bends square."""
    return LineString(places).buffer(0.5 * width, cap_style="flat", join_style="mitre")


def between(low: float, high: float, rng: np.random.Generator) -> float:
    """A number from ``low`` to ``high``."""
    return float(rng.uniform(low, high))
