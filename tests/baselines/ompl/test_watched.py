import numpy as np
import pytest
import shapely

from baselines.ompl.adapter import Problem
from baselines.ompl.watched import (
    AORRTCPlanner,
    BITstarPlanner,
    InformedRRTstarPlanner,
    RRTstarPlanner,
    SORRTstarPlanner,
)
from suite.planner import Budget, PlanStatus, Recorder
from suite.referee.path import Referee
from tests.baselines.ompl.laboratory import L_SHAPED, run, scene_of

WATCHED = (
    RRTstarPlanner,
    InformedRRTstarPlanner,
    SORRTstarPlanner,
    BITstarPlanner,
    AORRTCPlanner,
)

each = pytest.mark.parametrize("planner", [p() for p in WATCHED], ids=lambda p: p.name)

IN_SIGHT = {
    "in the open": scene_of([shapely.box(1, 8, 2, 9)], (1, 1), (9, 2)),
    "past a corner": scene_of([shapely.box(2, 2, 3, 3)], (10, 0), (0, 10), L_SHAPED),
}


@each
@pytest.mark.parametrize("name", IN_SIGHT)
def test_a_goal_in_sight_is_reached_from_the_start(planner, name):
    # AORRTC went from the goal to the goal; SORRT* waited for ever for a shorter path.
    scene = IN_SIGHT[name]
    query = scene.query()
    straight = np.linalg.norm(query.goal - query.start)
    for seed in range(3):
        recorder = Recorder()
        made = run(planner, scene, Budget(checks=5000), seed, recorder=recorder)
        assert made.status is PlanStatus.SOLVED
        assert Referee(scene).judge(query, made.path).valid
        assert made.claimed_cost == pytest.approx(straight, rel=1e-2)
        assert min(i.cost for i in recorder.improvements) >= straight * (1 - 1e-12)


@pytest.mark.parametrize("name", IN_SIGHT)
def test_sorrtstar_ends_when_its_path_is_straight(name):
    assert run(SORRTstarPlanner(), IN_SIGHT[name], Budget(checks=10**6)).checks < 10**5


def test_a_path_that_does_not_begin_at_the_start_is_no_path(monkeypatch):
    scene = IN_SIGHT["in the open"]
    monkeypatch.setattr(Problem, "straight_line", property(lambda _: np.array([[0, 0], [1, 1]])))
    made = run(RRTstarPlanner(), scene, Budget(checks=1000))
    assert (made.status, made.path) == (PlanStatus.EXHAUSTED, None)
