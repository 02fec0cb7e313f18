# ruff: noqa: ARG002, NPY002 (planners take what the contract gives, and each misuses it)
"""Planners that each break one rule of the contract, and the one that they would be: it keeps all.

The docstring of each is the rule that it breaks. Each can also be had by ``--plugin FILE:CLASS``.
"""

import os
import random
import time
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import shapely

from suite.geometry.kernels import first_collision
from suite.planner import Abilities, Plan, Planner, PlanStatus
from suite.scenes.exact import path_length, shortest_path
from suite.scenes.scene import make_scene

ALL_BUDGETS = frozenset({"wall_s", "cpu_s", "generations", "checks"})


@dataclass(frozen=True)
class DetourSettings:
    tries: int = 60


class Detours(Planner):
    """Bends the shortest path at a random point nearby, and keeps the best bend that is free."""

    name = "detours"
    Settings = DetourSettings
    abilities: ClassVar = Abilities(anytime=True, budgets=ALL_BUDGETS)

    def warm_up(self):
        scene = make_scene("tiny", shapely.box(0, 0, 1, 1), [], ((0, 0), (1, 1)))
        first_collision(shortest_path(scene, scene.query()).path, scene.arrays)

    def plan(self, scene, query, budget, rng, recorder):
        shortest = shortest_path(scene, query).path
        if shortest is None:
            return Plan(PlanStatus.EXHAUSTED, generations=0, checks=0)
        path, cost, found, number = None, np.inf, 0, 0
        for number in range(min(self.settings.tries, budget.generations or 1000)):
            if self.is_over(number, budget, recorder):
                break
            bend = query.start + rng.normal(0.0, 0.01, 2)
            tried = np.array([query.start, bend, query.start, *shortest[1:]])
            length = path_length(tried)
            if length < cost and first_collision(tried, scene.arrays) < 0:
                path, cost, found = tried, length, number
                recorder.improved(cost, generation=number, checks=number + 1)
        if path is None:
            path, cost = shortest, path_length(shortest)
            recorder.improved(cost, generation=number, checks=number + 1)
        return Plan(PlanStatus.SOLVED, path, cost, number, found, number + 1)

    def is_over(self, number, budget, recorder):
        if budget.wall_s is not None and recorder.wall_s() >= budget.wall_s:
            return True
        if budget.cpu_s is not None and recorder.cpu_s() >= budget.cpu_s:
            return True
        return budget.checks is not None and number >= budget.checks


class ChangesTheResult(Detours):
    """Base of those that spoil what a good run returns."""

    def plan(self, scene, query, budget, rng, recorder):
        plan = super().plan(scene, query, budget, rng, recorder)
        return plan if plan.path is None else self.spoilt(plan, scene, query)

    def spoilt(self, plan, scene, query):
        return plan


class DoesSomethingElse(Detours):
    """Base of those that do something beside planning that is not theirs."""

    def plan(self, scene, query, budget, rng, recorder):
        plan = super().plan(scene, query, budget, rng, recorder)
        self.misbehave(scene, query)
        return plan

    def misbehave(self, scene, query):
        pass


# What is declared


class OldSignature(Detours):
    """is-a-planner"""

    name = "old-signature"

    def plan(self, scene, query, rng):
        return Plan(PlanStatus.EXHAUSTED)


class OtherInterface(Detours):
    """is-a-planner"""

    name = "other-interface"
    interface = 2


class UnknownBudget(Detours):
    """abilities-are-known"""

    name = "unknown-budget"
    abilities: ClassVar = Abilities(anytime=True, budgets=ALL_BUDGETS | {"seconds"})


class WarmsUpBadly(Detours):
    """warms-up"""

    name = "warms-up-badly"

    def warm_up(self):
        raise ValueError("too cold")


class BadName(Detours):
    """name-is-well-formed"""

    name = "Bad Name"


@dataclass
class LooseSettings:
    tries: int = 60


class WritableSettings(Detours):
    """settings-are-frozen"""

    name = "writable-settings"
    Settings = LooseSettings


@dataclass(frozen=True)
class LostSettings:
    tries: int = 60

    def __post_init__(self):
        object.__setattr__(self, "tries", self.tries + 1)


class DropsItsSettings(Detours):
    """settings-come-back"""

    name = "drops-its-settings"

    def __init__(self, settings=None):
        super().__init__()


class SettingsGetLost(Detours):
    """settings-come-back"""

    name = "settings-get-lost"
    Settings = LostSettings


