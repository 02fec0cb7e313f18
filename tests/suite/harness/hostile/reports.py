# ruff: noqa: ARG002 (planners take what the contract gives, and some misuse it)
"""Planners whose reports, words or interface are wrong."""

import os

import numpy as np

from suite.planner import Improvement, Plan, Planner, PlanStatus

from .base import Base


class ReportsAsNumpyDoes(Base):
    """Hands over what sums and means of arrays are: other types, and NaN before the first path."""

    name = "reports-as-numpy-does"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.describe_generation({"best": np.inf, "mean": np.float32("nan"), "n": np.int64(1)})
        recorder.improved(np.float32(50.0), generation=np.int64(1), checks=np.int32(2))
        count = np.int64(3)
        return Plan(PlanStatus.SOLVED, self.path(scene, query), None, count, count, count)


class ReportsNan(Base):
    name = "reports-nan"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.improved(float("nan"))
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


class DescribesInWords(Base):
    name = "describes-in-words"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.describe_generation({"phase": "repair"})
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


class Backdates(Base):
    """Writes its improvements itself, from before the run."""

    name = "backdates"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.improvements.append(Improvement(-1.0, 0.0, 50.0, None, None))
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


class RestartsTheClock(Base):
    """Begins to count when its preparations are over."""

    name = "restarts-the-clock"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.start_clock()
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


class CountsBeyondMeasure(Base):
    name = "counts-beyond-measure"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.SOLVED, self.path(scene, query), checks=10**30)


class ComputesMoreThanItAsks(Base):
    name = "computes-more-than-it-asks"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.SOLVED, self.path(scene, query), checks=3, computed_checks=4)


class SaysHalfACharacter(Base):
    """Names a file whose name is not text."""

    name = "says-half-a-character"

    def misbehave(self):
        raise RuntimeError(os.fsdecode(b"no \xff file"))


class WrongSignature(Base):
    name = "wrong-signature"

    def plan(self, scene, query):
        return Plan(PlanStatus.EXHAUSTED)


class NewerInterface(Base):
    name = "newer-interface"
    interface = 2


class NoPlan(Planner):
    name = "no-plan"
