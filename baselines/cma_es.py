"""CMA-ES on the coordinates of a fixed number of waypoints, by the package cmaes.

Hansen and Ostermeier (2001); restarts with a population twice as large after Auger and Hansen
(2005). What one would try first with an optimiser from the shelf: no knowledge of obstacles but
the length of the path that lies in them. Metres; the optimiser itself sees genes and costs in rooms
of side 0.5 to 1.
"""

from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from baselines.ends import ends_are_free
from baselines.limits import time_is_over
from baselines.units import unit_of
from baselines.visibility_graph import tiny_scene
from suite.errors import PluginError
from suite.geometry.kernels import (
    FIRST,
    LAST,
    SKIP,
    XMAX,
    XMIN,
    YMAX,
    YMIN,
    ObstacleArrays,
    first_collision,
)
from suite.jit import kernel
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.scene import Query, Scene

try:
    from cmaes import CMA
except ModuleNotFoundError as error:
    raise PluginError(
        'it needs the package cmaes. Install it with: pip install "kbga-bench[cmaes]"'
    ) from error

LARGEST_SEED = 2**31 - 1

FALL = 1.0 - 1e-4
"""A cost that falls by less stagnates."""

TOUCH = 1e-11
"""Share of a path that may lie inside obstacles by rounding, where it touches them: worth an exact
check."""


@dataclass(frozen=True, slots=True)
class CmaEsSettings:
    """Settings of CMA-ES over waypoints; but for the population, the choices are ours.

    Tried on the paper's eight scenes, a second each: 3, 5 and 8 waypoints with penalties of 3, 10,
    100 and 1000 and sigmas of 0.1, 0.2 and 0.4 on 3 seeds, the best of these on 20. These solve 79
    of 160 runs with a median gap of 1.5 %; 1000 and 0.1 solve 82, with a gap of 4.7 %.

    waypoints : number of points between start and goal.
    penalty : cost of a metre inside obstacles, in metres of path.
    sigma : first standard deviation, as a share of the longer side of the workspace.
    population_size : of the first run; None leaves the package's 4 + 3 ln(n) for n coordinates.
    stagnation : generations in which a run's lowest cost falls by less than a ten thousandth,
        before it ends; the package's own tolerances wait for twelve digits.
    restarts : runs after the first, each with a population twice as large, from random waypoints.
    """

    waypoints: int = 5
    penalty: float = 3.0
    sigma: float = 0.2
    population_size: int | None = None
    stagnation: int = 50
    restarts: int = 6

    def __post_init__(self) -> None:
        least = {"waypoints": 1, "population_size": 2, "stagnation": 1, "restarts": 0}
        for setting in fields(self):
            value, low = getattr(self, setting.name), least.get(setting.name)
            if value is None:
                continue
            if low is not None and value < low:
                raise ValueError(f"{setting.name} is {value}. It must be {low} or more.")
            if low is None and not 0.0 < value < np.inf:
                raise ValueError(f"{setting.name} is {value}. It must be a number above 0.")


class CmaEsPlanner(Planner[CmaEsSettings]):
    """CMA-ES that minimises length plus penalty times the length inside obstacles.

    A run ends when it stagnates, or the package says so, and the last one ends the planner, unless
    the budget does before. An evaluation checks each of its segments; a path that seems to be the
    best free one has them checked once more, exactly, before it counts.
    """

    name: ClassVar[str] = "cmaes"
    Settings = CmaEsSettings
    abilities: ClassVar[Abilities] = Abilities(
        anytime=True, budgets=frozenset({"wall_s", "cpu_s", "generations", "checks"})
    )

    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,
        rng: np.random.Generator,
        recorder: Recorder,
    ) -> Plan:
        """Evolve waypoints, again from elsewhere when that has converged, within the budget."""
        if not ends_are_free(scene, query):
            return Plan(PlanStatus.INFEASIBLE, checks=0)
        search = Search(scene, query, self.settings, budget, recorder)
        for restart in range(self.settings.restarts + 1):
            search.run(restart, rng)
            if search.is_over():
                break
        return Plan(
            PlanStatus.EXHAUSTED if search.best is None else PlanStatus.SOLVED,
            search.best,
            claimed_cost=None if search.best is None else search.best_cost,
            generations=search.generation,
            generation_of_best=search.generation_of_best,
            checks=search.checks,
        )

    def warm_up(self) -> None:
        """Compile the kernel, and load what the package loads."""
        scene, rng = tiny_scene(), np.random.default_rng(0)
        self.plan(scene, scene.query(), Budget(generations=2), rng, Recorder())


