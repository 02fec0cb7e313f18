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
from suite.geometry.predicates import orientation
from suite.jit import kernel


class Mesh(NamedTuple):
    """Triangles of free space; V vertices, T triangles, and the rows of ``boxes`` are triangles.

    vertices : (V, 2) float64, metres.
    origin : (3 T,) int64, the vertex in which a half-edge begins.
    twin : (3 T,) int64, the half-edge on the other side; -1 where that is closed.
    bends : (3 T,) bool, whether solid is convex in a half-edge's origin, as seen from its triangle:
        only there, and only around it, a shortest path bends.
    first, last : (V,) int64, of a vertex in which solid is convex: the half-edge that leaves it
        along solid on its right, and the one that leaves it in the last triangle before the solid
        on its left. -1 elsewhere.
    outward : (T,) int64, the half-edge by which one leaves a triangle for the rest of the mesh, if
        it lies in a pocket that has no other way out; else -1.
    boxes : (T, 4) float64, xmin, ymin, xmax, ymax.
    """

    vertices: np.ndarray
    origin: np.ndarray
    twin: np.ndarray
    bends: np.ndarray
    first: np.ndarray
    last: np.ndarray
    outward: np.ndarray
    boxes: np.ndarray


class NoMesh(Exception):  # noqa: N818 (not an error of the program)
    """Faces were cut into triangles that don't fit together."""


def mesh_of(free: Sequence[Polygon], coordinates: Coordinates) -> Mesh:
    """Cut free space into triangles.

    Parameters
    ----------
    free : sequence of Polygon
        The free faces of an arrangement, metres.
    coordinates : Coordinates
        Of the scene.

    Returns
    -------
    Mesh

    Raises
    ------
    NoMesh
        If the triangulation is none: a triangle without area, or a side that ends within another.
    """
    local = shapely.transform(np.array(free, dtype=np.object_), coordinates.local)
    cut = shapely.get_parts(shapely.constrained_delaunay_triangles(local))
    # GEOS lists triangles clockwise.
    corners = shapely.get_coordinates(cut).reshape(-1, 4, 2)[:, 2::-1].reshape(-1, 2)
    places, origin = np.unique(_as_complex(corners), return_inverse=True)
    vertices = coordinates.world(np.stack([places.real, places.imag], axis=1))
    origin = origin.astype(np.int64)
    twin = _twins(origin, len(vertices))
    _check_sides(local, places, origin, twin)
    count = len(vertices)
    mesh = Mesh(
        vertices=vertices,
        origin=origin,
        twin=twin,
        bends=np.zeros(len(origin), dtype=np.bool_),
        first=np.full(count, -1, dtype=np.int64),
        last=np.full(count, -1, dtype=np.int64),
        outward=np.full(len(origin) // 3, -1, dtype=np.int64),
        boxes=_boxes(vertices[origin].reshape(-1, 3, 2)),
    )
    if not _mark(mesh):
        raise NoMesh("a triangle has no area")
    for table in mesh:
        table.setflags(write=False)
    return mesh


def _as_complex(xy: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Places as numbers, which sort faster than rows do. 0.0 and -0.0 are one."""
    return np.ascontiguousarray(xy + 0.0).view(np.complex128)[:, 0]


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


def _check_sides(
    free: NDArray[np.object_],
    places: NDArray[np.complex128],
    origin: NDArray[np.int64],
    twin: NDArray[np.int64],
) -> None:
    """Refuse triangles of which a side is neither another's nor one of a face."""
    rings = shapely.get_rings(free)
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    numbers = np.searchsorted(places, _as_complex(xy))
    numbers = np.minimum(numbers, len(places) - 1)
    stays = ring[1:] == ring[:-1]
    a, b = numbers[:-1][stays], numbers[1:][stays]
    sides = np.unique(np.minimum(a, b) * len(places) + np.maximum(a, b))
    open_ends = np.flatnonzero(twin < 0)
    a, b = origin[open_ends], origin[_after(open_ends)]
    alone = np.unique(np.minimum(a, b) * len(places) + np.maximum(a, b))
    if not np.isin(alone, sides).all():
        raise NoMesh("a side ends within another")


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
def _mark(mesh: Mesh) -> bool:
    """Fill in where paths bend, and what is a pocket; False if a triangle has no area."""
    origin, twin = mesh.origin, mesh.twin
    for t in range(origin.shape[0] // 3):
        if side_of(mesh.vertices, origin[3 * t], origin[3 * t + 1], origin[3 * t + 2]) <= 0:
            return False
    for h in range(origin.shape[0]):
        if twin[h] < 0:
            _mark_bend(mesh, h)
    for t in range(mesh.outward.shape[0]):
        _mark_pocket(mesh, t)
    return True


@kernel
def _mark_bend(mesh: Mesh, first: int) -> None:
    """Mark the corner in which a half-edge along solid begins, if solid is convex there."""
    last = first
    while mesh.twin[preceding(last)] >= 0:
        last = mesh.twin[preceding(last)]
    v = mesh.origin[first]
    before, after = mesh.origin[preceding(last)], mesh.origin[following(first)]
    if side_of(mesh.vertices, before, v, after) >= 0:
        return
    mesh.first[v] = first
    mesh.last[v] = last
    h = first
    while h >= 0:
        mesh.bends[h] = True
        h = mesh.twin[preceding(h)]


@kernel
def _mark_pocket(mesh: Mesh, t: int) -> None:
    """Mark a triangle with a single way out, and those that have but one because of it."""
    while mesh.outward[t] < 0:
        way = -1
        for h in range(3 * t, 3 * t + 3):
            other = mesh.twin[h]
            if other >= 0 and mesh.outward[other // 3] != other:
                if way >= 0:
                    return
                way = h
        if way < 0:
            return
        mesh.outward[t] = way
        t = mesh.twin[way] // 3
