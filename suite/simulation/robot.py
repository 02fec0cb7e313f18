"""The robot: a point that follows its path at constant speed, or waits.

Its places are rounded to the grid of the obstacles, as all starts are. On its way along a slanted
wall it would so stand in the wall by less than the grid: :meth:`Robot.settle` finds the free place
beside it. Seconds, metres.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from suite.geometry.coordinates import Coordinates
from suite.geometry.kernels import first_collision, segment_enters
from suite.scenes.scene import Scene
from suite.simulation.trajectory import Trajectory, make_trajectory

Path = NDArray[np.float64]


class Robot:
    """A point robot on its way.

    Parameters
    ----------
    start : (2,) float64, metres.
    speed : metres per second.
    coordinates : of the scene.

    Attributes
    ----------
    time : seconds.
    place : (2,) float64, metres.
    path : (n, 2) float64, metres, what lies ahead, from ``place`` on; None if it has no path.
    """

    def __init__(self, start: NDArray[np.float64], speed: float, coordinates: Coordinates) -> None:
        self.time = 0.0
        self._coordinates = coordinates
        self.place = self._on_grid(start)
        self.path: Path | None = None
        self._speed = speed
        self._rows = [(0.0, *self.place.tolist())]

    @property
    def trajectory(self) -> Trajectory:
        """Where it has been so far."""
        return make_trajectory(self._rows)

    @property
    def has_arrived(self) -> bool:
        """Whether it has come to the end of a path."""
        return self.path is not None and len(self.path) == 1

    def ahead(self, duration: float) -> Path | None:
        """The part of its path that it covers in that time: (n, 2), metres."""
        if self.path is None:
            return None
        passed, rest = self._cut(self.path, duration * self._speed)
        return np.vstack([*passed, rest[:1]])

    def drive(self, until: float) -> list[NDArray[np.float64]]:
        """Follow the path until a time, or to its end, whichever is first; the places passed."""
        if self.path is None or self.has_arrived:
            self.wait(until)
            return []
        passed, rest = self._cut(self.path, (until - self.time) * self._speed)
        places = [*passed[1:], rest[0]]
        for place in places:
            distance = float(np.hypot(*(place - self.place)))
            self._note(min(until, self.time + distance / self._speed), place)
        self.path = rest
        if not self.has_arrived:  # but for rounding it is that time already
            self._rows[-1] = (until, *self.place.tolist())
            self.time = until
        return places

    def wait(self, until: float) -> None:
        """Stay until a time."""
        if until > self.time:
            self._note(until, self.place)

    def settle(self, scene: Scene) -> bool:
        """Stand on the grid, in free space of a static scene; whether there is any within reach.

        Reach is the depth of a hit: what is deeper in an obstacle was hit by it. Of the places
        around, one from which the path ahead stays as free as it was.
        """
        fallback = None
        for place in self._places_around():
            x, y = place.tolist()
            if segment_enters(x, y, x, y, scene.arrays):
                continue
            fallback = place if fallback is None else fallback
            path = self._path_from(place)
            if path is None or first_collision(path[:2], scene.arrays) < 0:
                self._move_to(place)
                return True
        if fallback is None:
            return False
        self._move_to(fallback)
        return True

    def _path_from(self, place: NDArray[np.float64]) -> Path | None:
        if self.path is None or self.has_arrived:
            return None
        return np.vstack([place, self.path[1:]])

    def _move_to(self, place: NDArray[np.float64]) -> None:
        if not self.has_arrived:
            self.path = self._path_from(place)
            self.place = place
            self._rows[-1] = (self.time, *place.tolist())

    def _note(self, time: float, place: NDArray[np.float64]) -> None:
        self.time, self.place = time, place
        self._rows.append((time, *place.tolist()))

    def _on_grid(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """The same place on the grid of the obstacles, read-only."""
        snapped = self._coordinates.snapped(place)
        snapped.setflags(write=False)
        return snapped

    def _places_around(self) -> Iterator[NDArray[np.float64]]:
        yield self._on_grid(self.place)
        step = self._coordinates.grid
        while step < 4.0 * self._coordinates.hit_depth:
            for dx in (0, 1, -1):
                for dy in (0, 1, -1):
                    if dx or dy:
                        yield self._on_grid(self.place + np.array([dx, dy]) * step)
            step *= 4.0

    def _cut(self, path: Path, reach: float) -> tuple[list[NDArray[np.float64]], Path]:
        """The waypoints passed within a distance, and the path from the place where that ends.

        What is left begins at that place; at the end of the path, it is its last point alone.
        """
        passed = [path[0]]
        for i in range(len(path) - 1):
            step = path[i + 1] - path[i]
            length = float(np.hypot(*step))
            if length > reach:
                place = self._on_grid(path[i] + step * (reach / length))
                return passed, np.vstack([place, path[i + 1 :]])
            reach -= length
            passed.append(path[i + 1])
        return passed[:-1], path[-1:]
