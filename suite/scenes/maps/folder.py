"""The maps of a folder: of files that belong together, the one that stands for the map."""

import re
from pathlib import Path

from suite.errors import SceneError
from suite.scenes.maps.formats import FORMATS, understood

_IMAGE = re.compile(r"^image:\s*['\"]?([^'\"#\r\n]+?)['\"]?\s*(?:#.*)?$", re.MULTILINE)


def maps_in(folder: Path) -> list[Path]:
    """The maps and scene files of a folder, by name.

    Left out are files of queries whose map is there, images that a ROS map there names, and what
    is no map by its suffix.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    SceneError
        If it is no folder, or has none.
    """
    if not folder.is_dir():
        raise SceneError(f"{folder}: is no folder. Name one with maps in it.")
    files = sorted(path for path in folder.iterdir() if path.is_file())
    named = {(folder / name).resolve() for file in files for name in _images_of(file)}
    found = [
        file
        for file in files
        if file.suffix.lower() in (".geojson", *FORMATS)
        and file.resolve() not in named
        and not (file.suffix.lower() == ".scen" and _is_of_another(file, files))
    ]
    if not found:
        raise SceneError(f"{folder}: has no maps. {understood()}")
    return found


def _images_of(file: Path) -> list[str]:
    if file.suffix.lower() not in (".yaml", ".yml"):
        return []
    return _IMAGE.findall(file.read_text(encoding="utf-8", errors="replace"))


def _is_of_another(file: Path, files: list[Path]) -> bool:
    """Whether the map of a file of queries is there: MAP.SUFFIX.scen, or MAP.scen."""
    return any(
        file.stem in (other.name, other.stem) and other.suffix.lower() in (".map", ".mesh")
        for other in files
    )
