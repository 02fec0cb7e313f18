"""A* on a grid of eight neighbours by the package tcod, and string pulling.

Hart, Nilsson and Raphael (1968) for A*. The package searches; which edges of the grid are free
says the suite's exact kernel, so that no corner is cut and no thin wall is missed. Metres.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from baselines.ends import ends_are_free
from baselines.limits import time_is_over
from baselines.visibility_graph import tiny_scene
from suite.errors import PluginError
from suite.geometry.kernels import ObstacleArrays, first_collision, pinch_at, segment_enters
from suite.jit import kernel
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.exact import path_length
from suite.scenes.scene import Query, Scene

try:
    from tcod.path import CustomGraph, Pathfinder
except ModuleNotFoundError as error:
    raise PluginError(
        'it needs the package tcod. Install it with: pip install "kbga-bench[grid-astar]"'
    ) from error

CARDINAL, DIAGONAL = 70, 99
"""The package counts in whole numbers: 99 / 70 is the square root of 2 but for 5e-5."""

FINEST = 4000
"""Cells per side up to which every distance fits in the package's 32 bits."""

WAYS = ((0, 1), (1, 0), (1, 1), (1, -1))
"""Rows and columns from a cell to four of its neighbours; the other four have it as theirs."""

REACH = 2
"""Cells around that of the start, or the goal, through which it may be joined to the grid."""

Cell = tuple[int, int]


@dataclass(frozen=True, slots=True)
class GridAstarSettings:
    """Settings of A* on a grid.

    resolution : cells along the longer side of the workspace.
    smooth : pull the path taut: from each point straight on to the farthest one that it sees.
    """

    resolution: int = 200
    smooth: bool = True

    def __post_init__(self) -> None:
        if not 1 <= self.resolution <= FINEST:
            raise ValueError(f"resolution is {self.resolution}. It must be 1 to {FINEST} cells.")


class GridAstarPlanner(Planner[GridAstarSettings]):
    """A* from cell centre to cell centre along free segments, by the package tcod.

    A grid without a path proves nothing: such a run is exhausted. Time is looked at before
    each row of the grid and before the search, which is one call and takes the smaller part.
    """

    name: ClassVar[str] = "grid-astar"
    Settings = GridAstarSettings
    abilities: ClassVar[Abilities] = Abilities(
        deterministic=True, budgets=frozenset({"wall_s", "cpu_s", "checks"})
    )

    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,
        rng: np.random.Generator,  # noqa: ARG002
        recorder: Recorder,
    ) -> Plan:
        """Check the grid's edges, search it, and pull the path taut."""
        if not ends_are_free(scene, query):
            return Plan(PlanStatus.INFEASIBLE, checks=0)
        sight = Sight(scene.arrays, budget, time_is_over(budget, recorder))
        try:
            path = Grid(scene, self.settings.resolution, sight).path(query)
            if path is None:
                return Plan(PlanStatus.EXHAUSTED, checks=sight.checks)
        except OutOfBudgetError:
            return Plan(PlanStatus.EXHAUSTED, checks=sight.checks)
        recorder.improved(path_length(path), checks=sight.checks)
        if self.settings.smooth:
            path = pulled_taut(path, sight)
            recorder.improved(path_length(path), checks=sight.checks)
        return Plan(PlanStatus.SOLVED, path, claimed_cost=path_length(path), checks=sight.checks)

    def warm_up(self) -> None:
        """Compile the kernels."""
        scene = tiny_scene()
        planner = GridAstarPlanner(GridAstarSettings(resolution=10))
        planner.plan(scene, scene.query(), Budget(), np.random.default_rng(0), Recorder())


class OutOfBudgetError(Exception):
    """There is no check, or no time, left."""


class Sight:
    """Answers whether segments are free, and counts: no check more than the budget allows.

    arrays : ObstacleArrays
    checks : made so far.
    """

    def __init__(
        self, arrays: ObstacleArrays, budget: Budget, time_is_over: Callable[[], bool]
    ) -> None:
        self.arrays = arrays
        self.checks = 0
        self._limit = np.inf if budget.checks is None else budget.checks
        self._time_is_over = time_is_over

    def spend(self, checks: int) -> None:
        """Take so many checks from the budget; OutOfBudgetError if it does not have them."""
        if self.checks + checks > self._limit or self._time_is_over():
            raise OutOfBudgetError
        self.checks += checks

    def sees(self, a: NDArray[np.float64], b: NDArray[np.float64]) -> bool:
        """Whether the segment between two points (2,) is free."""
        self.spend(1)
        return bool(first_collision(np.array([a, b]), self.arrays) < 0)


