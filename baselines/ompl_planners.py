"""OMPL's planners (Sucan, Moll and Kavraki 2012), checked exactly and seen while they run.

Each planner is one row of settings and one way of watching it. Collision checks are the suite's
own exact kernel, called back from C++: OMPL's default checks points along a segment and cuts
corners. What a callback costs (0.6 us) is part of the planner's time. Metres.
"""

import time
import weakref
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from baselines.visibility_graph import tiny_scene
from suite.exact import path_length
from suite.geometry.kernels import segment_enters_tables
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scene import Query, Scene

Point = tuple[float, float]

LARGEST_SEED = 2**31 - 2

PATIENCE_S = 4.0
"""How long a search of a roadmap may wait for OMPL's thread, where a path is known to exist."""

NO_LIMIT_S = 1e6
"""A time that no run reaches: OMPL's condition that can be ended by a call needs some time."""


def _bound(setter: str) -> Any:
    """Declare a setting that OMPL's planner has a setter for; None leaves OMPL's own default."""
    return field(default=None, metadata={"setter": setter})


@dataclass(frozen=True, slots=True)
class OmplSettings:
    """Settings of any OMPL planner.

    default_wall_s : seconds of wall time of a run whose budget sets no limit; the choice is ours.
    """

    default_wall_s: float = 1.0

    def __post_init__(self) -> None:
        if not self.default_wall_s > 0.0:
            raise ValueError(f"default_wall_s is {self.default_wall_s}. It must be above 0.")


@dataclass(frozen=True, slots=True)
class RRTstarSettings(OmplSettings):
    """Settings of RRT*; None leaves OMPL's default.

    range : longest edge that extends the tree, metres.
    goal_bias : share of samples that are the goal itself.
    rewire_factor : how many neighbours are rewired, relative to what optimality needs.
    k_nearest : rewire the k nearest neighbours, instead of all within a radius.
    delay_cc : check neighbours in order of cost, and only until the first that is free.
    tree_pruning : drop the states that can't be part of a better path.
    prune_threshold : share by which the cost must fall before the tree is pruned.
    informed_sampling : sample only where a better path can lead.
    sample_rejection : reject samples that can't be part of a better path.
    new_state_rejection : reject new states that can't be part of a better path.
    ordered_sampling : draw samples in batches, and use the most promising first.
    batch_size : of ordered sampling.
    """

    range: float | None = _bound("setRange")
    goal_bias: float | None = _bound("setGoalBias")
    rewire_factor: float | None = _bound("setRewireFactor")
    k_nearest: bool | None = _bound("setKNearest")
    delay_cc: bool | None = _bound("setDelayCC")
    tree_pruning: bool | None = _bound("setTreePruning")
    prune_threshold: float | None = _bound("setPruneThreshold")
    informed_sampling: bool | None = _bound("setInformedSampling")
    sample_rejection: bool | None = _bound("setSampleRejection")
    new_state_rejection: bool | None = _bound("setNewStateRejection")
    ordered_sampling: bool | None = _bound("setOrderedSampling")
    batch_size: int | None = _bound("setBatchSize")

    def __post_init__(self) -> None:
        # Not super(): in a dataclass with slots it names the class before the slots were added.
        OmplSettings.__post_init__(self)
        if self.range is not None and not self.range > 0.0:
            raise ValueError(f"range is {self.range}. It must be above 0.")
        if self.goal_bias is not None and not 0.0 <= self.goal_bias <= 1.0:
            raise ValueError(f"goal_bias is {self.goal_bias}. It must lie between 0 and 1.")
        if self.rewire_factor is not None and not self.rewire_factor >= 1.0:
            raise ValueError(f"rewire_factor is {self.rewire_factor}. It must be 1 or more.")
        if self.batch_size is not None and not self.batch_size >= 1:
            raise ValueError(f"batch_size is {self.batch_size}. It must be 1 or more.")


@dataclass(frozen=True, slots=True)
class PRMstarSettings(OmplSettings):
    """Settings of PRM*; OMPL binds none of its own.

    slice_s : seconds of growth after which the roadmap is first searched; ours.
    slice_checks : the same in checks, for runs that are limited by them; ours.
    slice_growth : share of what was spent so far that later slices have at least; ours. A search
        costs more in a larger roadmap, so that it must come more seldom.
    """

    slice_s: float = 0.005
    slice_checks: int = 500
    slice_growth: float = 0.1

    def __post_init__(self) -> None:
        OmplSettings.__post_init__(self)
        for name in ("slice_s", "slice_checks", "slice_growth"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} is {getattr(self, name)}. It must be above 0.")


