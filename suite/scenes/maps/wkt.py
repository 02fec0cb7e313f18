"""Well-known text: polygons and what holds them, as shapely and every GIS tool write them."""

from pathlib import Path

import shapely
from shapely.geometry import Polygon

from suite.errors import SceneError
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.options import MapOptions


def read_wkt(path: Path, options: MapOptions) -> Drawing:  # noqa: ARG001 (none is of its kind)
    """Read a geometry of polygons: each is an obstacle, and their box the workspace.

    Raises
    ------
    SceneError
        If it is no such text.
    """
    try:
        geometry = shapely.from_wkt(path.read_text(encoding="utf-8-sig"))
    except (shapely.errors.GEOSException, UnicodeDecodeError) as error:
        raise SceneError(f"{path.name}: no well-known text ({error}).") from error
    parts = shapely.get_parts(geometry, return_index=False)
    polygons = [part for part in parts if isinstance(part, Polygon) and not part.is_empty]
    if len(polygons) < len(parts) or not polygons:
        raise SceneError(f"{path.name}: holds a {geometry.geom_type}. Give polygons.")
    return Drawing(shapely.box(*geometry.bounds), tuple(polygons))
