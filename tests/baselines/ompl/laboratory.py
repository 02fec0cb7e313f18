"""Small scenes with degenerate ends, and one run on them."""

import numpy as np
import shapely

from baselines.ompl.adapter import OmplPlanner
from suite.planner import Budget, Plan, Recorder
from suite.scenes.scene import Query, Scene, make_scene

ROOM = shapely.box(0, 0, 10, 10)
BOX = shapely.box(4, 2, 6, 8)
L_SHAPED = shapely.Polygon([(0, 0), (10, 0), (10, 5), (5, 5), (5, 10), (0, 10)])
RING = shapely.box(4, 4, 8, 8).difference(shapely.box(5, 5, 7, 7))


def scene_of(obstacles, start, goal, room=ROOM) -> Scene:
    return make_scene("room", room, obstacles, {"main": (start, goal)})


SCENES = {
    "one box": scene_of([BOX], (1, 5), (9, 5)),
    "ends on edges": scene_of([BOX], (4, 5), (6, 5)),
    "ends on corners": scene_of([BOX], (4, 2), (6, 8)),
    "ends in the corners of the room": scene_of([BOX], (0, 0), (10, 10)),
    "start in a pinch point": scene_of(
        [shapely.box(2, 2, 5, 5), shapely.box(5, 5, 8, 8)], (5, 5), (9, 9)
    ),
    "start in a dent": scene_of(
        [shapely.Polygon([(3, 2), (7, 2), (7, 8), (3, 8), (6, 5)])], (6, 5), (9, 5)
    ),
    "room of L shape": scene_of([shapely.box(2, 2, 3, 3)], (10, 0), (0, 10), L_SHAPED),
    "start is goal": scene_of([BOX], (1, 5), (1, 5)),
}


def run(
    planner: OmplPlanner,
    scene: Scene,
    budget: Budget,
    seed: int = 1,
    query: Query | None = None,
    recorder: Recorder | None = None,
) -> Plan:
    rng = np.random.default_rng(seed)
    return planner.plan(scene, query or scene.query(), budget, rng, recorder or Recorder())