class ExactCollision(ob.MotionValidator):  # type: ignore[misc]
    """OMPL's questions about states and motions, answered by the exact kernel and counted.

    Once ``limit`` checks are spent, nothing is checked any more and every motion is refused: a
    planner that is in the middle of an iteration then ends it without new edges.

    limit : checks that may be made.
    stop_at : checks after which ``stop`` is called.
    checks : checks made, of states and motions.
    state_checks : those of states.
    free_motions : list that takes the two ends of each free motion; None to keep none.
    """

    def __init__(self, information: Any, scene: Scene, limit: float) -> None:
        super().__init__(information)
        arrays = scene.arrays
        self._tables = (
            arrays.tree,
            arrays.vertices,
            arrays.pinches,
            arrays.ways,
        )
        self.limit = limit
        self.stop_at = limit
        self.stop: Callable[[], None] = _do_nothing
        self.checks = 0
        self.state_checks = 0
        self.free_motions: list[tuple[Point, Point]] | None = None

    def checkMotion(self, a: Any, b: Any) -> bool:  # noqa: N802 (OMPL's name)
        """Whether the segment a-b is free."""
        ax, ay, bx, by = a[0], a[1], b[0], b[1]
        is_free = self._check(ax, ay, bx, by)
        if is_free and self.free_motions is not None:
            self.free_motions.append(((ax, ay), (bx, by)))
        return is_free

    def is_free(self, state: Any) -> bool:
        """Whether a point is free; it counts as the check of a segment, which it costs."""
        self.state_checks += 1
        x, y = state[0], state[1]
        return self._check(x, y, x, y)

    def is_free_point(self, x: float, y: float) -> bool:
        """Whether a point is free; not counted."""
        return not segment_enters_tables(x, y, x, y, *self._tables)

    def _check(self, ax: float, ay: float, bx: float, by: float) -> bool:
        if self.checks >= self.stop_at:
            self.stop()
            if self.checks >= self.limit:
                return False
        self.checks += 1
        return not segment_enters_tables(ax, ay, bx, by, *self._tables)


def _do_nothing() -> None:
    pass


def _alive(reference: "weakref.ref[ExactCollision]") -> ExactCollision:
    collision = reference()
    if collision is None:
        raise RuntimeError("OMPL asked about a state after the end of the run.")
    return collision


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

    def refuse(self, scene: Scene, query: Query, budget: Budget) -> str | None:  # noqa: ARG002
        """Refuse a budget of generations alone: OMPL's planners have no common count of them."""
        if budget.generations is None or budget.wall_s is not None or budget.checks is not None:
            return None
        return f"{self.name} can't be limited by generations. Give wall_s or checks."

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
        ou.setLogLevel(ou.LogLevel.LOG_NONE)
        # OMPL has one seed for all; it is read when the objects of a run are built.
        ou.RNG.setSeed(int(rng.integers(1, LARGEST_SEED, endpoint=True)))
        wall_s = budget.wall_s
        if wall_s is None:
            wall_s = np.inf if budget.checks is not None else self.settings.default_wall_s
        limit = np.inf if budget.checks is None else budget.checks
        problem = Problem(scene, query, self._build, limit, began + wall_s)
        if not problem.ends_are_free():
            return Plan(PlanStatus.INFEASIBLE, checks=0)
        path = self._run(problem, recorder)
        details = {"state_checks": float(problem.collision.state_checks), **self._measures(problem)}
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
        for setting in fields(self.settings):
            value = getattr(self.settings, setting.name)
            if value is not None and "setter" in setting.metadata:
                getattr(planner, setting.metadata["setter"])(value)
        return planner

    def _iterations(self, problem: "Problem") -> int | None:  # noqa: ARG002
        """Return the number of iterations, where OMPL tells it."""
        return None

    def _measures(self, problem: "Problem") -> dict[str, float]:  # noqa: ARG002
        """Any numbers of the planner's own to keep with the row."""
        return {}


