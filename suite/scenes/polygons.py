"""Whether what somebody gives is a polygon that a scene can be made of, and if not, where it fails.

All of it is said before shapely sees it, in words that name the file, the polygon and the vertex.
Metres.
"""

from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.geometry import LinearRing, LineString, Polygon
from shapely.validation import explain_validity

from suite.errors import SceneError
from suite.geometry.coordinates import Coordinates, printed
from suite.geometry.tolerances import LARGEST


def as_polygon(where: str, what: str, shape: Polygon | ArrayLike) -> Polygon:
    """Make a polygon of vertices; a polygon stays itself.

    Parameters
    ----------
    where, what : str
        The file, or the scene; the obstacle, or the workspace.
    shape : Polygon, or vertices (n, 2)
        Metres.

    Returns
    -------
    Polygon

    Raises
    ------
    SceneError
        If it is neither.
    """
    if isinstance(shape, Polygon):
        return shape
    mend = "Give a shapely Polygon, or its vertices as an array (n, 2)."
    if isinstance(shape, shapely.Geometry):
        raise SceneError(f"{where}, {what}: it is a {type(shape).__name__}. {mend}")
    try:
        xy = np.array(shape, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise SceneError(f"{where}, {what}: it is no array of numbers. {mend}") from error
    if xy.ndim != 2 or xy.shape[1] != 2:
        raise SceneError(f"{where}, {what}: its shape is {xy.shape}. {mend}")
    # Before shapely sees them: it refuses short rings, and warns of NaN, in words of its own.
    _check_coordinates(where, what, xy)
    _check_ring(where, what, xy)
    return Polygon(xy)


def _check_coordinates(where: str, what: str, xy: NDArray[np.float64]) -> None:
    bad = np.flatnonzero(~(np.abs(xy) <= LARGEST).all(axis=1))  # so written, NaN is bad too
    if bad.size:
        x, y = xy[bad[0]]
        raise SceneError(
            f"{where}, {what}: vertex {bad[0] + 1} is ({x}, {y}). "
            f"Coordinates must be finite numbers, in metres, up to {LARGEST:g}."
        )


def _check_ring(where: str, what: str, xy: NDArray[np.float64]) -> None:
    corners = {(x, y) for x, y in xy.tolist()}
    if len(corners) < 3:
        raise SceneError(
            f"{where}, {what}: only {len(corners)} different vertices. A ring needs three."
        )


def check_polygon(where: str, what: str, polygon: Polygon) -> None:
    """Refuse a polygon that is not one, and say where it goes wrong.

    Parameters
    ----------
    where, what : str
        The file, or the scene; the obstacle, or the workspace.
    polygon : Polygon
        Metres.

    Raises
    ------
    SceneError
        If it crosses or touches itself, or has no area.
    """
    _check_coordinates(where, what, shapely.get_coordinates(polygon))
    for ring in (polygon.exterior, *polygon.interiors):
        _check_ring(where, what, shapely.get_coordinates(ring))
        crossing = _first_crossing(ring)
        if crossing is not None:
            i, j, x, y = crossing
            raise SceneError(
                f"{where}, {what}: edges {i} and {j} cross at {printed(x, y)}. "
                "List its vertices in order, or split it in two."
            )
    if polygon.area == 0.0:
        raise SceneError(f"{where}, {what}: its area is zero. Give it some width, or leave it out.")
    if not polygon.is_valid:
        raise SceneError(
            f"{where}, {what}: {explain_validity(polygon)}. Its rings must not cross, overlap "
            "or touch along a line; split it in several polygons."
        )


def check_width(where: str, what: str, polygon: Polygon, coordinates: Coordinates) -> None:
    """Refuse a polygon that vanishes on the grid of its scene.

    Parameters
    ----------
    where, what : str
        The file, or the scene; the obstacle, or the workspace.
    polygon : Polygon
        Valid, metres.
    coordinates : Coordinates
        Of the scene.

    Raises
    ------
    SceneError
        If it is narrower than the grid.
    """
    grid = coordinates.grid
    # Within a distance r of a ring of length l lies an area of 2 r l + pi r^2 at most, and snapping
    # moves no ring that far: what has more is not narrow, and most have.
    rings = 1 + len(polygon.interiors)
    if polygon.area > 2.0 * grid * (polygon.length + 2.0 * grid * rings):
        return
    local = shapely.transform(polygon, coordinates.local)
    if shapely.set_precision(local, grid).is_empty:
        raise SceneError(f"{where}, {what}: narrower than {grid:g} m. Coordinates are metres.")


def _first_crossing(ring: LinearRing) -> tuple[int, int, float, float] | None:
    """Numbers (from 1) of the first two edges of a ring that cross, and where; None if none do."""
    if ring.is_simple:
        return None
    edges = [LineString(ends) for ends in pairwise(ring.coords)]
    pairs = shapely.STRtree(edges).query(edges, predicate="crosses").T.tolist()
    if not pairs:
        return None
    i, j = min(pairs)
    point = edges[i].intersection(edges[j])
    return i + 1, j + 1, point.x, point.y
