"""OMPL's questions about states and motions, answered by the suite's exact kernel and counted.

OMPL's default checks points along a segment and cuts corners. What a callback costs (0.6 us) is
part of the planner's time. Metres.
"""

import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from suite.geometry.kernels import segment_enters_tables
from suite.scene import Scene

Point = tuple[float, float]


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
        self._tables = _tables(scene)
        self.limit = limit
        self.stop_at = limit
        self.stop: Callable[[], None] = do_nothing
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
        before = self.checks
        x, y = state[0], state[1]
        is_free = self._check(x, y, x, y)
        self.state_checks += self.checks - before
        return is_free

    def _check(self, ax: float, ay: float, bx: float, by: float) -> bool:
        if self.checks >= self.stop_at:
            self.stop()
            if self.checks >= self.limit:
                return False
        self.checks += 1
        return not segment_enters_tables(ax, ay, bx, by, *self._tables)


def is_free_point(scene: Scene, point: NDArray[np.float64]) -> bool:
    """Whether a point, (2,) in metres, lies in free space; not counted."""
    x, y = float(point[0]), float(point[1])
    return not segment_enters_tables(x, y, x, y, *_tables(scene))


def _tables(scene: Scene) -> tuple[Any, ...]:
    arrays = scene.arrays
    return arrays.tree, arrays.vertices, arrays.pinches, arrays.ways


def do_nothing() -> None:
    """Do nothing: what a limit calls while nobody waits for it."""


def state_checker(collision: ExactCollision) -> Callable[[Any], bool]:
    """Make the function that OMPL asks whether a state is free.

    OMPL owns this function, and the collision owns a part of OMPL: with a plain reference they
    would keep each other alive for ever.
    """
    reference = weakref.ref(collision)

    def is_free(state: Any) -> bool:
        alive = reference()
        if alive is None:
            raise RuntimeError("OMPL asked about a state after the end of the run.")
        return alive.is_free(state)

    return is_free
