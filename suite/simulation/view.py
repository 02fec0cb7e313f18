"""A run that has ended, as it stood at any moment: for pictures.

Nothing is simulated again; all of it follows from what the run left behind. Seconds, metres.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.affinity import translate
from shapely.geometry import Polygon
from shapely.ops import substring

from suite.scenes.dynamics import Dynamics
from suite.simulation.hits import vanishes
from suite.simulation.run import Replan, Simulation
from suite.simulation.settings import Charge

TURN_M = 1.0
"""A path ahead that becomes longer or shorter by more is news, metres."""


class Sight(StrEnum):
    """What the robot knows of an obstacle, and whether that moves."""

    STILL = "obstacle"
    MOVING = "moving obstacle"
    UNDETECTED = "not yet detected"


@dataclass(frozen=True, slots=True)
class Seen:
    """An obstacle that is there at a moment.

    polygon : where it is then, metres.
    """

    name: str
    polygon: Polygon
    sight: Sight


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """One moment of a run.

    time : seconds.
    obstacles : what is there, known or not; what is removed, or not there yet, is not.
    trail : (n, 2) float64, metres, the way of the robot so far. Its last row is the robot.
    path : (m, 2) float64, metres, what it means to follow from there; None without a path.
    """

    time: float
    obstacles: tuple[Seen, ...]
    trail: NDArray[np.float64]
    path: NDArray[np.float64] | None

    @property
    def robot(self) -> NDArray[np.float64]:
        """(2,), where the robot is, metres."""
        return self.trail[-1]


def update_times(run: Simulation) -> list[float]:
    """When the robot looked around, seconds; the moment in which it arrives is none of them."""
    interval, end = run.settings.interval, run.trajectory.end
    count = int(np.ceil(end / interval))
    times = [number * interval for number in range(count)]
    return [time for time in times if time < end] or [0.0]


def is_turn(before: float | None, now: float | None, driven: float) -> bool:
    """Whether the path ahead is another one than what was left of the one before; by costs, metres.

    Examples
    --------
    >>> is_turn(20.0, 15.0, 5.0), is_turn(20.0, 20.0, 5.0), is_turn(None, 20.0, 5.0)
    (False, True, True)
    """
    if before is None or now is None:
        return before is not now
    return abs(now - (before - driven)) > TURN_M


def view_at(run: Simulation, time: float) -> View:
    """How a run stood at a time.

    Parameters
    ----------
    run : Simulation
    time : float
        Seconds. At an update that the replanner was asked at, the path is its answer, though the
        robot gets that a moment later if planning is charged for.

    Returns
    -------
    View
    """
    return View(time, _obstacles(run, time), _trail(run, time), _path(run, time))


def _obstacles(run: Simulation, time: float) -> tuple[Seen, ...]:
    seen = []
    for obstacle in run.scene.obstacles:
        dynamics = obstacle.dynamics or Dynamics()
        if not dynamics.appears <= time < vanishes(dynamics, run.trajectory):
            continue
        sight = Sight.MOVING if obstacle.moves else Sight.STILL
        if dynamics.detection is not None and time < run.detected.get(obstacle.name, np.inf):
            sight = Sight.UNDETECTED
        polygon = translate(obstacle.polygon, *dynamics.offset(time))
        seen.append(Seen(obstacle.name, polygon, sight))
    return tuple(seen)


def _trail(run: Simulation, time: float) -> NDArray[np.float64]:
    way = run.trajectory
    return np.vstack([way.xy[way.times < time], way.at(time)])


def _path(run: Simulation, time: float) -> NDArray[np.float64] | None:
    asked = next((replan for replan in run.replans if replan.time == time), None)
    if asked is not None and asked.path is not None:
        return asked.path
    answered = time if asked is None else time + _charged(run, asked)
    courses = [course for course in run.courses if course.time <= answered]
    if not courses or courses[-1].path is None:
        return None
    return _rest(courses[-1].path, run.trajectory.at(time)[0])


def _charged(run: Simulation, replan: Replan) -> float:
    is_charged = run.settings.charge is Charge.MEASURED
    return replan.latency_s if is_charged and replan.latency_s is not None else 0.0


def _rest(path: NDArray[np.float64], robot: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """What is left of a path from the robot on; None at its end."""
    line = shapely.LineString(path)
    passed = line.project(shapely.Point(robot))
    ahead = shapely.get_coordinates(substring(line, passed, line.length))
    return np.vstack([robot, ahead[1:]]) if len(ahead) > 1 else None
