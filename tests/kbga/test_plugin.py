"""KBGA behind the plugin interface: budgets kept, improvements told, claims true."""

import json
import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from kbga.plugin import KBGAPlanner, KBGAPlusPlanner
from kbga.settings import KBGAPlusSettings, KBGASettings
from suite.planner import Budget, Plan, PlanStatus, Recorder
from suite.plugins.settings import make_settings
from suite.referee.path import judge
from suite.scenes.scene import Scene
from suite.store.record import canonical_json
from suite.typed import plain
from tests.kbga.laboratory import scene_of
from tests.suite.geometry.lattice import COMPILED, counts

SMALL = KBGASettings(population_size=12, resolution=20, max_generations=counts(15, 5))
WALL = scene_of(shapely.box(4, 0, 6, 8))
CLOSED = scene_of(shapely.box(8, 8, 10, 10).difference(shapely.box(8.5, 8.5, 9.5, 9.5)))


def plan(
    scene: Scene = WALL,
    budget: Budget | None = None,
    recorder: Recorder | None = None,
    settings: KBGASettings = SMALL,
) -> Plan:
    planner = KBGAPlanner(settings)
    rng = np.random.default_rng(4)
    recorder = Recorder() if recorder is None else recorder
    recorder.start_clock()
    return planner.plan(scene, scene.query(), budget or Budget(), rng, recorder)


@pytest.fixture(scope="module", autouse=True)
def warm() -> None:
    KBGAPlanner().warm_up()


def test_the_referee_accepts_what_it_calls_solved_and_agrees_on_its_length():
    made = plan()
    verdict = judge(WALL, WALL.query(), made.path)
    assert made.status is PlanStatus.SOLVED
    assert verdict.valid, verdict.reason
    assert made.claimed_cost == pytest.approx(verdict.length)


def test_where_there_is_no_way_it_can_say_so_at_once_and_why():
    recorder = Recorder()
    made = plan(CLOSED, recorder=recorder, settings=replace(SMALL, proves=True))
    assert (made.status, made.path, made.checks) == (PlanStatus.INFEASIBLE, None, 0)
    assert made.reason == (
        "no way: the start lies in a part of free space of 96 m2, which does not hold the goal."
    )
    assert plan(settings=replace(SMALL, proves=True)).status is PlanStatus.SOLVED


def test_without_a_path_it_is_exhausted_and_claims_the_penalised_cost():
    recorder = Recorder()
    made = plan(CLOSED, recorder=recorder)
    assert (made.status, made.path) == (PlanStatus.EXHAUSTED, None)
    assert made.generations == SMALL.max_generations
    assert recorder.improvements == []
    assert made.claimed_cost == min(row["best"] for row in recorder.trace)
    assert recorder.trace[made.generation_of_best or 0]["best"] == made.claimed_cost


def test_improvements_fall_and_the_last_is_the_path_returned():
    recorder = Recorder()
    made = plan(recorder=recorder)
    costs = [i.cost for i in recorder.improvements]
    assert costs == sorted(set(costs), reverse=True)
    assert made.path is not None
    assert costs[-1] == pytest.approx(np.hypot(*np.diff(made.path, axis=0).T).sum())
    last = recorder.improvements[-1]
    assert (last.cost, last.generation) == (made.claimed_cost, made.generation_of_best)
    checks = [i.checks or 0 for i in recorder.improvements]
    assert checks == sorted(checks)
    assert checks[-1] <= (made.checks or 0)


@pytest.mark.skipif(not COMPILED, reason="nothing is compiled")
@pytest.mark.parametrize("planner", ["KBGAPlanner()", "KBGAPlusPlanner()"])
def test_after_the_warm_up_a_run_compiles_and_loads_nothing_more(planner):
    code = f"""
from pathlib import Path
import sys
import numpy as np
from numba.core.registry import CPUDispatcher
from kbga.plugin import KBGAPlanner, KBGAPlusPlanner
from suite.planner import Budget, Recorder
from suite.scenes.catalogue import load_scene

def compiled():
    kernels = [k for m in list(sys.modules.values()) for k in vars(m).values()
               if isinstance(k, CPUDispatcher)]
    return {{k.py_func.__qualname__: len(k.signatures) for k in kernels}}

scene, recorder = load_scene("clustered"), Recorder()
{planner}.warm_up()
before = compiled()
recorder.start_clock()
made = {planner}.plan(scene, scene.query(), Budget(), np.random.default_rng(0), recorder)
after = compiled()
assert made.checks > 2048, "its table grows"
print({{name: n for name, n in after.items() if n != before[name]}})
"""
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "{}"


