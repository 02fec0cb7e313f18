import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely

from baselines.ompl_planners import (
    OmplPlanner,
    PRMstarPlanner,
    PRMstarSettings,
    RRTstarPlanner,
    RRTstarSettings,
)
from suite.exact import shortest_path
from suite.planner import Budget, Plan, PlanStatus, Recorder
from suite.referee import Referee
from suite.scene import Query, Scene, make_scene
from suite.scenes.catalogue import load_scene

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

both = pytest.mark.parametrize(
    "planner", [RRTstarPlanner(), PRMstarPlanner()], ids=lambda p: p.name
)


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


# Paths


@both
@pytest.mark.parametrize("name", SCENES)
def test_the_referee_accepts_every_path(planner, name):
    scene = SCENES[name]
    referee = Referee(scene)
    for seed in range(3):
        made = run(planner, scene, Budget(checks=3000), seed)
        assert made.status is PlanStatus.SOLVED
        seen = referee.judge(scene.query(), made.path)
        assert seen.valid, seen.reason
        assert seen.length == pytest.approx(made.claimed_cost, rel=1e-12)


@both
def test_a_longer_run_comes_close_to_the_optimum_of_a_paper_scene(planner):
    scene = load_scene("double_u")
    made = run(planner, scene, Budget(checks=60_000))
    seen = Referee(scene).judge(scene.query(), made.path)
    assert seen.valid, seen.reason
    assert 1.0 <= seen.length / shortest_path(scene, scene.query()).length < 1.1


@both
def test_an_enclosed_goal_is_exhausted_and_never_solved(planner):
    scene = scene_of([RING], (1, 5), (6, 6))
    for budget in (Budget(checks=2000), Budget(wall_s=0.05)):
        made = run(planner, scene, budget)
        assert (made.status, made.path, made.claimed_cost) == (PlanStatus.EXHAUSTED, None, None)


@both
def test_a_seam_encloses_too(planner):
    walls = [shapely.box(4, 0, 6, 5), shapely.box(4, 5, 6, 10)]
    assert run(planner, scene_of(walls, (1, 5), (9, 5)), Budget(checks=2000)).path is None


@both
@pytest.mark.parametrize(("start", "goal"), [((5, 5), (1, 1)), ((1, 1), (5, 5))])
def test_ends_inside_an_obstacle_are_infeasible_and_raise_nothing(planner, start, goal):
    query = Query("inside", np.array(start, dtype=float), np.array(goal, dtype=float))
    made = run(planner, SCENES["one box"], Budget(checks=100), query=query)
    assert (made.status, made.path) == (PlanStatus.INFEASIBLE, None)


# Anytime


@both
@pytest.mark.parametrize("budget", [Budget(checks=10_000), Budget(wall_s=0.3)], ids=str)
def test_improvements_fall_and_the_last_is_the_path(planner, budget):
    recorder = Recorder()
    made = run(planner, SCENES["one box"], budget, recorder=recorder)
    assert made.path is not None
    costs = [i.cost for i in recorder.improvements]
    assert all(after < before for before, after in pairwise(costs))
    assert costs[-1] == pytest.approx(made.claimed_cost, rel=1e-6)
    assert all(0 < i.checks <= made.checks for i in recorder.improvements)


def test_rrtstar_says_in_which_iteration_the_best_was_found():
    made = run(RRTstarPlanner(), SCENES["one box"], Budget(checks=5000))
    assert 0 < made.generation_of_best <= made.generations


# Budgets


@both
@pytest.mark.parametrize("checks", [1, 10, 1234])
def test_a_budget_of_checks_is_never_exceeded(planner, checks):
    assert run(planner, SCENES["one box"], Budget(checks=checks)).checks <= checks


@both
def test_a_budget_of_wall_time_is_kept_within_reason(planner):
    began = time.perf_counter()
    run(planner, load_scene("maze"), Budget(wall_s=0.2))
    # Generous: what is refused here is a planner that does not stop, not a slow machine.
    assert time.perf_counter() - began < 5.0


