"""Polygon meshes ``.mesh``: free space as convex cells, which any-angle planners search.

Version 2 is that of Polyanya (Cui, Harabor and Grastien 2017): all cells are free, numbers count
from 0, and a vertex names the cells around it. Version 3 (vleue/polyanya): numbers count from 1, a
vertex is a point alone, a cell says first whether it can be traversed, and an edge with a negative
neighbour can't be crossed. y is up in both.

The free cells are united, and what lies between them within their box is obstacle. Beside a map may
lie its queries, in ``FILE.mesh.scen`` or ``FILE.scen``; their lengths are those of shortest paths.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import TypeVar

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from suite.errors import SceneError
from suite.geometry.tolerances import LARGEST
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.polygons import drawing_of, solids
from suite.scenes.maps.scen import read_scen, scen_beside
from suite.scenes.maps.text import read_lines

VERSIONS = ("2", "3")

MOST = 10_000_000
"""Vertices or cells, so that a broken count does not take all memory."""

OVERLAP = 1e-6
"""Share of the free area that cells may have in common by rounding: meshes of several floors, which
lie above one another, have far more."""

T = TypeVar("T", int, float)


@dataclass(frozen=True, slots=True)
class _Cell:
    """number : for people. vertices : from 0. closed : edges (from, to) that can't be crossed."""

    number: int
    vertices: tuple[int, ...]
    closed: tuple[tuple[int, int], ...]


def read_mesh(path: Path, options: MapOptions) -> Drawing:
    """Read a polygon mesh of version 2 or 3, and the queries beside it.

    Returns
    -------
    Drawing
        Its properties hold the published lengths of its queries, which are those of Euclidean
        shortest paths.

    Raises
    ------
    SceneError
        With what is wrong and where: a count, a vertex, a cell, a line of the scenario file.
    """
    numbers = _Numbers(path)
    numbers.header()
    vertices, cells = numbers.count("vertices"), numbers.count("cells")
    xy = np.array([numbers.vertex(i) for i in range(vertices)]).reshape(-1, 2)
    free = [cell for i in range(cells) if (cell := numbers.cell(i, vertices)) is not None]
    numbers.end()
    space = _united(path, free, xy)
    room = shapely.box(*space.bounds)
    drawing = drawing_of(
        room,
        solids(room.difference(space)),
        simplify=options.simplify,
        properties={"format": f"polygon mesh {numbers.version}", "cells": cells},
    )
    return _with_queries(path, drawing)


