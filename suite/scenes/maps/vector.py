"""Whatever GDAL reads of vectors: shapefiles, GeoPackages, FlatGeobuf, GML, KML, MapInfo, DXF.

GDAL comes with pyogrio, the extra ``gdal``. Coordinates must be planar metres; a file that says
nothing of them is taken for that. In a DXF, whose drawings are lines, a line that closes is the
outline of an obstacle.
"""

import warnings
from pathlib import Path
from typing import Any

import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from suite.errors import SceneError, did_you_mean
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.polygons import obstacles_in_their_box
from suite.scenes.maps.projection import check_projection
from suite.scenes.maps.text import one_line

try:
    import pyogrio
except ImportError:  # an extra
    pyogrio = None

OUTLINES = ".dxf"
LEAST = 4
"""Points of a line that closes around something, the last of which is the first."""


def read_vector(path: Path, options: MapOptions) -> Drawing:
    """Read a layer: each polygon is an obstacle, and the box of all the workspace.

    Raises
    ------
    SceneError
        If GDAL is missing or can't read the file, if several layers may be meant, if the
        coordinates are degrees, or if there is no polygon.
    """
    if pyogrio is None:
        raise SceneError(
            f"{path.name}: is read by GDAL, which is not installed. "
            "Run: pip install 'kbga-bench[gdal]'"
        )
    if path.suffix.lower() == OUTLINES:
        _refuse_without_end(path)
    layer = _layer(path, options.layer)
    crs, shapes = _read(path, layer)
    if path.suffix.lower() == OUTLINES:
        shapes = [_outlined(shape) for shape in shapes]
    drawing = obstacles_in_their_box(
        path, shapes, simplify=options.simplify, properties={"format": "GDAL", "layer": layer}
    )
    check_projection(path.name, crs, drawing.workspace.bounds)
    return drawing


def _refuse_without_end(path: Path) -> None:
    """Refuse a DXF that is cut off: in some places GDAL would wait for its end forever."""
    try:
        text = path.read_bytes()
    except OSError as error:
        raise SceneError(f"{path}: can't be read ({error.strerror}).") from error
    if not text.rstrip(b"\x00\x1a \t\r\n").endswith(b"EOF"):
        raise SceneError(
            f"{path.name}: no DXF, or cut off: its last line is not EOF. Save it again, as text."
        )


def _layer(path: Path, wanted: str | None) -> str:
    """The layer to be read: the one that is wanted, or the only one that has a geometry."""
    layers = _asked(path, pyogrio.list_layers, path)
    names = [str(name) for name, kind in layers if kind is not None]
    if wanted is not None:
        if wanted not in names:
            raise SceneError(
                f"{path.name}: has no layer '{wanted}'. It has {_listed(names)}."
                f"{did_you_mean(wanted, names)}"
            )
        return wanted
    if not names:
        raise SceneError(f"{path.name}: holds no geometry. Give a file with polygons.")
    if len(names) > 1:
        raise SceneError(
            f"{path.name}: has {len(names)} layers, {_listed(names)}. Name one: "
            f"{path.name}@layer={names[0]}, or --layer of import."
        )
    return names[0]


def _listed(names: list[str]) -> str:
    return ", ".join(names[:12]) + (f" and {len(names) - 12} more" if len(names) > 12 else "")


def _read(path: Path, layer: str) -> tuple[str | None, list[BaseGeometry | None]]:
    meta, _, shapes, _ = _asked(
        path, pyogrio.raw.read, path, layer=layer, columns=[], force_2d=True
    )
    try:
        read = [None if shape is None else shapely.from_wkb(shape) for shape in shapes]
    except shapely.errors.GEOSException as error:
        raise SceneError(
            f"{path.name}: holds a geometry that can't be read ({one_line(error)})."
        ) from error
    return meta["crs"], read


def _asked(path: Path, question: Any, *arguments: Any, **options: Any) -> Any:
    """What pyogrio answers; what it has to say of a file that is broken is an error of ours."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of fields and measures, which nobody reads
            return question(*arguments, **options)
    # Errors of its own are RuntimeErrors, and broken files bring up others.
    except (RuntimeError, ValueError, OSError, UnicodeDecodeError) as error:
        said = one_line(str(error).replace(str(path), path.name), 200)
        raise SceneError(f"{path.name}: GDAL can't read it ({said}).") from error


def _outlined(shape: BaseGeometry | None) -> BaseGeometry | None:
    """A line that closes as the polygon within; anything else as it is."""
    if shape is None or shape.geom_type != "LineString" or not shape.is_closed:
        return shape
    xy = shapely.get_coordinates(shape)
    return Polygon(xy) if len(xy) >= LEAST else shape