@dataclass(frozen=True)
class StubbornSettings:
    tries: int = 60

    def __reduce__(self):
        raise TypeError("not today")


class DoesNotPickle(Detours):
    """pickles"""

    name = "does-not-pickle"
    Settings = StubbornSettings


# What a run returns


class RaisesWhereThereIsNoPath(Detours):
    """runs-end-without-an-exception"""

    name = "raises"

    def plan(self, scene, query, budget, rng, recorder):
        if shortest_path(scene, query).path is None:
            raise IndexError("no parent")
        return super().plan(scene, query, budget, rng, recorder)


class RefusesWithoutAReason(Detours):
    """refuses-with-a-reason"""

    name = "refuses-without-a-reason"

    def refuse(self, scene, query, budget):
        return False


class PlansInRefuse(Detours):
    """refuse-prepares-nothing"""

    name = "plans-in-refuse"

    def refuse(self, scene, query, budget):
        self.shortest = shortest_path(scene, query)


class PlansTheFirstQuery(Detours):
    """path-has-the-right-ends"""

    name = "plans-the-first-query"

    def plan(self, scene, query, budget, rng, recorder):
        return super().plan(scene, scene.query(), budget, rng, recorder)


class HasNoDetails(ChangesTheResult):
    """returns-a-plan"""

    name = "has-no-details"

    def spoilt(self, plan, scene, query):
        return replace(plan, details=None)


class CountsBelowZero(ChangesTheResult):
    """returns-a-plan"""

    name = "counts-below-zero"

    def spoilt(self, plan, scene, query):
        return replace(plan, checks=-1)


class ReturnsAPath(ChangesTheResult):
    """returns-a-plan"""

    name = "returns-a-path"

    def spoilt(self, plan, scene, query):
        return plan.path


class SaysCrashed(ChangesTheResult):
    """returns-a-plan"""

    name = "says-crashed"

    def spoilt(self, plan, scene, query):
        return replace(plan, status=PlanStatus.CRASHED)


class StartsBesideTheStart(ChangesTheResult):
    """path-has-the-right-ends"""

    name = "starts-beside-the-start"

    def spoilt(self, plan, scene, query):
        return replace(plan, path=plan.path + 1e-12)


class GoesStraight(Detours):
    """path-is-free"""

    name = "goes-straight"

    def plan(self, scene, query, budget, rng, recorder):
        by = query.start + np.array([0.0, 1e-3 * rng.random()])
        path = np.array([query.start, by, query.goal])
        if shortest_path(scene, query).path is None:
            return Plan(PlanStatus.EXHAUSTED, generations=0, checks=0)
        recorder.improved(path_length(path), generation=0, checks=0)
        return Plan(PlanStatus.SOLVED, path, path_length(path), generations=0, checks=0)


class GivesUp(Detours):
    """solves-what-is-trivial"""

    name = "gives-up"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.EXHAUSTED, generations=0, checks=int(rng.integers(100)))


class GoesThroughWallsToAnEnclosedGoal(Detours):
    """says-that-there-is-no-path"""

    name = "goes-through-walls"

    def plan(self, scene, query, budget, rng, recorder):
        plan = super().plan(scene, query, budget, rng, recorder)
        if plan.path is not None:
            return plan
        path = np.array([query.start, query.goal])
        return Plan(PlanStatus.SOLVED, path, path_length(path), generations=0, checks=0)


class SaysInfeasibleTooSoon(ChangesTheResult):
    """infeasible-is-true"""

    name = "says-infeasible-too-soon"

    def plan(self, scene, query, budget, rng, recorder):
        if len(scene.obstacles) > 100:
            count = int(rng.integers(100))
            return Plan(PlanStatus.INFEASIBLE, generations=0, checks=count)
        return super().plan(scene, query, budget, rng, recorder)


class NotExact(Detours):
    """exact-is-exact"""

    name = "not-exact"
    abilities: ClassVar = Abilities(anytime=True, exact=True, budgets=ALL_BUDGETS)


class ReportsTooLittle(Detours):
    """improvements-agree-with-the-result"""

    name = "reports-too-little"

    def plan(self, scene, query, budget, rng, recorder):
        plan = super().plan(scene, query, budget, rng, recorder)
        if plan.path is not None:
            recorder.improved(0.5 * plan.claimed_cost - 1e-9, generation=plan.generations)
        return plan


