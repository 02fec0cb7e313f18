"""PRM and PRM*: growing and searching take turns, so that a counted run is reproducible."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og

from baselines.ompl.adapter import OmplPlanner, Problem
from baselines.ompl.collision import Point, do_nothing
from baselines.ompl.settings import ABOVE_0, AT_LEAST_1, OmplSettings, bound, ours
from suite.planner import Recorder
from suite.scenes.exact import path_length

PATIENCE_S = 4.0
"""How long a search of a roadmap may wait for OMPL's thread, where a path is known to exist."""


@dataclass(frozen=True, slots=True)
class PRMstarSettings(OmplSettings):
    """Settings of any roadmap; OMPL binds none of its own for PRM*.

    slice_s : seconds of growth after which the roadmap is first searched; ours.
    slice_checks : the same in checks, for runs that are limited by them; ours.
    slice_growth : share of what was spent so far that later slices have at least; ours. A search
        costs more in a larger roadmap, so that it must come more seldom.
    """

    slice_s: float = ours(0.005, ABOVE_0)
    slice_checks: int = ours(500, ABOVE_0)
    slice_growth: float = ours(0.1, ABOVE_0)


@dataclass(frozen=True, slots=True)
class PRMSettings(PRMstarSettings):
    """Settings of PRM: those of :class:`PRMstarSettings`, and its neighbours.

    max_nearest_neighbors : neighbours to which a new milestone is connected; None leaves OMPL's
        10. PRM* needs more and more of them.
    """

    max_nearest_neighbors: int | None = bound("setMaxNearestNeighbors", AT_LEAST_1)


@dataclass(slots=True)
class Pause:
    """Whether growth is paused, so that a roadmap is only searched.

    draws : samples that were drawn outside pauses.
    """

    is_on: bool = False
    draws: int = 0


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
        self._pause.draws += 1
        return bool(self._uniform.sample(state))

    def sampleNear(self, state: Any, near: Any, distance: float) -> bool:  # noqa: N802
        """Draw a free state near another."""
        return not self._pause.is_on and bool(self._uniform.sampleNear(state, near, distance))


class RoadmapPlanner(OmplPlanner[PRMstarSettings]):
    """Base of PRM and PRM*: a roadmap that grows, searched again and again.

    OMPL's own ``solve`` searches in a second thread while the first one grows the roadmap, and
    after 0.4 s adds random walks: its result depends on how fast the machine is. So here growth
    and search take turns: ``growRoadmap`` until a slice of the budget is spent, then ``solve``
    with the sampler paused. A run that is limited by checks is then the same everywhere.
    """

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        pause = Pause()
        search = _RoadmapSearch(problem, pause)
        began = time.perf_counter()
        path = None
        while True:
            found = search.shortest()
            if found is not None:
                path = found
                recorder.improved(path_length(path), checks=problem.collision.checks)
            if problem.is_over():
                problem.collision.visits = pause.draws
                return path
            self._grow(problem, time.perf_counter() - began, search.last_s)

    def _grow(self, problem: Problem, elapsed_s: float, search_s: float) -> None:
        """Grow the roadmap until the slice ends: by checks if they are limited, else by time."""
        settings, collision = self.settings, problem.collision
        slice_ends = np.inf
        left_s = problem.remaining_s() - search_s
        if np.isfinite(collision.limit):
            size = max(settings.slice_checks, settings.slice_growth * collision.checks)
            slice_ends = min(collision.checks + int(size), collision.limit)
        else:
            left_s = min(left_s, max(settings.slice_s, settings.slice_growth * elapsed_s))
        condition = problem.until_over(left_s)
        collision.call_at(slice_ends, condition.terminate)
        problem.planner.growRoadmapPtc(condition)
        collision.call_at(np.inf, do_nothing)

    def _measures(self, problem: Problem) -> dict[str, float]:
        return {
            "milestones": float(problem.planner.milestoneCount()),
            "roadmap_edges": float(problem.planner.edgeCount()),
        }


class _RoadmapSearch:
    """Searches of a roadmap that does not grow meanwhile.

    last_s : how long the last search took, seconds.
    """

    def __init__(self, problem: Problem, pause: Pause) -> None:
        self._problem = problem
        self._pause = pause
        problem.information.setValidStateSamplerAllocator(
            lambda information: PausableSampler(information, pause)
        )
        self._components = _Components()
        self._is_connected = False
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
            collision.free_motions = []
            unit = self._problem.unit
            start, goal = tuple((query.start / unit).tolist()), tuple((query.goal / unit).tolist())
            self._is_connected = self._components.root(start) == self._components.root(goal)
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


class PRMPlanner(RoadmapPlanner):
    """PRM (Kavraki et al. 1996): each milestone is connected to a few neighbours.

    Its paths need not come to the optimum, however large the roadmap.
    """

    name: ClassVar[str] = "ompl-prm"
    Settings: ClassVar[type[Any]] = PRMSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.PRM


class PRMstarPlanner(RoadmapPlanner):
    """PRM* (Karaman and Frazzoli 2011): the more milestones, the more neighbours of each."""

    name: ClassVar[str] = "ompl-prmstar"
    Settings: ClassVar[type[Any]] = PRMstarSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.PRMstar
