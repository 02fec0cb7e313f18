"""OMPL's planners (Sucan, Moll and Kavraki 2012) behind the plugin interface: what all share.

Each planner is one row of settings and one way of watching it while it runs. Metres outside;
OMPL's own coordinates are those of :mod:`baselines.ompl.units`.
"""

import time
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou
from typing_extensions import TypeVar

from baselines.ends import ends_are_free
from baselines.limits import time_is_over
from baselines.ompl.callbacks import way_s
from baselines.ompl.collision import ExactCollision, state_checker
from baselines.ompl.settings import OmplSettings, apply
from baselines.ompl.units import metres, tables_in
from baselines.units import free_side, unit_of
from baselines.visibility_graph import tiny_scene
from suite.geometry.kernels import first_collision
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.exact import path_length
from suite.scenes.scene import Query, Scene

LARGEST_SEED = 2**31 - 2

SAME_POINT = 1e-9
"""OMPL calls a state within 2e-16 units of the goal the goal; what is farther off is elsewhere."""

NO_LIMIT_S = 1e6
"""A time that no run reaches: OMPL's condition that can be ended by a call needs some time."""

SHORTEST_S = 1e-4
"""The least time that a condition is given."""


SettingsT = TypeVar("SettingsT", bound=OmplSettings, default=OmplSettings)
"""Settings of a planner of OMPL."""


class OmplPlanner(Planner[SettingsT]):
    """Base of all OMPL planners: set up the problem, run, and read the path."""

    abilities: ClassVar[Abilities] = Abilities(
        anytime=True, budgets=frozenset({"wall_s", "cpu_s", "checks"})
    )
    Settings: ClassVar[type[Any]] = OmplSettings
    ompl_class: ClassVar[Callable[[Any], Any]]
    """The planner's class in ``ompl.geometric``."""

    @abstractmethod
    def _run(self, problem: "Problem", recorder: Recorder) -> NDArray[np.float64] | None:
        """Run until the budget is spent, report improvements, and return the best path."""

    def warm_up(self) -> None:
        """Compile the kernel, load OMPL, and time its way into Python."""
        way_s()
        scene = tiny_scene()
        self.plan(scene, scene.query(), Budget(checks=50), np.random.default_rng(0), Recorder())

    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,
        rng: np.random.Generator,
        recorder: Recorder,
    ) -> Plan:
        """Run OMPL's planner within the budget."""
        began = time.perf_counter()
        if not ends_are_free(scene, query):
            return Plan(PlanStatus.INFEASIBLE, checks=0)
        if np.array_equal(query.start, query.goal):
            # Nothing to plan; OMPL's informed samplers raise an exception there.
            recorder.improved(0.0, checks=0)
            stay = np.array([query.start, query.goal])
            return Plan(PlanStatus.SOLVED, stay, claimed_cost=0.0, checks=0)
        ou.setLogLevel(ou.LogLevel.LOG_NONE)
        # OMPL has one seed for all; it is read when the objects of a run are built.
        ou.RNG.setSeed(int(rng.integers(1, LARGEST_SEED, endpoint=True)))
        if budget.wall_s is None and budget.cpu_s is None and budget.checks is None:
            budget = replace(budget, wall_s=self.settings.default_wall_s)
        problem = Problem(scene, query, self._build, budget, recorder)
        path = self._run(problem, recorder)
        problem.let_go()
        details = {
            "state_checks": float(problem.collision.state_checks),
            **self._measures(problem),
            **callback_share(problem, time.perf_counter() - began),
        }
        checks = problem.collision.checks
        if path is None:
            return Plan(
                PlanStatus.EXHAUSTED,
                generations=self._iterations(problem),
                checks=checks,
                details=details,
            )
        return Plan(
            PlanStatus.SOLVED,
            path,
            claimed_cost=path_length(path),
            generations=self._iterations(problem),
            generation_of_best=recorder.improvements[-1].generation
            if recorder.improvements
            else None,
            checks=checks,
            details=details,
        )

    def _build(self, problem: "Problem") -> Any:
        """Build OMPL's planner and hand it the settings that are not None."""
        planner = type(self).ompl_class(problem.information)
        apply(self.settings, planner, problem)
        return planner

    def _iterations(self, problem: "Problem") -> int | None:  # noqa: ARG002
        """Return the number of iterations, where OMPL tells it."""
        return None

    def _measures(self, problem: "Problem") -> dict[str, float]:  # noqa: ARG002
        """Any numbers of the planner's own to keep with the row."""
        return {}


def callback_share(problem: "Problem", elapsed_s: float) -> dict[str, float]:
    """Share of the run that went into Python and into the way there and back, estimated.

    See :meth:`ExactCollision.seconds` and :func:`way_s`. A run of one check has no estimate.
    """
    seconds = problem.collision.seconds(way_s())
    return {} if seconds is None else {"callback_share": seconds / elapsed_s}