class Problem:
    """One run's OMPL objects, all kept alive to its end: a dropped one crashes the process.

    collision : ExactCollision
    planner : of OMPL, set up.
    definition : of OMPL; knows the paths that were found.
    deadline : on the clock of ``time.perf_counter``.
    """

    def __init__(
        self,
        scene: Scene,
        query: Query,
        build: Callable[[Any], Any],
        limit: float,
        deadline: float,
    ) -> None:
        self.query = query
        self.deadline = deadline
        self._space = ob.RealVectorStateSpace(2)
        self._space.setBounds(_bounds(scene))
        self._setup = og.SimpleSetup(self._space)
        self.information = self._setup.getSpaceInformation()
        self.collision = ExactCollision(self.information, scene, limit)
        self.information.setMotionValidator(self.collision)
        # OMPL owns this function, and the validator owns a part of OMPL: a cycle would never die.
        collision = weakref.ref(self.collision)
        self._setup.setStateValidityChecker(lambda state: _alive(collision).is_free(state))
        self._start, self._goal = self._state(query.start), self._state(query.goal)
        self._setup.setStartAndGoalStates(self._start, self._goal)
        self.planner = build(self.information)
        self._setup.setPlanner(self.planner)
        self.definition = self._setup.getProblemDefinition()

    def _state(self, point: NDArray[np.float64]) -> Any:
        state = self._space.allocState()
        state[0], state[1] = float(point[0]), float(point[1])
        return state

    def ends_are_free(self) -> bool:
        """Whether start and goal lie in free space; OMPL asks again, and these are not counted."""
        return self.collision.is_free_point(*self.query.start) and self.collision.is_free_point(
            *self.query.goal
        )

    def set_up(self) -> None:
        """Let OMPL choose what was not set, and build the planner's structures."""
        self._setup.setup()

    def remaining_s(self) -> float:
        """Return the seconds of wall time that are left."""
        return self.deadline - time.perf_counter()

    def is_over(self) -> bool:
        """Whether the budget is spent."""
        return self.collision.checks >= self.collision.limit or self.remaining_s() <= 0.0

    def path(self) -> NDArray[np.float64] | None:
        """Read the best exact solution so far; approximate ones end short of the goal."""
        if not self.definition.hasExactSolution():
            return None
        states = self.definition.getSolutionPath().getStates()
        path = np.array([(s[0], s[1]) for s in states], dtype=np.float64)
        # OMPL calls a state within 2e-16 of the goal the goal.
        path[0], path[-1] = self.query.start, self.query.goal
        return path


def _bounds(scene: Scene) -> Any:
    xmin, ymin, xmax, ymax = scene.bounds
    bounds = ob.RealVectorBounds(2)
    for axis, (low, high) in enumerate(((xmin, xmax), (ymin, ymax))):
        bounds.setLow(axis, low)
        bounds.setHigh(axis, high)
    return bounds


class RRTstarPlanner(OmplPlanner):
    """RRT* (Karaman and Frazzoli 2011): a tree that is rewired as it grows.

    Its termination condition is called in each iteration, and reads the best cost there.
    """

    name: ClassVar[str] = "ompl-rrtstar"
    Settings: ClassVar[type[Any]] = RRTstarSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.RRTstar

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        planner, collision = problem.planner, problem.collision
        best = np.inf

        def is_over() -> bool:
            nonlocal best
            cost = planner.bestCost().value()
            if cost < best:
                best = cost
                recorder.improved(cost, generation=planner.numIterations(), checks=collision.checks)
            return problem.is_over()

        problem.set_up()
        planner.solve(ob.PlannerTerminationCondition(is_over))
        is_over()  # the last iteration may have found a better path
        return problem.path()

    def _iterations(self, problem: Problem) -> int:
        return int(problem.planner.numIterations())


@dataclass(slots=True)
class Pause:
    """Whether growth is paused, so that a roadmap is only searched."""

    is_on: bool = False


class PausableSampler(ob.ValidStateSampler):  # type: ignore[misc]
    """Uniform samples of free space, or none at all during a pause."""

    def __init__(self, information: Any, pause: Pause) -> None:
        super().__init__(information)
        self._uniform = ob.UniformValidStateSampler(information)
        self._pause = pause

    def sample(self, state: Any) -> bool:
        """Draw a free state; in a pause draw nothing, and no random number either."""
        if self._pause.is_on:
            time.sleep(1e-4)  # leave the processor to the thread that searches
            return False
        return bool(self._uniform.sample(state))

    def sampleNear(self, state: Any, near: Any, distance: float) -> bool:  # noqa: N802
        """Draw a free state near another."""
        return not self._pause.is_on and bool(self._uniform.sampleNear(state, near, distance))


