"""Spirals: a wall wound around the start."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from suite.scenes.families.draft import SIDE, Draft, bar, between, within_room

CORE = 7.0
"""Radius of the free space around the start, metres."""

OUTER = 44.0
"""Radius at which the wall ends, metres."""


@dataclass(frozen=True, slots=True)
class Spiral:
    """A wall that winds around the start, with the goal outside.

    Hard for planners with an idea of the direction: the way leads around and around, off from the
    goal for half of each turn, and no part of it can be cut off.

    turns : of the wall.
    sides : of each turn; the wall bends at as many corners.
    thickness : of the wall, as a share of the distance between two turns.
    arms : walls that wind beside each other, 1 or 2; with two there are two corridors.
    """

    turns: float = 2.5
    sides: int = 12
    thickness: float = 0.3
    arms: int = 1

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random."""
        arms = int(rng.integers(1, 3))
        turns = between(1.3, 3.6 / arms + 0.4, rng)
        return cls(turns, int(rng.integers(5, 17)), between(0.15, 0.45, rng), arms)

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw the wall (Archimedes' spiral, in straight pieces)."""
        pitch = (OUTER - CORE) / self.turns
        steps = np.arange(0.0, self.turns * self.sides + 1e-9) / self.sides  # of a turn
        hand, first = rng.choice([-1.0, 1.0]), between(0.0, 1.0, rng)
        walls = []
        for arm in range(self.arms):
            angles = 2.0 * np.pi * (first + hand * (steps + arm / self.arms))
            radii = CORE + pitch * steps
            places = SIDE / 2.0 + radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
            walls.append(bar(places, self.thickness * pitch / self.arms))
        corner = [(5.0, 5.0), (SIDE - 5.0, 5.0), (SIDE - 5.0, SIDE - 5.0), (5.0, SIDE - 5.0)]
        x, y = corner[rng.integers(4)]
        return Draft(within_room(walls), (SIDE / 2.0, SIDE / 2.0), (x, y))
