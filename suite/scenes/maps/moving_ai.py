"""Moving AI's grids: a .map of cells, and the queries of a .scen file beside it.

After https://movingai.com/benchmarks/formats.html and Sturtevant (2012), Benchmarks for grid-based
pathfinding, IEEE TCIAIG 4(2). A cell is a square of a metre. Free are passable terrain (``.`` and
``G``) and swamp (``S``, which is "passable from regular terrain", here as fast as that). All other
letters are blocked: out of bounds (``@``, ``O``), trees (``T``), and water (``W``), which is
"traversable, but not passable from terrain": no way leads from one to the other.

Their lengths are of paths on the grid, from centre to centre of neighbouring cells, never across
the corner of a blocked one: an upper bound of the optimum, which the properties of a scene have as
``published``.
"""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from suite.errors import SceneError
from suite.scenes.maps.drawing import Drawing, Point
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.pixels import drawing_of
from suite.scenes.maps.scen import Asked, map_of, read_scen, scen_beside
from suite.scenes.maps.text import read_lines

FREE = ".GS"
SUFFIX = ".map"
HEADER = ("type octile", "height H", "width W", "map")
LARGEST_SIDE = 100_000


def read_grid(path: Path, options: MapOptions) -> Drawing:
    """Read a .map, with the queries of the .scen file beside it, if there is one.

    Raises
    ------
    SceneError
        If either can't be read, or the queries are of a map of another size.
    """
    scen = scen_beside(path)
    return _drawing(path, scen, read_scen(scen) if scen else (), options)


def read_queries(path: Path, options: MapOptions) -> Drawing:
    """Read a .scen file, with the .map that it names.

    Raises
    ------
    SceneError
        If either can't be read, or the queries are of a map of another size.
    """
    asked = read_scen(path)
    if not asked:
        raise SceneError(f"{path.name}: has no queries, and so names no map. Name the map itself.")
    grid = map_of(path, asked)
    if grid.suffix.lower() != SUFFIX:
        raise SceneError(
            f"{path.name}: is of {grid.name}, which is no grid. Name that: its queries come along."
        )
    return _drawing(grid, path, asked, options)


def _drawing(
    path: Path, scen: Path | None, asked: tuple[Asked, ...], options: MapOptions
) -> Drawing:
    cells = _cells(path)
    occupied = ~np.isin(cells, list(FREE))
    drawing = drawing_of(occupied, simplify=options.simplify)
    height, width = cells.shape
    blocked = "".join(np.unique(cells[occupied]).tolist())
    properties = {"format": "Moving AI", "cells": f"{width} x {height}", "blocked_letters": blocked}
    if scen is None:
        return Drawing(drawing.workspace, drawing.obstacles, properties=properties)
    for query in asked:
        if (query.width, query.height) != (width, height):
            raise SceneError(
                f"{scen.name}, query {query.name}: is of a map of {query.width:g} x "
                f"{query.height:g} cells, but {path.name} has {width} x {height}. "
                "Put the queries of this map beside it."
            )
    return Drawing(
        drawing.workspace,
        drawing.obstacles,
        queries={q.name: (_centre(q.start, height), _centre(q.goal, height)) for q in asked},
        strata={q.name: q.bucket for q in asked},
        properties=properties
        | {"published": {q.name: q.length for q in asked}, "published_as": "octile"},
    )


def _centre(cell: Point, height: int) -> Point:
    """The centre of a cell, given by its column and row from the upper left."""
    return cell[0] + 0.5, height - (cell[1] + 0.5)


def _cells(path: Path) -> NDArray[np.str_]:
    """The letters of a map, (rows, columns), the upper row first."""
    lines = [line.rstrip() for line in read_lines(path)]
    height, width = _size(path, lines[: len(HEADER)])
    rows = lines[len(HEADER) :]
    while rows and not rows[-1]:
        rows.pop()
    if len(rows) != height:
        raise SceneError(
            f"{path.name}: has {len(rows)} rows of cells, but its height is {height}. "
            "Give a row a line, and nothing behind them."
        )
    for number, row in enumerate(rows, len(HEADER) + 1):
        if len(row) != width:
            raise SceneError(
                f"{path.name}, line {number}: a row of {len(row)} cells, but its width is {width}. "
                "Give a letter a cell."
            )
        if not row.isprintable() or not row.isascii() or " " in row:
            raise SceneError(f"{path.name}, line {number}: cells are letters. Free are {FREE}.")
    return np.array([list(row) for row in rows], dtype="U1")


def _size(path: Path, header: list[str]) -> tuple[int, int]:
    """The height and width that a map's header states."""
    patterns = (r"type\s+octile", r"height\s+([0-9]{1,9})", r"width\s+([0-9]{1,9})", "map")
    sizes = []
    for number, (wanted, pattern) in enumerate(zip(HEADER, patterns, strict=True), 1):
        line = header[number - 1].strip() if len(header) >= number else ""
        found = re.fullmatch(pattern, line)
        if found is None:
            raise SceneError(
                f"{path.name}, line {number}: not '{wanted}', as maps of Moving AI begin. "
                f"Its first lines are {', '.join(HEADER)}."
            )
        sizes += [int(size) for size in found.groups()]
    height, width = sizes
    if not (0 < height <= LARGEST_SIDE and 0 < width <= LARGEST_SIDE):
        raise SceneError(
            f"{path.name}: {width} x {height} cells. Give 1 to {LARGEST_SIDE} along each side."
        )
    return height, width