class PRMstarPlanner(OmplPlanner):
    """PRM* (Karaman and Frazzoli 2011): a roadmap that grows, searched again and again.

    OMPL's own ``solve`` searches in a second thread while the first one grows the roadmap, and
    after 0.4 s adds random walks: its result depends on how fast the machine is. So here growth
    and search take turns: ``growRoadmap`` until a slice of the budget is spent, then ``solve``
    with the sampler paused. A run that is limited by checks is then the same everywhere.
    """

    name: ClassVar[str] = "ompl-prmstar"
    Settings: ClassVar[type[Any]] = PRMstarSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.PRMstar

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        search = _RoadmapSearch(problem)
        began = time.perf_counter()
        path = None
        while True:
            found = search.shortest()
            if found is not None:
                path = found
                recorder.improved(path_length(path), checks=problem.collision.checks)
            if problem.is_over():
                return path
            self._grow(problem, time.perf_counter() - began, search.last_s)

    def _grow(self, problem: Problem, elapsed_s: float, search_s: float) -> None:
        """Grow the roadmap until the slice ends: by checks if they are limited, else by time."""
        settings, collision = self.settings, problem.collision
        left_s = min(problem.remaining_s() - search_s, NO_LIMIT_S)
        if np.isfinite(collision.limit):
            size = max(settings.slice_checks, settings.slice_growth * collision.checks)
            collision.stop_at = min(collision.checks + int(size), collision.limit)
        else:
            left_s = min(left_s, max(settings.slice_s, settings.slice_growth * elapsed_s))
        condition = ob.timedPlannerTerminationCondition(max(left_s, 1e-4))
        collision.stop = condition.terminate
        problem.planner.growRoadmapPtc(condition)
        collision.stop = _do_nothing

    def _measures(self, problem: Problem) -> dict[str, float]:
        return {
            "milestones": float(problem.planner.milestoneCount()),
            "roadmap_edges": float(problem.planner.edgeCount()),
        }


class _RoadmapSearch:
    """Searches of a roadmap that does not grow meanwhile.

    last_s : how long the last search took, seconds.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._pause = pause = Pause()
        problem.information.setValidStateSamplerAllocator(
            lambda information: PausableSampler(information, pause)
        )
        self._components = _Components()
        self._is_connected = False
        self._has_loop = False
        self.last_s = 0.0
        problem.set_up()
        problem.collision.free_motions = []
        self._solve(0.0001)  # adds start and goal to the roadmap

    def shortest(self) -> NDArray[np.float64] | None:
        """Shortest path from start to goal in the roadmap as it is; None if there is none.

        OMPL's thread searches only if it starts before ``solve`` ends, which nobody promises; so
        ``solve`` is called for ever longer until it has.
        """
        began = time.perf_counter()
        if not self._connects():
            return None
        definition = self._problem.definition
        # Solutions are kept sorted by a cost that the two threads of earlier calls raced for.
        definition.clearSolutionPaths()
        wait_s = 0.0005
        while not definition.hasExactSolution() and wait_s < PATIENCE_S:
            self._solve(wait_s)
            wait_s *= 2.0
        self.last_s = time.perf_counter() - began
        return self._problem.path()

    def _connects(self) -> bool:
        """Whether the roadmap connects start and goal: each free motion is one of its edges."""
        collision, query = self._problem.collision, self._problem.query
        if not self._is_connected and collision.free_motions is not None:
            for a, b in collision.free_motions:
                self._components.join(a, b)
                self._has_loop = self._has_loop or a == b
            collision.free_motions = []
            start, goal = tuple(query.start.tolist()), tuple(query.goal.tolist())
            self._is_connected = self._components.root(start) == self._components.root(goal)
            if start == goal:  # two milestones in one place: connected by an edge without length
                self._is_connected = self._has_loop
            if self._is_connected:
                collision.free_motions = None
        return self._is_connected

    def _solve(self, wait_s: float) -> None:
        self._pause.is_on = True
        self._problem.planner.solve(wait_s)
        self._pause.is_on = False


class _Components:
    """Connected components of points, by union and find (Tarjan 1975)."""

    def __init__(self) -> None:
        self._parent: dict[Point, Point] = {}

    def root(self, point: Point) -> Point:
        parent = self._parent
        above = parent.setdefault(point, point)
        while above != point:
            parent[point] = parent[above]
            point, above = above, parent[above]
        return point

    def join(self, a: Point, b: Point) -> None:
        self._parent[self.root(a)] = self.root(b)
