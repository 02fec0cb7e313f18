"""Free space of a scene that stands still: its parts, and the place in it nearest to a point."""

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Point, Polygon

from suite.geometry.coordinates import Coordinates

_AROUND = np.stack(np.meshgrid(*[np.arange(-2.0, 3.0)] * 2), axis=-1).reshape(-1, 2)
"""Steps to the places of the grid around one of them."""


def free_regions(solid: MultiPolygon) -> MultiPolygon:
    """The parts of free space, between two of which there is no path.

    Parameters
    ----------
    solid : MultiPolygon
        What is closed, with the frame around the workspace: see
        :class:`suite.geometry.arrangement.Arrangement`.

    Returns
    -------
    MultiPolygon
        Open sets that touch in single points at the most. Empty if nothing is free.
    """
    free = shapely.box(*solid.bounds).difference(solid)
    return MultiPolygon([part for part in shapely.get_parts(free) if isinstance(part, Polygon)])


def nearest_free(
    point: NDArray[np.float64],
    regions: MultiPolygon,
    solid: MultiPolygon,
    coordinates: Coordinates,
) -> NDArray[np.float64]:
    """The place of the grid in free space that is nearest to a point.

    Parameters
    ----------
    point : (2,) float64, metres
        Anywhere.
    regions : MultiPolygon
        Of :func:`free_regions`.
    solid : MultiPolygon
        What is closed; free is what does not lie in its interior.
    coordinates : Coordinates
        Of the scene.

    Returns
    -------
    (2,) float64, metres, read-only
        The point itself, if nothing is free.
    """
    if regions.is_empty:
        return point
    shapely.prepare(regions)
    nearest = shapely.get_coordinates(shapely.shortest_line(regions, Point(point)))[0]
    # On a slanted border lies hardly any place of the grid: the nearest may be closed.
    around = coordinates.snapped(nearest) + coordinates.grid * _AROUND
    places = coordinates.snapped(around)
    free = places[_is_free(places, solid)]
    if not len(free):  # between walls that lie nearer than the grid is wide: their corners are free
        corners = shapely.get_coordinates(regions)
        free = corners[_is_free(corners, solid)]
    # From the point itself, places beside the nearest are as far, but for rounding.
    place = np.array(free[np.argmin(np.hypot(*(free - nearest).T))])
    place.setflags(write=False)
    return place


def _is_free(places: NDArray[np.float64], solid: MultiPolygon) -> NDArray[np.bool_]:
    """Which of some places (n, 2) within the frame are free."""
    shapely.prepare(solid)
    return ~np.asarray(shapely.contains(solid, shapely.points(places)))
