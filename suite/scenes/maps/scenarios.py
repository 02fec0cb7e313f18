"""Scenario files ``.scen`` of version 1: queries of a map, a line each, as Moving AI writes them.

``bucket map width height start-x start-y goal-x goal-y length``, apart by tabs or spaces. What the
coordinates mean is the map's own affair.
"""

import math
from dataclasses import dataclass
from pathlib import Path

from suite.errors import SceneError
from suite.geometry.tolerances import LARGEST

COLUMNS = 9


@dataclass(frozen=True, slots=True)
class Scenario:
    """A line of a scenario file.

    name : its number among the queries of the file, from 1.
    bucket : queries of one have about the same length.
    start, goal : x, y as they are written.
    length : of the shortest path, as the file has it.
    """

    name: str
    bucket: str
    start: tuple[float, float]
    goal: tuple[float, float]
    length: float


def scenario_file(path: Path) -> Path | None:
    """The scenario file beside a map: ``MAP.SUFFIX.scen``, or ``MAP.scen``; None without one."""
    beside = (path.with_name(f"{path.name}.scen"), path.with_suffix(".scen"))
    return next((file for file in beside if file.is_file()), None)


def read_scenarios(path: Path) -> list[Scenario]:
    """Read a scenario file.

    Raises
    ------
    SceneError
        With the line that can't be read.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"{path.name}: can't be read ({error}).") from error
    first = lines[0].split() if lines else []
    if first[:1] != ["version"] or first[1:] not in (["1"], ["1.0"]):
        raise SceneError(f"{path.name}, line 1: no scenario file. It begins with 'version 1'.")
    rows = [(i, line) for i, line in enumerate(lines[1:], 2) if line.strip()]
    return [
        _scenario(f"{path.name}, line {line_number}", str(number), line)
        for number, (line_number, line) in enumerate(rows, 1)
    ]


def _scenario(where: str, name: str, line: str) -> Scenario:
    fields = line.split("\t") if line.count("\t") >= COLUMNS - 1 else line.split()
    if len(fields) < COLUMNS:
        raise SceneError(
            f"{where}: {len(fields)} fields. A query has {COLUMNS}: bucket, map, width, height, "
            "start x, start y, goal x, goal y, length."
        )
    bucket, *numbers = (fields[0].strip(), *fields[-5:])
    try:
        x, y, to_x, to_y, length = (float(number) for number in numbers)
    except ValueError as error:
        raise SceneError(f"{where}: {error}. Start, goal and length are numbers.") from error
    if not max(map(abs, (x, y, to_x, to_y))) <= LARGEST or not 0.0 <= length < math.inf:
        raise SceneError(f"{where}: its numbers are not finite, or too large.")
    return Scenario(name, bucket, (x, y), (to_x, to_y), length)
