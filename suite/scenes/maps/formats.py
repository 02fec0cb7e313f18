"""The formats of maps: by the suffix of a file, what reads it."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from pkgutil import resolve_name
from typing import cast

import shapely
from shapely.geometry import Polygon

from suite.errors import SceneError
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.options import OPTIONS, MapOptions
from suite.scenes.scene import Obstacle, Scene, make_scene

Reader = Callable[[Path, MapOptions], Drawing]


@dataclass(frozen=True, slots=True)
class Format:
    """A format of maps.

    name : for people.
    reader : ``MODULE:FUNCTION``, imported when a map of it is read: it may bring a library.
    options : of :class:`MapOptions` that it heeds; any other is refused.
    """

    name: str
    reader: str
    options: tuple[str, ...] = ()


_IMAGE = Format(
    "images", "suite.scenes.maps.image:read_image", ("resolution", "threshold", "simplify")
)
_ROS = Format("ROS map_server", "suite.scenes.maps.ros:read_ros", ("unknown", "simplify"))

_GDAL = Format("what GDAL reads", "suite.scenes.maps.vector:read_vector", ("layer", "simplify"))

FORMATS = {
    **dict.fromkeys((".png", ".pgm", ".bmp", ".jpg", ".jpeg", ".tif", ".tiff"), _IMAGE),
    **dict.fromkeys((".yaml", ".yml"), _ROS),
    ".map": Format("Moving AI's grids", "suite.scenes.maps.moving_ai:read_grid", ("simplify",)),
    ".scen": Format("their queries", "suite.scenes.maps.moving_ai:read_queries", ("simplify",)),
    ".mesh": Format("polygon meshes", "suite.scenes.maps.mesh:read_mesh", ("simplify",)),
    ".svg": Format("SVG drawings", "suite.scenes.maps.svg:read_svg", ("threshold", "simplify")),
    **dict.fromkeys((".shp", ".gpkg", ".fgb", ".gml", ".kml", ".tab", ".dxf"), _GDAL),
    ".wkt": Format("well-known text", "suite.scenes.maps.wkt:read_wkt", ("simplify",)),
}

WITHOUT_ROLES = Format(
    "GeoJSON without roles", "suite.scenes.maps.features:read_features", ("simplify",)
)
"""Of GeoJSON files, the suffix says not whether they are scenes."""


def understood() -> str:
    """The suffixes of scene files and maps, and the format of each, in a sentence.

    Examples
    --------
    >>> understood()[:56]
    'Understood are .geojson, .json (scene files), .png, .pgm'
    """
    of: dict[str, list[str]] = {"scene files": [".geojson", ".json"]}
    for suffix, form in FORMATS.items():
        of.setdefault(form.name, []).append(suffix)
    told = ", ".join(f"{', '.join(suffixes)} ({name})" for name, suffixes in of.items())
    return f"Understood are {told}."


def read_map(
    path: Path, options: MapOptions, *, inflate: float = 0.0, form: Format | None = None
) -> Scene:
    """Read a map as a scene, whose queries may be none, and may be blocked.

    Parameters
    ----------
    path : Path
    options : MapOptions
    inflate : float
        Radius of the robot, metres; see :func:`suite.scenes.scene.make_scene`.
    form : Format, optional
        Default: that of the suffix, one of :data:`FORMATS`.

    Raises
    ------
    SceneError
        If the file can't be read. The message says what, where and how to mend it.
    """
    form = form or FORMATS[path.suffix.lower()]
    for option in OPTIONS:
        if getattr(options, option) is not None and option not in form.options:
            heeded = f"It heeds {', '.join(form.options)}" if form.options else "It heeds none"
            raise SceneError(f"{path.name}: {option} says nothing of {form.name}. {heeded}.")
    if not path.is_file():
        raise SceneError(f"{path}: can't be read (there is no such file).")
    drawing = cast(Reader, resolve_name(form.reader))(path, options)
    return make_scene(
        path.stem,
        _unsigned(drawing.workspace),
        [Obstacle(f"obstacle {i}", _unsigned(p)) for i, p in enumerate(drawing.obstacles, 1)],
        drawing.queries,
        properties=drawing.properties,
        path=path,
        inflate=inflate,
        strata=drawing.strata,
        keep_blocked=True,
    )


def _unsigned(polygon: Polygon) -> Polygon:
    """The polygon with 0 for each -0, which is the same place, but not the same bytes of a hash."""
    return shapely.transform(polygon, lambda xy: xy + 0.0)
