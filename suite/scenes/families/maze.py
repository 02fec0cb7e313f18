"""Mazes: cells with walls between them, of which a spanning tree is open."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely

from suite.scenes.families.draft import SIDE, Draft, around, between

Cell = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Maze:
    """A maze of square cells, from one corner to the opposite one.

    Hard for planners that improve a path locally, for the way is all turns and every wrong turn
    ends in a blind alley; and for samplers, which must hit each corridor. A braided maze has loops:
    several ways, of which most are wrong.

    cells : along each side.
    wall : width of a wall, as a share of a cell's side.
    braid : share of the blind alleys that are opened; 0: a perfect maze, with one way.
    """

    cells: int = 6
    wall: float = 0.25
    braid: float = 0.0

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random: as many perfect mazes as braided ones."""
        braid = between(0.3, 1.0, rng) if rng.random() < 0.5 else 0.0
        return cls(int(rng.integers(4, 9)), between(0.15, 0.4, rng), braid)

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw a maze: passages by a random walk that turns back where it has to (depth first)."""
        open_ways = self._spanning_tree(rng)
        self._braid(open_ways, rng)
        side = SIDE / self.cells
        inset = 0.5 * self.wall * side
        rooms = [self._room(cell, cell, side, inset) for cell in self._all_cells()]
        passages = [self._room(*way, side, inset) for way in sorted(open_ways)]
        middle = 0.5 * side
        return Draft(around([*rooms, *passages]), (middle, middle), (SIDE - middle, SIDE - middle))

    def _all_cells(self) -> list[Cell]:
        return [(i, j) for i in range(self.cells) for j in range(self.cells)]

    def _neighbours(self, cell: Cell) -> list[Cell]:
        i, j = cell
        beside = ((i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1))
        return [(k, m) for k, m in beside if 0 <= k < self.cells and 0 <= m < self.cells]

    def _spanning_tree(self, rng: np.random.Generator) -> set[tuple[Cell, Cell]]:
        """Ways between neighbours, the lesser first, that join all cells and hold no loop."""
        ways: set[tuple[Cell, Cell]] = set()
        seen, walk = {(0, 0)}, [(0, 0)]
        while walk:
            new = [cell for cell in self._neighbours(walk[-1]) if cell not in seen]
            if not new:
                walk.pop()
                continue
            cell = new[rng.integers(len(new))]
            ways.add(_way(walk[-1], cell))
            seen.add(cell)
            walk.append(cell)
        return ways

    def _braid(self, ways: set[tuple[Cell, Cell]], rng: np.random.Generator) -> None:
        """Open blind alleys, each with a probability, into another neighbour."""
        for cell in self._all_cells():
            beside = self._neighbours(cell)
            closed = [other for other in beside if _way(cell, other) not in ways]
            if len(beside) - len(closed) == 1 and rng.random() < self.braid:
                ways.add(_way(cell, closed[rng.integers(len(closed))]))

    @staticmethod
    def _room(one: Cell, other: Cell, side: float, inset: float) -> shapely.Polygon:
        """The free space of one cell, or of two neighbours and the passage between them."""
        (i, j), (k, m) = one, other
        return shapely.box(
            i * side + inset, j * side + inset, (k + 1) * side - inset, (m + 1) * side - inset
        )


def _way(one: Cell, other: Cell) -> tuple[Cell, Cell]:
    return (one, other) if one < other else (other, one)
