"""Scattered obstacles of arbitrary shape and size, as :mod:`suite.scenes.scattered` draws them."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from suite.scenes.families.draft import Draft
from suite.scenes.scattered import GOAL, START, scattered


@dataclass(frozen=True, slots=True)
class Scattering:
    """Obstacles of arbitrary shape and size, convex and concave, that stand apart.

    The paper's own kind (Fig. 14). Hard for planners that keep to the first way past each obstacle:
    there are as many sides to choose as obstacles. Easy for samplers.

    obstacles : convex parts.
    """

    obstacles: int = 60

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random: 20 to 200 parts, each octave as likely."""
        return cls(round(float(np.exp(rng.uniform(np.log(20.0), np.log(200.0))))))

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw the obstacles."""
        scene = scattered(self.obstacles, int(rng.integers(2**31)))
        return Draft([obstacle.polygon for obstacle in scene.obstacles], START, GOAL)
