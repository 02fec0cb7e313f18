"""OMPL's planners that tell their best cost while they run: the RRT* family, BIT* and AORRTC.

The wheel 2.0.1 does not bind OMPL's callback for better paths. So the best cost is read where
Python is asked anyway, every so many times that it is asked whether a motion is free. A better path
is reported late by so many checks at most, some 0.1 to 0.3 ms, and never too early.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import geometric as og

from baselines.ompl.adapter import OmplPlanner, Problem
from baselines.ompl.settings import A_SHARE, AT_LEAST_1, OmplSettings, RangeSettings, bound
from suite.planner import Recorder
from suite.scenes.exact import path_length

STRAIGHT = 1.0 + 1e-9
"""A path that is longer than the straight line by less than this factor is as good as straight.

SORRT* must not go on from there: it waits for samples that could make the path shorter, for ever.
"""


LAZY = 13
"""Checks between two looks at planners that work long between two checks: 5 to 30 us."""


class Watch:
    """Reads the planner's best cost and reports it where it is better than before."""

    def __init__(
        self, problem: Problem, recorder: Recorder, iterations: Callable[[Problem], int | None]
    ) -> None:
        self._best = np.inf
        self._best_cost = problem.planner.bestCost
        self._problem = problem
        self._recorder = recorder
        self._iterations = iterations

    def look(self) -> None:
        """Report a better path, if there is one."""
        cost = self._best_cost().value()
        if cost < self._best:
            self._best = cost
            self._recorder.improved(
                cost * self._problem.unit,
                generation=self._iterations(self._problem),
                checks=self._problem.collision.checks,
            )


