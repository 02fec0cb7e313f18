"""Well-known text: polygons and what holds them, as shapely and every GIS tool write them.

One geometry, or one a line; nested collections, and Z and M, which are left out. With an ``SRID=``
before it (EWKT), its coordinates must be planar metres.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import shapely
from shapely.geometry.base import BaseGeometry

from suite.errors import SceneError
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.polygons import obstacles_in_their_box
from suite.scenes.maps.projection import check_projection
from suite.scenes.maps.text import one_line, read_lines

_SRID = re.compile(r"\s*SRID\s*=\s*(\d{1,9})\s*;", re.IGNORECASE)


def read_wkt(path: Path, options: MapOptions) -> Drawing:
    """Read geometries: each polygon is an obstacle, and the box of all the workspace.

    Raises
    ------
    SceneError
        If it is no such text, or holds no polygon. The message says in which line.
    """
    return obstacles_in_their_box(
        path,
        list(_geometries(path)),
        simplify=options.simplify,
        properties={"format": "well-known text"},
    )


def _geometries(path: Path) -> Iterator[BaseGeometry]:
    """Each geometry: what lies between two of them is the end of a line, with all brackets shut."""
    pending, first = "", 1
    for number, line in enumerate(read_lines(path), 1):
        if not pending and not line.strip():
            continue
        first = number if not pending else first
        pending += f"{line}\n"
        if pending.count("(") == pending.count(")") and not _goes_on(pending):
            yield _geometry(path, first, pending)
            pending = ""
    if pending:
        yield _geometry(path, first, pending)


def _goes_on(text: str) -> bool:
    """Whether a geometry without brackets is one that is to come, not an empty one."""
    return "(" not in text and "EMPTY" not in text.upper() and bool(_SRID.match(text))


def _geometry(path: Path, line: int, text: str) -> BaseGeometry:
    where = f"{path.name}, line {line}"
    srid = _SRID.match(text)
    try:
        geometry = shapely.from_wkt(text[srid.end() if srid else 0 :].strip())
    except (shapely.errors.GEOSException, ValueError) as error:
        raise SceneError(
            f"{where}: no well-known text ({one_line(error)}). "
            "Write POLYGON ((0 0, 1 0, 0 1, 0 0)), and no text behind it."
        ) from error
    if srid and int(srid[1]):
        check_projection(where, f"EPSG:{int(srid[1])}", geometry.bounds)
    return geometry
