"""Hypothesis strategies for scenes and paths.

Coordinates are drawn from small integers wherever possible: obstacles then touch, overlap, share
edges and meet the border all the time, and every predicate is decided in exact arithmetic, so that
agreement with an oracle needs no tolerance.
"""

import numpy as np
import shapely
from hypothesis import strategies as st
from numpy.typing import NDArray
from shapely.geometry import Polygon

from suite.geometry.arrangement import arrange
from suite.scenes.scene import Scene, make_scene

SIDE = 7
"""Side of the lattice workspace, metres."""


def lattice_points(side: int = SIDE) -> st.SearchStrategy[tuple[float, float]]:
    """Points with whole coordinates in [0, side]."""
    coordinate = st.integers(0, side).map(float)
    return st.tuples(coordinate, coordinate)


def lattice_boxes(side: int = SIDE) -> st.SearchStrategy[Polygon]:
    """Boxes with whole coordinates, one to three metres wide and high."""

    def box(x: int, y: int, width: int, height: int) -> Polygon:
        return shapely.box(x, y, min(x + width, side), min(y + height, side))

    corner = st.integers(0, side - 1)
    return st.builds(box, corner, corner, st.integers(1, 3), st.integers(1, 3))


def lattice_polygons(side: int = SIDE) -> st.SearchStrategy[Polygon]:
    """Triangles and simple quadrilaterals, convex and concave, with whole coordinates."""
    corners = st.lists(lattice_points(side), min_size=3, max_size=4, unique=True)
    return corners.map(Polygon).filter(lambda p: p.is_valid and p.area > 0.0)


def float_polygons(side: int = SIDE) -> st.SearchStrategy[Polygon]:
    """Triangles with coordinates of any kind, not slimmer than the arrangement's grid."""
    coordinate = st.floats(0.0, float(side), allow_subnormal=False)
    corners = st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=3, unique=True)
    return corners.map(Polygon).filter(lambda p: p.is_valid and p.area > 1e-3)


@st.composite
def scenes(
    draw: st.DrawFn,
    polygons: st.SearchStrategy[Polygon] | None = None,
    max_obstacles: int = 6,
    side: int = SIDE,
) -> Scene:
    """Scenes of random obstacles, whose query leads from one free place to another.

    polygons : of one obstacle; by default lattice boxes and lattice polygons.
    """
    if polygons is None:
        polygons = lattice_boxes(side) | lattice_polygons(side)
    obstacles = draw(st.lists(polygons, min_size=1, max_size=max_obstacles))
    workspace = shapely.box(0, 0, side, side)
    free = _free_lattice_points(workspace, obstacles, side)
    if len(free) == 0:  # a wider workspace has free corners
        workspace, free = shapely.box(0, 0, side + 2, side + 2), np.full((1, 2), side + 1.0)
    ends = st.integers(0, len(free) - 1)
    queries = {"main": (free[draw(ends)], free[draw(ends)])}
    return make_scene("lattice", workspace, obstacles, queries)


def _free_lattice_points(
    workspace: Polygon, obstacles: list[Polygon], side: int
) -> NDArray[np.float64]:
    """Lattice points outside the interior of what is closed, as the arrangement rounds it."""
    grid = np.stack(np.meshgrid(*[np.arange(side + 1.0)] * 2), axis=-1).reshape(-1, 2)
    return grid[~shapely.contains_xy(arrange(workspace, obstacles).solid, *grid.T)]


@st.composite
def paths(
    draw: st.DrawFn, scene: Scene, max_points: int = 6, side: int = SIDE
) -> NDArray[np.float64]:
    """Paths (n, 2) over lattice points and over the vertices of what is closed in a scene."""
    vertices = shapely.get_coordinates(scene.arrangement.solid)
    xmin, ymin, xmax, ymax = scene.bounds
    inside = vertices[
        np.all((vertices >= (xmin, ymin)) & (vertices <= (xmax, ymax)), axis=1)
    ].tolist()
    points = lattice_points(side) | st.sampled_from([tuple(v) for v in inside])
    return np.array(draw(st.lists(points, min_size=2, max_size=max_points)), dtype=np.float64)
