"""The world at each update: what exists, what the robot has detected, what its coming removed.

A robot senses at updates only. What it has detected it knows for good, wherever that moves; no
obstacle hides another. A removal by the robot's coming is physical: it happens when it comes.
"""

from dataclasses import replace

import shapely
from shapely.affinity import translate

from suite.scenes.dynamics import Dynamics
from suite.scenes.scene import Obstacle, Scene, scene_at
from suite.simulation.hits import vanishes
from suite.simulation.settings import WorldSettings
from suite.simulation.trajectory import Trajectory


class World:
    """A dynamic scene, seen by a robot from one update to the next.

    Parameters
    ----------
    scene : Scene
    settings : WorldSettings

    Attributes
    ----------
    scene : Scene
        With the motions as fast as the settings want them.
    detected : dict from the name of an obstacle that was unknown at first and is not any more to
        when it was detected, seconds.
    """

    def __init__(self, scene: Scene, settings: WorldSettings) -> None:
        self.scene = quickened(scene, settings.obstacle_speed_factor)
        self.settings = settings
        self.detected: dict[str, float] = {}
        self._known: Scene | None = None
        self._state: object = None

    def look(self, trajectory: Trajectory) -> Scene:
        """The static scene that the robot knows at the end of its way so far.

        The same object as the last time if nothing that it knows has changed. Its arrangement is
        built here: that is the world's work and not the planner's.
        """
        time = trajectory.end
        changing = [o for o in self.scene.obstacles if o.dynamics is not None]
        gone = {o.name for o in changing if vanishes(_of(o), trajectory) <= time}
        there = [o for o in changing if o.name not in gone and _of(o).is_there(time)]
        robot = shapely.Point(trajectory.xy[-1])
        self.detected |= {o.name: time for o in there if self._detects(o, robot, time)}
        known = [o for o in there if self._is_known(o)]
        state = [(o.name, *_of(o).offset(time).tolist()) for o in known]
        if self._known is None or state != self._state:
            names = {o.name for o in known}
            unknown = {o.name for o in changing if o.name not in names}
            self._known = scene_at(self.scene, time, without=unknown)
            self._state = state
            # Touching the cached property builds it.
            _ = self._known.arrangement
        return self._known

    def _is_known(self, obstacle: Obstacle) -> bool:
        return _of(obstacle).detection is None or obstacle.name in self.detected

    def _detects(self, obstacle: Obstacle, robot: shapely.Point, time: float) -> bool:
        dynamics = _of(obstacle)
        if dynamics.detection is None or obstacle.name in self.detected:
            return False
        within = dynamics.detection.range
        within = self.settings.sensing_range if within is None else within
        polygon = translate(obstacle.polygon, *dynamics.offset(time))
        return bool(polygon.distance(robot) <= within)


def quickened(scene: Scene, factor: float) -> Scene:
    """The same scene with all motions so many times as fast.

    Examples
    --------
    >>> from suite.scenes.dynamics import constant_speed
    >>> from suite.scenes.scene import make_scene
    >>> door = Obstacle("door", shapely.box(0, 4, 2, 5), Dynamics(constant_speed((1, 0), 0, 10)))
    >>> scene = make_scene("hall", shapely.box(0, 0, 20, 9), [door], ((8, 4.5), (1, 8)))
    >>> quickened(scene, 2.5).obstacles[0].dynamics.motion.times.tolist()
    [0.0, 4.0]
    """
    if factor == 1.0:
        return scene
    obstacles = (
        o if o.dynamics is None else replace(o, dynamics=o.dynamics.faster(factor))
        for o in scene.obstacles
    )
    return replace(scene, obstacles=tuple(obstacles))


def _of(obstacle: Obstacle) -> Dynamics:
    return obstacle.dynamics or Dynamics()
