"""A navigation mesh: free space as triangles that know their neighbours, for searches to walk over.

A constrained Delaunay triangulation of the free faces of an arrangement, as half-edges: triangle t
has the half-edges 3 t, 3 t + 1, 3 t + 2, counter-clockwise, so that free space lies on the left of
each. A half-edge leads to its twin in the next triangle, or nowhere, where space is closed. Metres.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from suite.geometry.coordinates import Coordinates
from suite.geometry.parts import as_complex
from suite.geometry.predicates import orientation
from suite.jit import kernel


class Mesh(NamedTuple):
    """Triangles of free space; V vertices, T triangles, and the rows of ``boxes`` are triangles.

    vertices : (V, 2) float64, metres.
    half_edges : (3 T, 3) int64: ORIGIN, the vertex in which it begins; WAY, its twin, or -1 where
        that is closed, or -2 - twin where the twin leads into a pocket; BENDS, whether solid is
        convex in its origin, as seen from its triangle: only there, and only around it, a shortest
        path bends.
    fans : (V, 2) int64, of a vertex in which solid is convex: FIRST, the half-edge that leaves it
        along solid on its right, and LAST, the one that leaves it in the last triangle before the
        solid on its left. -1 elsewhere.
    outward : (T,) int64, the half-edge by which one leaves a triangle that lies in a pocket, which
        has no other way out for the rest of the mesh; -1 elsewhere.
    boxes : (T, 4) float64, xmin, ymin, xmax, ymax.
    most : int, the largest number of triangles around a vertex.
    """

    vertices: np.ndarray
    half_edges: np.ndarray
    fans: np.ndarray
    outward: np.ndarray
    boxes: np.ndarray
    most: int


ORIGIN, WAY, BENDS = range(3)
FIRST, LAST = range(2)


def mesh_of(free: Sequence[Polygon], coordinates: Coordinates) -> Mesh | None:
    """Cut free space into triangles.

    Parameters
    ----------
    free : sequence of Polygon
        The free faces of an arrangement, metres.
    coordinates : Coordinates
        Of the scene.

    Returns
    -------
    Mesh or None
        None if the triangulation is none: a triangle has no area, or a side ends within another.
    """
    local = shapely.transform(np.array(free, dtype=np.object_), coordinates.local)
    cut = shapely.get_parts(shapely.constrained_delaunay_triangles(local))
    # GEOS lists triangles clockwise.
    corners = shapely.get_coordinates(cut).reshape(-1, 4, 2)[:, 2::-1].reshape(-1, 2)
    places, origin = np.unique(as_complex(corners), return_inverse=True)
    vertices = coordinates.world(np.stack([places.real, places.imag], axis=1))
    twin = _twins(origin, len(vertices))
    if not _fit(local, places, origin, twin):
        return None
    mesh = Mesh(
        vertices=vertices,
        half_edges=np.stack([origin, twin, np.zeros_like(twin)], axis=1).astype(np.int64),
        fans=np.full((len(vertices), 2), -1, dtype=np.int64),
        outward=np.full(len(origin) // 3, -1, dtype=np.int64),
        boxes=_boxes(vertices[origin].reshape(-1, 3, 2)),
        most=int(np.bincount(origin).max(initial=0)),
    )
    if not _mark(mesh.vertices, mesh.half_edges, mesh.fans, mesh.outward):
        return None
    for table in mesh[:-1]:
        table.setflags(write=False)
    return mesh


def _after(half_edges: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.where(half_edges % 3 == 2, half_edges - 2, half_edges + 1)


def _twins(origin: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """The half-edge that runs the other way, for each; -1 if there is none."""
    half_edges = np.arange(len(origin))
    end = origin[_after(half_edges)]
    there, back = origin * count + end, end * count + origin
    order = np.argsort(there)
    at = np.minimum(np.searchsorted(there, back, sorter=order), len(order) - 1)
    found = order[at] if len(order) else order
    return np.where(there[found] == back, found, -1)


def _fit(
    free: NDArray[np.object_],
    places: NDArray[np.complex128],
    origin: NDArray[np.int64],
    twin: NDArray[np.int64],
) -> bool:
    """Whether each side of a triangle is another's too, or one of a face."""
    rings = shapely.get_rings(free)
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    numbers = np.searchsorted(places, as_complex(xy))
    numbers = np.minimum(numbers, len(places) - 1)
    stays = ring[1:] == ring[:-1]
    a, b = numbers[:-1][stays], numbers[1:][stays]
    sides = np.unique(np.minimum(a, b) * len(places) + np.maximum(a, b))
    open_ends = np.flatnonzero(twin < 0)
    a, b = origin[open_ends], origin[_after(open_ends)]
    alone = np.unique(np.minimum(a, b) * len(places) + np.maximum(a, b))
    return bool(np.isin(alone, sides).all())


def _boxes(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.hstack([triangles.min(axis=1), triangles.max(axis=1)])


@kernel
def following(h: int) -> int:
    """The next half-edge of the same triangle, counter-clockwise."""
    return h - 2 if h % 3 == 2 else h + 1


@kernel
def preceding(h: int) -> int:
    """The half-edge of the same triangle that ends where this one begins."""
    return h + 2 if h % 3 == 0 else h - 1


@kernel
def side_of(xy: np.ndarray, a: int, b: int, c: int) -> int:
    """Side of the line from place a to place b on which place c lies: rows of ``xy``."""
    return orientation(xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1])


@kernel
def _mark(
    vertices: np.ndarray, half_edges: np.ndarray, fans: np.ndarray, outward: np.ndarray
) -> bool:
    """Fill in where paths bend, and what is a pocket; False if a triangle has no area."""
    for h in range(0, half_edges.shape[0], 3):
        a, b, c = half_edges[h, ORIGIN], half_edges[h + 1, ORIGIN], half_edges[h + 2, ORIGIN]
        if side_of(vertices, a, b, c) <= 0:
            return False
    for h in range(half_edges.shape[0]):
        if half_edges[h, WAY] < 0:
            _mark_bend(vertices, half_edges, fans, h)
    for t in range(outward.shape[0]):
        _mark_pocket(half_edges, outward, t)
    for t in range(outward.shape[0]):
        if outward[t] >= 0:
            half_edges[half_edges[outward[t], WAY], WAY] = -2 - outward[t]
    return True


@kernel
def _mark_bend(vertices: np.ndarray, half_edges: np.ndarray, fans: np.ndarray, first: int) -> None:
    """Mark the corner in which a half-edge along solid begins, if solid is convex there."""
    last = first
    while half_edges[preceding(last), WAY] >= 0:
        last = half_edges[preceding(last), WAY]
    v = half_edges[first, ORIGIN]
    before, after = half_edges[preceding(last), ORIGIN], half_edges[following(first), ORIGIN]
    if side_of(vertices, before, v, after) >= 0:
        return
    fans[v, FIRST] = first
    fans[v, LAST] = last
    h = first
    while h >= 0:
        half_edges[h, BENDS] = 1
        h = half_edges[preceding(h), WAY]


@kernel
def _mark_pocket(half_edges: np.ndarray, outward: np.ndarray, t: int) -> None:
    """Mark a triangle with a single way out, and those that have but one because of it."""
    while outward[t] < 0:
        out = -1
        for h in range(3 * t, 3 * t + 3):
            other = half_edges[h, WAY]
            if other >= 0 and outward[other // 3] != other:
                if out >= 0:
                    return
                out = h
        if out < 0:
            return
        outward[t] = out
        t = half_edges[out, WAY] // 3
