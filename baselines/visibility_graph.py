"""The exact solver as a planner: a yardstick in the same tables as the planners it measures."""

from functools import cache
from typing import ClassVar

import numpy as np
import shapely

from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene, make_scene


class VisibilityGraphPlanner(Planner):
    """Lazy A* over the tangent visibility graph; see :mod:`suite.scenes.exact`.

    It needs no budget: it ends with the shortest path, or with the proof that there is none.
    """

    name: ClassVar[str] = "visibility-graph"
    abilities: ClassVar[Abilities] = Abilities(deterministic=True, exact=True)

    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,  # noqa: ARG002 (the search ends by itself, sooner than any sensible limit)
        rng: np.random.Generator,  # noqa: ARG002
        recorder: Recorder,
    ) -> Plan:
        """Find the shortest path, or say that there is none."""
        found = shortest_path(scene, query)
        if found.path is None:
            return Plan(PlanStatus.INFEASIBLE, checks=found.checks)
        recorder.improved(found.length, checks=found.checks)
        return Plan(PlanStatus.SOLVED, found.path, claimed_cost=found.length, checks=found.checks)

    def warm_up(self) -> None:
        """Compile the search."""
        shortest_path(tiny_scene(), tiny_scene().query())


@cache
def tiny_scene() -> Scene:
    """Make a scene of one box that is in the way: enough to compile whatever plans."""
    return make_scene(
        "tiny", shapely.box(0, 0, 3, 3), [shapely.box(1, 0, 2, 2)], {"main": ((0, 1), (3, 1))}
    )
