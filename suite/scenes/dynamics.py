"""How an obstacle changes over time: it moves, it is unknown until sensed, it comes and goes.

Values only; the simulated world of ``suite.simulation`` acts on them. Seconds from the start of the
run, metres, x right, y up.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from msgspec import Meta, Struct
from msgspec.structs import fields
from numpy.typing import ArrayLike, NDArray

from suite.errors import SceneError
from suite.geometry.tolerances import LARGEST
from suite.typed import MisfitError, shown, typed


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A translation that is piecewise linear in time. Made by :func:`make_motion`.

    times : (n,) float64, seconds, ascending, read-only.
    offsets : (n, 2) float64, metres from where the obstacle is drawn, read-only. Before the first
        time and after the last one the obstacle rests at the first and at the last offset.
    """

    times: NDArray[np.float64]
    offsets: NDArray[np.float64]

    def offset(self, time: float) -> NDArray[np.float64]:
        """(2,), how far from its drawing the obstacle is at a time, metres.

        Examples
        --------
        >>> make_motion([(0, 0, 0), (10, 20, 0)]).offset(4).tolist()
        [8.0, 0.0]
        """
        return np.array([np.interp(time, self.times, column) for column in self.offsets.T])

    def faster(self, factor: float) -> "Motion":
        """The same way at another speed, from the same moment on.

        Examples
        --------
        >>> make_motion([(2, 0, 0), (12, 20, 0)]).faster(2.5).times.tolist()
        [2.0, 6.0]
        """
        first = self.times[0]
        return Motion(_frozen(first + (self.times - first) / factor), self.offsets)


