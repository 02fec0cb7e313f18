"""Referee of a run in time: whether the robot was ever hit, when, and by which obstacle.

Robot and obstacles move in continuous time, both along straight lines between the moments in which
either turns. Seen from the obstacle the robot then moves along a straight segment, and it is hit if
and only if that segment enters the obstacle as it is drawn: no time is sampled. Touching is free,
as everywhere (DE-9IM: interiors meet); what is less deep than a hit is rounding, so obstacles are
shrunk by that. It knows of no planner and of no plan, only of where the robot was.

What exists counts, whether the robot knew of it or not. Metres, seconds.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from suite.referee.path import INTERIORS_MEET
from suite.scenes.dynamics import Dynamics
from suite.scenes.scene import Obstacle, Scene
from suite.simulation.trajectory import Trajectory

BORDER = "the border of the workspace"


@dataclass(frozen=True, slots=True)
class Hit:
    """The robot was in an obstacle.

    time : seconds, when it first was.
    obstacle : its name.
    place : (x, y) of the robot then, metres.
    """

    time: float
    obstacle: str
    place: tuple[float, float]


def hits(scene: Scene, trajectory: Trajectory) -> list[Hit]:
    """The first hit by each obstacle, in the order of time.

    Parameters
    ----------
    scene : Scene
        With the dynamics of its obstacles.
    trajectory : Trajectory
        Of the robot.

    Returns
    -------
    list of Hit
        Empty if the robot was never hit. Static obstacles that touch are one, named after the one
        that is nearest.

    Examples
    --------
    A robot that stands still, and a door that comes at 1 m/s:

    >>> from suite.simulation.trajectory import make_trajectory
    >>> from suite.scenes.dynamics import constant_speed
    >>> from suite.scenes.scene import make_scene
    >>> door = Obstacle("door", shapely.box(0, 4, 2, 5), Dynamics(constant_speed((1, 0), 0, 9)))
    >>> scene = make_scene("hall", shapely.box(0, 0, 20, 9), [door], ((8, 4.5), (1, 8)))
    >>> still = make_trajectory([(0, 8, 4.5), (20, 8, 4.5)])
    >>> [(round(hit.time, 3), hit.obstacle) for hit in hits(scene, still)]
    [(6.0, 'door')]
    """
    depth = scene.coordinates.hit_depth
    found = [_hit_by(o, trajectory, depth) for o in scene.obstacles if o.dynamics is not None]
    found.append(_hit_by_what_stays(scene, trajectory))
    return sorted((hit for hit in found if hit is not None), key=lambda hit: hit.time)


def vanishes(dynamics: Dynamics, trajectory: Trajectory) -> float:
    """When an obstacle is removed, given where the robot went; infinite if it never is."""
    removal = dynamics.removal
    if removal is None:
        return np.inf
    end = np.inf if removal.time is None else removal.time
    if removal.place is not None:
        reached = trajectory.first_within(removal.place, removal.distance)
        end = end if reached is None else min(end, reached)
    return float(end)


def _hit_by(obstacle: Obstacle, trajectory: Trajectory, depth: float) -> Hit | None:
    dynamics = obstacle.dynamics or Dynamics()
    start = max(dynamics.appears, float(trajectory.times[0]))
    stop = min(vanishes(dynamics, trajectory), trajectory.end)
    if start > stop or (start == stop and stop < trajectory.end):
        return None
    times = _moments(dynamics, trajectory, start, stop)
    robot = trajectory.at(times)
    ways = robot - np.array([dynamics.offset(time) for time in times])
    entry = _first_entry(_shrunk(obstacle.polygon, depth), times, ways)
    if entry is None:
        return None
    x, y = trajectory.at(entry)[0].tolist()
    return Hit(entry, obstacle.name, (x, y))


def _moments(
    dynamics: Dynamics, trajectory: Trajectory, start: float, stop: float
) -> NDArray[np.float64]:
    """Times between which robot and obstacle both move straight, from start to stop."""
    turns = [trajectory.times]
    if dynamics.motion is not None:
        turns.append(dynamics.motion.times)
    within = np.concatenate(turns)
    within = within[(within > start) & (within < stop)]
    return np.unique(np.concatenate([[start], within, [stop]]))


def _hit_by_what_stays(scene: Scene, trajectory: Trajectory) -> Hit | None:
    """First hit by the static obstacles or the frame around the workspace."""
    static = tuple(o for o in scene.obstacles if o.dynamics is None)
    stays = replace(scene, obstacles=static)
    solid = _shrunk(stays.arrangement.solid, scene.coordinates.hit_depth)
    entry = _first_entry(solid, trajectory.times, trajectory.xy)
    if entry is None:
        return None
    x, y = trajectory.at(entry)[0].tolist()
    place = shapely.Point(x, y)
    near = [(o.polygon.distance(place), o.name) for o in static]
    near.append((scene.workspace.exterior.distance(place), BORDER))
    return Hit(entry, min(near)[1], (x, y))


def _shrunk(polygon: BaseGeometry, depth: float) -> BaseGeometry:
    """What lies deeper than that; a sliver narrower than twice that can't hit."""
    inner: BaseGeometry = polygon.buffer(-depth, join_style="mitre")
    shapely.prepare(inner)
    return inner


def _first_entry(
    closed: BaseGeometry, times: NDArray[np.float64], ways: NDArray[np.float64]
) -> float | None:
    """When a point that moves straight between (times, ways) first enters a closed region."""
    if closed.is_empty:
        return None
    if len(times) == 1:
        inside = shapely.relate_pattern(closed, shapely.Point(ways[0]), INTERIORS_MEET)
        return float(times[0]) if inside else None
    for i in _entering(closed, ways):
        share = _share_until_entry(closed, ways[i], ways[i + 1])
        return float(times[i] + share * (times[i + 1] - times[i]))
    return None


def _entering(closed: BaseGeometry, ways: NDArray[np.float64]) -> Iterator[int]:
    """Numbers of the steps in which the interior of a region is met, in order."""
    stands = (ways[1:] == ways[:-1]).all(axis=1)
    steps = np.empty(len(stands), dtype=np.object_)
    steps[stands] = shapely.points(ways[1:][stands])
    steps[~stands] = shapely.linestrings(np.stack([ways[:-1], ways[1:]], axis=1)[~stands])
    yield from np.flatnonzero(shapely.relate_pattern(closed, steps, INTERIORS_MEET)).tolist()


def _share_until_entry(
    closed: BaseGeometry, a: NDArray[np.float64], b: NDArray[np.float64]
) -> float:
    """Share of the step a-b, which is known to enter a region, that lies before the entry."""
    length = float(np.hypot(*(b - a)))
    if length == 0.0 or closed.contains(shapely.Point(a)):
        return 0.0
    pieces = shapely.get_parts(shapely.intersection(shapely.LineString([a, b]), closed))
    entered = pieces[shapely.relate_pattern(closed, pieces, INTERIORS_MEET)]
    # An entry so shallow that the intersection is rounded to the edge: where it touches, then.
    entered = entered if len(entered) else pieces
    distance = float(shapely.distance(entered, shapely.Point(a)).min()) if len(entered) else 0.0
    return min(1.0, distance / length)
