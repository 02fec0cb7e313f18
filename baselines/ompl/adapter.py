"""OMPL's planners (Sucan, Moll and Kavraki 2012) behind the plugin interface: what all share.

Each planner is one row of settings and one way of watching it while it runs. Metres.
"""

import time
from abc import abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from baselines.ompl.collision import ExactCollision, is_free_point, state_checker
from baselines.ompl.settings import OmplSettings, apply
from baselines.visibility_graph import tiny_scene
from suite.exact import path_length
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scene import Query, Scene

LARGEST_SEED = 2**31 - 2

SAME_POINT_M = 1e-9
"""OMPL calls a state within 2e-16 of the goal the goal; what is farther off is another place."""


class OmplPlanner(Planner):
    """Base of all OMPL planners: set up the problem, run, and read the path."""

    abilities: ClassVar[Abilities] = Abilities(
        anytime=True, budgets=frozenset({"wall_s", "checks"})
    )
    Settings: ClassVar[type[Any]] = OmplSettings
    ompl_class: ClassVar[Callable[[Any], Any]]
    """The planner's class in ``ompl.geometric``."""

    @abstractmethod
    def _run(self, problem: "Problem", recorder: Recorder) -> NDArray[np.float64] | None:
        """Run until the budget is spent, report improvements, and return the best path."""

    def warm_up(self) -> None:
        """Compile the kernel and load OMPL."""
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
        if not (is_free_point(scene, query.start) and is_free_point(scene, query.goal)):
            return Plan(PlanStatus.INFEASIBLE, checks=0)
        if np.array_equal(query.start, query.goal):
            # Nothing to plan; OMPL's informed samplers raise an exception there.
            recorder.improved(0.0, checks=0)
            stay = np.array([query.start, query.goal])
            return Plan(PlanStatus.SOLVED, stay, claimed_cost=0.0, checks=0)
        ou.setLogLevel(ou.LogLevel.LOG_NONE)
        # OMPL has one seed for all; it is read when the objects of a run are built.
        ou.RNG.setSeed(int(rng.integers(1, LARGEST_SEED, endpoint=True)))
        wall_s = budget.wall_s
        if wall_s is None:
            wall_s = np.inf if budget.checks is not None else self.settings.default_wall_s
        limit = np.inf if budget.checks is None else budget.checks
        problem = Problem(scene, query, self._build, limit, wall_s, recorder.wall_s)
        path = self._run(problem, recorder)
        details = {
            "state_checks": float(problem.collision.state_checks),
            **self._measures(problem),
            **callback_share(problem.collision, time.perf_counter() - began),
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

    def _build(self, information: Any) -> Any:
        """Build OMPL's planner and hand it the settings that are not None."""
        planner = type(self).ompl_class(information)
        apply(self.settings, planner)
        return planner

    def _iterations(self, problem: "Problem") -> int | None:  # noqa: ARG002
        """Return the number of iterations, where OMPL tells it."""
        return None

    def _measures(self, problem: "Problem") -> dict[str, float]:  # noqa: ARG002
        """Any numbers of the planner's own to keep with the row."""
        return {}


def callback_share(collision: ExactCollision, elapsed_s: float) -> dict[str, float]:
    """Share of the run that went into answering OMPL's questions in Python, estimated.

    The mean time of an answer (see :meth:`ExactCollision.mean_s`) times the number of checks. A
    run of one check has no estimate.
    """
    mean_s = collision.mean_s()
    return {} if mean_s is None else {"callback_share": mean_s * collision.checks / elapsed_s}


class Problem:
    """One run's OMPL objects, all kept alive to its end: a dropped one crashes the process.

    collision : ExactCollision
    planner : of OMPL, set up.
    definition : of OMPL; knows the paths that were found.
    wall_s : seconds on the clock at which the run must end.
    clock : the recorder's, in seconds: the run has no other.
    """

    def __init__(
        self,
        scene: Scene,
        query: Query,
        build: Callable[[Any], Any],
        limit: float,
        wall_s: float,
        clock: Callable[[], float],
    ) -> None:
        self.query = query
        self.wall_s = wall_s
        self.clock = clock
        self._space = ob.RealVectorStateSpace(2)
        self._space.setBounds(_bounds(scene))
        self._setup = og.SimpleSetup(self._space)
        self.information = self._setup.getSpaceInformation()
        self.collision = ExactCollision(self.information, scene, limit)
        self.information.setMotionValidator(self.collision)
        self._setup.setStateValidityChecker(state_checker(self.collision))
        self._start, self._goal = self._state(query.start), self._state(query.goal)
        self._setup.setStartAndGoalStates(self._start, self._goal)
        self.planner = build(self.information)
        self._setup.setPlanner(self.planner)
        self.definition = self._setup.getProblemDefinition()

    def _state(self, point: NDArray[np.float64]) -> Any:
        state = self._space.allocState()
        state[0], state[1] = float(point[0]), float(point[1])
        return state

    @property
    def straight_line(self) -> NDArray[np.float64]:
        """The segment from start to goal as a path."""
        return np.array([self.query.start, self.query.goal], dtype=np.float64)

    def set_up(self) -> None:
        """Let OMPL choose what was not set, and build the planner's structures."""
        self._setup.setup()

    def remaining_s(self) -> float:
        """Return the seconds of wall time that are left."""
        return self.wall_s - self.clock()

    def is_over(self) -> bool:
        """Whether the budget is spent."""
        return self.collision.checks >= self.collision.limit or self.remaining_s() <= 0.0

    def path(self) -> NDArray[np.float64] | None:
        """Read the best exact solution so far, from start to goal; None if there is none.

        Approximate solutions end short of the goal. AORRTC has called paths exact that do not
        begin at the start.
        """
        if not self.definition.hasExactSolution():
            return None
        states = self.definition.getSolutionPath().getStates()
        path = np.array([(s[0], s[1]) for s in states], dtype=np.float64)
        ends = self.straight_line
        if not np.allclose(path[[0, -1]], ends, rtol=0.0, atol=SAME_POINT_M):
            return None
        path[[0, -1]] = ends
        return path


def _bounds(scene: Scene) -> Any:
    xmin, ymin, xmax, ymax = scene.bounds
    bounds = ob.RealVectorBounds(2)
    for axis, (low, high) in enumerate(((xmin, xmax), (ymin, ymax))):
        bounds.setLow(axis, low)
        bounds.setHigh(axis, high)
    return bounds
