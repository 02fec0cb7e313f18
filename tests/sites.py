"""Random building sites, at any place on earth and of any size.

A site is drawn in whole units, as a survey rounds it: rooms and buildings turned, boxes that touch,
walls that cross the border of the room. In a room of 100 m a unit is a millimetre; in another the
rounding scales with it. Placed, a coordinate is the decimal number of the map, rounded to the
nearest float64. Its twin at the origin is that placed site, moved without any rounding at all:
where their optima differ, it is our geometry that differs.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

Points = NDArray[np.float64]
Ends = tuple[Points, Points]

SIDE, DEPTH = 100_000, 75_000
"""Of a room that is not turned, units."""

PLACES = {
    "the origin": (0.0, 0.0),
    "UTM 32N Munich": (691608.2, 5334765.7),
    "UTM 37S Nairobi": (257390.5, 9857640.5),
    "EPSG:3857 Tokyo": (15550400.3, 4256900.9),
    "Lambert-93 Paris": (652381.7, 6862047.2),
    "British National Grid": (530047.1, 180422.6),
    "EPSG:3857 Ushuaia": (-7602633.4, -7320512.8),
}
"""Lower left corner of a site, metres."""

ROOMS = {"1 mm": -8, "10 cm": -6, "10 m": -4, "100 m": -3, "10 km": -1, "1,000 km": 1}
"""The longer side of a room, and the power of ten metres that a unit is in it."""

CLEAR = 20.0
"""Distance of starts and goals from all walls, units."""


@dataclass(frozen=True, slots=True, eq=False)
class Site:
    """A room, its buildings and its queries.

    unit : metres to which its coordinates were rounded, before they became floats.
    """

    room: Polygon
    buildings: tuple[Polygon, ...]
    queries: dict[str, Ends]
    unit: float

    @property
    def corner(self) -> Points:
        """Lower left corner of the box of the room, (2,)."""
        return np.array(self.room.bounds[:2])

    def at_origin(self) -> "Site":
        """The same site with its corner in the origin; ValueError if floats can't hold it."""
        return _mapped(self, lambda xy: _exact_difference(xy, self.corner), self.unit)


def draw_site(rng: np.random.Generator) -> Site:
    """Draw a site in whole units, its lower left corner in the origin."""
    angle = rng.uniform(0.0, 2.0 * np.pi)
    room = _turned(_box(0, 0, SIDE, DEPTH), angle if rng.random() < 0.5 else 0.0)
    buildings = [p for _ in range(rng.integers(2, 7)) for p in _building(angle, rng)]
    low = np.array(room.bounds[:2])
    room, *buildings = (shapely.transform(p, lambda xy: xy - low) for p in (room, *buildings))
    return Site(room, tuple(buildings), _queries(room, buildings, rng), 1.0)


def placed(site: Site, place: str, room: str) -> Site:
    """A site in whole units, put where a map of that place has it, in a room of that size."""
    power = ROOMS[room]
    metre = 10**-power if power < 0 else 1  # units that a metre is, a whole number
    step = 1 if power < 0 else 10**power
    corner = np.round(np.array(PLACES[place]) * metre)
    # Whole numbers below 2**53, and one division: the nearest float to the decimal number.
    return _mapped(site, lambda xy: (corner + step * xy) / metre, 10.0**power)


def _mapped(site: Site, move: Callable[[Points], Points], unit: float) -> Site:
    room, *buildings = (shapely.transform(p, move) for p in (site.room, *site.buildings))
    queries = {name: (move(start), move(goal)) for name, (start, goal) in site.queries.items()}
    return Site(room, tuple(buildings), queries, unit)


def _exact_difference(a: Points, b: Points) -> Points:
    difference = a - b
    virtual = a - difference  # Knuth's two-difference: what rounding left off is zero
    if np.any((a - (difference + virtual)) + (virtual - b) != 0.0):
        raise ValueError("the site can't be moved without rounding")
    return difference + 0.0


def _box(x: float, y: float, width: float, depth: float) -> Polygon:
    return shapely.box(x, y, x + width, y + depth)


def _turned(polygon: Polygon, angle: float) -> Polygon:
    """Turn about the middle of the room, and round to whole units."""
    centre = np.array([SIDE / 2, DEPTH / 2])
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.array([[cos, -sin], [sin, cos]])
    return shapely.transform(polygon, lambda xy: np.round((xy - centre) @ turn.T + centre))


def _building(angle: float, rng: np.random.Generator) -> list[Polygon]:
    """A wall, a box, an L or two boxes that touch; turned with the site, or by itself."""
    x, y = rng.uniform(-0.1, 1.0, 2) * (SIDE, DEPTH)
    width, depth, wing, high = rng.uniform(4_000, 28_000, 4)
    first = _box(x, y, width, depth)
    second = _box(x + width, y + rng.uniform(-0.5, 0.9) * depth, wing, high)
    kind = rng.integers(8)
    if kind == 0:  # a wall across the room, and more often than not no way past it
        shapes = [_box(x, -0.2 * DEPTH, 300, 1.4 * DEPTH)]
    elif kind < 3:
        shapes = [first]
    elif kind < 5:
        shapes = [first.difference(_box(x + width / 2, y + depth / 2, width, depth))]
    else:
        shapes = [first, second]
    own = rng.uniform(0.0, 0.3) if rng.random() < 0.3 else 0.0
    return [_turned(shape, angle + own) for shape in shapes]


def _queries(room: Polygon, buildings: list[Polygon], rng: np.random.Generator) -> dict[str, Ends]:
    """Two queries between points that are clear of all walls."""
    closed = shapely.union_all([room.boundary, *buildings])
    shapely.prepare(closed)
    shapely.prepare(room)
    xmin, ymin, xmax, ymax = room.bounds
    points: list[Points] = []
    while len(points) < 4:
        x, y = np.round(rng.uniform((xmin, ymin), (xmax, ymax)))
        place = shapely.Point(x, y)
        if room.contains(place) and closed.distance(place) > CLEAR:
            points.append(np.array([x, y]))
    return {"first": (points[0], points[1]), "second": (points[2], points[3])}
