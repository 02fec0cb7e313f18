# ruff: noqa: ARG002 (planners take what the contract gives, and some misuse it)
"""Planners whose scene, path or claim is not what it should be."""

import numpy as np

from suite.planner import Plan, PlanStatus

from .base import Base


class ChangesTheScene(Base):
    name = "changes-the-scene"

    def plan(self, scene, query, budget, rng, recorder):
        query.goal[:] = query.start
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))


class MovesTheGoal(Base):
    """Not by mistake."""

    name = "moves-the-goal"

    def plan(self, scene, query, budget, rng, recorder):
        query.goal.setflags(write=True)
        query.goal[:] = query.start + 0.1
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))


class ChangesObstacles(Base):
    name = "changes-obstacles"

    def plan(self, scene, query, budget, rng, recorder):
        scene.obstacles = ()
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))


class ReturnsNone(Base):
    name = "returns-none"

    def plan(self, scene, query, budget, rng, recorder):
        return None


class Generates(Base):
    """Its plan is a generator function, by one ``yield`` too many."""

    name = "generates"

    def plan(self, scene, query, budget, rng, recorder):
        yield Plan(PlanStatus.SOLVED, self.path(scene, query))


class ReturnsAGenerator(Base):
    name = "returns-a-generator"

    def path(self, scene, query):
        return (point for point in (query.start, query.goal))


class ReturnsAWrongShape(Base):
    name = "returns-a-wrong-shape"

    def path(self, scene, query):
        return np.zeros((4, 3))


class ReturnsNoPath(Base):
    name = "returns-no-path"

    def path(self, scene, query):
        return None


class ReturnsNaN(Base):
    name = "returns-nan"

    def path(self, scene, query):
        return np.array([query.start, [np.nan, 1.0], query.goal])


class ReturnsText(Base):
    name = "returns-text"

    def path(self, scene, query):
        return "left, then right"


class Cheats(Base):
    """Goes straight on."""

    name = "cheats"

    def path(self, scene, query):
        return np.array([query.start, query.goal])


class SaysCrashed(Base):
    name = "says-crashed"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.CRASHED)


class GivesUp(Base):
    """And needs no time to get ready."""

    name = "gives-up"

    def warm_up(self):
        pass

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.EXHAUSTED, claimed_cost=1234.5, generations=7, generation_of_best=2)


class ClaimsInfeasible(Base):
    name = "claims-infeasible"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.INFEASIBLE)


class Refuses(Base):
    name = "refuses"

    def refuse(self, scene, query, budget):
        return "not on a Monday"
