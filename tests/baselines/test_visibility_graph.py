import numpy as np
import pytest
import shapely

from baselines.visibility_graph import VisibilityGraphPlanner
from suite.planner import Budget, Plan, PlanStatus, Recorder
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene
from suite.scenes.scene import Scene, make_scene

ROOM = shapely.box(0, 0, 10, 10)
QUERY = {"main": ((0, 3), (10, 3))}
ONE_BOX = make_scene("one box", ROOM, [shapely.box(4, 0, 6, 7)], QUERY)
WALLED_OFF = make_scene(
    "walled off", ROOM, [shapely.box(4, 0, 6, 5), shapely.box(4, 5, 6, 10)], QUERY
)


def plan(scene: Scene, recorder: Recorder | None = None) -> Plan:
    planner = VisibilityGraphPlanner()
    planner.warm_up()
    recorder = recorder or Recorder()
    return planner.plan(scene, scene.query(), Budget(), np.random.default_rng(0), recorder)


def test_the_shortest_path_is_returned_and_claimed():
    made = plan(ONE_BOX)
    assert made.status is PlanStatus.SOLVED
    assert made.path.tolist() == [[0, 3], [4, 7], [6, 7], [10, 3]]
    assert made.claimed_cost == pytest.approx(2 + 2 * np.hypot(4, 4))
    assert made.checks > 0


def test_the_improvement_is_reported_with_its_checks():
    recorder = Recorder()
    made = plan(ONE_BOX, recorder)
    assert [(i.cost, i.checks) for i in recorder.improvements] == [(made.claimed_cost, made.checks)]


def test_no_path_is_infeasible_and_never_exhausted():
    made = plan(WALLED_OFF)
    assert (made.status, made.path, made.claimed_cost) == (PlanStatus.INFEASIBLE, None, None)


def test_it_needs_no_randomness_and_says_so():
    planner = VisibilityGraphPlanner()
    assert planner.abilities.exact
    assert planner.abilities.deterministic
    paths = [
        planner.plan(ONE_BOX, ONE_BOX.query(), Budget(), np.random.default_rng(s), Recorder()).path
        for s in (1, 2)
    ]
    assert np.array_equal(*paths)


def test_the_referee_accepts_its_path_in_a_maze():
    scene = load_scene("maze")
    made = plan(scene)
    seen = judge(scene, scene.query(), made.path)
    assert seen.valid, seen.reason
    assert seen.length == pytest.approx(made.claimed_cost, rel=1e-12)