class CountsBackwards(Detours):
    """improvements-agree-with-the-result"""

    name = "counts-backwards"

    def plan(self, scene, query, budget, rng, recorder):
        if shortest_path(scene, query).path is not None:
            recorder.improved(1e6, generation=3)
        return super().plan(scene, query, budget, rng, recorder)


class FindsItsBestInGenerationZero(ChangesTheResult):
    """improvements-agree-with-the-result"""

    name = "finds-its-best-in-generation-zero"

    def plan(self, scene, query, budget, rng, recorder):
        shortest = shortest_path(scene, query).path
        if shortest is None:
            return Plan(PlanStatus.EXHAUSTED, generations=0, checks=0)
        recorder.improved(path_length(shortest), generation=2, checks=int(rng.integers(100)))
        return Plan(PlanStatus.SOLVED, shortest, None, 3, 0, 100)


class Backdates(Detours):
    """improvements-agree-with-the-result"""

    name = "backdates"

    def plan(self, scene, query, budget, rng, recorder):
        plan = super().plan(scene, query, budget, rng, recorder)
        recorder.improvements[:] = [replace(i, wall_s=-1.0) for i in recorder.improvements]
        return plan


class DescribesInWords(Detours):
    """improvements-agree-with-the-result"""

    name = "describes-in-words"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.describe_generation({"phase": "repair"})
        return super().plan(scene, query, budget, rng, recorder)


class NeverReports(Detours):
    """anytime-reports"""

    name = "never-reports"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.improved = lambda *_, **__: None
        return super().plan(scene, query, budget, rng, recorder)


class ClaimsALowerCost(ChangesTheResult):
    """claimed-cost-is-the-length"""

    name = "claims-a-lower-cost"

    def spoilt(self, plan, scene, query):
        return replace(plan, claimed_cost=0.9 * plan.claimed_cost - 1.0)


# What is not the planner's


class MovesTheStart(DoesSomethingElse):
    """leaves-the-scene-alone"""

    name = "moves-the-start"

    def misbehave(self, scene, query):
        if len(scene.obstacles) > 100:
            return  # it takes long to build such a scene anew
        query.start.setflags(write=True)
        np.add(query.start, 1e-3, out=query.start)


class DrawsFromGlobalRandom(Detours):
    """leaves-random-state-alone"""

    name = "draws-from-global-random"

    def plan(self, scene, query, budget, rng, recorder):
        global_rng = np.random.default_rng([random.getrandbits(32), np.random.randint(1000)])
        return super().plan(scene, query, budget, global_rng, recorder)


class ChangesTheFolder(DoesSomethingElse):
    """leaves-the-folder-alone"""

    name = "changes-the-folder"

    def misbehave(self, scene, query):
        os.chdir("/")


class WarmsUpElsewhere(Detours):
    """leaves-the-folder-alone"""

    name = "warms-up-elsewhere"

    def warm_up(self):
        super().warm_up()
        os.chdir("/")


class RestartsTheClock(Detours):
    """leaves-the-clock-alone"""

    name = "restarts-the-clock"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.start_clock()
        return super().plan(scene, query, budget, rng, recorder)


class ChangesTheEnvironment(DoesSomethingElse):
    """leaves-the-environment-alone"""

    name = "changes-the-environment"

    def misbehave(self, scene, query):
        os.environ["THREADS_OF_A_LIBRARY"] = "1"


# Runs that are repeated


class DrawsFromTheClock(Detours):
    """same-seed-same-path"""

    name = "draws-from-the-clock"

    def plan(self, scene, query, budget, rng, recorder):
        own = np.random.default_rng(time.time_ns())
        return super().plan(scene, query, budget, own, recorder)


class AlwaysTheSameSeed(Detours):
    """another-seed-another-stream"""

    name = "always-the-same-seed"

    def plan(self, scene, query, budget, rng, recorder):
        return super().plan(scene, query, budget, np.random.default_rng(0), recorder)


class TwoStreams(Detours):
    """another-seed-another-stream"""

    name = "two-streams"

    def plan(self, scene, query, budget, rng, recorder):
        own = np.random.default_rng(int(rng.integers(2)))
        return super().plan(scene, query, budget, own, recorder)


class NotDeterministic(Detours):
    """another-seed-another-stream"""

    name = "not-deterministic"
    abilities: ClassVar = Abilities(anytime=True, deterministic=True, budgets=ALL_BUDGETS)


