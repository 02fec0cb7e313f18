import gc
import weakref
from itertools import pairwise

import numpy as np
import pytest

from baselines.ompl.adapter import Problem
from baselines.ompl.oneshot import RRTConnectPlanner, RRTConnectSettings
from suite.planner import Budget, PlanAfresh, PlanStatus, Recorder
from suite.referee import Referee
from suite.scenes.catalogue import load_scene
from tests.baselines.ompl.laboratory import SCENES, run

SIMPLIFIED = (RRTConnectPlanner(),)

each_simplified = pytest.mark.parametrize("planner", SIMPLIFIED, ids=lambda p: p.name)

PLENTY = Budget(checks=10**6)


def test_a_oneshot_planner_ends_with_its_path_and_says_that_it_is_not_anytime():
    planner = RRTConnectPlanner()
    assert not planner.abilities.anytime
    assert planner.abilities.budgets == {"wall_s", "checks"}
    assert run(planner, SCENES["one box"], PLENTY).checks < 10_000


# Simplifier


def plain(planner):
    return type(planner)(planner.Settings(simplify=False))


@each_simplified
def test_the_path_before_simplification_is_the_first_improvement(planner):
    scene = load_scene("obstacles_20")
    recorder = Recorder()
    made = run(planner, scene, PLENTY, recorder=recorder)
    before = run(plain(planner), scene, PLENTY)
    first, last = recorder.improvements
    assert (first.cost, first.checks) == (before.claimed_cost, before.checks)
    assert (last.cost, last.checks) == (made.claimed_cost, made.checks)
    assert last.cost < first.cost
    assert last.checks > first.checks  # its checks count


@each_simplified
def test_a_budget_that_ends_in_the_simplifier_leaves_a_free_path(planner):
    scene = load_scene("clustered")
    referee = Referee(scene)
    before = run(plain(planner), scene, PLENTY)
    whole = run(planner, scene, PLENTY)
    steps = np.linspace(before.checks, whole.checks, 40, dtype=int).tolist()
    costs = []
    for checks in steps:
        made = run(planner, scene, Budget(checks=checks))
        assert made.checks <= checks
        assert referee.judge(scene.query(), made.path).valid
        costs.append(made.claimed_cost)
    assert costs[0] == before.claimed_cost
    assert costs[-1] == whole.claimed_cost
    assert all(after <= earlier for earlier, after in pairwise(costs))
    assert len(set(costs)) > 5


class Ticking(Recorder):
    """A clock that goes on by a second whenever it is read."""

    def start_clock(self) -> None:
        super().start_clock()
        self._ticks = 0

    def wall_s(self) -> float:
        self._ticks += 1
        return float(self._ticks)


@each_simplified
def test_a_clock_that_runs_out_in_the_simplifier_leaves_a_free_path(planner):
    scene = load_scene("clustered")
    whole = Ticking()
    shortest = run(planner, scene, Budget(wall_s=1e9), recorder=whole).claimed_cost
    first, last = (int(i.wall_s) for i in whole.improvements)
    costs = []
    for seconds in range(first + 1, last + 1):
        made = run(planner, scene, Budget(wall_s=float(seconds)), recorder=Ticking())
        assert Referee(scene).judge(scene.query(), made.path).valid
        costs.append(made.claimed_cost)
    assert costs[0] == whole.improvements[0].cost
    assert costs[-1] == shortest
    assert len(set(costs)) > 3


@each_simplified
def test_ten_runs_in_one_process_are_the_same(planner):
    scene = load_scene("obstacles_20")
    found = run(plain(planner), scene, PLENTY, seed=5).checks
    for checks in (found, found + 50, 10**6):
        paths = {
            run(planner, scene, Budget(checks=checks), seed=5).path.tobytes() for _ in range(10)
        }
        assert len(paths) == 1


@each_simplified
def test_it_replans_from_new_places_for_ever(planner):
    scene = load_scene("obstacles_20")
    query = scene.query()
    replanner = planner.replanner(np.random.default_rng(3))
    assert isinstance(replanner, PlanAfresh)
    referee = Referee(scene)
    made = replanner.begin(scene, query, Budget(wall_s=0.02), Recorder())
    for _ in range(100):
        assert made.status is PlanStatus.SOLVED
        assert referee.judge(query, made.path).valid
        step = made.path[1] - made.path[0]
        onward = made.path[0] + step * min(1.0, 1.0 / np.linalg.norm(step))
        query = type(query)(query.name, onward, query.goal)
        made = replanner.update(scene, query, Budget(wall_s=0.02), Recorder())


@each_simplified
@pytest.mark.parametrize("budget", [Budget(checks=80), PLENTY], ids=str)
def test_nothing_of_a_run_stays_in_memory(planner, budget, monkeypatch):
    alive = []
    set_up = Problem.set_up

    def remember(problem):
        alive.extend((weakref.ref(problem), weakref.ref(problem.collision)))
        set_up(problem)

    monkeypatch.setattr(Problem, "set_up", remember)
    run(planner, load_scene("obstacles_20"), budget)
    gc.collect()
    assert [reference() for reference in alive] == [None, None]


def test_the_simplifier_can_be_switched_off():
    scene = load_scene("zigzag")
    recorder = Recorder()
    off = RRTConnectPlanner(RRTConnectSettings(simplify=False))
    made = run(off, scene, PLENTY, recorder=recorder)
    assert [i.checks for i in recorder.improvements] == [made.checks]
