"""Offices: corridors with rooms on both sides, and doors."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely
from shapely.geometry import Polygon

from suite.scenes.families.draft import SIDE, Draft, Place, around, between

SILL = 1e-3
"""Metres that a door reaches into the rooms, so that no sliver of wall is left in it."""


@dataclass(frozen=True, slots=True)
class Office:
    """Rows of rooms along parallel corridors, which a cross corridor joins.

    Hard for planners that sample the whole floor, for most of it is rooms that lead nowhere; and
    for those that go straight: the way is out of a door, along corridors, and in at another one.

    corridors : parallel ones.
    corridor : their width, metres.
    door : width of a door, metres.
    wall : thickness of the walls, metres.
    through : share of neighbouring rooms with a door between them, a way besides the corridor.
    """

    corridors: int = 2
    corridor: float = 6.0
    door: float = 2.0
    wall: float = 0.8
    through: float = 0.2

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random."""
        return cls(
            int(rng.integers(1, 4)),
            between(3.0, 8.0, rng),
            between(1.0, 3.0, rng),
            between(0.4, 1.2, rng),
            between(0.0, 0.4, rng),
        )

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw the floor from below: a row of rooms, a corridor, two rows, a corridor, a row."""
        wall, floor = self.wall, SIDE - self.wall
        depth = (SIDE - self.corridors * (self.corridor + 2.0 * wall)) / (2.0 * self.corridors)
        cross = between(0.3, 0.7, rng) * SIDE
        free = [shapely.box(cross, wall, cross + self.corridor, floor)]
        halves = ((wall, cross - wall), (cross + self.corridor + wall, floor))
        ends: list[Place] = []
        for number in range(self.corridors):
            bottom = number * (2.0 * depth + self.corridor + 2.0 * wall) + depth + wall
            top = bottom + self.corridor
            free.append(shapely.box(wall, bottom, floor, top))
            below = (bottom - wall - depth + (wall if number == 0 else 0.5 * wall), bottom - wall)
            last = number == self.corridors - 1
            above = (top + wall, top + wall + depth - (wall if last else 0.5 * wall))
            for low, high, door_at in ((*below, bottom - wall), (*above, top)):
                for left, right in halves:
                    rooms = self._row(left, right, low, high, rng)
                    free += [*rooms, *self._doors(rooms, door_at, rng)]
                    ends += [_somewhere(room, rng) for room in rooms]
        return Draft(around(free), ends[0], ends[-1])

    def _row(
        self, left: float, right: float, low: float, high: float, rng: np.random.Generator
    ) -> list[Polygon]:
        """Rooms of random widths beside each other."""
        count = max(1, round((right - left) / between(12.0, 22.0, rng)))
        # No room is narrower than half of an even one: each has place for its door.
        shares = 0.5 / count + 0.5 * rng.dirichlet(np.full(count, 6.0))
        walls = np.concatenate([[0.0], np.cumsum(shares)]) * (right - left + self.wall)
        edges = left + walls
        return [shapely.box(edges[i], low, edges[i + 1] - self.wall, high) for i in range(count)]

    def _doors(
        self, rooms: list[Polygon], door_at: float, rng: np.random.Generator
    ) -> list[Polygon]:
        """A door of each room to the corridor, and some to the next room."""
        doors = []
        for number, room in enumerate(rooms):
            left, low, right, high = room.bounds
            begin = between(left, right - self.door, rng)
            low_sill, high_sill = door_at - SILL, door_at + self.wall + SILL
            doors.append(shapely.box(begin, low_sill, begin + self.door, high_sill))
            if number + 1 < len(rooms) and rng.random() < self.through:
                begin = between(low, high - self.door, rng)
                doors.append(
                    shapely.box(right - SILL, begin, right + self.wall + SILL, begin + self.door)
                )
        return doors


def _somewhere(room: Polygon, rng: np.random.Generator) -> Place:
    """A place in a room, not near its walls."""
    left, low, right, high = room.bounds
    return (
        left + between(0.25, 0.75, rng) * (right - left),
        low + between(0.25, 0.75, rng) * (high - low),
    )
