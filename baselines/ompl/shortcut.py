"""RRT-Connect, OMPL's shortcuts, and again from the start until the budget ends.

What one would build first from OMPL's parts for short paths (Geraerts and Overmars 2007); OMPL's
own AnytimePathShortening is not in the wheel.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import geometric as og

from baselines.ompl.adapter import OmplPlanner, Problem
from baselines.ompl.settings import (
    A_SHARE,
    ABOVE_0,
    AT_LEAST_1,
    Lengths,
    RangeSettings,
    ours,
    share_of_side,
)
from baselines.ompl.simplification import BudgetSpentError, ended_by_exception
from baselines.ompl.watched import STRAIGHT
from suite.planner import Recorder
from suite.scenes.exact import path_length

SNAP = 0.005
"""Share of the path's length within which a shortcut ends in a waypoint; OMPL's own default."""

ROPE_TOLERANCE = 0.1
"""OMPL's ratio between the tolerance and the distance of points of its rope shortcut."""


@dataclass(frozen=True, slots=True)
class ShortcutSettings(RangeSettings):
    """Settings of RRT-Connect with shortcuts and restarts.

    Those of :class:`RangeSettings` are RRT-Connect's; the choices of all others are ours.

    reach : share of the path that a shortcut of a cycle's first round leaves out at most.
    narrowing : factor on the reach from round to round.
    rounds : rounds of random shortcuts in a cycle, each followed by dropping vertices.
    steps : random shortcuts tried in a round.
    empty_steps : the same without a success, after which a round ends.
    rope : distance of the points between which OMPL's rope shortcut looks for straight lines, once
        after the first cycle, metres; None for no such step.
    rope_share : the same as a share of the side of free space, as ``range_share`` is; in place of
        ``rope``.
    gain : share by which a cycle must shorten a path to be followed by another one.
    hopeless : a path that is longer than the best one by this factor after its first cycle is left.
    """

    reach: float = ours(0.33, ABOVE_0)
    narrowing: float = ours(0.4, ABOVE_0)
    rounds: int = ours(3, AT_LEAST_1)
    steps: int = ours(400, AT_LEAST_1)
    empty_steps: int = ours(100, AT_LEAST_1)
    rope: float | None = ours(None, ABOVE_0)
    rope_share: float | None = share_of_side("rope")
    gain: float = ours(0.001, A_SHARE)
    hopeless: float = ours(1.05, AT_LEAST_1)


class ShortcutPlanner(OmplPlanner[ShortcutSettings]):
    """RRT-Connect (Kuffner and LaValle 2000), shortcuts, restarts: the best path of all."""

    name: ClassVar[str] = "ompl-shortcut"
    Settings: ClassVar[type[Any]] = ShortcutSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.RRTConnect

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        problem.set_up()
        best = _Best(problem, recorder)
        straight = STRAIGHT * path_length(problem.straight_line)
        while not problem.is_over() and best.length > straight:
            problem.planner.clear()
            problem.definition.clearSolutionPaths()
            problem.planner.solve(problem.until_over())
            if problem.definition.hasExactSolution():
                self._shorten(problem, best)
        return best.path

    def _shorten(self, problem: Problem, best: "_Best") -> None:
        """Shorten the path that RRT-Connect found, until it is no use or the budget is spent."""
        try:
            with ended_by_exception(problem):
                _Shortening(problem, self.settings, best).run()
        except BudgetSpentError:
            pass


class _Best:
    """The best path so far.

    A path is only taken once the kernel has gone over all of it, which counts: OMPL cuts edges into
    pieces that it does not check, and rounding may move a piece into an obstacle.

    path : (n, 2) float64, metres; None without one.
    length : metres.
    """

    def __init__(self, problem: Problem, recorder: Recorder) -> None:
        self.path: NDArray[np.float64] | None = None
        self.length = np.inf
        self._problem = problem
        self._recorder = recorder

    def offer(self, solution: Any) -> None:
        """Take one of OMPL's paths if it is free and better; BudgetSpentError if no check can."""
        if solution.length() * self._problem.unit >= self.length:
            return
        collision = self._problem.collision
        segments = solution.getStateCount() - 1
        if collision.checks + segments > collision.limit:
            raise BudgetSpentError
        collision.checks += segments
        path = self._problem.read(solution)
        if path is not None and path_length(path) < self.length:
            self.path, self.length = path, path_length(path)
            self._recorder.improved(self.length, checks=collision.checks)


def _rope(settings: ShortcutSettings, lengths: Lengths) -> float | None:
    """Distance of the points of the rope shortcut in OMPL's coordinates; None for no such step."""
    rope = settings.rope
    if settings.rope_share is not None:
        rope = settings.rope_share * lengths.side
    return None if rope is None else rope / lengths.unit


class _Shortening:
    """Cycles of shortcuts on one path of RRT-Connect's."""

    def __init__(self, problem: Problem, settings: ShortcutSettings, best: _Best) -> None:
        self._settings = settings
        self._unit = problem.unit
        self._rope = _rope(settings, problem)
        self._best = best
        self._solution = problem.definition.getSolutionPath()
        self._simplifier = og.PathSimplifier(problem.information)

    def run(self) -> None:
        """Repeat cycles while they gain something, unless the first shows that there is no hope."""
        settings, solution = self._settings, self._solution
        self._best.offer(solution)
        before = np.inf
        while solution.length() < (1.0 - settings.gain) * before:
            is_first, before = before == np.inf, solution.length()
            self._cycle()
            if is_first and solution.length() * self._unit > settings.hopeless * self._best.length:
                return
            if is_first and self._rope is not None:
                self._simplifier.ropeShortcutPath(solution, self._rope, ROPE_TOLERANCE * self._rope)
                self._best.offer(solution)

    def _cycle(self) -> None:
        settings = self._settings
        for round_ in range(settings.rounds):
            self._simplifier.partialShortcutPath(
                self._solution,
                settings.steps,
                settings.empty_steps,
                settings.reach * settings.narrowing**round_,
                SNAP,
            )
            self._simplifier.reduceVertices(self._solution)
            self._best.offer(self._solution)
