"""OMPL's planners that end with their first path, and OMPL's simplifier to follow them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og

from baselines.ompl.adapter import OmplPlanner, Problem
from baselines.ompl.settings import ABOVE_0, OmplSettings, bound, ours
from baselines.ompl.simplification import simplify
from suite.exact import path_length
from suite.planner import Abilities, Recorder


class OneShotPlanner(OmplPlanner):
    """Base of the planners that end with their first path, or with the budget."""

    abilities: ClassVar[Abilities] = Abilities(budgets=OmplPlanner.abilities.budgets)

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        problem.set_up()
        problem.planner.solve(ob.PlannerTerminationCondition(problem.is_over))
        path = problem.path()
        if path is not None:
            recorder.improved(path_length(path), checks=problem.collision.checks)
        return path


@dataclass(frozen=True, slots=True)
class SimplifiedSettings(OmplSettings):
    """Settings of any planner whose path OMPL simplifies.

    simplify : spend what is left of the budget, or as much as it takes, on OMPL's simplifier. The
        path before it is reported as the first improvement.
    """

    simplify: bool = ours(True)


class SimplifiedPlanner(OneShotPlanner):
    """Base of the planners that stop at any path, which OMPL's simplifier then shortens."""

    Settings: ClassVar[type[Any]] = SimplifiedSettings

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        found = super()._run(problem, recorder)
        if found is None or not self.settings.simplify:
            return found
        path = simplify(problem)
        recorder.improved(path_length(path), checks=problem.collision.checks)
        return min(path, found, key=path_length)


@dataclass(frozen=True, slots=True)
class RRTConnectSettings(SimplifiedSettings):
    """Settings of RRT-Connect; None leaves OMPL's default.

    range : longest edge that extends a tree, metres.
    intermediate_states : add the states along an edge to the tree, too.
    """

    range: float | None = bound("setRange", ABOVE_0)
    intermediate_states: bool | None = bound("setIntermediateStates")


class RRTConnectPlanner(SimplifiedPlanner):
    """RRT-Connect (Kuffner and LaValle 2000): two trees that grow towards each other."""

    name: ClassVar[str] = "ompl-rrtconnect"
    Settings: ClassVar[type[Any]] = RRTConnectSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.RRTConnect
