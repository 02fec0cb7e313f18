"""Forests: trees of many sizes, as polygons of 12 to 24 sides."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from shapely.geometry import Polygon

from suite.scenes.families.draft import ROOM, Draft, between
from suite.scenes.placing import scatter

START, GOAL = (5.0, 5.0), (95.0, 95.0)


@dataclass(frozen=True, slots=True)
class Forest:
    """Discs that stand apart, of 12 to 24 sides.

    Hard for planners that bend at corners, as the exact ones do: a forest has thousands, and no
    path is much better than many others. Easy for samplers.

    trees : how many.
    cover : share of the room that they cover.
    gap : metres between two, at the least.
    """

    trees: int = 80
    cover: float = 0.2
    gap: float = 1.0

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random."""
        return cls(int(rng.integers(30, 161)), between(0.1, 0.28, rng), between(0.4, 1.2, rng))

    def draft(self, rng: np.random.Generator) -> Draft:
        """Throw the trees, the largest first."""
        sizes = rng.lognormal(0.0, 0.4, self.trees).clip(0.4, 2.5)
        radii = np.sort(sizes)[::-1] * np.sqrt(self.cover * 1e4 / (np.pi * np.sum(sizes**2)))
        trees = [_disc(float(radius), int(rng.integers(12, 25)), rng) for radius in radii]
        return Draft(scatter(trees, [], self.gap, ROOM, (START, GOAL), rng), START, GOAL)


def _disc(radius: float, sides: int, rng: np.random.Generator) -> Polygon:
    angles = 2.0 * np.pi * (np.arange(sides) + rng.random()) / sides
    return Polygon(radius * np.column_stack([np.cos(angles), np.sin(angles)]))
