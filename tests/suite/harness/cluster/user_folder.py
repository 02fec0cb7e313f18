"""The folder of a user: a scene, a matrix, a planner in a file and a module that it imports."""

import shapely

from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene

PLUGIN = '''
import os
import time
from pathlib import Path

import numba
import numpy as np

from detours import length
from suite.planner import Abilities, Plan, Planner, PlanStatus


@numba.njit(cache=True)
def bend(x):
    return 3.0 + x


class Lucky(Planner):
    """Goes by a random place, above the block."""

    name = "lucky"
    abilities = Abilities(budgets=frozenset({"generations"}))

    def warm_up(self):
        bend(0.5)

    def plan(self, scene, query, budget, rng, recorder):
        with Path(os.environ["HOME"], "ran-from").open("a") as file:
            file.write(__file__ + "\\n")
        time.sleep(0.1)
        path = np.array([query.start, [5.0, bend(length * rng.random())], query.goal])
        return Plan(PlanStatus.SOLVED, path)
'''


def write_user_folder(folder, seeds):
    folder.mkdir()
    block = make_scene(
        "block", shapely.box(0, 0, 10, 10), [shapely.box(4, 0, 6, 2)], {"main": ((1, 3), (9, 3))}
    )
    write_scene(block, folder / "block.geojson")
    (folder / "lucky.py").write_text(PLUGIN)
    (folder / "detours.py").write_text("length = 5.0\n")
    scenes = '["block.geojson", "block.geojson@turn=17"]'
    planner = '[[planner]]\nplanner = "lucky"\nbudget = { generations = 1 }\n'
    (folder / "matrix.toml").write_text(f"scenes = {scenes}\nseeds = {seeds}\n{planner}")
    return folder
