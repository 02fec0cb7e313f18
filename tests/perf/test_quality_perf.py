"""How far KBGA's paths are from the exact optimum, on two lattices; the referee measures them."""

import pytest

from suite.planner import PlanStatus
from suite.referee.path import Referee
from tests.perf.series import SCENES, SEEDS, optimum, plan, planner, scene


@pytest.mark.parametrize("scene_name", SCENES)
@pytest.mark.parametrize("resolution", [100, 400])
def test_gap(benchmark, resolution, scene_name):
    benchmark.group = f"whole runs at resolution {resolution}: all seeds"
    runner = planner("kbga-plus", resolution=resolution)
    plans = []
    benchmark.pedantic(
        lambda: plans.extend(plan(runner, scene_name, seed) for seed in range(SEEDS)), rounds=1
    )
    referee, query = Referee(scene(scene_name)), scene(scene_name).query()
    judged = [referee.judge(query, p.path) for p in plans if p.status is PlanStatus.SOLVED]
    benchmark.extra_info.update(
        measure="gap",
        scene=scene_name,
        resolution=resolution,
        gaps=[j.length / optimum(scene_name) - 1.0 for j in judged if j.valid],
        seeds=SEEDS,
    )
