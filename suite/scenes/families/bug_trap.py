"""Bug traps: a vessel whose mouth leads inwards, open on the far side of the goal."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from shapely import affinity
from shapely.geometry import Polygon

from suite.scenes.families.draft import ROOM, SIDE, Draft, Place, bar, between, within_room

APART = 3.0
"""Metres of a vessel from the border and from another one."""

TRIES = 200
"""Directions that are tried until the vessels stand so far apart."""


@dataclass(frozen=True, slots=True)
class BugTrap:
    """A vessel around the start, out of which only a neck leads that reaches into it.

    Hard for trees that grow from the start: they fill the vessel, and the mouth is met from the
    wrong side (the bug trap of motion planning's benchmarks). With two traps the goal lies in one,
    too, and trees from both ends are caught.

    size : of a vessel, metres.
    mouth : width of the neck, metres.
    neck : how far the neck reaches in, as a share of the vessel's size.
    traps : 1, around the start, or 2, around the goal as well.
    """

    size: float = 36.0
    mouth: float = 5.0
    neck: float = 0.35
    traps: int = 1

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random."""
        traps = int(rng.integers(1, 3))
        size = between(38.0, 58.0, rng) if traps == 1 else between(28.0, 40.0, rng)
        return cls(size, between(1.0, 7.0, rng), between(0.2, 0.5, rng), traps)

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw the vessels, their mouths turned away from the middle of the room, more or less."""
        thickness = between(1.0, 2.5, rng)
        low, high = (0.27 * SIDE, 0.73 * SIDE) if self.traps == 2 else (0.4 * SIDE, 0.94 * SIDE)
        start, goal = (low, between(30.0, 70.0, rng)), (high, between(30.0, 70.0, rng))
        for _ in range(TRIES):
            walls = [self._vessel(start, 180.0 + between(-70.0, 70.0, rng), thickness)]
            if self.traps == 2:
                walls.append(self._vessel(goal, between(-70.0, 70.0, rng), thickness))
            if _stand_apart(walls):
                break
        return Draft(within_room(walls), start, goal)

    def _vessel(self, place: Place, turn: float, thickness: float) -> Polygon:
        """A vessel around a place, its mouth in the direction of ``turn`` degrees."""
        half, lip = 0.5 * self.size, 0.5 * (self.mouth + thickness)
        inner = half - self.neck * self.size
        outline = [(inner, lip), (half, lip), (0.6 * half, half), (-0.6 * half, half), (-half, lip)]
        outline += [(x, -y) for x, y in reversed(outline)]
        vessel = affinity.rotate(bar(outline, thickness), turn, origin=(0.0, 0.0))
        # The place lies between the end of the neck and the bottom.
        back = np.radians(turn)
        away = 0.5 * (half - inner)
        x, y = place[0] + away * np.cos(back), place[1] + away * np.sin(back)
        return affinity.translate(vessel, x, y)


def _stand_apart(walls: list[Polygon]) -> bool:
    """Whether vessels lie apart from the border and, where there are two, from each other."""
    inner = ROOM.buffer(-APART)
    are_inside = all(inner.contains(wall) for wall in walls)
    return are_inside and (len(walls) == 1 or walls[0].distance(walls[1]) >= APART)
