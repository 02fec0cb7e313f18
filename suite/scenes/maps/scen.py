"""Moving AI's queries: a .scen file, a query a line, beside the map that they are asked of."""

import re
from dataclasses import dataclass
from pathlib import Path

from suite.errors import SceneError
from suite.scenes.maps.drawing import Point
from suite.scenes.maps.text import finite, one_line, read_lines
from suite.typed import shown

FIELDS = "bucket, map, width, height, start x, start y, goal x, goal y and length"


@dataclass(frozen=True, slots=True)
class Asked:
    """A line of a .scen file, as it stands there.

    name : its bucket and its number among the file's queries, from 1: ``12-125``.
    bucket : of queries about as long.
    map : the map that it is asked of, by its path or name.
    width, height : of that map.
    start, goal : of a grid's cells the column and row, from the upper left; of a mesh the points.
    length : as the file has it.
    """

    name: str
    bucket: str
    map: str
    width: float
    height: float
    start: Point
    goal: Point
    length: float


def scen_beside(path: Path) -> Path | None:
    """The file of a map's queries: MAP.SUFFIX.scen, or MAP.scen; None if there is neither."""
    places = (path.with_name(f"{path.name}.scen"), path.with_suffix(".scen"))
    return next((place for place in places if place.is_file()), None)


def map_of(path: Path, asked: tuple[Asked, ...]) -> Path:
    """The map that a file of queries is asked of: beside it, or where the file says.

    Raises
    ------
    SceneError
        If it is nowhere, or is not one map.
    """
    said = sorted({query.map for query in asked})
    if len(said) != 1:
        raise SceneError(
            f"{path.name}: its queries are of {len(said)} maps. Keep those of one map in the file."
        )
    named = Path(said[0].replace("\\", "/"))
    places = (path.with_suffix(""), path.parent / named, path.parent / named.name)
    for place in places:
        if place.suffix and _is_file(place):
            return place
    raise SceneError(
        f"{path.name}: its map, {one_line(named.name)}, is not beside it. Put it into its folder."
    )


def _is_file(place: Path) -> bool:
    try:
        return place.is_file()
    except (OSError, ValueError):  # a name that is too long, or that none can have
        return False


def read_scen(path: Path) -> tuple[Asked, ...]:
    """Read the queries of a map.

    Raises
    ------
    SceneError
        If a line is none. The message says which, and what it lacks.
    """
    lines = read_lines(path)
    version = lines[0].split() if lines else []
    if len(version) != 2 or version[0] != "version" or finite(version[1]) != 1.0:
        raise SceneError(f"{path.name}, line 1: not 'version 1', as files of queries begin.")
    rows = [(number, line.split()) for number, line in enumerate(lines[1:], 2) if line.strip()]
    return tuple(_asked(path, line, row, i) for i, (line, row) in enumerate(rows, 1))


def _asked(path: Path, line: int, row: list[str], number: int) -> Asked:
    # The name of a map may hold spaces: what is fixed is what stands before and behind it.
    bucket, name, values = row[0], " ".join(row[1:-7]), [finite(text) for text in row[-7:]]
    told = [value for value in values if value is not None]
    if len(row) < 9 or len(told) < 7:
        raise SceneError(
            f"{path.name}, line {line}: no query. Give {FIELDS}, the last seven in numbers."
        )
    if not re.fullmatch("[0-9]{1,9}", bucket):
        raise SceneError(f"{path.name}, line {line}: bucket is {shown(bucket)}. Give a number.")
    width, height, x, y, to_x, to_y, length = told
    return Asked(
        name=f"{int(bucket)}-{number}",
        bucket=str(int(bucket)),
        map=name,
        width=width,
        height=height,
        start=(x, y),
        goal=(to_x, to_y),
        length=length,
    )
