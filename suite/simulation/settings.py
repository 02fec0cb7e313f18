"""How fast the robot is, how often and how far it looks, and what its planning costs it."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from math import isfinite
from typing import Any

from suite.errors import SceneError
from suite.scenes.scene import Scene


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


def _check_number(name: str, value: Any, *, least_is_allowed: bool) -> None:
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
    if not is_number or value < 0.0 or (value == 0.0 and not least_is_allowed):
        rule = "0 or more" if least_is_allowed else "above 0"
        raise SceneError(f"world: {name} is {value!r}. It must be a finite number, {rule}.")


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
    _check_names(f"{scene.name}: its property 'world'", own)
    _check_names("world: it", wanted)
    try:
        settings = _with(WorldSettings(), own)
    except SceneError as error:
        raise SceneError(f"{scene.name}: {error}") from error
    return _with(settings, wanted)


def _check_names(what: str, values: Any) -> None:
    """Refuse anything but a mapping from fields of WorldSettings."""
    names = [field.name for field in fields(WorldSettings)]
    if isinstance(values, Mapping) and not values.keys() - set(names):
        return
    held = sorted(values.keys() - set(names))[0] if isinstance(values, Mapping) else values
    raise SceneError(f"{what} holds {held!r}. It takes {', '.join(names)}.")


def _with(settings: WorldSettings, values: Mapping[str, Any]) -> WorldSettings:
    changed = replace(settings, **values)
    try:
        return replace(changed, charge=Charge(changed.charge))
    except ValueError as error:
        known = " or ".join(repr(charge.value) for charge in Charge)
        raise SceneError(f"world: charge is {changed.charge!r}. It must be {known}.") from error