class Problem:
    """One run's OMPL objects, all kept alive to its end: a dropped one crashes the process.

    collision : ExactCollision
    planner : of OMPL, set up.
    definition : of OMPL; knows the paths that were found.
    unit : metres that are 1 in OMPL's coordinates.
    """

    def __init__(
        self,
        scene: Scene,
        query: Query,
        build: Callable[["Problem"], Any],
        budget: Budget,
        recorder: Recorder,
    ) -> None:
        self.query = query
        self.unit = unit_of(scene)
        self._scene = scene
        self._wall_s = np.inf if budget.wall_s is None else budget.wall_s
        self._clock = recorder.wall_s
        self._time_is_over = time_is_over(budget, recorder)
        self._space = ob.RealVectorStateSpace(2)
        self._space.setBounds(_bounds(scene, self.unit))
        self._setup = og.SimpleSetup(self._space)
        self.information = self._setup.getSpaceInformation()
        limit = np.inf if budget.checks is None else budget.checks
        self.collision = ExactCollision(
            self.information, tables_in(self.unit, scene), limit, self._time_is_over
        )
        self.information.setMotionValidator(self.collision)
        self._setup.setStateValidityChecker(state_checker(self.collision))
        self._start, self._goal = self._state(query.start), self._state(query.goal)
        self._setup.setStartAndGoalStates(self._start, self._goal)
        self._build = build
        self.renew_planner()
        self.definition = self._setup.getProblemDefinition()

    def _state(self, point: NDArray[np.float64]) -> Any:
        state = self._space.allocState()
        state[0], state[1] = (float(x) / self.unit for x in point)
        return state

    @cached_property
    def side(self) -> float:
        """Of the box around the part of free space that the query lies in, metres."""
        return free_side(self._scene, self.query)

    @property
    def straight_line(self) -> NDArray[np.float64]:
        """The segment from start to goal as a path, metres."""
        return np.array([self.query.start, self.query.goal], dtype=np.float64)

    def straight_line_is_free(self) -> bool:
        """Check the straight line; it counts."""
        return self.collision.checkMotion(self._start, self._goal)

    def renew_planner(self) -> None:
        """Build the planner anew: some of OMPL's can't be used twice."""
        self.planner = self._build(self)
        self._setup.setPlanner(self.planner)

    def be_satisfied_with(self, length: float) -> None:
        """Have the planner end by itself with a path that is shorter than this, metres."""
        self._objective = ob.PathLengthOptimizationObjective(self.information)
        self._objective.setCostThreshold(ob.Cost(length / self.unit))
        self._setup.setOptimizationObjective(self._objective)

    def set_up(self) -> None:
        """Let OMPL choose what was not set, and build the planner's structures."""
        self._setup.setup()

    def until_over(self, seconds: float = np.inf) -> Any:
        """Make OMPL's condition that is true when the budget is spent, or after so many seconds.

        OMPL looks at its own clock in each iteration and never asks Python. Where checks or CPU
        time end the run, the collision check ends the condition by a call.
        """
        seconds = min(seconds, self.remaining_s(), NO_LIMIT_S)
        condition = ob.timedPlannerTerminationCondition(max(seconds, SHORTEST_S))
        self.collision.end = condition.terminate
        return condition

    def remaining_s(self) -> float:
        """Return the seconds of wall time that are left."""
        return self._wall_s - self._clock()

    def is_over(self) -> bool:
        """Whether the budget is spent."""
        return self.collision.checks >= self.collision.limit or self._time_is_over()

    def let_go(self) -> None:
        """Forget what would keep the run alive."""
        self.collision.let_go()

    def path(self) -> NDArray[np.float64] | None:
        """Read the best exact solution so far, from start to goal; None if there is none.

        Approximate solutions end short of the goal.
        """
        if not self.definition.hasExactSolution():
            return None
        return self.read(self.definition.getSolutionPath())

    def read(self, solution: Any) -> NDArray[np.float64] | None:
        """Read one of OMPL's paths, metres; None unless it is free and leads from start to goal.

        The kernel goes over it once more, uncounted. OMPL's simplifiers cut edges into pieces that
        they don't check, and rounding may move a piece into an obstacle. AORRTC has called paths
        exact that do not begin at the start.
        """
        path = metres(solution.getStates(), self.unit)
        ends = self.straight_line
        if not np.allclose(path[[0, -1]], ends, rtol=0.0, atol=SAME_POINT * self.unit):
            return None
        path[[0, -1]] = ends
        return path if first_collision(path, self._scene.arrays) < 0 else None


def _bounds(scene: Scene, unit: float) -> Any:
    xmin, ymin, xmax, ymax = scene.bounds
    bounds = ob.RealVectorBounds(2)
    for axis, (low, high) in enumerate(((xmin, xmax), (ymin, ymax))):
        bounds.setLow(axis, float(low) / unit)
        bounds.setHigh(axis, float(high) / unit)
    return bounds
