"""Whether the coordinates of a map of the earth are planar metres, and what to do if not."""

import math
import re

from suite.errors import SceneError
from suite.scenes.crs import check_crs
from suite.typed import shown

Bounds = tuple[float, float, float, float]

DEGREES = "OGC:CRS84"
"""What GeoJSON is in that says nothing (RFC 7946): longitude and latitude."""

_PLANAR = re.compile(r"\s*(?:PROJCS|PROJCRS|LOCAL_CS|ENGCRS)\[")
_UNIT = re.compile(r'UNIT\s*\[\s*"([^"]*)"\s*,\s*([-+.\deE]+)')


def check_projection(where: str, crs: str | None, bounds: Bounds) -> None:
    """Refuse a coordinate reference system of degrees, or of a length that is no metre.

    Parameters
    ----------
    where : str
        The file, for errors.
    crs : str, optional
        As GIS tools name it: ``EPSG:32632``, or well-known text. None is metres.
    bounds : xmin, ymin, xmax, ymax
        Of what the map holds, in its own units.

    Raises
    ------
    SceneError
        With the command that mends it.

    Examples
    --------
    >>> check_projection("a.shp", "EPSG:32632", (0, 0, 1, 1))
    >>> check_projection("a.shp", "EPSG:4326", (11.5, 48.1, 11.6, 48.2))
    Traceback (most recent call last):
    suite.errors.SceneError: a.shp: its coordinates are degrees ('EPSG:4326'), and a scene's \
are metres. Project it: ogr2ogr -t_srs EPSG:32632 metres.gpkg a.shp
    """
    if crs is None or _is_planar(crs):
        return
    name = shown(crs[:60])
    project = f"ogr2ogr -t_srs {_utm(bounds)} metres.gpkg {where.partition(',')[0]}"
    if may_be_degrees(bounds):
        raise SceneError(
            f"{where}: its coordinates are degrees ({name}), and a scene's are metres. "
            f"Project it: {project}"
        )
    raise SceneError(
        f"{where}: its coordinates ({name}) are not known to be planar and in metres. "
        "Project it with ogr2ogr -t_srs, to the UTM zone of the place say."
    )


def _is_planar(crs: str) -> bool:
    if _PLANAR.match(crs):
        units = _UNIT.findall(crs)
        try:
            return bool(units) and math.isclose(float(units[-1][1]), 1.0)
        except ValueError:
            return False
    try:
        check_crs({"properties": {"name": crs}})
    except SceneError:
        return False
    return True


def may_be_degrees(bounds: Bounds) -> bool:
    """Whether all coordinates could be longitudes and latitudes."""
    xmin, ymin, xmax, ymax = bounds
    return max(-xmin, xmax) <= 180.0 and max(-ymin, ymax) <= 90.0


def _utm(bounds: Bounds) -> str:
    """The UTM zone of the middle of bounds in degrees."""
    longitude, latitude = 0.5 * (bounds[0] + bounds[2]), 0.5 * (bounds[1] + bounds[3])
    zone = min(60, int((longitude + 180.0) // 6.0) + 1) if may_be_degrees(bounds) else 1
    return f"EPSG:{326 if latitude >= 0.0 else 327}{zone:02d}"
