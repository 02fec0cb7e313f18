"""Outlines with fewer vertices, that never shrink what they surround. Metres, or any other unit.

A vertex in which an outline is hollow or straight is left out, the shallowest first: the chord over
it cuts a pocket off from free space, and the polygon grows by that pocket. A vertex that sticks out
stays, so that a polygon never leaves its own convex hull, nor a convex workspace that it lies in.
"""

import heapq
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from suite.geometry.coordinates import coordinates_of

Points = NDArray[np.float64]

LEAST = 3
"""Vertices that a ring keeps."""


def simplified(polygon: Polygon, tolerance: float) -> Polygon:
    """Leave out hollow vertices of a polygon, where it then grows by no more than a tolerance.

    Parameters
    ----------
    polygon : Polygon
        Valid, metres.
    tolerance : float
        Above 0 m.

    Returns
    -------
    Polygon
        Valid. It covers the polygon, to the grid of such coordinates, and reaches no further than
        the tolerance beyond it. Its vertices are some of the polygon's.

    Examples
    --------
    >>> steps = Polygon([(0, 0), (3, 0), (3, 3), (2, 3), (2, 2), (1, 2), (1, 1), (0, 1)])
    >>> simplified(steps, 0.8).exterior.coords[:]
    [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (2.0, 3.0), (0.0, 1.0), (0.0, 0.0)]
    >>> simplified(steps, 0.7).equals(steps)
    True
    """
    whole = shapely.orient_polygons(polygon)
    rings = [shapely.get_coordinates(ring)[:-1] for ring in (whole.exterior, *whole.interiors)]
    everything = shapely.STRtree(np.asarray(shapely.points(np.concatenate(rings))))
    first = np.cumsum([0, *(len(ring) for ring in rings)])
    slack = 0.1 * coordinates_of(polygon.bounds).grid
    shell, *holes = (
        _Outline(ring, int(at), everything, tolerance, slack).without_pockets()
        for ring, at in zip(rings, first[:-1], strict=True)
    )
    return Polygon(shell, holes)


@dataclass(frozen=True, slots=True, eq=False)
class _Outline:
    """A ring on whose left lies what it surrounds.

    xy : (n, 2), its vertices.
    first : the number of its first vertex among those of all rings of the polygon.
    everything : those vertices: a pocket must hold none but its own.
    """

    xy: Points
    first: int
    everything: shapely.STRtree
    tolerance: float
    slack: float

    def without_pockets(self) -> Points:
        n = len(self.xy)
        before, after = list(range(-1, n - 1)), list(range(1, n + 1))
        before[0], after[-1] = n - 1, 0
        gone = [False] * n
        left = n
        heap: list[tuple[float, int, int, int]] = []

        def offer(i: int) -> None:
            depth = self._depth(before[i], i, after[i])
            if depth is not None:
                heapq.heappush(heap, (depth, before[i], i, after[i]))

        for i in range(n):
            offer(i)
        while heap and left > LEAST:
            _, a, i, b = heapq.heappop(heap)
            # Where a neighbour has gone since, the chord of today has an entry of its own.
            if gone[i] or (a, b) != (before[i], after[i]) or not self._is_empty(a, i, b):
                continue
            gone[i] = True
            left -= 1
            after[a], before[b] = b, a
            offer(a)
            offer(b)
        return self.xy[[i for i in range(n) if not gone[i]]]

    def _depth(self, a: int, i: int, b: int) -> float | None:
        """How deep the pocket over a vertex is; None if there is none that may be closed.

        No point of a pocket lies further from the outline than the farthest vertex between the ends
        of the chord lies from the chord.
        """
        n = len(self.xy)
        start, end = self.xy[a], self.xy[b]
        chord = end - start
        if _cross(self.xy[i] - start, chord) > 0.0:
            return None
        between = self.xy[np.arange(a + 1, b + n * (b <= a)) % n] - start
        length = float(np.hypot(*chord))
        along = between @ chord / length
        left = (chord[0] * between[:, 1] - chord[1] * between[:, 0]) / length
        over = np.maximum(np.maximum(-along, along - length), 0.0)
        depth = float(np.hypot(over, left).max())
        return depth if depth <= self.tolerance and left.min() >= -self.slack else None

    def _is_empty(self, a: int, i: int, b: int) -> bool:
        """Whether the triangle that a chord cuts off holds nothing else of the polygon."""
        n = len(self.xy)
        corners = self.xy[[a, i, b]]
        triangle = shapely.LineString(corners).convex_hull
        found = self.everything.query(triangle, predicate="intersects") - self.first
        return not np.any((found < 0) | (found >= n) | ((found - a) % n > (b - a) % n))


def _cross(u: Points, v: Points) -> float:
    return float(u[0] * v[1] - u[1] * v[0])
