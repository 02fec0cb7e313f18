"""One run: the robot drives, the world changes, every interval a replanner is asked for a path.

At each update the robot looks, stands on its place, and the replanner is asked for a path from
there in what is known then. What the paper leaves open, we decide so:

- Planning takes simulated time (its wall time, or none). Meanwhile the robot goes on along its old
  path, unless the stretch up to the next update leads into what it knows to be closed: then it
  waits. Without an old path it waits.
- A path begins where the robot was asked. When it comes, the robot joins it by the straight way to
  its first waypoint, or, where that is not free, goes back the way it came since.
- An update that finds the planner still at work does not ask it again. The robot looks all the
  same, and does not drive knowingly into what it sees; a path that comes later, planned for what
  was known before, is taken only if it is still free.
- Without a new path (none found, or one that the referee rejects) the robot keeps its old one if
  all that lies ahead of it is free; else it waits, and asks again at the next update.
- If what the robot knows encloses it (an obstacle moved onto it, or appeared there), nobody is
  asked: it waits. That is a hit, which the referee of the run reports.
- A hit is recorded and the run goes on, so that one hit does not hide what else there is to see.
- A run ends at the goal or at its time limit.

Nothing is sampled: the robot drives from event to event (waypoints, updates, answers of the
planner), so there is no time step to choose.
"""

import gc
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from suite.errors import ContractError
from suite.geometry.kernels import first_collision
from suite.planner import Budget, Plan, PlanStatus, Recorder, Replanner
from suite.referee.claims import plain_plan
from suite.referee.clock import Clock
from suite.referee.path import judge
from suite.scenes.exact import path_length, shortest_path
from suite.scenes.scene import Query, Scene
from suite.simulation.hits import Hit, hits
from suite.simulation.robot import Robot
from suite.simulation.settings import Charge, WorldSettings
from suite.simulation.trajectory import Crossing, Trajectory, crossings
from suite.simulation.world import World

ENCLOSED = "enclosed"
"""Status of an update at which the robot stood in what it knows to be closed."""


@dataclass(frozen=True, slots=True, eq=False)
class Replan:
    """What came of one update at which the replanner was asked, or could not be.

    time : seconds of simulated time.
    place : (2,) float64, metres, where the robot was.
    changed : whether that is not what it knew at the update before.
    status : a :class:`suite.planner.PlanStatus`, or ENCLOSED.
    reason : why, where that is not plain.
    path : (n, 2) float64, metres, from ``place`` to the goal; None without a valid one.
    cost : its length, metres.
    optimum : length of the shortest path in what was known, metres; None if there is none.
    latency_s : wall time of the call, seconds; None if nobody was asked.
    generations, checks, computed_checks, details : what the plan says of them.
    """

    time: float
    place: NDArray[np.float64]
    changed: bool
    status: str
    reason: str | None = None
    path: NDArray[np.float64] | None = None
    cost: float | None = None
    optimum: float | None = None
    latency_s: float | None = None
    generations: int | None = None
    checks: int | None = None
    computed_checks: int | None = None
    details: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """What the robot set out to follow.

    time : seconds, from when on.
    path : (n, 2) float64, metres, from where it was then; None if it had to wait.
    """

    time: float
    path: NDArray[np.float64] | None


class Outcome(StrEnum):
    """How a run ended, in a word."""

    REACHED = "reached"
    """The robot stands at the goal."""
    OUT_OF_TIME = "out_of_time"
    """The time limit came first."""


