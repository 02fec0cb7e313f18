"""OMPL's questions about states and motions, answered by the suite's exact kernel and counted.

OMPL's default checks points along a segment and cuts corners. What a callback costs (0.6 us) is
part of the planner's time. Metres.
"""

import weakref
from collections.abc import Callable
from itertools import pairwise
from time import perf_counter_ns
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from suite.geometry.kernels import segment_enters_tables
from suite.scene import Scene

Point = tuple[float, float]

CHECKS_BETWEEN_SAMPLES = 31
"""Of the time of an answer; a prime, because planners ask in rounds."""

INTERRUPTED_NS = 100_000
"""An answer that took longer was interrupted; none takes a tenth of it."""


class ExactCollision(ob.MotionValidator):  # type: ignore[misc]
    """OMPL's questions about states and motions, answered by the exact kernel and counted.

    Once ``limit`` checks are spent, nothing is checked any more and every motion is refused: a
    planner that is in the middle of an iteration then ends it without new edges.

    limit : checks that may be made.
    checks : checks made, of states and motions.
    state_checks : those of states.
    free_motions : list that takes the two ends of each free motion; None to keep none.
    """

    def __init__(self, information: Any, scene: Scene, limit: float) -> None:
        super().__init__(information)
        self._tables = _tables(scene)
        self.limit = limit
        self.checks = 0
        self.state_checks = 0
        self.free_motions: list[tuple[Point, Point]] | None = None
        self._stop_at = limit
        self._stop: Callable[[], None] = do_nothing
        self._pause_at: float = 1  # the first check of all is slower than the others
        self._samples = 0
        self._sampled_ns = 0

    def checkMotion(self, a: Any, b: Any) -> bool:  # noqa: N802 (OMPL's name)
        """Whether the segment a-b is free."""
        if self.checks >= self._pause_at:
            return self._paused(self.checkMotion, a, b)
        self.checks += 1
        ax, ay, bx, by = a[0], a[1], b[0], b[1]
        is_free = not segment_enters_tables(ax, ay, bx, by, *self._tables)
        if is_free and self.free_motions is not None:
            self.free_motions.append(((ax, ay), (bx, by)))
        return is_free

    def is_free(self, state: Any) -> bool:
        """Whether a point is free; it counts as the check of a segment, which it costs."""
        if self.checks >= self._pause_at:
            return self._paused(self.is_free, state)
        self.checks += 1
        self.state_checks += 1
        x, y = state[0], state[1]
        return not segment_enters_tables(x, y, x, y, *self._tables)

    def call_at(self, checks: float, stop: Callable[[], None]) -> None:
        """Have ``stop`` called before each check from then on that so many are made."""
        self._stop_at, self._stop = checks, stop
        self._pause_at = min(self._pause_at, checks)

    def mean_s(self) -> float | None:
        """Mean time of an answer in seconds, from a sample; None if there is none.

        Every 31st answer is timed, at the pauses that the limits need anyway. Answers take 4 % more
        for it, a run some 1 %. In counted runs the sample's mean came to 1.02 to 1.25 times that of
        timing every answer, 1.07 in the median of 22 planners and scenes. It holds what Python and
        the kernel do, but not OMPL's way into Python and back, a fifth of what a question costs.
        """
        if self._samples == 0:
            return None
        return max(self._sampled_ns / self._samples - _clock_ns(), 0.0) * 1e-9

    def _paused(self, question: Callable[..., bool], *states: Any) -> bool:
        """Answer a question unless the run is over, and take the time that the answer takes."""
        if self.checks >= self._stop_at:
            self._stop()
        if self.checks >= self.limit:
            return False
        self._pause_at = self.checks + CHECKS_BETWEEN_SAMPLES
        began = perf_counter_ns()
        is_free = question(*states)
        taken = perf_counter_ns() - began
        if taken < INTERRUPTED_NS:
            self._samples += 1
            self._sampled_ns += taken
        self._pause_at = min(self._pause_at, self._stop_at, self.limit)
        return is_free


def _clock_ns() -> int:
    """Time that the clock itself adds to what it measures, nanoseconds: the median of eleven."""
    readings = [perf_counter_ns() for _ in range(12)]
    return sorted(after - before for before, after in pairwise(readings))[5]


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