@both
def test_the_first_limit_that_is_reached_ends_the_run(planner):
    assert run(planner, SCENES["one box"], Budget(wall_s=60.0, checks=500)).checks <= 500
    assert run(planner, SCENES["one box"], Budget(wall_s=0.05, checks=10**9)).checks < 10**9


def test_without_a_budget_the_default_of_the_settings_ends_the_run():
    for planner in (
        RRTstarPlanner(RRTstarSettings(default_wall_s=0.05)),
        PRMstarPlanner(PRMstarSettings(default_wall_s=0.05)),
    ):
        assert run(planner, SCENES["one box"], Budget()).checks > 0


@both
def test_generations_alone_are_refused_with_a_reason(planner):
    scene = SCENES["one box"]
    assert "wall_s or checks" in planner.refuse(scene, scene.query(), Budget(generations=10))
    for budget in (Budget(), Budget(checks=1), Budget(generations=10, wall_s=1.0)):
        assert planner.refuse(scene, scene.query(), budget) is None


# Randomness


@both
def test_another_seed_gives_another_path(planner):
    paths = [run(planner, SCENES["one box"], Budget(checks=2000), seed).path for seed in (1, 2)]
    assert not np.array_equal(*paths)


PROGRAM = """
import sys, numpy as np
from suite.plugins import load_planner
from suite.planner import Budget, Recorder
from suite.scenes.catalogue import load_scene
scene = load_scene("zigzag")
planner = load_planner(sys.argv[1])()
if sys.argv[2] == "after another run":
    planner.warm_up()
recorder = Recorder()
rng = np.random.default_rng(7)
plan = planner.plan(scene, scene.query(), Budget(checks=20_000), rng, recorder)
print(plan.path.tobytes().hex(), [(i.cost, i.checks) for i in recorder.improvements])
"""


@both
def test_same_seed_and_checks_give_the_same_path_in_another_process(planner):
    root = Path(__file__).parents[2]
    printed = [
        subprocess.run(
            [sys.executable, "-c", PROGRAM, planner.name, when],
            capture_output=True, text=True, check=True, cwd=root,
        )
        for when in ("first of all", "after another run")
    ]  # fmt: skip
    assert printed[0].stdout == printed[1].stdout
    assert len(printed[0].stdout) > 100
    assert printed[0].stderr == ""  # OMPL's log and nanobind's reports of leaks stay away


# Settings


def test_every_setting_of_rrtstar_reaches_ompl():
    every = RRTstarSettings(
        range=3.0, goal_bias=0.2, rewire_factor=1.2, k_nearest=False, delay_cc=False,
        tree_pruning=True, prune_threshold=0.1, informed_sampling=True, sample_rejection=False,
        new_state_rejection=True, ordered_sampling=False, batch_size=10,
    )  # fmt: skip
    assert run(RRTstarPlanner(every), SCENES["one box"], Budget(checks=3000)).path is not None


def test_a_short_range_makes_many_waypoints():
    near = RRTstarPlanner(RRTstarSettings(range=0.5))
    assert len(run(near, SCENES["one box"], Budget(checks=20_000)).path) >= 16


@pytest.mark.parametrize("wrong", [
    {"range": 0.0}, {"goal_bias": 1.5}, {"rewire_factor": 0.5}, {"batch_size": 0},
    {"default_wall_s": 0.0},
])  # fmt: skip
def test_settings_that_make_no_sense_are_refused(wrong):
    with pytest.raises(ValueError, match="It must"):
        RRTstarSettings(**wrong)


@pytest.mark.parametrize("wrong", ["slice_s", "slice_checks", "slice_growth", "default_wall_s"])
def test_slices_must_have_a_size(wrong):
    with pytest.raises(ValueError, match="It must be above 0"):
        PRMstarSettings(**{wrong: 0})