def make_motion(waypoints: ArrayLike) -> Motion:
    """Motion along waypoints.

    Parameters
    ----------
    waypoints : (n, 3)
        Rows of time (seconds, ascending, not below 0), dx and dy (metres from the drawing).

    Raises
    ------
    SceneError
        If it is no such table.
    """
    try:
        table = np.array(waypoints)
        if table.dtype.kind in "SUb":
            raise TypeError  # numpy would read "1" and true as numbers
        rows = table.astype(np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise SceneError("its waypoints are no table of numbers. Give [[t, dx, dy], ...].") from (
            error
        )
    if rows.ndim != 2 or rows.shape[1] != 3 or len(rows) == 0:
        raise SceneError(
            f"its waypoints have the shape {rows.shape}. Give [[t, dx, dy], ...], one at least."
        )
    if not (np.abs(rows) <= LARGEST).all():  # so written, NaN is refused too
        raise SceneError(f"a waypoint is not finite or beyond {LARGEST:g}. Use s and m.")
    times = rows[:, 0]
    if times[0] < 0.0 or (np.diff(times) <= 0.0).any():
        raise SceneError(
            f"the times of its waypoints are {shown(times.tolist())}. "
            "They must rise, from 0 s or later."
        )
    return Motion(_frozen(times.copy()), _frozen(rows[:, 1:].copy()))


def constant_speed(velocity: tuple[float, float], start: float, stop: float) -> Motion:
    """Motion along a line at a constant speed, from one time to another; at rest before and after.

    Parameters
    ----------
    velocity : (vx, vy), metres per second.
    start, stop : seconds.

    Examples
    --------
    >>> constant_speed((1, 0), 0, 20).offset(25).tolist()
    [20.0, 0.0]
    """
    span = stop - start
    return make_motion([(start, 0.0, 0.0), (stop, velocity[0] * span, velocity[1] * span)])


Length = Annotated[float, Meta(ge=0.0, le=LARGEST, description="a finite number, 0 or more")]
_Coordinate = Annotated[float, Meta(ge=-LARGEST, le=LARGEST, description="a finite number")]
Pair = tuple[_Coordinate, _Coordinate]


class Detection(Struct, frozen=True, forbid_unknown_fields=True):
    """The obstacle is unknown until the robot comes near; from then on it is known for good.

    range : metres from the robot to the obstacle's edge; None for the sensing range of the robot.
    """

    range: Length | None = None


class Removal(Struct, frozen=True, forbid_unknown_fields=True):
    """The obstacle vanishes at a time, or when the robot comes near a place: whichever is first.

    time : seconds; None if time does not remove it.
    place : (x, y), metres; None if no place of the robot's does.
    distance : metres from the place within which the robot must come.
    """

    time: Length | None = None
    place: Annotated[Pair, Meta(description="[x, y], metres")] | None = None
    distance: Length = 0.0


class _Motion(Struct, frozen=True, forbid_unknown_fields=True):
    """Motion as a file has it."""

    waypoints: Any = None
    velocity: Annotated[Pair, Meta(description="[vx, vy], metres per second")] | None = None
    start: Length = 0.0
    stop: Length | None = None


class _Properties(Struct, frozen=True):
    """Those of an obstacle's properties that make it dynamic."""

    motion: (
        Annotated[_Motion, Meta(description="an object of waypoints, or velocity, start, stop")]
        | None
    ) = None
    detection: Annotated[Detection, Meta(description="an object of range")] | None = None
    removal: Annotated[Removal, Meta(description="an object of time, place, distance")] | None = (
        None
    )
    appears: Length = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Dynamics:
    """What is not static about an obstacle; the default is nothing.

    motion : how it moves, or None.
    detection : when it becomes known, or None if it is known from the start.
    removal : when it vanishes, or None if it stays.
    appears : seconds; before that it is not there.
    """

    motion: Motion | None = None
    detection: Detection | None = None
    removal: Removal | None = None
    appears: float = 0.0

    def offset(self, time: float) -> NDArray[np.float64]:
        """(2,), how far from its drawing the obstacle is at a time, metres."""
        return np.zeros(2) if self.motion is None else self.motion.offset(time)

    def is_there(self, time: float) -> bool:
        """Whether the obstacle exists at a time, as far as time alone decides."""
        end = np.inf if self.removal is None or self.removal.time is None else self.removal.time
        return bool(self.appears <= time < end)

    def faster(self, factor: float) -> "Dynamics":
        """The same with another speed of motion."""
        return self if self.motion is None else replace(self, motion=self.motion.faster(factor))


_KEYS = tuple(field.name for field in fields(_Properties))


def parse_dynamics(properties: Mapping[str, Any]) -> Dynamics | None:
    """Read the dynamics of an obstacle from its properties in a scene file.

    Parameters
    ----------
    properties : mapping
        As :mod:`suite.scenes.geojson` describes them.

    Returns
    -------
    Dynamics or None
        None if the obstacle is static.

    Raises
    ------
    SceneError
        With what is wrong and how to mend it; the caller says where.
    """
    given = {
        key: _without_nulls(properties[key]) for key in _KEYS if properties.get(key) is not None
    }
    if not given:
        return None
    try:
        read = typed(given, _Properties)
    except MisfitError as error:
        # The name of a value is in the error; that of a table with a wrong key is not.
        name = next(key for key in reversed(error.keys) if isinstance(key, str))
        place = "" if str(error).startswith(name) else f"{name}: "
        raise SceneError(f"its {place}{error}") from error
    if read.removal is not None:
        _check_removal(read.removal, given["removal"])
    return Dynamics(_motion(read.motion), read.detection, read.removal, read.appears)


def _without_nulls(value: Any) -> Any:
    """An object without what it leaves out by saying null; anything else as it is."""
    return {k: v for k, v in value.items() if v is not None} if isinstance(value, dict) else value


def as_properties(dynamics: Dynamics | None) -> dict[str, Any]:
    """The same as plain data, for scene files; :func:`parse_dynamics` reads it back.

    Examples
    --------
    >>> as_properties(Dynamics(make_motion([(0, 0, 0), (9, 1, 0)]), removal=Removal(time=30.0)))
    {'motion': {'waypoints': [[0.0, 0.0, 0.0], [9.0, 1.0, 0.0]]}, 'removal': {'time': 30.0}}
    """
    data: dict[str, Any] = {}
    if dynamics is None:
        return data
    if dynamics.motion is not None:
        motion = dynamics.motion
        data["motion"] = {"waypoints": np.column_stack([motion.times, motion.offsets]).tolist()}
    if dynamics.detection is not None:
        known = dynamics.detection.range
        data["detection"] = {} if known is None else {"range": known}
    if dynamics.removal is not None:
        removal = dynamics.removal
        data["removal"] = {} if removal.time is None else {"time": removal.time}
        if removal.place is not None:
            data["removal"] |= {"place": list(removal.place), "distance": removal.distance}
    if dynamics.appears > 0.0:
        data["appears"] = dynamics.appears
    return data


def as_text(dynamics: Dynamics) -> str:
    """The same as one line that is equal for equal dynamics: for hashes."""
    return json.dumps(as_properties(dynamics), sort_keys=True)


def _motion(read: _Motion | None) -> Motion | None:
    if read is None:
        return None
    if (read.waypoints is None) == (read.velocity is None):
        raise SceneError("its motion has to have either waypoints or a velocity.")
    if read.velocity is None:
        if (read.start, read.stop) != (0.0, None):
            raise SceneError("its motion has waypoints and more. Start and stop go with velocity.")
        return make_motion(read.waypoints)
    if read.stop is None:
        raise SceneError("its motion has a velocity and no stop. Give the time when it rests.")
    if read.stop <= read.start:
        raise SceneError(
            f"its motion stops at {read.stop} s, not after its start. Give a later stop."
        )
    return constant_speed(read.velocity, read.start, read.stop)


def _check_removal(removal: Removal, given: Mapping[str, Any]) -> None:
    if removal.time is None and removal.place is None:
        raise SceneError("its removal names neither a time nor a place. Give one of them.")
    if (removal.place is None) != (given.get("distance") is None):
        raise SceneError("its removal has to have place and distance together.")


def _frozen(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array.setflags(write=False)
    return array
