"""Rooms with clutter: rooms in rows, doors between them, and things that stand about in each."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely
from shapely.geometry import Point

from suite.scenes.families.clutter import Clutter
from suite.scenes.families.draft import SIDE, Draft, Place, around, between
from suite.scenes.placing import scatter


@dataclass(frozen=True, slots=True)
class RoomsWithClutter:
    """Rooms in rows and columns, a door between each two neighbours, and clutter in all of them.

    Hard because two things are: which doors to take, and how to get past what stands between two.
    What a planner learns of the one does not help with the other.

    rooms : along each side.
    door : width of a door, metres.
    wall : thickness of the walls, metres.
    pieces : in each room.
    closed : share of the doors that are closed, as far as all rooms can be reached without them.
    """

    rooms: int = 3
    door: float = 4.0
    wall: float = 1.5
    pieces: int = 4
    closed: float = 0.3

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random."""
        rooms = int(rng.integers(2, 5))
        return cls(
            rooms,
            between(2.0, 5.0, rng),
            between(0.8, 2.0, rng),
            int(rng.integers(2, 12 // rooms + 1)),
            between(0.0, 0.5, rng),
        )

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw rooms, doors and clutter; the last stays away from doors, start and goal."""
        side = (SIDE - (self.rooms + 1) * self.wall) / self.rooms
        corners = [self.wall + i * (side + self.wall) for i in range(self.rooms)]
        rooms = [shapely.box(x, y, x + side, y + side) for x in corners for y in corners]
        doors, sills = self._doors(corners, side, rng)
        start, goal = (corners[0] + 3.0,) * 2, (corners[-1] + side - 3.0,) * 2
        obstacles = around([*rooms, *doors])
        clutter = Clutter(self.pieces, cover=0.22)
        for room in rooms:
            around_it = room.buffer(1.0)
            near = [end for end in (start, goal, *sills) if around_it.intersects(Point(end))]
            pieces = clutter.thrown(rng, room.area)
            obstacles += scatter(pieces, [], 1.2, room, near, rng)
        return Draft(obstacles, start, goal)

    def _doors(
        self, corners: list[float], side: float, rng: np.random.Generator
    ) -> tuple[list[shapely.Polygon], list[Place]]:
        """Openings between neighbours, and a place on either side of each to be kept free."""
        ways = [((i, j), (i + 1, j)) for i in range(self.rooms - 1) for j in range(self.rooms)]
        ways += [((i, j), (i, j + 1)) for i in range(self.rooms) for j in range(self.rooms - 1)]
        doors: list[shapely.Polygon] = []
        sills: list[Place] = []
        joined = {(i, j): (i, j) for i in range(self.rooms) for j in range(self.rooms)}
        for number in rng.permutation(len(ways)):
            one, other = ways[number]
            is_needed = joined[one] != joined[other]
            if not is_needed and rng.random() < self.closed:
                continue
            new, old = joined[one], joined[other]
            joined = {room: new if part == old else part for room, part in joined.items()}
            at = between(0.2, 0.8, rng) * (side - self.door)
            x, y = corners[one[0]], corners[one[1]]
            if one[0] != other[0]:
                door = (x + side - 0.01, y + at, x + side + self.wall + 0.01, y + at + self.door)
                middle = y + at + 0.5 * self.door
                sills += [(x + side - 0.5, middle), (x + side + self.wall + 0.5, middle)]
            else:
                door = (x + at, y + side - 0.01, x + at + self.door, y + side + self.wall + 0.01)
                middle = x + at + 0.5 * self.door
                sills += [(middle, y + side - 0.5), (middle, y + side + self.wall + 0.5)]
            doors.append(shapely.box(*door))
        return doors, sills