class _Numbers:
    """The numbers of a file in turn, whatever white space lies between, each read as what it is."""

    def __init__(self, path: Path) -> None:
        lines = (line.partition("//")[0] for line in read_lines(path))  # comments of version 3
        self._words: Iterator[str] = (word for line in lines for word in line.split())
        self._name = path.name
        self.version = ""

    def header(self) -> None:
        """Read ``mesh`` and the version."""
        if next(self._words, "") != "mesh":
            raise SceneError(f"{self._name}: no polygon mesh. Its first line is 'mesh'.")
        self.version = next(self._words, "")
        if self.version not in VERSIONS:
            raise SceneError(
                f"{self._name}: a mesh of version {self.version[:20]!r}. Give one of version "
                f"{' or '.join(VERSIONS)}, as the second line says."
            )

    def count(self, what: str) -> int:
        """Read how many there are."""
        found = self._next(int, f"the number of {what}")
        if not 0 < found <= MOST:
            raise SceneError(f"{self._name}: it says that it has {found} {what}.")
        return found

    def vertex(self, index: int) -> tuple[float, float]:
        """Read a point, and over the cells around it."""
        what = f"vertex {index + self._first}"
        x, y = self._next(float, what), self._next(float, what)
        if not (abs(x) <= LARGEST and abs(y) <= LARGEST):  # so written, NaN is refused too
            raise SceneError(
                f"{self._name}, {what}: ({x}, {y}). Coordinates must be finite numbers, in metres, "
                f"up to {LARGEST:g}."
            )
        if self.version == "2":
            self._several(self._next(int, what), what)
        return x, y

    def cell(self, index: int, vertices: int) -> _Cell | None:
        """Read a cell; None if it is not free."""
        what = f"cell {index + self._first}"
        free = self.version == "2" or self._next(int, what) != 0
        sides = self._next(int, what)
        if sides < 3:
            raise SceneError(f"{self._name}, {what}: {sides} vertices. A cell has three or more.")
        corners = self._several(sides, what)
        neighbours = self._several(sides, what)
        for corner in corners:
            if not self._first <= corner < vertices + self._first:
                raise SceneError(
                    f"{self._name}, {what}: there is no vertex {corner}. They are numbered from "
                    f"{self._first} to {vertices - 1 + self._first} in version {self.version}."
                )
        own = tuple(corner - self._first for corner in corners)
        # The neighbour of an edge stands where the edge ends.
        edges = ((own[i - 1], own[i]) for i in range(sides))
        closed = tuple(e for e, cell in zip(edges, neighbours, strict=True) if self._is_shut(cell))
        return _Cell(index + self._first, own, closed) if free else None

    def end(self) -> None:
        """See that nothing is left."""
        left = next(self._words, None)
        if left is not None:
            raise SceneError(
                f"{self._name}: {left[:20]!r} stands behind the last cell. Mend the counts in its "
                "third line."
            )

    @property
    def _first(self) -> int:
        return 0 if self.version == "2" else 1

    def _is_shut(self, neighbour: int) -> bool:
        return neighbour < 0 if self.version == "2" else neighbour <= 0

    def _several(self, count: int, what: str) -> list[int]:
        words = list(islice(self._words, max(0, count)))
        if len(words) < count:
            raise SceneError(f"{self._name}, {what}: the file ends here.")
        return [self._as(int, word, what) for word in words]

    def _next(self, kind: type[T], what: str) -> T:
        word = next(self._words, None)
        if word is None:
            raise SceneError(f"{self._name}, {what}: the file ends here.")
        return self._as(kind, word, what)

    def _as(self, kind: type[T], word: str, what: str) -> T:
        try:
            return kind(word)
        except ValueError as error:
            whole = "whole number" if kind is int else "number"
            raise SceneError(f"{self._name}, {what}: {word[:20]!r} is no {whole}.") from error


def _refuse_thin_walls(path: Path, free: list[_Cell]) -> None:
    """Refuse an edge that free cells share and that can't be crossed: an obstacle has an area."""
    sides = {}
    for cell in free:
        sides.update({(cell.vertices[i - 1], v): cell for i, v in enumerate(cell.vertices)})
    for cell in free:
        for a, b in cell.closed:
            if (b, a) in sides:
                raise SceneError(
                    f"{path.name}: between the free cells {cell.number} and {sides[b, a].number} "
                    "is a wall without width. Give it some, for obstacles are polygons."
                )


def _united(path: Path, free: list[_Cell], xy: NDArray[np.float64]) -> BaseGeometry:
    cells = np.array([Polygon(xy[list(cell.vertices)]) for cell in free], dtype=object)
    wide = shapely.area(shapely.convex_hull(cells)) > 0.0  # one without area is no room
    wrong = np.flatnonzero(~shapely.is_valid(cells) & wide)
    if wrong.size:
        raise SceneError(
            f"{path.name}, cell {free[wrong[0]].number}: its edges cross. List its vertices in "
            "order."
        )
    if not wide.any():
        raise SceneError(f"{path.name}: no cell is free. There is nowhere to go.")
    _refuse_thin_walls(path, [cell for cell, is_wide in zip(free, wide, strict=True) if is_wide])
    space = shapely.union_all(cells[wide])
    areas = shapely.area(cells[wide])
    if areas.sum() > (1.0 + OVERLAP) * space.area:
        raise SceneError(
            f"{path.name}: its cells overlap, by {areas.sum() - space.area:g} of {space.area:g} "
            "square metres. A scene is flat: give the cells of one floor."
        )
    return space


def _with_queries(path: Path, drawing: Drawing) -> Drawing:
    file = scen_beside(path)
    if file is None:
        return drawing
    asked = read_scen(file)
    return replace(
        drawing,
        queries={query.name: (query.start, query.goal) for query in asked},
        strata={query.name: query.bucket for query in asked},
        properties={
            **drawing.properties,
            "published": {query.name: query.length for query in asked},
            "published_as": "euclidean",
        },
    )
