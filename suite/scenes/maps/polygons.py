"""Polygons out of whatever geometry a map holds, and what of it is none."""

import warnings
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from suite.errors import SceneError
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.simplify import simplified
from suite.scenes.scene import SceneWarning

_KINDS = {"Point": "point", "LineString": "line", "LinearRing": "line"}


def drawing_of(
    workspace: Polygon,
    obstacles: Iterable[Polygon],
    *,
    simplify: float | None,
    properties: Mapping[str, Any] | None = None,
) -> Drawing:
    """A map of a workspace and obstacles, with fewer vertices if that is wanted."""
    kept = tuple(obstacles)
    if simplify is not None:
        kept = tuple(
            simplified(polygon, simplify) if polygon.is_valid else polygon for polygon in kept
        )
    return Drawing(workspace, kept, properties=properties or {})


def solids(geometry: BaseGeometry) -> tuple[Polygon, ...]:
    """The polygons with an area in a geometry, however deep its collections are nested.

    Examples
    --------
    >>> nested = "GEOMETRYCOLLECTION (POINT (1 1), MULTIPOLYGON (((0 0, 1 0, 0 1, 0 0))))"
    >>> [polygon.area for polygon in solids(shapely.from_wkt(nested))]
    [0.5]
    """
    return tuple(p for p in _parts(geometry) if isinstance(p, Polygon) and p.area > 0.0)


def obstacles_in_their_box(
    path: Path,
    geometries: Iterable[BaseGeometry | None],
    *,
    simplify: float | None,
    properties: Mapping[str, Any] | None = None,
) -> Drawing:
    """A map of which each polygon is an obstacle, and their box the workspace.

    Lines and points have no area to be in the way with: they are left out, with a
    :class:`suite.scenes.scene.SceneWarning` that counts them.

    Raises
    ------
    SceneError
        If there is no polygon.
    """
    parts = [part for geometry in geometries if geometry is not None for part in _parts(geometry)]
    polygons = tuple(shapely.force_2d(part) for part in parts if isinstance(part, Polygon))
    others = Counter(_KINDS[part.geom_type] for part in parts if not isinstance(part, Polygon))
    told = " and ".join(f"{n} {kind}{'s' if n > 1 else ''}" for kind, n in sorted(others.items()))
    if not polygons:
        found = f"holds {told}, and no polygon" if others else "holds no polygon"
        raise SceneError(
            f"{path.name}: {found}. Draw obstacles as polygons, or lines with some width "
            "(shapely: line.buffer(0.1))."
        )
    if others:
        warnings.warn(
            f"{path.name}: {told} left out: obstacles are polygons.", SceneWarning, stacklevel=2
        )
    room = shapely.box(*shapely.total_bounds(polygons))
    return drawing_of(room, polygons, simplify=simplify, properties=properties)


def _parts(geometry: BaseGeometry) -> list[BaseGeometry]:
    """Points, lines and polygons of a geometry that are not empty."""
    if geometry.is_empty:
        return []
    if not hasattr(geometry, "geoms"):
        return [geometry]
    return [part for member in geometry.geoms for part in _parts(member)]
