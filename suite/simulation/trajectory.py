"""Where a robot was when: a path in time, piecewise linear. Seconds, metres."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """A way through plane and time. Made by :func:`make_trajectory`.

    times : (n,) float64, seconds, not falling, n >= 1, read-only.
    xy : (n, 2) float64, metres, read-only. Between two times the robot moves along the straight
        line at constant speed.
    """

    times: NDArray[np.float64]
    xy: NDArray[np.float64]

    @property
    def length(self) -> float:
        """Metres travelled."""
        return float(self._steps().sum())

    @property
    def waiting_s(self) -> float:
        """Seconds in which the robot did not move."""
        return float(np.diff(self.times)[self._steps() == 0.0].sum())

    @property
    def end(self) -> float:
        """The last time, seconds."""
        return float(self.times[-1])

    def at(self, times: ArrayLike) -> NDArray[np.float64]:
        """(m, 2), the places at m times, metres; the ends hold before and after."""
        wanted = np.atleast_1d(np.asarray(times, dtype=np.float64))
        return np.stack([np.interp(wanted, self.times, column) for column in self.xy.T], axis=1)

    def first_within(self, place: tuple[float, float], distance: float) -> float | None:
        """First time at which the robot is within a distance of a place; None if it never is.

        Examples
        --------
        >>> make_trajectory([(0, 0, 0), (10, 20, 0)]).first_within((10, 0), 4.0)
        3.0
        """
        offsets = self.xy - np.asarray(place, dtype=np.float64)
        if np.hypot(*offsets[0]) <= distance:
            return float(self.times[0])
        for i in range(len(offsets) - 1):
            share = _share_until_within(offsets[i], offsets[i + 1], distance)
            if share is not None:
                return float(self.times[i] + share * (self.times[i + 1] - self.times[i]))
        return None

    def _steps(self) -> NDArray[np.float64]:
        return np.asarray(np.hypot(*np.diff(self.xy, axis=0).T))


def make_trajectory(rows: Iterable[tuple[float, float, float]]) -> Trajectory:
    """Trajectory through (t, x, y), in the order of time."""
    table = np.array(list(rows), dtype=np.float64).reshape(-1, 3)
    times, xy = table[:, 0].copy(), table[:, 1:].copy()
    times.setflags(write=False)
    xy.setflags(write=False)
    return Trajectory(times, xy)


def _share_until_within(
    a: NDArray[np.float64], b: NDArray[np.float64], distance: float
) -> float | None:
    """Share of the way from a to b after which the origin is within a distance of it."""
    step = b - a
    # |a + s step|^2 = distance^2, the smaller root: where the way enters the disc.
    square = float(step @ step)
    half = float(a @ step)
    rest = half * half - square * (float(a @ a) - distance * distance)
    if square == 0.0 or rest < 0.0:
        return None
    share = (-half - float(np.sqrt(rest))) / square
    return share if 0.0 <= share <= 1.0 else None


@dataclass(frozen=True, slots=True)
class Crossing:
    """A gate that was passed, and when, seconds."""

    time: float
    gate: str


def crossings(trajectory: Trajectory, name: str, gate: ArrayLike) -> list[Crossing]:
    """Each time the trajectory passes from one side of a gate to the other.

    Parameters
    ----------
    trajectory : Trajectory
    name : str
    gate : (2, 2)
        Ends of the segment across the opening, metres.

    Examples
    --------
    >>> through = make_trajectory([(0, 1, 0), (4, 1, 8)])
    >>> crossings(through, "door", [(0, 4), (2, 4)])
    [Crossing(time=2.0, gate='door')]
    """
    first, last = np.asarray(gate, dtype=np.float64)
    along = last - first
    # Signed heights above the gate's line, and shares of the way along it.
    away = trajectory.xy - first
    heights = along[0] * away[:, 1] - along[1] * away[:, 0]
    shares = (away @ along) / float(along @ along)
    found: list[Crossing] = []
    before = 0  # the last point that was beside the line, not on it
    for i in range(1, len(heights)):
        if heights[i] == 0.0:
            continue
        if heights[before] * heights[i] < 0.0:
            share = heights[i - 1] / (heights[i - 1] - heights[i])
            place = shares[i - 1] + share * (shares[i] - shares[i - 1])
            if 0.0 <= place <= 1.0:
                times = trajectory.times
                time = times[i - 1] + share * (times[i] - times[i - 1])
                found.append(Crossing(float(time), name))
        before = i
    return found
