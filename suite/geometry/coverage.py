"""Whether everything that was drawn is closed: the promise that an arrangement makes. Metres."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, Polygon

from suite.geometry.coordinates import Coordinates

MOST = 2.0
"""Widths of the grid that a vertex may have moved: half of its diagonal, and as much for an edge
that is bent around another vertex."""


def left_open(solid: MultiPolygon, drawn: Sequence[Polygon], coordinates: Coordinates) -> list[int]:
    """Which polygons are not covered by what is closed, to the grid.

    Parameters
    ----------
    solid : MultiPolygon
        All that is closed, metres.
    drawn : sequence of Polygon
        What shall be.
    coordinates : Coordinates
        Of the scene.

    Returns
    -------
    list of int
        Indices of those in which a disc of twice the grid's radius has its centre in free space.
    """
    closed = shapely.transform(solid, coordinates.local)
    shapely.prepare(closed)
    inner = shapely.buffer(
        [shapely.transform(polygon, coordinates.local) for polygon in drawn],
        -MOST * coordinates.grid,
        join_style="mitre",
    )
    return np.flatnonzero(~shapely.covers(closed, inner)).tolist()