@dataclass(frozen=True, slots=True, eq=False)
class Simulation:
    """One run that has ended.

    scene : Scene, with motions as fast as they were.
    query : Query
    settings : WorldSettings
    outcome : how it ended.
    trajectory : where the robot was when.
    replans : one for each update at which the replanner was asked, or could not be.
    courses : what the robot followed, in the order of time; the first one begins with the first
        answer of the replanner.
    detected : mapping from the name of an obstacle that was unknown at first to when it was
        detected, seconds.
    hits : the first hit by each obstacle.
    gates : the openings that the robot passed, in order.
    """

    scene: Scene
    query: Query
    settings: WorldSettings
    outcome: Outcome
    trajectory: Trajectory
    replans: tuple[Replan, ...]
    courses: tuple[Course, ...]
    detected: Mapping[str, float]
    hits: tuple[Hit, ...]
    gates: tuple[Crossing, ...]

    @property
    def reached(self) -> bool:
        """Whether the robot came to the goal."""
        return self.outcome is Outcome.REACHED

    @property
    def opening(self) -> str | None:
        """The opening that it passed last; None if it passed none."""
        return self.gates[-1].gate if self.gates else None


def simulate(
    scene: Scene,
    query: Query,
    replanner: Replanner,
    settings: WorldSettings,
    budget: Budget | None = None,
) -> Simulation:
    """Let a robot find its way through a dynamic scene.

    Parameters
    ----------
    scene : Scene
        With the dynamics of its obstacles.
    query : Query
        From where to where.
    replanner : Replanner
        New for this run.
    settings : WorldSettings
    budget : Budget, optional
        For each single plan; by default the planner's own limits.

    Returns
    -------
    Simulation
        Always: what a replanner raises is an update without a path.
    """
    run = _Run(scene, query, replanner, settings, budget or Budget())
    outcome = run.to_the_end()
    trajectory = run.robot.trajectory
    gates = [
        crossing
        for name, gate in scene.properties.get("gates", {}).items()
        for crossing in crossings(trajectory, name, gate)
    ]
    return Simulation(
        scene=run.world.scene,
        query=query,
        settings=settings,
        outcome=outcome,
        trajectory=trajectory,
        replans=tuple(run.replans),
        courses=tuple(run.courses),
        detected=dict(run.world.detected),
        hits=tuple(hits(run.world.scene, trajectory)),
        gates=tuple(sorted(gates, key=lambda crossing: crossing.time)),
    )


@dataclass(slots=True, eq=False)
class _Pending:
    """An answer of the replanner that the robot does not have yet.

    ready : seconds, when it comes.
    path : (n, 2) float64, metres, or None.
    way : the places where the robot has been since it asked, the first one where it asked.
    """

    ready: float
    path: NDArray[np.float64] | None
    way: list[NDArray[np.float64]] = field(default_factory=list)


