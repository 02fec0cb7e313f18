from itertools import pairwise

import pytest

from baselines.ompl.adapter import Problem
from baselines.ompl.oneshot import RRTConnectPlanner, RRTConnectSettings
from baselines.ompl.shortcut import ShortcutPlanner, ShortcutSettings
from suite.planner import Budget, PlanStatus, Recorder
from suite.referee.path import Referee
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from tests.baselines.ompl.laboratory import SCENES, run, scene_of


def test_its_first_path_is_that_of_rrt_connect():
    scene = load_scene("clustered")
    recorder = Recorder()
    run(ShortcutPlanner(), scene, Budget(checks=20_000), recorder=recorder)
    raw = run(RRTConnectPlanner(RRTConnectSettings(simplify=False)), scene, Budget(checks=20_000))
    assert recorder.improvements[0].cost == raw.claimed_cost
    # The kernel goes over a path before it counts, and that counts.
    assert recorder.improvements[0].checks == raw.checks + len(raw.path) - 1


def test_restarts_bring_it_closer_than_one_path_can_come():
    scene = load_scene("clustered")  # at least four ways round, and the first path takes any
    optimum = shortest_path(scene, scene.query()).length
    gaps = []
    for seed in range(3):
        made = run(ShortcutPlanner(), scene, Budget(checks=150_000), seed)
        assert Referee(scene).judge(scene.query(), made.path).valid
        gaps.append(made.claimed_cost / optimum - 1.0)
    assert max(gaps) < 0.01


def test_a_larger_budget_goes_on_from_where_the_smaller_one_ended():
    scene = load_scene("clustered")
    referee = Referee(scene)
    costs = []
    for checks in range(600, 12_000, 400):
        made = run(ShortcutPlanner(), scene, Budget(checks=checks))
        assert made.checks <= checks
        if made.path is not None:
            assert referee.judge(scene.query(), made.path).valid
            costs.append(made.claimed_cost)
    assert all(after <= before for before, after in pairwise(costs))
    assert len(set(costs)) > 5


def test_a_budget_of_checks_is_used_up():
    made = run(ShortcutPlanner(), load_scene("zigzag"), Budget(checks=20_000))
    assert 0.98 * 20_000 <= made.checks <= 20_000


def test_a_straight_path_ends_the_run():
    scene = scene_of([], (1, 1), (9, 2))
    made = run(ShortcutPlanner(), scene, Budget(checks=10**6))
    assert made.checks < 10_000
    assert made.claimed_cost == pytest.approx(65**0.5)


def test_a_path_that_the_kernel_rejects_is_never_taken(monkeypatch):
    monkeypatch.setattr(Problem, "read", lambda *_: None)
    recorder = Recorder()
    made = run(ShortcutPlanner(), SCENES["one box"], Budget(checks=5000), recorder=recorder)
    assert (made.status, made.path, recorder.improvements) == (PlanStatus.EXHAUSTED, None, [])


def test_the_rope_is_a_setting():
    scene = load_scene("double_u")
    runs = [
        run(ShortcutPlanner(ShortcutSettings(rope=rope)), scene, Budget(checks=30_000))
        for rope in (None, 2.0)
    ]
    assert runs[0].claimed_cost != runs[1].claimed_cost
