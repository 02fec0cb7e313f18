"""Whether a coordinate reference system is planar and in metres, by the name that a file gives it.

GeoJSON of 2008 has a member ``crs`` of the collection, which GIS tools still write::

    "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}

Names of EPSG codes are looked up in ``planar_metres.toml``, the same on every machine and without
a network. Axes are read as GIS tools write them, x first, whatever order the code's own is. Web
Mercator (EPSG:3857) counts as metres, though away from the equator its metres are too short.
"""

import re
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from suite.errors import SceneError
from suite.typed import shown

_EPSG = re.compile(
    r"(?:urn:(?:x-)?ogc:def:crs:EPSG:(?:[\w.]*:)?|https?://www\.opengis\.net/def/crs/EPSG/[\w.]+/|EPSG:)"
    r"(\d{4,6})",
    re.IGNORECASE,
)
"""The ways to name a code: a URN with or without a version, a URL, and what people write."""

_MEND = (
    "Project the file (geopandas: frame.to_crs(frame.estimate_utm_crs())); or, if its numbers are "
    "metres, take the member 'crs' out (geopandas: frame.set_crs(None, allow_override=True))."
)


def check_crs(member: Any) -> None:
    """Refuse a ``crs`` that is not known to be planar and in metres.

    Parameters
    ----------
    member : Any
        Of the collection, as JSON has it. None is no crs: coordinates are metres.

    Raises
    ------
    SceneError
        With how to mend it; the caller says where. A name that is in no list is refused too.

    Examples
    --------
    >>> check_crs({"type": "name", "properties": {"name": "EPSG:25832"}})
    >>> check_crs({"type": "name", "properties": {"name": "EPSG:4326"}})
    Traceback (most recent call last):
    suite.errors.SceneError: its crs 'EPSG:4326' is not known to be planar and in metres. ...
    """
    if member is None:
        return
    name = _name(member)
    code = _EPSG.fullmatch(name)
    if code is None or int(code[1]) not in _planar_codes():
        raise SceneError(f"its crs {shown(name)} is not known to be planar and in metres. {_MEND}")


def _name(member: Any) -> str:
    properties = member.get("properties") if isinstance(member, dict) else None
    name = properties.get("name") if isinstance(properties, dict) else None
    if not isinstance(name, str):
        raise SceneError(
            f"its crs is {shown(member)}, which names none. Take it out if the coordinates are "
            'metres, or give {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::..."}}.'
        )
    return name.strip()


@cache
def _planar_codes() -> frozenset[int]:
    text = (Path(__file__).parent / "planar_metres.toml").read_text(encoding="utf-8")
    ranges = (entry.partition("-") for entry in tomllib.loads(text)["codes"].split())
    return frozenset(
        code for low, _, high in ranges for code in range(int(low), int(high or low) + 1)
    )
