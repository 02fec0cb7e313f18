"""Obstacles grown by the radius of a robot, and rooms shrunk by it: nowhere by less.

What lies within the radius of a polygon's outline is covered: along its edges by strips as wide,
around its vertices by fans whose sides touch the circle from outside. A buffer, whose chords lie
within the circle, would let a robot come nearer than its radius.

What is grown is rounded to the grid twice, here and in the arrangement. So the radius is taken a
little larger; but not along edges that are parallel to an axis, which are rounded outwards once and
then stay where they are: on a map of cells of a metre a robot of radius 0.5 m may stand in each
cell beside a wall. Metres, near zero.
"""

import math
from collections.abc import Iterable
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LinearRing, MultiPolygon, Polygon

SIDES = 48
"""Sides that stand for a quarter of a circle. A way along them is longer than along the circle by
0.009 % (the tangent of half of a side's angle, over that half): no optimum grows by more."""

ROUNDINGS = 2.0
"""Widths of the grid by which the radius is taken larger: each rounding moves an edge by 0.71."""

NOISE = 1e-3
"""Of the grid: what is further beyond a multiple of it than that belongs to the next one."""

Points = NDArray[np.float64]


def grown(polygon: Polygon, radius: float, grid: float) -> Polygon:
    """Cover all that lies within a radius of a polygon.

    Parameters
    ----------
    polygon : Polygon
        Valid, metres.
    radius : float
        Above 0 m.
    grid : float
        Of the scene, metres: what is narrower is no hole.

    Returns
    -------
    Polygon
        Nowhere is its border nearer to the polygon than the radius, to a thousandth of the grid,
        even after it is rounded to the grid once more.

    Examples
    --------
    >>> from shapely import box
    >>> grown(box(0, 0, 1, 1), 0.5, 1e-9).intersection(box(0.1, -9, 0.9, 9)).bounds
    (0.1, -0.5, 0.9, 1.5)
    """
    cover = shapely.union_all([polygon, *_band(polygon, radius, grid)], grid_size=grid)
    outline = next(p.exterior for p in shapely.get_parts(cover) if isinstance(p, Polygon))
    holes = shapely.get_parts(Polygon(outline).difference(cover))
    return Polygon(outline, [hole.exterior for hole in _wide(holes, grid)])


def shrunk(polygon: Polygon, radius: float, grid: float) -> Polygon | MultiPolygon:
    """Leave of a polygon what lies no nearer to its border than a radius.

    Parameters
    ----------
    polygon : Polygon
        Valid, metres.
    radius : float
        Above 0 m.
    grid : float
        Of the scene, metres: what is narrower is no hole.

    Returns
    -------
    Polygon or MultiPolygon
        Empty if there is nothing left.
    """
    band = shapely.union_all(_band(polygon, radius, grid), grid_size=grid)
    left = polygon.difference(band, grid_size=grid)
    pieces = _wide(shapely.get_parts(left), grid)
    return pieces[0] if len(pieces) == 1 else MultiPolygon(pieces)


def _wide(pieces: Iterable[shapely.Geometry], grid: float) -> list[Polygon]:
    """Those polygons that are more than slits where the sides of two pieces were rounded apart."""
    polygons = [piece for piece in pieces if isinstance(piece, Polygon)]
    return [p for p in polygons if not p.buffer(-2.0 * grid, join_style="mitre").is_empty]


def _band(polygon: Polygon, radius: float, grid: float) -> list[Polygon]:
    """Pieces that together cover what lies within a radius of a polygon's rings."""
    rings = (polygon.exterior, *polygon.interiors)
    return [piece for ring in rings for piece in _around(ring, radius, grid)]


def _around(ring: LinearRing, radius: float, grid: float) -> list[Polygon]:
    """Strips along the edges of a ring, and fans around its vertices."""
    wide = radius + ROUNDINGS * grid
    corners = _without_repeats(shapely.get_coordinates(ring))
    ways = np.diff(corners, axis=0)
    ways /= np.hypot(*ways.T)[:, np.newaxis]
    # tips[i] stands around corners[i], between the edge before it and the edge after it
    turns = zip(corners[:-1], np.roll(ways, 1, axis=0), ways, strict=True)
    fans = [_fan(corner, before, after, wide) for corner, before, after in turns]
    strips = [
        _level(a, b, radius, grid)
        if np.any(a == b)
        else Polygon([a, right_a[-1], right_b[0], b, left_b[0], left_a[-1]])
        for (a, b), ((right_a, left_a), (right_b, left_b)) in zip(
            pairwise(corners), pairwise([*fans, fans[0]]), strict=True
        )
    ]
    sides = [(v, side) for v, both in zip(corners[:-1], fans, strict=True) for side in both]
    sectors = [Polygon([v, *side]) for v, side in sides if len(side) > 1]
    return strips + [sector for sector in sectors if sector.area > 0.0]


def _level(a: Points, b: Points, radius: float, grid: float) -> Polygon:
    """The strip along an edge parallel to an axis: its long sides on the grid."""
    across = int(a[1] == b[1])  # the axis that the edge does not run along
    low, high = np.minimum(a, b), np.maximum(a, b)
    low[across] = grid * math.floor((low[across] - radius) / grid + NOISE)
    high[across] = grid * math.ceil((high[across] + radius) / grid - NOISE)
    return shapely.box(*low, *high)


def _without_repeats(xy: Points) -> Points:
    return xy[np.r_[True, np.any(xy[1:] != xy[:-1], axis=1)]]


def _fan(corner: Points, before: Points, after: Points, radius: float) -> tuple[Points, Points]:
    """Where the strips of two edges end that meet in a corner: on their right, and on their left.

    On the outer side that is where the sides of a polyline meet that touches the circle around the
    corner from outside, the two strips' own sides its first and its last; with the end of a strip
    that is level, which ends square and is less wide by the roundings. On the inner side the strips
    overlap, and each ends square.
    """
    turn = math.atan2(before[0] * after[1] - before[1] * after[0], float(before @ after))
    normals = radius * np.array([(before[1], -before[0]), (after[1], -after[0])])
    count = max(1, math.ceil(abs(turn) / (0.5 * math.pi / SIDES)))
    half = 0.5 * turn / count
    angles = half * (2.0 * np.arange(count) + 1.0)
    outer = math.copysign(1.0, turn)  # a left turn's outer side is its right
    cos, sin = np.cos(angles) / math.cos(half), np.sin(angles) / math.cos(half)
    x, y = outer * normals[0]
    tips = corner + np.column_stack([cos * x - sin * y, sin * x + cos * y])
    ends = corner + outer * normals
    tips = np.vstack([ends[:1][int(before.all()) :], tips, ends[1:][int(after.all()) :]])
    square = corner - outer * normals
    return (tips, square) if turn >= 0.0 else (square, tips)
