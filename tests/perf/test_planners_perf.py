"""How long whole runs take, compiled: `make perf`. Skipped in the ordinary test run."""

from itertools import count
from statistics import median

import pytest

from suite.errors import SceneError
from suite.planner import Budget, Recorder
from tests.perf.series import OURS, SCENES, SEEDS, plan, planner, scene

FEW, MANY = "scattered_20", "scattered_3000"


@pytest.mark.parametrize("scene_name", SCENES)
@pytest.mark.parametrize("planner_name", [*OURS, "plain-ga", "visibility-graph"])
def test_whole_run(benchmark, planner_name, scene_name):
    benchmark.group = f"whole run on {scene_name}"
    _measure_whole_runs(benchmark, "whole run", planner_name, scene_name)


@pytest.mark.parametrize("scene_name", [FEW, MANY])
def test_whole_run_among_scattered_obstacles(benchmark, scene_name):
    benchmark.group = "whole run among scattered obstacles"
    try:
        scene(scene_name)
    except SceneError as error:
        pytest.skip(f"the catalogue has no such scene yet: {error}")
    _measure_whole_runs(benchmark, "whole run among scattered", "kbga-plus", scene_name)


def _measure_whole_runs(benchmark, measure, planner_name, scene_name):
    runner = planner(planner_name)
    seeds = count()
    best_s, generations, checks = [], [], []

    def run():
        recorder = Recorder()
        made = plan(runner, scene_name, next(seeds), recorder=recorder)
        generations.append(made.generations)
        checks.append(made.checks)
        best_s.extend(i.wall_s for i in recorder.improvements[-1:])

    benchmark.pedantic(run, rounds=SEEDS, warmup_rounds=1)
    benchmark.extra_info.update(
        measure=measure, scene=scene_name, planner=planner_name,
        best_s=median(best_s) if best_s else None,
        generations=_median(generations), checks=_median(checks),
    )  # fmt: skip


def _median(counts):
    return None if None in counts else median(counts)


@pytest.mark.parametrize("scene_name", SCENES)
@pytest.mark.parametrize("planner_name", OURS)
def test_first_population(benchmark, planner_name, scene_name):
    """Set-up, first population and one generation: what a run can't be shorter than."""
    benchmark.group = f"{planner_name} until its first generation"
    runner = planner(planner_name)
    seeds = count()
    benchmark.pedantic(
        lambda: plan(runner, scene_name, next(seeds), Budget(generations=1)),
        rounds=SEEDS,
        warmup_rounds=1,
    )
    benchmark.extra_info.update(measure="first generation", scene=scene_name, planner=planner_name)
