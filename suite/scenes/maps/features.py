"""GeoJSON that knows no roles, as GIS tools and open data have it: each polygon is an obstacle.

Its ``crs`` must be planar metres. Without one it is degrees by RFC 7946, unless its numbers are too
large for that: then they are taken for metres.
"""

import json
from pathlib import Path
from typing import Any

import shapely
from shapely.geometry.base import BaseGeometry

from suite.errors import SceneError
from suite.scenes.crs import check_crs
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.polygons import obstacles_in_their_box
from suite.scenes.maps.projection import DEGREES, check_projection, may_be_degrees
from suite.scenes.maps.text import one_line


def knows_no_roles(path: Path) -> bool:
    """Whether a file is a FeatureCollection of which no feature says its role in a scene."""
    try:
        text = path.read_text(encoding="utf-8-sig")
        if '"role"' in text:  # so that a scene is not read twice
            return False
        document = json.loads(text)
    except (OSError, ValueError, RecursionError):
        return False
    features = document.get("features") if isinstance(document, dict) else None
    return (
        isinstance(features, list)
        and bool(features)
        and document.get("type") == "FeatureCollection"
        and all(isinstance(f, dict) and isinstance(f.get("geometry"), dict) for f in features)
    )


def read_features(path: Path, options: MapOptions) -> Drawing:
    """Read the polygons of a file of which :func:`knows_no_roles` holds.

    Raises
    ------
    SceneError
        If a geometry can't be read, none is a polygon, or its coordinates are degrees.
    """
    document = json.loads(path.read_text(encoding="utf-8-sig"))
    shapes = [_geometry(path, i, f["geometry"]) for i, f in enumerate(document["features"], 1)]
    drawing = obstacles_in_their_box(
        path, shapes, simplify=options.simplify, properties={"format": "GeoJSON without roles"}
    )
    if document.get("crs") is not None:
        try:
            check_crs(document["crs"])
        except SceneError as error:
            raise SceneError(f"{path.name}: {error}") from error
    elif may_be_degrees(drawing.workspace.bounds):
        check_projection(path.name, DEGREES, drawing.workspace.bounds)
    return drawing


def _geometry(path: Path, number: int, geometry: dict[str, Any]) -> BaseGeometry:
    try:
        return shapely.from_geojson(json.dumps(geometry))
    except (shapely.errors.GEOSException, ValueError) as error:
        raise SceneError(
            f"{path.name}, feature {number}: its geometry can't be read ({one_line(error)})."
        ) from error
