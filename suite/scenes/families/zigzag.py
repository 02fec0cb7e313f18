"""Zigzags: walls from either side in turn, with a gap at the end of each."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely

from suite.scenes.families.draft import SIDE, Draft, between, within_room

MARGIN = 8.0
"""Metres in front of the first wall and behind the last one."""

JITTER = 0.25
"""Of the distance between walls, by which each is moved at the most."""


@dataclass(frozen=True, slots=True)
class Zigzag:
    """Parallel walls, each with a gap at one end; or a comb, with all gaps at the same side.

    Hard for planners that take short cuts through obstacles at a price, for every straight line
    meets all walls; and, with many walls, for those that allow a path only so many bends. A comb
    leads into its teeth: each is a blind alley in the direction of the goal.

    walls : how many.
    gap : width of the gaps, metres.
    thickness : of a wall, metres.
    comb : whether all gaps are at the same side.
    """

    walls: int = 5
    gap: float = 8.0
    thickness: float = 3.0
    comb: bool = False

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random."""
        walls = int(rng.integers(3, 11))
        gap, thickness = between(2.0, 14.0, rng), between(1.0, 4.0, rng)
        return cls(walls, gap, thickness, bool(rng.random() < 0.3))

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw the walls, none where the other would stand without its jitter."""
        pitch = (SIDE - 2.0 * MARGIN) / self.walls
        obstacles = []
        for number in range(self.walls):
            middle = MARGIN + pitch * (number + 0.5 + between(-JITTER, JITTER, rng))
            gap = self.gap * between(0.7, 1.3, rng)
            left, right = middle - 0.5 * self.thickness, middle + 0.5 * self.thickness
            is_low = self.comb or number % 2 == 0
            low, high = (-1.0, SIDE - gap) if is_low else (gap, SIDE + 1.0)
            obstacles.append(shapely.box(left, low, right, high))
        start = (0.4 * MARGIN, between(5.0, 60.0, rng))
        goal = (SIDE - 0.4 * MARGIN, between(5.0, 60.0, rng))
        return Draft(within_room(obstacles), start, goal)