class Search:
    """What the runs of one plan share: the problem, the budget, and the best free path so far.

    best : (n, 2) float64, metres; None until a free path is found.
    best_cost : float, metres.
    generation, checks : counted over all runs.
    generation_of_best : None until a free path is found.
    """

    def __init__(
        self,
        scene: Scene,
        query: Query,
        settings: CmaEsSettings,
        budget: Budget,
        recorder: Recorder,
    ) -> None:
        self.best: NDArray[np.float64] | None = None
        self.best_cost = np.inf
        self.generation = 0
        self.generation_of_best: int | None = None
        self.checks = 0
        self._arrays = scene.arrays
        self._ends = np.array([query.start, query.goal])
        # The package takes steps beyond 1e4 for divergence, and has other fixed tolerances.
        self._unit = unit_of(scene)
        bounds = np.reshape(scene.bounds, (2, 2)).T / self._unit
        self._bounds = np.tile(bounds, (settings.waypoints, 1))
        self._settings = settings
        self._budget = budget
        self._time_is_over = time_is_over(budget, recorder)
        self._recorder = recorder

    def run(self, restart: int, rng: np.random.Generator) -> None:
        """Run CMA-ES once, until it has converged or the budget is spent."""
        cma = self._optimiser(restart, rng)
        lowest, since = np.inf, 0
        while since < self._settings.stagnation and not (cma.should_stop() or self.is_over()):
            solutions = self._generation(cma)
            if solutions is None:
                return
            cma.tell(solutions)
            cost = min(cost for _, cost in solutions)
            lowest, since = (cost, 0) if cost < FALL * lowest else (lowest, since + 1)

    def _generation(self, cma: Any) -> list[tuple[NDArray[np.float64], float]] | None:
        """A generation's genes and costs; None if the budget ends before it does."""
        self.generation += 1
        solutions: list[tuple[NDArray[np.float64], float]] = []
        while len(solutions) < cma.population_size:
            if self._is_spent():
                return None
            genes = cma.ask()
            cost = self._cost(self._unit * genes)
            solutions.append((genes, cost / self._unit))
        return solutions

    def is_over(self) -> bool:
        """Whether the budget does not allow another generation."""
        generations = self._budget.generations
        return self._is_spent() or (generations is not None and self.generation >= generations)

    def _is_spent(self) -> bool:
        """Whether there is no time left, or there are not enough checks for another path."""
        return not self._can_check(self._settings.waypoints + 1) or self._time_is_over()

    def _can_check(self, segments: int) -> bool:
        """Whether the budget has as many checks left."""
        return self._budget.checks is None or self.checks + segments <= self._budget.checks

    def _optimiser(self, restart: int, rng: np.random.Generator) -> Any:
        """The package's optimiser: first around the straight line, then around random points."""
        settings = self._settings
        low, high = self._bounds.T
        share = np.linspace(0.0, 1.0, settings.waypoints + 2)[1:-1, None]
        line = (self._ends[0] + share * (self._ends[1] - self._ends[0])).ravel() / self._unit
        size = settings.population_size or 4 + int(3 * np.log(len(low)))
        return CMA(
            mean=line if restart == 0 else rng.uniform(low, high),
            sigma=settings.sigma * float(np.max(high - low)),
            bounds=self._bounds,
            seed=int(rng.integers(LARGEST_SEED)),
            population_size=size * 2**restart,
        )

    def _cost(self, waypoints: NDArray[np.float64]) -> float:
        """Cost of a path, metres; if it is free and the best, it is kept and reported."""
        path = np.vstack([self._ends[0], waypoints.reshape(-1, 2), self._ends[1]])
        length, inside = lengths(path, self._arrays)
        self.checks += len(path) - 1
        if length < self.best_cost and inside <= TOUCH * length:
            self._keep_if_free(path, length)
        return float(length + self._settings.penalty * inside)

    def _keep_if_free(self, path: NDArray[np.float64], length: float) -> None:
        if not self._can_check(len(path) - 1):
            return
        self.checks += len(path) - 1
        if first_collision(path, self._arrays) < 0:
            self.best, self.best_cost = path, length
            self.generation_of_best = self.generation
            self._recorder.improved(length, generation=self.generation, checks=self.checks)


@kernel
def lengths(path: np.ndarray, arrays: ObstacleArrays) -> tuple[float, float]:
    """Length of a path (n, 2), and of what of it lies inside obstacles or the frame, metres."""
    total, inside = 0.0, 0.0
    for i in range(path.shape[0] - 1):
        ax, ay, bx, by = path[i, 0], path[i, 1], path[i + 1, 0], path[i + 1, 1]
        length = np.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
        total += length
        inside += length * _share_inside(ax, ay, bx, by, arrays.tree, arrays.vertices)
    return total, inside


@kernel
def _share_inside(
    ax: float, ay: float, bx: float, by: float, tree: np.ndarray, vertices: np.ndarray
) -> float:
    """Share of segment a-b that lies inside the convex parts, which do not overlap."""
    share = 0.0
    row = 0
    while row < tree.shape[0]:
        if (
            max(ax, bx) < tree[row, XMIN]
            or min(ax, bx) > tree[row, XMAX]
            or max(ay, by) < tree[row, YMIN]
            or min(ay, by) > tree[row, YMAX]
        ):
            row = int(tree[row, SKIP])
            continue
        first = int(tree[row, FIRST])
        if first >= 0:
            share += _share_in_part(ax, ay, bx, by, vertices, first, int(tree[row, LAST]) - 1)
        row += 1
    return share


@kernel
def _share_in_part(
    ax: float, ay: float, bx: float, by: float, vertices: np.ndarray, first: int, last: int
) -> float:
    """Share of segment a-b inside a convex part, clipped edge by edge (Cyrus and Beck 1978)."""
    enters, leaves = 0.0, 1.0
    px, py = vertices[last, 0], vertices[last, 1]
    for i in range(first, last + 1):
        qx, qy = vertices[i, 0], vertices[i, 1]
        # The part lies on the left of p-q: there, side + t * rise is above 0.
        side = (qx - px) * (ay - py) - (qy - py) * (ax - px)
        rise = (qx - px) * (by - ay) - (qy - py) * (bx - ax)
        if rise > 0.0:
            enters = max(enters, -side / rise)
        elif rise < 0.0:
            leaves = min(leaves, -side / rise)
        elif side <= 0.0:
            return 0.0
        px, py = qx, qy
    return max(leaves - enters, 0.0)