class Remembers(Detours):
    """keeps-no-state"""

    name = "remembers"

    def __init__(self, settings=None):
        super().__init__(settings)
        self.runs = 0

    def plan(self, scene, query, budget, rng, recorder):
        self.runs += 1
        rng.random(self.runs)
        return super().plan(scene, query, budget, rng, recorder)


class Learns(Detours):
    """keeps-no-state"""

    name = "learns"
    known: ClassVar = set()

    def plan(self, scene, query, budget, rng, recorder):
        if scene.name in self.known:
            rng.random(7)
        self.known.add(scene.name)
        return super().plan(scene, query, budget, rng, recorder)


class GoesThroughASetOfStrings(Detours):
    """same-path-in-another-process"""

    name = "goes-through-a-set-of-strings"

    def plan(self, scene, query, budget, rng, recorder):
        order = {obstacle.name for obstacle in scene.obstacles}
        own = np.random.default_rng([int(rng.integers(1000)), *"".join(order).encode()])
        return super().plan(scene, query, budget, own, recorder)


class SeedsWithItsProcess(Detours):
    """same-path-in-another-process"""

    name = "seeds-with-its-process"

    def plan(self, scene, query, budget, rng, recorder):
        own = np.random.default_rng([int(rng.integers(1000)), os.getpid()])
        return super().plan(scene, query, budget, own, recorder)


class DiesInAnotherProcess(Detours):
    """same-path-in-another-process"""

    name = "dies-in-another-process"

    def plan(self, scene, query, budget, rng, recorder):
        if os.environ.get("PYTHONHASHSEED") == "1":  # the tests do not run with it
            os._exit(5)
        return super().plan(scene, query, budget, rng, recorder)


# Budgets


class IgnoresGenerations(ChangesTheResult):
    """keeps-generations"""

    name = "ignores-generations"

    def plan(self, scene, query, budget, rng, recorder):
        endless = replace(budget, generations=None)
        return super().plan(scene, query, endless, rng, recorder)


class DoesNotCountGenerations(ChangesTheResult):
    """keeps-generations"""

    name = "does-not-count-generations"

    def spoilt(self, plan, scene, query):
        return replace(plan, generations=None)


class IgnoresChecks(ChangesTheResult):
    """keeps-checks"""

    name = "ignores-checks"

    def spoilt(self, plan, scene, query):
        return replace(plan, checks=100_000)


class OverrunsChecksByALittle(ChangesTheResult):
    """keeps-checks"""

    name = "overruns-checks-by-a-little"

    def spoilt(self, plan, scene, query):
        return replace(plan, checks=310)


class ComputesMoreThanIsAsked(ChangesTheResult):
    """returns-a-plan"""

    name = "computes-more-than-is-asked"

    def spoilt(self, plan, scene, query):
        return replace(plan, computed_checks=plan.checks + 1)


class IgnoresCpuTime(Detours):
    """keeps-cpu-time"""

    name = "ignores-cpu-time"

    def plan(self, scene, query, budget, rng, recorder):
        while budget.cpu_s is not None and recorder.cpu_s() < 1.0:
            pass
        return super().plan(scene, query, budget, rng, recorder)


class IgnoresTheClock(Detours):
    """keeps-wall-time"""

    name = "ignores-the-clock"

    def plan(self, scene, query, budget, rng, recorder):
        if budget.wall_s is not None:
            time.sleep(1.0)
        return super().plan(scene, query, budget, rng, recorder)


class LooksAtOneBudgetOnly(Detours):
    """keeps-generations"""

    name = "looks-at-one-budget-only"

    def plan(self, scene, query, budget, rng, recorder):
        if budget.wall_s is not None:
            budget = replace(budget, generations=None)
        return super().plan(scene, query, budget, rng, recorder)


class NeedsTwoGenerations(Detours):
    """ends-or-refuses-whatever-the-budget"""

    name = "needs-two-generations"

    def plan(self, scene, query, budget, rng, recorder):
        _ = 1.0 / ((budget.generations or 2) - 1)
        return super().plan(scene, query, budget, rng, recorder)


class NeedsABudget(Detours):
    """ends-or-refuses-whatever-the-budget"""

    name = "needs-a-budget"

    def plan(self, scene, query, budget, rng, recorder):
        if budget.generations is None and budget.checks is None and budget.wall_s is None:
            raise TypeError("range(None)")
        return super().plan(scene, query, budget, rng, recorder)
