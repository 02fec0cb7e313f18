"""Random solids on a small lattice, where degenerate cases are common and arithmetic is exact.

Every edge is level, upright or at 45 degrees and every vertex an integer, so that all intersections
are multiples of one half: shapely, the kernels and the arrangement then have nothing to round.
"""

from collections.abc import Sequence

import numpy as np
import shapely
from numba import config
from numpy.typing import NDArray
from shapely.geometry import LineString, Point, Polygon, box
from shapely.geometry.base import BaseGeometry

COMPILED = not config.DISABLE_JIT
Rng = np.random.Generator


def counts(compiled: int, interpreted: int) -> int:
    """How many examples a test can afford with the JIT on, and with it off."""
    return compiled if COMPILED else interpreted


def random_workspace(rng: Rng, size: int) -> Polygon:
    """A square, at times with a bite taken out of a corner or a side."""
    room = box(0, 0, size, size)
    if rng.random() < 0.4:
        x, y = rng.integers(0, size, 2)
        w, h = rng.integers(1, 4, 2)
        bitten = room.difference(box(x, y, x + w, y + h))
        if isinstance(bitten, Polygon) and not bitten.interiors:
            return bitten
    return room


def random_obstacle(rng: Rng, size: int) -> Polygon:
    """A box, a right triangle with two equal sides, a diamond, or a frame with a hole."""
    x, y = (int(v) for v in rng.integers(0, size, 2))
    kind = rng.integers(0, 5)
    if kind <= 1:
        w, h = (int(v) for v in rng.integers(1, 4, 2))
        return box(x, y, x + w, y + h)
    a = int(rng.integers(1, 4))
    if kind == 2:
        corners = [(x, y), (x + a, y), (x + a, y + a), (x, y + a)]
        del corners[int(rng.integers(0, 4))]
        return Polygon(corners)
    if kind == 3:
        return Polygon([(x - a, y), (x, y - a), (x + a, y), (x, y + a)])
    return box(x, y, x + a + 2, y + a + 2).difference(box(x + 1, y + 1, x + a + 1, y + a + 1))


def random_solid(rng: Rng) -> tuple[Polygon, list[Polygon]]:
    """A workspace and 1 to 8 obstacles in it that touch, overlap and nest as they like."""
    size = int(rng.integers(5, 9))
    room = random_workspace(rng, size)
    obstacles: list[Polygon] = []
    for _ in range(int(rng.integers(1, 9))):
        inside = shapely.get_parts(random_obstacle(rng, size).intersection(room))
        obstacles += [p for p in inside if isinstance(p, Polygon) and p.area > 0]
    return room, obstacles


def random_segments(rng: Rng, room: Polygon, count: int) -> NDArray[np.float64]:
    """Segments (count, 4) between points of the half lattice, many short, level or upright."""
    xmin, ymin, xmax, ymax = (int(v) for v in room.bounds)
    ends = rng.integers([xmin, ymin] * 2, [xmax + 1, ymax + 1] * 2, (count, 4)).astype(float)
    near = rng.random(count) < 0.4
    ends[near, 2:] = ends[near, :2] + rng.integers(-2, 3, (int(near.sum()), 2))
    halved = rng.random(count) < 0.3
    ends[halved] += 0.5 * rng.integers(-1, 2, (int(halved.sum()), 4))
    return ends


def frame_around(room: Polygon) -> Polygon:
    """All that lies outside the workspace, up to 1.25 m away: more than any segment here needs."""
    xmin, ymin, xmax, ymax = room.bounds
    return box(xmin - 1.25, ymin - 1.25, xmax + 1.25, ymax + 1.25).difference(room)


def lines(segments: NDArray[np.float64]) -> NDArray[np.object_]:
    """Segments (n, 4) as shapely geometries; a segment of no length is a point."""
    drawn = np.asarray(shapely.linestrings(segments.reshape(-1, 2, 2)))
    dots = (segments[:, :2] == segments[:, 2:]).all(axis=1)
    drawn[dots] = shapely.points(segments[dots, :2])
    return drawn


def pinches(solid: BaseGeometry, radius: float = 0.1) -> list[tuple[Point, list[Polygon]]]:
    """Vertices around which the free part of a small disc falls apart, and its pieces."""
    found = []
    for x, y in np.unique(shapely.get_coordinates(solid), axis=0):
        centre = Point(x, y)
        pieces = shapely.get_parts(centre.buffer(radius).difference(solid))
        if len(pieces) > 1:
            found.append((centre, list(pieces)))
    return found


def is_pinched(a: Sequence[float], bend: Point, b: Sequence[float], free: list[Polygon]) -> bool:
    """Whether a path a -> bend -> b changes from one free piece around its bend to another."""
    stubs = []
    for end in (a, b):
        way = np.subtract(end, (bend.x, bend.y))
        stubs.append(Point(np.add((bend.x, bend.y), 0.05 * way / np.hypot(*way))))
    return not any(all(piece.distance(s) < 1e-9 for s in stubs) for piece in free)


def enters(solid: BaseGeometry, segments: NDArray[np.float64]) -> NDArray[np.bool_]:
    """The oracle: interiors meet (shapely), or the segment slips through a pinch point."""
    drawn = lines(segments)
    answer = np.asarray(shapely.relate_pattern(solid, drawn, "T********"))
    for centre, free in pinches(solid):
        for i in np.flatnonzero(~answer & (shapely.distance(drawn, centre) == 0.0)):
            line = drawn[i]
            if isinstance(line, LineString) and not line.boundary.intersects(centre):
                answer[i] = is_pinched(segments[i, :2], centre, segments[i, 2:], free)
    return answer


def star(rng: Rng, centre: NDArray[np.float64], radius: float) -> Polygon:
    """A star-shaped polygon of 3 to 11 random vertices, none of them on any grid."""
    angles = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(3, 12))))
    reach = radius * rng.uniform(0.3, 1.0, angles.size)
    polygon = Polygon(centre + np.c_[reach * np.cos(angles), reach * np.sin(angles)])
    return polygon if polygon.is_valid else star(rng, centre, radius)