class WatchedPlanner(OmplPlanner):
    """Base of the planners that are watched while they ask about motions.

    checks_between_looks : None for those between two pauses of the collision check.
    """

    checks_between_looks: ClassVar[int | None] = None

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        problem.be_satisfied_with(STRAIGHT * path_length(problem.straight_line))
        problem.set_up()
        return self._solve(problem, recorder)

    def _solve(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        watch = Watch(problem, recorder, self._iterations)
        problem.collision.look = watch.look
        if self.checks_between_looks is not None:
            problem.collision.checks_between_pauses = self.checks_between_looks
        problem.planner.solve(problem.until_over())
        watch.look()  # the last checks may have led to a better path
        return problem.path()

    def _iterations(self, problem: Problem) -> int | None:
        count = getattr(problem.planner, "numIterations", None)
        return None if count is None else int(count())


@dataclass(frozen=True, slots=True)
class TreeSettings(RangeSettings):
    """Settings of the whole RRT* family: those of :class:`RangeSettings`, and how it rewires.

    goal_bias : share of samples that are the goal itself.
    rewire_factor : how many neighbours are rewired, relative to what optimality needs.
    k_nearest : rewire the k nearest neighbours, instead of all within a radius.
    delay_cc : check neighbours in order of cost, and only until the first that is free.
    tree_pruning : drop the states that can't be part of a better path.
    prune_threshold : share by which the cost must fall before the tree is pruned.
    new_state_rejection : reject new states that can't be part of a better path.
    """

    goal_bias: float | None = bound("setGoalBias", A_SHARE)
    rewire_factor: float | None = bound("setRewireFactor", AT_LEAST_1)
    k_nearest: bool | None = bound("setKNearest")
    delay_cc: bool | None = bound("setDelayCC")
    tree_pruning: bool | None = bound("setTreePruning")
    prune_threshold: float | None = bound("setPruneThreshold", A_SHARE)
    new_state_rejection: bool | None = bound("setNewStateRejection")


@dataclass(frozen=True, slots=True)
class RRTstarSettings(TreeSettings):
    """Settings of RRT*: those of :class:`TreeSettings`, and where it samples.

    informed_sampling : sample only where a better path can lead.
    sample_rejection : reject samples that can't be part of a better path.
    ordered_sampling : draw samples in batches, and use the most promising first.
    batch_size : of ordered sampling.
    """

    informed_sampling: bool | None = bound("setInformedSampling")
    sample_rejection: bool | None = bound("setSampleRejection")
    ordered_sampling: bool | None = bound("setOrderedSampling")
    batch_size: int | None = bound("setBatchSize", AT_LEAST_1)


@dataclass(frozen=True, slots=True)
class InformedRRTstarSettings(TreeSettings):
    """Settings of Informed RRT*: those of :class:`TreeSettings`, and how it samples the ellipse.

    What makes it informed can't be switched off: it would be another planner.

    pruned_measure : count only the area that can hold a better path in the radius of rewiring.
    sampling_attempts : samples drawn at most until one lies both in the ellipse and in the scene.
    """

    pruned_measure: bool | None = bound("setPrunedMeasure")
    sampling_attempts: int | None = bound("setNumSamplingAttempts", AT_LEAST_1)


@dataclass(frozen=True, slots=True)
class SORRTstarSettings(InformedRRTstarSettings):
    """Settings of SORRT*: those of :class:`InformedRRTstarSettings`, and its batches.

    batch_size : samples that are sorted by promise before they are used.
    """

    batch_size: int | None = bound("setBatchSize", AT_LEAST_1)


@dataclass(frozen=True, slots=True)
class BITstarSettings(OmplSettings):
    """Settings of BIT*; None leaves OMPL's default.

    samples_per_batch : samples added to the graph at a time.
    rewire_factor : how many neighbours are tried, relative to what optimality needs.
    k_nearest : edges to the k nearest neighbours, instead of to all within a radius.
    strict_queue_ordering : keep the queue of edges sorted when costs change.
    pruning : drop the states that can't be part of a better path.
    prune_threshold : share by which the cost must fall before the graph is pruned.
    delay_rewiring : rewire only once there is a path.
    just_in_time_sampling : draw samples only where the search arrives; needs ``k_nearest`` off.
    drop_samples_on_prune : drop samples without edges when the graph is pruned.
    """

    samples_per_batch: int | None = bound("setSamplesPerBatch", AT_LEAST_1)
    rewire_factor: float | None = bound("setRewireFactor", AT_LEAST_1)
    k_nearest: bool | None = bound("setUseKNearest")
    strict_queue_ordering: bool | None = bound("setStrictQueueOrdering")
    pruning: bool | None = bound("setPruning")
    prune_threshold: float | None = bound("setPruneThresholdFraction", A_SHARE)
    delay_rewiring: bool | None = bound("setDelayRewiringUntilInitialSolution")
    just_in_time_sampling: bool | None = bound("setJustInTimeSampling")
    drop_samples_on_prune: bool | None = bound("setDropSamplesOnPrune")


class RRTstarPlanner(WatchedPlanner):
    """RRT* (Karaman and Frazzoli 2011): a tree that is rewired as it grows."""

    name: ClassVar[str] = "ompl-rrtstar"
    Settings: ClassVar[type[Any]] = RRTstarSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.RRTstar


class InformedRRTstarPlanner(WatchedPlanner):
    """Informed RRT* (Gammell et al. 2014): RRT* that samples the ellipse of better paths."""

    name: ClassVar[str] = "ompl-informedrrtstar"
    Settings: ClassVar[type[Any]] = InformedRRTstarSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.InformedRRTstar


class SORRTstarPlanner(WatchedPlanner):
    """SORRT* (Gammell, Barfoot and Srinivasa 2020): Informed RRT* with sorted samples."""

    name: ClassVar[str] = "ompl-sorrtstar"
    Settings: ClassVar[type[Any]] = SORRTstarSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.SORRTstar


class BITstarPlanner(WatchedPlanner):
    """BIT* (Gammell, Barfoot and Srinivasa 2020): batches of samples, searched as one graph."""

    name: ClassVar[str] = "ompl-bitstar"
    Settings: ClassVar[type[Any]] = BITstarSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.BITstar
    checks_between_looks: ClassVar[int | None] = LAZY


class AORRTCPlanner(WatchedPlanner):
    """AORRTC (Wilson et al. 2025): RRT-Connect again and again, each time for a lower cost.

    OMPL 2.0.1 has it go from the goal to the goal where start and goal see each other (its issue
    1420). The straight line, which AORRTC tries first, is therefore tried here. Besides, each
    run has a new object, because its best cost survives ``clear``; and one that was never set up
    crashes the process when it goes.
    """

    name: ClassVar[str] = "ompl-aorrtc"
    Settings: ClassVar[type[Any]] = RangeSettings
    ompl_class: ClassVar[Callable[[Any], Any]] = og.AORRTC
    checks_between_looks: ClassVar[int | None] = LAZY

    def _run(self, problem: Problem, recorder: Recorder) -> NDArray[np.float64] | None:
        problem.set_up()
        if problem.straight_line_is_free():
            line = problem.straight_line
            recorder.improved(path_length(line), checks=problem.collision.checks)
            return line
        return self._solve(problem, recorder)