def test_the_trace_has_a_row_per_generation_the_first_population_included():
    recorder = Recorder()
    made = plan(recorder=recorder)
    assert [row["generation"] for row in recorder.trace] == list(range((made.generations or 0) + 1))
    names = {"generation", "best", "mean", "feasible_share", "diversity", "checks"}
    assert all(set(row) == names for row in recorder.trace)
    assert recorder.trace[-1]["checks"] == made.checks


def test_populations_are_shown_only_if_asked_for():
    asked, not_asked = Recorder(snapshot_of={0, 3}.__contains__), Recorder()
    first, second = plan(recorder=asked), plan(recorder=not_asked)
    assert not_asked.snapshots == []
    assert [snapshot.generation for snapshot in asked.snapshots] == [0, 3]
    assert all(len(snapshot.paths) == 12 for snapshot in asked.snapshots)
    assert all(path[0].tolist() == [1, 1] for path in asked.snapshots[0].paths)
    assert np.array_equal(first.path, second.path)


@pytest.mark.parametrize("generations", [1, 3])
def test_a_budget_of_generations_is_kept_exactly(generations):
    assert plan(CLOSED, Budget(generations=generations)).generations == generations


@pytest.mark.parametrize("checks", [1, 40, 100, 333])
@pytest.mark.parametrize(
    "planner",
    [KBGAPlanner(), KBGAPlusPlanner(KBGAPlusSettings(proves=False))],
    ids=["kbga", "plus"],
)
def test_a_budget_of_checks_is_kept_to_the_last_one(planner, checks):
    made = planner.plan(
        CLOSED, CLOSED.query(), Budget(checks=checks), np.random.default_rng(1), Recorder()
    )
    assert made.checks == checks
    assert 0 < (made.computed_checks or 0) <= checks


def test_a_run_of_few_checks_begins_as_the_run_of_many_does():
    few, many = Recorder(), Recorder()
    plan(budget=Budget(checks=150), recorder=few)
    made = plan(recorder=many)
    assert (made.checks or 0) > 150
    both = [(i.cost, i.checks) for i in many.improvements if (i.checks or 0) < 150]
    assert both
    assert [(i.cost, i.checks) for i in few.improvements][: len(both)] == both


def test_a_budget_of_time_that_is_over_at_once_leaves_the_first_population():
    assert plan(CLOSED, Budget(wall_s=1e-9)).generations == 0


def test_a_budget_of_time_ends_a_run_that_would_go_on():
    endless = KBGASettings(population_size=12, resolution=20, max_generations=10**9)
    recorder = Recorder()
    made = plan(CLOSED, Budget(wall_s=0.05), recorder, endless)
    assert made.generations is not None
    assert 0 < made.generations < 10**9
    assert recorder.wall_s() >= 0.05


def test_a_budget_of_cpu_time_ends_a_run_that_would_go_on():
    endless = KBGASettings(population_size=12, resolution=20, max_generations=10**9)
    recorder = Recorder()
    made = plan(CLOSED, Budget(cpu_s=0.05), recorder, endless)
    assert 0 < (made.generations or 0) < 10**9
    assert recorder.cpu_s() >= 0.05


def test_an_ample_budget_changes_nothing():
    ample = Budget(wall_s=1e6, generations=10**6, checks=10**12)
    assert np.array_equal(plan(budget=ample).path, plan().path)


def test_it_keeps_the_budgets_that_it_says_it_keeps():
    assert KBGAPlanner.abilities.anytime
    assert KBGAPlanner.abilities.budgets == {"wall_s", "cpu_s", "generations", "checks"}
    assert not KBGAPlanner.abilities.exact


def test_an_infinite_repair_limit_survives_the_way_through_a_matrix_and_the_store():
    made = make_settings(KBGAPlanner, {"repair_limit": "inf"})  # as --set gives it
    assert made == make_settings(KBGAPlanner, {"repair_limit": math.inf})  # as TOML gives it
    stored = json.loads(canonical_json(plain(made)))
    assert make_settings(KBGAPlanner, stored) == made
    assert stored["repair_limit"] == math.inf
