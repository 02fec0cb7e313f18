"""What lies inside of closed lines, by the two rules of drawings: nonzero and evenodd.

As in SVG 2, section 13.4. Rings may cross themselves and one another.
"""

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LinearRing, MultiPolygon, Point, Polygon

Ring = NDArray[np.float64]


def filled(rings: Sequence[Ring], *, evenodd: bool = False) -> Polygon | MultiPolygon:
    """The area inside of rings.

    Parameters
    ----------
    rings : sequence of (n, 2) float64
        Each closes by itself; one of fewer than three different points has no inside.
    evenodd : bool
        Inside is what is surrounded an odd number of times; else, what is surrounded more often one
        way round than the other.

    Returns
    -------
    Polygon or MultiPolygon
        Its vertices are those of the rings, and where they cross.

    Examples
    --------
    >>> outer, inner = [(0, 0), (3, 0), (3, 3), (0, 3)], [(1, 1), (2, 1), (2, 2), (1, 2)]
    >>> both = [np.array(ring, dtype=float) for ring in (outer, inner)]
    >>> filled(both).area, filled(both, evenodd=True).area, filled([both[0], both[1][::-1]]).area
    (9.0, 8.0, 8.0)
    """
    wide = [ring for ring in rings if len(np.unique(ring, axis=0)) > 2]
    if len(wide) == 1 and LinearRing(wide[0]).is_simple:
        return Polygon(wide[0])
    lines = shapely.union_all([LinearRing(ring) for ring in wide])
    faces = shapely.get_parts(shapely.polygonize([lines]))
    around = [sum(_turns(ring, face.representative_point()) for ring in wide) for face in faces]
    inside = [
        f for f, turns in zip(faces, around, strict=True) if (turns % 2 if evenodd else turns)
    ]
    area = shapely.union_all(inside)
    return area if isinstance(area, Polygon | MultiPolygon) else MultiPolygon()


def _turns(ring: Ring, point: Point) -> int:
    """How often a ring goes round a point that is not on it, counter-clockwise."""
    a = ring - (point.x, point.y)
    b = np.roll(a, -1, axis=0)
    left = a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1] > 0.0
    up = (a[:, 1] <= 0.0) & (b[:, 1] > 0.0) & left
    down = (a[:, 1] > 0.0) & (b[:, 1] <= 0.0) & ~left
    return int(up.sum()) - int(down.sum())
