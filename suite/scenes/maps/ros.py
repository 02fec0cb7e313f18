"""Occupancy grids of ROS: a yaml file, as map_server reads it, and the image that it names.

After nav2_map_server's map_io.cpp, as it is since pull request 5071 of navigation2 (2025). Its grid
has 100 for occupied, 0 for free, and else -1 for unknown or, in the modes ``scale`` and ``raw``,
what lies between. With p the darkness of a pixel, 1 without its brightness (the brightness itself,
if ``negate``), brightness being the mean of red, green and blue:

``trinary``
    Occupied where p >= occupied_thresh, free where p <= free_thresh, else unknown, and so is all
    that is not opaque.
``scale``
    The same, but between the thresholds 1 to 99 in proportion, rounded.
``raw``
    The brightness itself, of 255; above 100 it is unknown. It heeds neither ``negate`` nor
    thresholds nor opacity.

Here, all that is neither occupied nor free is unknown: nobody has said that a robot can go there.

Up to ROS 2 Jazzy a darkness of exactly a threshold was unknown, and opacity was averaged in as a
fourth colour in ``trinary``, by which the unknown of an opaque image with an alpha channel became
free (issue 4233 there): nobody wants that of a map. Brightness was the mean then, as it is here;
map_server has Magick weigh colours since, which is the same in grey.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
import yaml
from numpy.typing import NDArray

from suite.errors import SceneError
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.options import MapOptions, Unknown
from suite.scenes.maps.pixels import drawing_of
from suite.scenes.maps.raster import Raster, read_raster
from suite.scenes.maps.text import finite, one_line
from suite.typed import MisfitError, shown, typed

OCCUPIED, FREE, UNKNOWN = 100.0, 0.0, -1.0

_Pose = Annotated[
    tuple[float, float, float],
    msgspec.Meta(
        description="x, y and yaw of the lower left pixel's corner, in metres and radians"
    ),
]
_Flag = Annotated[
    Literal[0, 1] | bool,
    msgspec.Meta(description="0 where dark pixels are occupied, 1 where bright ones are"),
]
_Metres = Annotated[
    float, msgspec.Meta(description="the metres of a pixel, in one number: pixels are squares")
]
_Share = Annotated[float, msgspec.Meta(description="a share from 0 to 1")]


class MapYaml(msgspec.Struct, frozen=True, forbid_unknown_fields=False):
    """What a yaml file of map_server says; keys that it does not know, it does not heed.

    image : path of the image, from the folder of the yaml file.
    resolution : metres of a pixel.
    origin : x, y of the lower left pixel's lower left corner, metres, and yaw about it, radians.
    negate : whether bright pixels are the occupied ones.
    occupied_thresh, free_thresh : darkness from which on a pixel is occupied, up to which free.
    mode : how darkness becomes occupancy.
    """

    image: Annotated[str, msgspec.Meta(description="the path of the map's image")]
    resolution: _Metres
    origin: _Pose
    negate: _Flag
    occupied_thresh: _Share
    free_thresh: _Share
    mode: Literal["trinary", "scale", "raw"] = "trinary"


def read_ros(path: Path, options: MapOptions) -> Drawing:
    """Read an occupancy grid of ROS.

    Raises
    ------
    SceneError
        If the yaml file or its image can't be used.
    """
    said = _read_yaml(path)
    image = path.parent / said.image
    raster = read_raster(image, f"{path.name}, image {one_line(image.name)}")
    values = occupancy(raster, said)
    known = (values == OCCUPIED) | (values == FREE)
    occupied = values == OCCUPIED
    unknown = options.unknown or Unknown.OCCUPIED
    if unknown is Unknown.OCCUPIED:
        occupied |= ~known
    x, y, yaw = said.origin
    drawing = drawing_of(
        occupied,
        resolution=said.resolution,
        origin=(x, y),
        yaw=yaw,
        simplify=options.simplify,
    )
    height, width = values.shape
    properties = {
        "format": "ROS map_server",
        "pixels": f"{width} x {height}",
        "resolution": said.resolution,
        "mode": said.mode,
        "unknown": unknown.value,
        "unknown_share": float(1.0 - known.mean()),
    }
    return Drawing(drawing.workspace, drawing.obstacles, properties=properties)


def occupancy(raster: Raster, said: MapYaml) -> NDArray[np.float64]:
    """The values of the grid that map_server would publish, the upper row first."""
    if said.mode == "raw":
        level = np.rint(raster.brightness * 255.0)
        return np.where(level <= OCCUPIED, level, UNKNOWN)
    dark = raster.brightness if said.negate else raster.darkness
    between = np.full_like(dark, UNKNOWN)
    if said.mode == "scale":
        share = (dark - said.free_thresh) / (said.occupied_thresh - said.free_thresh)
        between = np.floor(share * OCCUPIED + 0.5)
    value = np.select(
        [dark >= said.occupied_thresh, dark <= said.free_thresh], [OCCUPIED, FREE], between
    )
    return value if raster.opacity is None else np.where(raster.opacity < 1.0, UNKNOWN, value)


def _read_yaml(path: Path) -> MapYaml:
    try:
        data = yaml.safe_load(path.read_bytes())
    except OSError as error:
        raise SceneError(f"{path}: can't be read ({error.strerror}).") from error
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = f", line {mark.line + 1}" if mark else ""
        raise SceneError(f"{path.name}{line}: no YAML ({one_line(error.problem)}).") from error
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        # Of ValueError, what PyYAML lets out: no text, and dates and numbers that there are not.
        raise SceneError(f"{path.name}: no YAML ({one_line(error)}).") from error
    if not isinstance(data, dict):
        raise SceneError(
            f"{path.name}: is {shown(data)}. Give the keys of a map of ROS's map_server: "
            "image, resolution, origin, negate, occupied_thresh, free_thresh."
        )
    try:
        said = typed(_with_numbers(data), MapYaml)
    except MisfitError as error:
        raise SceneError(f"{path.name}: {error}") from error
    _check(path, said)
    return said


def _with_numbers(data: Mapping[Any, Any]) -> dict[str, Any]:
    """The keys that are names; with numbers like 5e-2, which YAML 1.1 takes for strings."""
    return {
        key: [_number(item) for item in value] if isinstance(value, list) else _number(value)
        for key, value in data.items()
        if isinstance(key, str)
    } | {key: data[key] for key in ("image", "mode") if key in data}


def _number(value: Any) -> Any:
    number = finite(value) if isinstance(value, str) else None
    return value if number is None else number


def _check(path: Path, said: MapYaml) -> None:
    if not said.image or "\0" in said.image:
        raise SceneError(f"{path.name}: image is {shown(said.image)}. Give the path of the image.")
    if not (math.isfinite(said.resolution) and said.resolution > 0.0):
        raise SceneError(
            f"{path.name}: resolution is {said.resolution:g}. Give metres of a pixel, above 0."
        )
    if not all(map(math.isfinite, said.origin)):
        raise SceneError(f"{path.name}: origin is {shown(said.origin)}. Give finite numbers.")
    if not 0.0 <= said.free_thresh < said.occupied_thresh <= 1.0:
        raise SceneError(
            f"{path.name}: free_thresh is {said.free_thresh:g} and occupied_thresh "
            f"{said.occupied_thresh:g}. Give two shares from 0 to 1, that of free the lower one."
        )
