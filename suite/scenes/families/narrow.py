"""Narrow passages: a thick wall with one way through, and others that only seem to be."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely
from numpy.typing import NDArray

from suite.scenes.families.draft import SIDE, Draft, around, bar, between


@dataclass(frozen=True, slots=True)
class Narrow:
    """A wall across the room, one passage through it, and decoys that end inside.

    Hard for samplers, whose chance to hit the passage falls with its width; and for planners that
    follow the first opening: most are decoys, as wide as the passage is or wider.

    width : of the passage, metres.
    wall : thickness of the wall, metres.
    decoys : openings that end inside the wall, from either side.
    bends : of the passage.
    """

    width: float = 1.0
    wall: float = 25.0
    decoys: int = 4
    bends: int = 1

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random: widths from 0.2 to 4 m, each octave as likely."""
        width = float(np.exp(rng.uniform(np.log(0.2), np.log(4.0))))
        return cls(width, between(12.0, 40.0, rng), int(rng.integers(2, 7)), int(rng.integers(3)))

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw the openings in lanes of their own, so that none meets another one."""
        left, right = 0.5 * (SIDE - self.wall), 0.5 * (SIDE + self.wall)
        free = [shapely.box(0.0, 0.0, left, SIDE), shapely.box(right, 0.0, SIDE, SIDE)]
        lane = SIDE / (self.decoys + 1)
        passage = int(rng.integers(self.decoys + 1))
        for number in range(self.decoys + 1):
            middle, reach = (number + 0.5) * lane, 0.5 * lane - 2.5
            width, first, last = self.width, left, right
            if number != passage:
                width *= between(1.0, 3.0, rng)
                depth = between(0.5, 0.92, rng) * self.wall
                first, last = (left, left + depth) if rng.random() < 0.5 else (right - depth, right)
            places = self._places(first, last, middle, reach - 0.5 * width, rng)
            free.append(bar(_into_the_open(places, width, first == left, last == right), width))
        start = (between(4.0, 0.5 * left, rng), between(10.0, SIDE - 10.0, rng))
        goal = (SIDE - between(4.0, 0.5 * left, rng), between(10.0, SIDE - 10.0, rng))
        return Draft(around(free), start, goal)

    def _places(
        self, first: float, last: float, middle: float, sway: float, rng: np.random.Generator
    ) -> NDArray[np.float64]:
        """Where a corridor bends, and its ends (n, 2): at most ``sway`` metres from ``middle``."""
        columns = np.linspace(first, last, self.bends + 2)
        sway = max(min(sway, 0.5 * (columns[1] - columns[0])), 0.0)  # no bend sharper than square
        rows = middle + rng.uniform(-sway, sway, len(columns))
        return np.column_stack([columns, rows])


def _into_the_open(
    places: NDArray[np.float64], width: float, opens_left: bool, opens_right: bool
) -> NDArray[np.float64]:
    """A corridor that reaches so far out of the wall that its slanting end leaves no sliver."""
    longer = places.copy()
    for end, inner, opens in ((0, 1, opens_left), (-1, -2, opens_right)):
        if opens:
            ahead = places[end] - places[inner]
            longer[end] += ahead / np.hypot(*ahead) * width
    return longer
