"""An oracle for hits: robot and obstacles at many times, each looked at by shapely alone.

It shares no code with the referee. What lies between two samples it can't see, so it finds fewer
hits than there are; of those that it finds none may be missing from a report.
"""

import numpy as np
import shapely
from numpy.typing import NDArray

from suite.scenes.scene import Obstacle, Scene
from suite.simulation.trajectory import Trajectory

EVERY = 0.004
"""Seconds between two samples: a robot of 6 m/s and an obstacle of 8 m/s move 6 cm meanwhile."""

DEEPER = 1e-5
"""Metres: above a hit's depth, and far below what 6 cm of way cut out of an obstacle."""


def sampled_times(trajectory: Trajectory) -> NDArray[np.float64]:
    """(n,), evenly from the first to the last moment, and all at which the robot turns."""
    number = int(np.ceil(trajectory.end / EVERY)) + 1
    return np.union1d(np.linspace(0.0, trajectory.end, number), trajectory.times)


def sampled_hits(scene: Scene, trajectory: Trajectory) -> dict[str, float]:
    """From the name of each obstacle in which a sample is, to the time of the first one."""
    times = sampled_times(trajectory)
    robot = _interpolated(times, trajectory.times, trajectory.xy)
    found = {o.name: _first(times, _inside(o, times, robot)) for o in scene.obstacles}
    return {name: time for name, time in found.items() if time is not None}


def leaves_the_room(scene: Scene, trajectory: Trajectory) -> bool:
    """Whether a corner of the trajectory lies outside the workspace, which is convex."""
    return bool((shapely.distance(scene.workspace, shapely.points(trajectory.xy)) > DEEPER).any())


def _interpolated(
    times: NDArray[np.float64], moments: NDArray[np.float64], places: NDArray[np.float64]
) -> NDArray[np.float64]:
    return np.column_stack([np.interp(times, moments, column) for column in places.T])


def _first(times: NDArray[np.float64], inside: NDArray[np.bool_]) -> float | None:
    return float(times[np.argmax(inside)]) if inside.any() else None


def _inside(
    obstacle: Obstacle, times: NDArray[np.float64], robot: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """At which times the robot is deep in an obstacle that is there, (n,) bool."""
    dynamics = obstacle.dynamics
    there = np.ones(len(times), dtype=np.bool_)
    seen = robot
    if dynamics is not None:
        there &= times >= dynamics.appears
        if dynamics.motion is not None:
            seen = robot - _interpolated(times, dynamics.motion.times, dynamics.motion.offsets)
        if dynamics.removal is not None and dynamics.removal.time is not None:
            there &= times < dynamics.removal.time
        if dynamics.removal is not None and dynamics.removal.place is not None:
            there &= ~_has_come(dynamics.removal.place, dynamics.removal.distance, robot)
    deep = np.zeros(len(times), dtype=np.bool_)
    shapely.prepare(obstacle.polygon)
    touched = np.flatnonzero(there & shapely.contains_xy(obstacle.polygon, *seen.T))
    depths = shapely.distance(obstacle.polygon.boundary, shapely.points(seen[touched]))
    deep[touched] = depths > DEEPER
    return deep


def _has_come(
    place: tuple[float, float], distance: float, robot: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Whether the robot may have come within a distance of a place by each sample or the next one.

    In doubt it has: then the oracle looks at less, but finds no hit by what is gone.
    """
    step = np.hypot(*np.diff(robot, axis=0).T).max(initial=0.0)
    near = np.hypot(*(robot - place).T) <= distance + step
    return np.logical_or.accumulate(near | np.append(near[1:], False))
