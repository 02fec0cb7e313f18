# ruff: noqa: ARG002, NPY002 (replanners take what the contract gives, and each misuses it)
"""Planners whose replanners each break one rule, and the one that they would be: it keeps all.

The docstring of each is the rule that it breaks.
"""

import time
from dataclasses import replace
from typing import ClassVar

import numpy as np

from suite.planner import Plan, PlanStatus, Replanner
from tests.suite.conformance.broken_planners import Detours


class Again(Replanner):
    """Plans afresh; base of those that do something else as well. It keeps all rules."""

    def __init__(self, planner, rng):
        self.planner, self.rng = planner, rng

    def begin(self, scene, query, budget, recorder):
        return self.planner.plan(scene, query, budget, self.rng, recorder)

    def update(self, scene, query, budget, recorder):
        return self.spoilt(self.begin(scene, query, budget, recorder), scene, query)

    def spoilt(self, plan, scene, query):
        return plan


class Replans(Detours):
    """Base of those that have a replanner of their own."""

    kind: ClassVar = Again

    def replanner(self, rng):
        return self.kind(self, rng)


class ReturnsNothing(Again):
    def spoilt(self, plan, scene, query):
        return plan if plan.path is not None else None


class ReplansNothing(Replans):
    """replans-end-with-a-plan"""

    name = "replans-nothing"
    kind = ReturnsNothing


class Stumbles(Again):
    seen = None

    def spoilt(self, plan, scene, query):
        if scene is self.seen:
            raise KeyError("nothing has changed")
        self.seen = scene
        return plan


class StumblesOverTheSameScene(Replans):
    """replans-end-with-a-plan"""

    name = "stumbles-over-the-same-scene"
    kind = Stumbles


class Stubborn(Again):
    def spoilt(self, plan, scene, query):
        by = query.start + np.array([0.0, 1e-3 * self.rng.random()])
        path = np.array([query.start, by, query.goal])
        return Plan(PlanStatus.SOLVED, path, None, 0, 0, 0)


class GoesOnAsBefore(Replans):
    """replans-suit-what-is-known"""

    name = "goes-on-as-before"
    kind = Stubborn


class Backwards(Again):
    first = None

    def begin(self, scene, query, budget, recorder):
        self.first = query if self.first is None else self.first
        return super().begin(scene, self.first, budget, recorder)


class StartsWhereItBegan(Replans):
    """replans-suit-what-is-known"""

    name = "starts-where-it-began"
    kind = Backwards


class Disheartened(Again):
    lost = False

    def spoilt(self, plan, scene, query):
        self.lost = self.lost or plan.path is None
        return Plan(PlanStatus.EXHAUSTED, generations=0, checks=0) if self.lost else plan


class LosesHeart(Replans):
    """replans-suit-what-is-known"""

    name = "loses-heart"
    kind = Disheartened


class Hopeless(Again):
    def spoilt(self, plan, scene, query):
        return replace(plan, status=PlanStatus.INFEASIBLE, path=None)


class CallsEachUpdateInfeasible(Replans):
    """replans-suit-what-is-known"""

    name = "calls-each-update-infeasible"
    kind = Hopeless


class Summing(Again):
    total = 0

    def spoilt(self, plan, scene, query):
        self.total += plan.generations
        return replace(plan, generations=self.total, generation_of_best=None)


class CountsOnAndOn(Replans):
    """replans-keep-budgets"""

    name = "counts-on-and-on"
    kind = Summing


class Slow(Again):
    updates = 0

    def update(self, scene, query, budget, recorder):
        self.updates += 1
        if budget.wall_s is not None and self.updates == 2:
            time.sleep(0.7)
        return super().update(scene, query, budget, recorder)


class UpdatesSlowly(Replans):
    """replans-keep-budgets"""

    name = "updates-slowly"
    kind = Slow


class Unseeded(Again):
    def __init__(self, planner, rng):
        super().__init__(planner, np.random.default_rng())


class ReplansFromItsOwnStream(Replans):
    """replans-repeat"""

    name = "replans-from-its-own-stream"
    kind = Unseeded


class SharesOneStream(Replans):
    """replans-repeat"""

    name = "shares-one-stream"

    def replanner(self, rng):
        self.rng = rng  # of the last one that was made
        return Again(self, None)

    def plan(self, scene, query, budget, rng, recorder):
        return super().plan(scene, query, budget, self.rng if rng is None else rng, recorder)


class Careless(Again):
    def spoilt(self, plan, scene, query):
        np.random.seed(0)
        return plan


class SeedsTheGlobalGenerator(Replans):
    """replans-leave-things-alone"""

    name = "seeds-the-global-generator"
    kind = Careless


class Marking(Again):
    def spoilt(self, plan, scene, query):
        scene.arrays.vertices.setflags(write=True)
        scene.arrays.vertices[:1] += 1e-9
        return plan


class MarksTheScene(Replans):
    """replans-leave-things-alone"""

    name = "marks-the-scene"
    kind = Marking
