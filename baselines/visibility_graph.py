"""The visibility search as a planner: exact, in the same tables as the planners it measures.

Not the solver of the optima (suite.scenes.exact), which walks a navigation mesh, and is the planner
``polyanya``: that one asks no question about segments, so it has no place on a clock of checks.
"""

from functools import cache
from typing import ClassVar

import numpy as np
import shapely

from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.exact import path_length
from suite.scenes.scene import Query, Scene, make_scene
from suite.scenes.visibility import tangent_path


class VisibilityGraphPlanner(Planner):
    """Lazy A* over the tangent visibility graph; see :mod:`suite.scenes.visibility`.

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
        path, checks = tangent_path(scene, query)
        if path is None:
            return Plan(PlanStatus.INFEASIBLE, checks=checks)
        length = path_length(path)
        recorder.improved(length, checks=checks)
        return Plan(PlanStatus.SOLVED, path, claimed_cost=length, checks=checks)

    def warm_up(self) -> None:
        """Compile the search."""
        tangent_path(tiny_scene(), tiny_scene().query())


@cache
def tiny_scene() -> Scene:
    """Make a scene of one box that is in the way: enough to compile whatever plans."""
    return make_scene(
        "tiny", shapely.box(0, 0, 3, 3), [shapely.box(1, 0, 2, 2)], {"main": ((0, 1), (3, 1))}
    )
