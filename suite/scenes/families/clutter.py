"""Clutter: letters, hooks and stars, as the paper's clustered environment has them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely
from shapely import affinity
from shapely.geometry import Polygon

from suite.scenes.families.draft import ROOM, Draft, Place, bar, between, polygons_of
from suite.scenes.placing import scatter

START, GOAL = (5.0, 5.0), (95.0, 95.0)

_LETTERS: Mapping[str, list[list[Place]]] = {
    "L": [[(0, 2), (0, 0), (1.4, 0)]],
    "T": [[(-1, 1), (1, 1)], [(0, 1), (0, -1)]],
    "U": [[(0, 2), (0, 0), (1.5, 0), (1.5, 2)]],
    "E": [[(1.3, 2), (0, 2), (0, 0), (1.3, 0)], [(0, 1), (1.1, 1)]],
    "H": [[(0, 0), (0, 2)], [(1.4, 0), (1.4, 2)], [(0, 1), (1.4, 1)]],
    "Z": [[(0, 2), (1.5, 2), (0, 0), (1.5, 0)]],
    "hook": [[(0, 0), (0, 2), (1.3, 2), (1.3, 1)]],
    "C": [[(1.4, 1.6), (1.4, 2), (0, 2), (0, 0), (1.4, 0), (1.4, 0.4)]],
}
"""Strokes of each letter, in units of its own."""


@dataclass(frozen=True, slots=True)
class Clutter:
    """Letters, hooks and stars of all sizes, close together.

    Hard because of its hollows: a repair that goes around the nearest corner ends in one, and the
    convex parts that an obstacle is cut into say nothing of them.

    pieces : how many.
    cover : share of the room that their convex hulls cover.
    gap : metres between two, at the least.
    stars : share of the pieces that are stars.
    """

    pieces: int = 20
    cover: float = 0.35
    gap: float = 1.5
    stars: float = 0.3

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random."""
        return cls(
            int(rng.integers(10, 41)),
            between(0.25, 0.42, rng),
            between(0.8, 2.0, rng),
            between(0.1, 0.5, rng),
        )

    def draft(self, rng: np.random.Generator) -> Draft:
        """Throw the pieces, the largest first."""
        return Draft(scatter(self.thrown(rng), [], self.gap, ROOM, (START, GOAL), rng), START, GOAL)

    def thrown(self, rng: np.random.Generator, room: float = 1e4) -> list[Polygon]:
        """Pieces around the origin, the largest first, for ``room`` square metres."""
        shares = np.sort(rng.lognormal(0.0, 0.6, self.pieces).clip(0.3, 3.0))[::-1]
        areas = self.cover * room * shares / shares.sum()
        return [self._piece(float(area), rng) for area in areas]

    def _piece(self, area: float, rng: np.random.Generator) -> Polygon:
        """A star or a letter, turned, whose convex hull has an area (square metres)."""
        draw: Callable[[np.random.Generator], Polygon]
        draw = _star if rng.random() < self.stars else _letter
        piece = affinity.rotate(draw(rng), between(0.0, 360.0, rng), origin=(0.0, 0.0))
        hull = piece.convex_hull
        piece = affinity.translate(piece, -hull.centroid.x, -hull.centroid.y)
        factor = float(np.sqrt(area / hull.area))
        return affinity.scale(piece, factor, factor, origin=(0.0, 0.0))


def _letter(rng: np.random.Generator) -> Polygon:
    strokes = list(_LETTERS.values())[rng.integers(len(_LETTERS))]
    width = between(0.3, 0.5, rng)
    [letter] = polygons_of(shapely.union_all([bar(stroke, width) for stroke in strokes]))
    return letter


def _star(rng: np.random.Generator) -> Polygon:
    """Of four to seven points."""
    points = int(rng.integers(4, 8))
    angles = np.pi * np.arange(2 * points) / points
    radii = np.where(np.arange(2 * points) % 2 == 0, 1.0, between(0.35, 0.55, rng))
    return Polygon(radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)]))
