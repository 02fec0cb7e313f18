"""The formats of maps: by the suffix of a file, what reads it."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from pkgutil import resolve_name
from typing import cast

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


FORMATS = {
    ".wkt": Format("well-known text", "suite.scenes.maps.wkt:read_wkt"),
}


def read_map(path: Path, options: MapOptions, *, inflate: float = 0.0) -> Scene:
    """Read a map as a scene, whose queries may be none, and may be blocked.

    Parameters
    ----------
    path : Path
    options : MapOptions
    inflate : float
        Radius of the robot, metres; see :func:`suite.scenes.scene.make_scene`.

    Raises
    ------
    SceneError
        If the file can't be read. The message says what, where and how to mend it.
    """
    form = FORMATS[path.suffix.lower()]
    for option in OPTIONS:
        if getattr(options, option) is not None and option not in form.options:
            heeded = f"It heeds {', '.join(form.options)}" if form.options else "It heeds none"
            raise SceneError(f"{path.name}: {option} says nothing of {form.name}. {heeded}.")
    if not path.is_file():
        raise SceneError(f"{path}: can't be read (there is no such file).")
    drawing = cast(Reader, resolve_name(form.reader))(path, options)
    return make_scene(
        path.stem,
        drawing.workspace,
        [Obstacle(f"obstacle {i}", polygon) for i, polygon in enumerate(drawing.obstacles, 1)],
        drawing.queries,
        properties=drawing.properties,
        path=path,
        inflate=inflate,
        strata=drawing.strata,
        keep_blocked=True,
    )