class Grid:
    """Square cells over the workspace, and which segments between their centres are free.

    xs, ys : (columns,), (rows,) float64, metres: the centres of the cells.
    """

    def __init__(self, scene: Scene, resolution: int, sight: Sight) -> None:
        xmin, ymin, xmax, ymax = scene.bounds
        self._side = max(xmax - xmin, ymax - ymin) / resolution
        self.xs = _centres(xmin, xmax, self._side)
        self.ys = _centres(ymin, ymax, self._side)
        self._sight = sight
        self._graph = CustomGraph(self.shape)
        self._graph.set_heuristic(cardinal=CARDINAL, diagonal=DIAGONAL)
        self._add_edges()

    @property
    def shape(self) -> Cell:
        """Rows and columns."""
        return len(self.ys), len(self.xs)

    def path(self, query: Query) -> NDArray[np.float64] | None:
        """A path (n, 2) over cell centres, short but for its bends; None if there is none."""
        starts, goals = self._near(query.start), self._near(query.goal)
        self._sight.spend(0)
        pathfinder = Pathfinder(self._graph)
        for cell in starts:
            away = np.hypot(*(self._centre(cell) - query.start)) / self._side
            pathfinder.add_root(cell, round(CARDINAL * away))
        # The first, which is the nearest, unless there is no way to it.
        for cell in goals if starts else []:
            cells = pathfinder.path_to(cell)
            if tuple(cells[0]) in starts:
                centres = np.column_stack([self.xs[cells[:, 1]], self.ys[cells[:, 0]]])
                return np.vstack([query.start, centres, query.goal])
        return None

    def _add_edges(self) -> None:
        cost = np.ones(self.shape, dtype=np.int8)
        for down, right in WAYS:
            free = np.zeros(self.shape, dtype=np.int8)
            for row in range(len(self.ys) - down):
                self._sight.spend(len(self.xs) - abs(right))
                check_row(row, down, right, self.xs, self.ys, free, self._sight.arrays)
            back = np.roll(free, (down, right), axis=(0, 1))  # what goes round is 0
            length = DIAGONAL if down and right else CARDINAL
            self._graph.add_edge((down, right), length, cost=cost, condition=free)
            self._graph.add_edge((-down, -right), length, cost=cost, condition=back)

    def _centre(self, cell: Cell) -> NDArray[np.float64]:
        return np.array([self.xs[cell[1]], self.ys[cell[0]]])

    def _near(self, point: NDArray[np.float64]) -> list[Cell]:
        """Cells around a point whose centres it sees, the nearest first."""
        column, row = (
            int(np.searchsorted(centres, at - 0.5 * self._side, side="right"))
            for centres, at in zip((self.xs, self.ys), point, strict=True)
        )
        cells = [
            (i, j)
            for i in range(max(row - REACH, 0), min(row + REACH + 1, len(self.ys)))
            for j in range(max(column - REACH, 0), min(column + REACH + 1, len(self.xs)))
            if pinch_at(self.xs[j], self.ys[i], self._sight.arrays.pinches) < 0
        ]
        cells.sort(key=lambda cell: float(np.hypot(*(self._centre(cell) - point))))
        return [cell for cell in cells if self._sight.sees(point, self._centre(cell))]


def _centres(low: float, high: float, side: float) -> NDArray[np.float64]:
    count = max(1, int(np.ceil((high - low) / side - 1e-9)))
    return np.asarray(low + side * (np.arange(count) + 0.5), dtype=np.float64)


@kernel
def check_row(
    row: int,
    down: int,
    right: int,
    xs: np.ndarray,
    ys: np.ndarray,
    free: np.ndarray,
    arrays: ObstacleArrays,
) -> None:
    """Set in ``free``, (rows, columns), which cells of a row have a free segment that way.

    A path may bend in a centre, but never in a pinch point: so no segment begins or ends there.
    """
    for column in range(max(-right, 0), xs.shape[0] - max(right, 0)):
        ax, ay = xs[column], ys[row]
        bx, by = xs[column + right], ys[row + down]
        free[row, column] = (
            not segment_enters(ax, ay, bx, by, arrays)
            and pinch_at(ax, ay, arrays.pinches) < 0
            and pinch_at(bx, by, arrays.pinches) < 0
        )


def pulled_taut(path: NDArray[np.float64], sight: Sight) -> NDArray[np.float64]:
    """A path that goes from each of its points straight to the farthest one that is seen.

    It ends where the budget does: the rest of the path then stays as it is.
    """
    kept = [0]
    try:
        while kept[-1] < len(path) - 1:
            kept.append(_farthest_seen(path, kept[-1], sight))
    except OutOfBudgetError:
        kept.extend(range(kept[-1] + 1, len(path)))
    return path[kept]


def _farthest_seen(path: NDArray[np.float64], here: int, sight: Sight) -> int:
    for there in range(len(path) - 1, here + 1, -1):
        if sight.sees(path[here], path[there]):
            return there
    return here + 1
