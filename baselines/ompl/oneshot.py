"""OMPL's planners that end with their first path, and OMPL's simplifier to follow them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import geometric as og

from baselines.ompl.adapter import OmplPlanner, Problem, SettingsT
from baselines.ompl.settings import A_SHARE, AT_LEAST_1, OmplSettings, RangeSettings, bound, ours
from baselines.ompl.simplification import simplify
from suite.planner import Abilities, Recorder
from suite.scenes.exact import path_length


class OneShotPlanner(OmplPlanner[SettingsT]):
    """Base of the planners that end with their first path, or with the budget."""

    abilities: ClassVar[Abilities] = Abilities(budgets=OmplPlanner.abilities.budgets)

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        problem.set_up()
        problem.planner.solve(problem.until_over())
        path = problem.path()
        if path is not None:
            recorder.improved(path_length(path), checks=problem.collision.checks)
        return path


@dataclass(frozen=True, slots=True)
class SimplifiedSettings(RangeSettings):
    """Settings of any planner whose path OMPL simplifies: its range, and whether it does.

    simplify : spend what is left of the budget, or as much as it takes, on OMPL's simplifier. The
        path before it is reported as the first improvement.
    """

    simplify: bool = ours(True)


class SimplifiedPlanner(OneShotPlanner[SimplifiedSettings]):
    """Base of the planners that stop at any path, which OMPL's simplifier then shortens."""

    Settings: ClassVar[type[Any]] = SimplifiedSettings

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        found = super()._run(problem, recorder)
        if found is None or not self.settings.simplify:
            return found
        simplify(problem)
        path = problem.path()
        if path is None or path_length(path) >= path_length(found):
            return found
        recorder.improved(path_length(path), checks=problem.collision.checks)
        return path


@dataclass(frozen=True, slots=True)
class RRTConnectSettings(SimplifiedSettings):
    """Settings of RRT-Connect: those of :class:`SimplifiedSettings`, and what joins the tree.

    intermediate_states : add the states along an edge to the tree, too.
    """

    intermediate_states: bool | None = bound("setIntermediateStates")


@dataclass(frozen=True, slots=True)
class RRTSettings(RRTConnectSettings):
    """Settings of RRT: those of :class:`RRTConnectSettings`, and its goal bias.

    goal_bias : share of samples that are the goal itself.
    """

    goal_bias: float | None = bound("setGoalBias", A_SHARE)


@dataclass(frozen=True, slots=True)
class BFMTSettings(OmplSettings):
    """Settings of BFMT*; None leaves OMPL's default.

    There is no setting for the free area, which OMPL 2.0.1 estimates whatever it is told.

    num_samples : free samples drawn at the start; OMPL's default is 1000.
    radius_multiplier : how many neighbours are tried, relative to what optimality needs. Below 1,
        OMPL 2.0.1 has crashed where a state had none.
    nearest_k : neighbours are the k nearest, instead of all within a radius.
    cache_cc : remember which motions collide.
    heuristics : expand the state that promises the shortest path, not that nearest to the start.
    extended : once the samples are used up without a path, draw more until the budget is spent.
    """

    num_samples: int | None = bound("setNumSamples", AT_LEAST_1)
    radius_multiplier: float | None = bound("setRadiusMultiplier", AT_LEAST_1)
    nearest_k: bool | None = bound("setNearestK")
    cache_cc: bool | None = bound("setCacheCC")
    heuristics: bool | None = bound("setHeuristics")
    extended: bool | None = bound("setExtendedFMT")


@dataclass(frozen=True, slots=True)
class FMTSettings(BFMTSettings):
    """Settings of FMT*: those of :class:`BFMTSettings`.

    With ``nearest_k`` off, ``extended`` must be off too: OMPL 2.0.1 crashes in the extension if a
    state has no neighbour within the radius.
    """

    def __post_init__(self) -> None:
        BFMTSettings.__post_init__(self)
        if self.nearest_k is False and self.extended is not False:
            raise ValueError(
                "nearest_k is False with extended on, which can crash OMPL. "
                "It must be left on, or extended be False too."
            )


class RRTPlanner(SimplifiedPlanner):
    """RRT (LaValle 1998): a tree that grows from the start until it meets the goal."""

    name: ClassVar[str] = "ompl-rrt"
    Settings: ClassVar[type[Any]] = RRTSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.RRT


class RRTConnectPlanner(SimplifiedPlanner):
    """RRT-Connect (Kuffner and LaValle 2000): two trees that grow towards each other."""

    name: ClassVar[str] = "ompl-rrtconnect"
    Settings: ClassVar[type[Any]] = RRTConnectSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.RRTConnect


class FMTPlanner(OneShotPlanner):
    """FMT* (Janson et al. 2015): a tree that marches outward through a set of samples."""

    name: ClassVar[str] = "ompl-fmt"
    Settings: ClassVar[type[Any]] = FMTSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.FMT


class BFMTPlanner(OneShotPlanner):
    """BFMT* (Starek et al. 2015): FMT* from both ends."""

    name: ClassVar[str] = "ompl-bfmt"
    Settings: ClassVar[type[Any]] = BFMTSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.BFMT
