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
    local = np.array([shapely.transform(p, coordinates.local) for p in drawn], dtype=np.object_)
    width = MOST * coordinates.grid
    inner = shapely.buffer(local, -width, join_style="mitre")
    # The quick test knows most; where nothing is left, or GEOS lost it, what is open is looked at.
    doubtful = np.flatnonzero(~shapely.covers(closed, inner)).tolist()
    return [i for i in doubtful if _is_wide(shapely.difference(local[i], closed), width)]


def _is_wide(left: shapely.Geometry, width: float) -> bool:
    """Whether a disc of a radius fits in any part of what is left, as far as GEOS can tell."""
    parts = [part for part in shapely.get_parts(left) if isinstance(part, Polygon)]
    return any(
        not part.buffer(-width).is_empty
        or part.exterior.distance(part.representative_point()) > width
        for part in parts
    )
