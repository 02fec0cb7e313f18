# ruff: noqa: ARG002 (planners take what the contract gives, and some misuse it)
"""What the hostile planners have in common: the shortest path, after some misbehaviour."""

import os
import time

import shapely

from suite.planner import Plan, Planner, PlanStatus
from suite.scenes.exact import shortest_path
from suite.scenes.scene import make_scene

HANG_S = 3600.0
"""Longer than any test waits: whoever hangs so long is ended by others, or the test fails."""


class Base(Planner):
    def warm_up(self):
        scene = make_scene("tiny", shapely.box(0, 0, 1, 1), [], {"main": ((0, 0), (1, 1))})
        shortest_path(scene, scene.query())

    def path(self, scene, query):
        return shortest_path(scene, query).path

    def plan(self, scene, query, budget, rng, recorder):
        self.misbehave()
        return Plan(PlanStatus.SOLVED, self.path(scene, query))

    def misbehave(self):
        pass


def go_away(then=lambda: time.sleep(HANG_S)):
    """A daemon, as the book has it: fork, leave session and terminal, fork again, let go."""
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            os.closerange(0, 256)
            then()
        os._exit(0)
