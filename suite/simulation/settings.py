"""How fast the robot is, how often and how far it looks, and what its planning costs it."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite
from typing import Any

from suite.errors import SceneError
from suite.scenes.scene import Scene
from suite.typed import MisfitError, dataclass_of, typed


class Charge(StrEnum):
    """What simulated time a call of the planner takes."""

    MEASURED = "measured"
    """The wall time that it took: a slow planner is late."""
    ZERO = "zero"
    """None: runs can be repeated bit for bit."""


@dataclass(frozen=True, slots=True)
class WorldSettings:
    """Settings of a simulation. A scene file holds their defaults in its property ``world``.

    speed : of the robot, metres per second.
    interval : seconds between two updates of what the robot knows and where it is.
    sensing_range : metres within which the robot detects an unknown obstacle at an update.
    time_limit : seconds of simulated time after which a run ends without its goal.
    obstacle_speed_factor : all motions of obstacles are so many times as fast.
    charge : what time planning takes.
    """

    speed: float = 2.0
    interval: float = 2.0
    sensing_range: float = 10.0
    time_limit: float = 600.0
    obstacle_speed_factor: float = 1.0
    charge: Charge = Charge.MEASURED

    def __post_init__(self) -> None:
        for name in ("speed", "interval", "time_limit", "obstacle_speed_factor"):
            _check_number(name, getattr(self, name), least_is_allowed=False)
        _check_number("sensing_range", self.sensing_range, least_is_allowed=True)


def _check_number(name: str, value: float, *, least_is_allowed: bool) -> None:
    if not isfinite(value) or value < 0.0 or (value == 0.0 and not least_is_allowed):
        rule = "0 or more" if least_is_allowed else "above 0"
        raise SceneError(f"{name} is {value!r}. It must be a finite number, {rule}.")


def world_settings(scene: Scene, overrides: Mapping[str, Any] | None = None) -> WorldSettings:
    """The settings that a scene asks for, and what is to be different this time.

    Parameters
    ----------
    scene : Scene
    overrides : mapping from a field's name to its value, optional
        None leaves a field as it is.

    Raises
    ------
    SceneError
        If the scene or the overrides name a field that there is not, or a value is out of range.
    """
    own = scene.properties.get("world", {})
    wanted = {key: value for key, value in (overrides or {}).items() if value is not None}
    try:
        dataclass_of(typed(own, dict[str, Any]), WorldSettings)
    except (MisfitError, SceneError) as error:
        raise SceneError(f"{scene.name}, its property 'world': {error}") from error
    try:
        return dataclass_of(own | wanted, WorldSettings)
    except (MisfitError, SceneError) as error:
        raise SceneError(f"world: {error}") from error