class _Run:
    """The state of a run from one update to the next."""

    def __init__(
        self,
        scene: Scene,
        query: Query,
        replanner: Replanner,
        settings: WorldSettings,
        budget: Budget,
    ) -> None:
        self.world = World(scene, settings)
        self.robot = Robot(query.start, settings.speed, scene.coordinates)
        self.replans: list[Replan] = []
        self.courses: list[Course] = []
        self._query = query
        self._replanner = replanner
        self._settings = settings
        self._budget = budget
        self._ask: Callable[..., Any] = replanner.begin
        self._known: Scene | None = None
        self._pending: _Pending | None = None

    def to_the_end(self) -> Outcome:
        """Go from update to update until the goal or the time limit."""
        limit, interval = self._settings.time_limit, self._settings.interval
        number = 0
        while not self._is_there() and number * interval < limit:
            self._update(min((number + 1) * interval, limit))
            number += 1
        return Outcome.REACHED if self._is_there() else Outcome.OUT_OF_TIME

    def _is_there(self) -> bool:
        return bool(np.array_equal(self.robot.place, self._query.goal))

    def _update(self, until: float) -> None:
        """Look, ask, and drive until the next update."""
        known = self.world.look(self.robot.trajectory)
        changed = self._known is not None and known is not self._known
        self._known = known
        if not self.robot.settle(known):
            self.replans.append(Replan(self.robot.time, self.robot.place, changed, ENCLOSED))
            self._pending = None
            self.robot.path = None
            self.courses.append(Course(self.robot.time, None))
            self.robot.wait(until)
            return
        if self._pending is None:
            self._pending = self._plan(known, changed)
        self._drive_while_planning(until)
        if self._pending is None and not self._is_there():
            self.robot.drive(until)

    def _drive_while_planning(self, until: float) -> None:
        """Keep to the old path as far as it is known to be free, until the answer comes."""
        pending, robot = self._pending, self.robot
        if pending is None or self._known is None:
            return
        pause = min(pending.ready, until)
        stretch = robot.ahead(until - robot.time)
        if stretch is None or first_collision(stretch, self._known.arrays) >= 0:
            robot.wait(pause)
        elif pause > robot.time:
            pending.way += list(robot.drive(pause))
        if self._is_there():
            self._pending = None
        elif pending.ready <= robot.time:
            self._take(pending, self._known)
            self.courses.append(Course(robot.time, robot.path))
            self._pending = None

    def _take(self, pending: _Pending, known: Scene) -> None:
        """Follow the new path, if there is one and it is free; else the old one, if that is."""
        robot = self.robot
        robot.settle(known)
        for path in _joining(robot.place, pending):
            if first_collision(path, known.arrays) < 0:
                robot.path = path
                return
        if robot.path is not None and first_collision(robot.path, known.arrays) >= 0:
            robot.path = None

    def _plan(self, known: Scene, changed: bool) -> _Pending:
        """Ask the replanner; its answer comes when it has been charged for."""
        robot = self.robot
        query = Query(self._query.name, robot.place, self._query.goal)
        recorder = Recorder()
        clock = Clock(recorder)
        returned: Any = None
        reason: str | None = None
        # The garbage on the heap is the simulation's: collecting it is not the planner's time.
        gc.disable()
        try:
            with clock:
                returned = self._ask(known, query, self._budget, recorder)
        except (Exception, SystemExit):
            # Other people's code: whatever it raises is an update without a path.
            reason = traceback.format_exc(limit=-1).strip()
        gc.enable()
        self._ask = self._replanner.update
        asked = Replan(
            robot.time, query.start, changed, PlanStatus.ERROR, reason, latency_s=clock.wall_s
        )
        self.replans.append(_judged(asked, known, query, returned))
        charge = clock.wall_s if self._settings.charge is Charge.MEASURED else 0.0
        return _Pending(robot.time + charge, self.replans[-1].path, [robot.place])


def _judged(asked: Replan, known: Scene, query: Query, returned: Any) -> Replan:
    """What an answer is worth: a path only if the static referee finds it free in what is known.

    ``asked`` has the reason if there is no answer, for something was raised.
    """
    plan, reason, path = Plan(PlanStatus.ERROR), asked.reason, None
    if reason is None:
        try:
            plan = plain_plan(returned)
        except ContractError as error:
            reason = str(error)
    status = plan.status
    if status is PlanStatus.SOLVED:
        verdict = judge(known, query, plan.path)
        if verdict.valid:
            path = np.array(plan.path, dtype=np.float64)
        else:
            status, reason = PlanStatus.INVALID, verdict.reason
    optimum = shortest_path(known, query).length
    return replace(
        asked,
        status=str(status),
        reason=reason,
        path=path,
        cost=None if path is None else path_length(path),
        optimum=float(optimum) if np.isfinite(optimum) else None,
        generations=plan.generations,
        checks=plan.checks,
        computed_checks=plan.computed_checks,
        details=plan.details,
    )


def _joining(place: NDArray[np.float64], pending: _Pending) -> list[NDArray[np.float64]]:
    """Ways from where the robot is now onto a path from where it asked, the best one first."""
    path, way = pending.path, pending.way
    if path is None:
        return []
    if np.array_equal(place, path[0]):
        return [path]
    straight = np.vstack([place, path[1:]])
    back = np.vstack([place, *way[-2::-1], path[1:]])
    return [straight, back]
