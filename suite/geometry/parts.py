"""Faces cut into convex parts: constrained Delaunay, then Hertel and Mehlhorn (1983).

Vertices are numbers of places, in the order of their coordinates: whoever sorts by number sorts by
place, and numbers are quicker to compare and to look up. Metres.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from suite.geometry.predicates import ERROR_BOUND, orientation

Part = list[int]
"""Vertices of a convex part, counter-clockwise."""


class Places:
    """The vertices of faces, each once, by x and then y.

    xy : (V, 2) float64, metres.
    points : the same as tuples of floats.
    """

    def __init__(self, faces: Sequence[Polygon]) -> None:
        corners = shapely.get_coordinates(np.array(faces, dtype=np.object_))
        self._sorted = np.unique(as_complex(corners))
        self.xy = np.stack([self._sorted.real, self._sorted.imag], axis=1)
        self.points: list[tuple[float, float]] = [(x, y) for x, y in self.xy.tolist()]

    def numbers(self, xy: NDArray[np.float64]) -> NDArray[np.int64]:
        """Numbers of coordinates (n, 2) that are all among the places."""
        return np.searchsorted(self._sorted, as_complex(xy))


def as_complex(xy: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Places (n, 2) as numbers, which sort as rows do, and faster. 0.0 and -0.0 are one."""
    return np.ascontiguousarray(xy + 0.0).view(np.complex128)[:, 0]


def sides(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.int64]:
    """The orientation predicate of many: rows (n, 2) each; the sign is exact, as there."""
    left = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1])
    right = (a[:, 1] - c[:, 1]) * (b[:, 0] - c[:, 0])
    signs = np.sign(left - right).astype(np.int64)
    bound = ERROR_BOUND * (np.abs(left) + np.abs(right))
    for i in np.flatnonzero(np.abs(left - right) <= bound).tolist():
        signs[i] = orientation(*a[i], *b[i], *c[i])
    return signs


def convex_parts(
    faces: Sequence[Polygon], group_of_face: Sequence[int], places: Places
) -> tuple[list[Part], list[int]]:
    """Convex parts of faces, and the group of each.

    Parameters
    ----------
    faces : sequence of Polygon
        That meet in common vertices.
    group_of_face : sequence of int
        Only parts of one group are merged.
    places : Places
        The vertices of the faces.

    Returns
    -------
    parts : list of Part
    group_of : list of int
    """
    cut = shapely.constrained_delaunay_triangles(np.array(faces, dtype=np.object_))
    shapes, face = shapely.get_parts(cut, return_index=True)
    corners = shapely.get_coordinates(shapes).reshape(-1, 4, 2)
    numbers = places.numbers(corners[:, :3].reshape(-1, 2)).reshape(-1, 3)
    turn = sides(corners[:, 0], corners[:, 1], corners[:, 2])
    numbers[turn < 0, 1:] = numbers[turn < 0, :0:-1]
    wide = turn != 0
    groups = np.array(group_of_face, dtype=np.int64)[face[wide]]
    return _merged_while_convex(numbers[wide].tolist(), groups.tolist(), places.points)


def _merged_while_convex(
    triangles: Sequence[Part], group_of: Sequence[int], points: Sequence[tuple[float, float]]
) -> tuple[list[Part], list[int]]:
    """Remove shared edges of a group's parts while the result stays convex (Hertel, Mehlhorn)."""
    parts: dict[int, Part] = dict(enumerate(triangles))
    owner = {edge: i for i, part in parts.items() for edge in _edges_of(part)}
    for a, b in list(owner):
        i, j = owner.get((a, b)), owner.get((b, a))
        if i is None or j is None or i == j or group_of[i] != group_of[j]:
            continue
        merged = _merged(parts[i], parts[j], a, b, points)
        if merged is None:
            continue
        for edge in (*_edges_of(parts[i]), *_edges_of(parts[j])):
            del owner[edge]
        del parts[j]
        parts[i] = merged
        owner.update(dict.fromkeys(_edges_of(merged), i))
    return list(parts.values()), [group_of[i] for i in parts]


def _edges_of(part: Part) -> Iterable[tuple[int, int]]:
    return pairwise([*part, part[0]])


def _merged(
    first: Part, second: Part, a: int, b: int, points: Sequence[tuple[float, float]]
) -> Part | None:
    """Union of two convex parts over their common edge a -> b of the first, if it is convex."""
    i = first.index(a)
    j = second.index(b)
    head = first[i + 1 :] + first[: i + 1]  # b ... a
    tail = second[j + 1 :] + second[: j + 1]  # a ... b
    # A vertex inside the common side would be left over as a spike: the side goes as a whole.
    while head[1] == tail[-2]:
        head, tail = head[1:], tail[:-1]
    while head[-2] == tail[1]:
        head, tail = head[:-1], tail[1:]
    a, b = tail[0], head[0]
    if orientation(*points[head[-2]], *points[a], *points[tail[1]]) < 0:
        return None
    if orientation(*points[tail[-2]], *points[b], *points[head[1]]) < 0:
        return None
    return head + tail[1:-1]
