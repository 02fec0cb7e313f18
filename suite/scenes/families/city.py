"""Cities: blocks between streets, some with a yard."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely
from shapely.geometry import Polygon

from suite.scenes.families.draft import SIDE, Draft, between, polygons_of


@dataclass(frozen=True, slots=True)
class City:
    """Blocks between streets that run through; some have a yard with a gateway, some are parks.

    Hard because of its many ways of nearly the same length: a planner that settles on the first is
    a few per cent off. Yards with one gateway are traps.

    blocks : along each side.
    street : mean width of a street, metres.
    yards : share of the blocks with a yard.
    parks : share of the blocks that are free.
    """

    blocks: int = 5
    street: float = 5.0
    yards: float = 0.4
    parks: float = 0.1

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random."""
        blocks = int(rng.integers(3, 8))
        street = between(0.12, 0.35, rng) * SIDE / blocks
        return cls(blocks, street, between(0.2, 0.7, rng), between(0.0, 0.2, rng))

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw streets of random widths at random distances, and what stands between them."""
        columns, rows = (self._spans(rng) for _ in range(2))
        obstacles: list[Polygon] = []
        for left, right in columns:
            for low, high in rows:
                if rng.random() < self.parks:
                    continue
                block = shapely.box(left, low, right, high)
                has_yard = rng.random() < self.yards
                obstacles += polygons_of(self._with_yard(block, rng) if has_yard else block)
        start = (0.5 * columns[0][0], 0.5 * rows[0][0])
        goal = (0.5 * (columns[-1][1] + SIDE), 0.5 * (rows[-1][1] + SIDE))
        if rng.random() < 0.5:  # from one side of the town to the other one, not across it
            start, goal = (start[0], goal[1]), (goal[0], start[1])
        return Draft(obstacles, start, goal)

    def _spans(self, rng: np.random.Generator) -> list[tuple[float, float]]:
        """Where blocks begin and end along one side: streets are around all of them."""
        streets = self.street * rng.uniform(0.6, 1.4, self.blocks + 1)
        widths = rng.dirichlet(np.full(self.blocks, 10.0)) * (SIDE - streets.sum())
        begin = np.cumsum(streets)[:-1] + np.concatenate([[0.0], np.cumsum(widths)[:-1]])
        return list(zip(begin.tolist(), (begin + widths).tolist(), strict=True))

    def _with_yard(self, block: Polygon, rng: np.random.Generator) -> shapely.Geometry:
        """A block around a yard, which a gateway through one of its sides leads into."""
        left, low, right, high = block.bounds
        width, height = right - left, high - low
        deep = between(0.2, 0.3, rng) * min(width, height)
        yard = shapely.box(left + deep, low + deep, right - deep, high - deep)
        side, gate = int(rng.integers(4)), between(0.15, 0.4, rng)
        x, y = (left + deep, low + deep)
        wide, high_ = width - 2.0 * deep, height - 2.0 * deep
        at = between(0.0, 1.0 - gate, rng)
        gateway = (
            shapely.box(x + at * wide, low - 1.0, x + (at + gate) * wide, low + deep + 1e-3),
            shapely.box(x + at * wide, high - deep - 1e-3, x + (at + gate) * wide, high + 1.0),
            shapely.box(left - 1.0, y + at * high_, left + deep + 1e-3, y + (at + gate) * high_),
            shapely.box(right - deep - 1e-3, y + at * high_, right + 1.0, y + (at + gate) * high_),
        )[side]
        return block.difference(shapely.union_all([yard, gateway]))
