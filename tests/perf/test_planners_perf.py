"""How long whole runs take, compiled: `make perf`. Skipped in the ordinary test run."""

from itertools import count

import numpy as np
import pytest

from suite.planner import Budget, Recorder
from suite.plugins import load_planner
from suite.scenes.catalogue import load_scene, scene_names


@pytest.mark.parametrize("scene_name", scene_names())
@pytest.mark.parametrize("planner_name", ["kbga", "plain-ga", "visibility-graph"])
def test_whole_run(benchmark, planner_name, scene_name):
    benchmark.group = f"whole run on {scene_name}"
    scene = load_scene(scene_name)
    planner = load_planner(planner_name)()
    planner.warm_up()
    seeds = count()

    def run():
        rng = np.random.default_rng(next(seeds))
        return planner.plan(scene, scene.query(), Budget(), rng, Recorder())

    benchmark.pedantic(run, rounds=20, warmup_rounds=1)
