from itertools import pairwise

import numpy as np
import pytest

from baselines.ompl.oneshot import (
    BFMTPlanner,
    FMTPlanner,
    RRTConnectPlanner,
    RRTConnectSettings,
    RRTPlanner,
    SimplifiedPlanner,
)
from suite.planner import Budget, PlanAfresh, PlanStatus, Recorder
from suite.referee.path import Referee
from suite.scenes.catalogue import load_scene
from tests.baselines.ompl.laboratory import RING, SCENES, run, scene_of

MARCHING = (FMTPlanner, BFMTPlanner)
SIMPLIFIED = (RRTPlanner, RRTConnectPlanner)
ONE_SHOT = (*SIMPLIFIED, *MARCHING)

each = pytest.mark.parametrize("planner", [p() for p in ONE_SHOT], ids=lambda p: p.name)
each_simplified = pytest.mark.parametrize(
    "planner", [p() for p in SIMPLIFIED], ids=lambda p: p.name
)
each_marching = pytest.mark.parametrize("planner", MARCHING, ids=lambda p: p.name)

PLENTY = Budget(checks=10**6)
ENCLOSED = {
    "goal": scene_of([RING], (1, 5), (6, 6)),
    "start": scene_of([RING], (6, 6), (1, 5)),
}


@each
def test_a_oneshot_planner_ends_with_its_path_and_says_that_it_is_not_anytime(planner):
    assert not planner.abilities.anytime
    assert planner.abilities.budgets == {"wall_s", "cpu_s", "checks"}
    assert run(planner, SCENES["one box"], PLENTY).checks < 10_000


@each
def test_the_budget_that_a_path_needs_is_enough_and_one_check_less_is_not(planner):
    if isinstance(planner, SimplifiedPlanner):
        planner = plain(planner)
    scene = load_scene("clustered")
    whole = run(planner, scene, PLENTY)
    enough = run(planner, scene, Budget(checks=whole.checks + 1))
    assert enough.path.tobytes() == whole.path.tobytes()
    short = run(planner, scene, Budget(checks=whole.checks - 1))
    assert (short.status, short.path) == (PlanStatus.EXHAUSTED, None)


# FMT* and BFMT*


@each_marching
@pytest.mark.parametrize("checks", [1, 2, 3, 500, 1100])
def test_a_budget_that_ends_in_the_samples_is_exhausted(planner, checks):
    made = run(planner(), SCENES["one box"], Budget(checks=checks))
    assert (made.status, made.checks) == (PlanStatus.EXHAUSTED, checks)
    assert made.details["state_checks"] <= checks


@each_marching
@pytest.mark.parametrize("end", ENCLOSED)
def test_without_extension_an_enclosed_end_ends_the_run_early(planner, end):
    made = run(planner(planner.Settings(extended=False)), ENCLOSED[end], PLENTY)
    assert made.status is PlanStatus.EXHAUSTED
    assert made.checks < 10_000


@each_marching
@pytest.mark.parametrize("end", ENCLOSED)
def test_with_extension_an_enclosed_end_takes_the_whole_budget(planner, end):
    made = run(planner(), ENCLOSED[end], Budget(checks=10_000))
    assert (made.status, made.checks) == (PlanStatus.EXHAUSTED, 10_000)
    assert run(planner(), ENCLOSED[end], Budget(wall_s=0.05)).status is PlanStatus.EXHAUSTED


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
def test_it_replans_from_a_hundred_places_in_one_process(planner):
    scene = load_scene("obstacles_20")
    query = scene.query()
    replanner = planner.replanner(np.random.default_rng(3))
    assert isinstance(replanner, PlanAfresh)
    referee = Referee(scene)
    made = replanner.begin(scene, query, Budget(checks=20_000), Recorder())
    for _ in range(100):
        assert made.status is PlanStatus.SOLVED
        assert referee.judge(query, made.path).valid
        step = made.path[1] - made.path[0]
        onward = made.path[0] + step * min(1.0, 1.0 / np.linalg.norm(step))
        query = type(query)(query.name, onward, query.goal)
        made = replanner.update(scene, query, Budget(checks=20_000), Recorder())


def test_the_simplifier_can_be_switched_off():
    scene = load_scene("zigzag")
    recorder = Recorder()
    off = RRTConnectPlanner(RRTConnectSettings(simplify=False))
    made = run(off, scene, PLENTY, recorder=recorder)
    assert [i.checks for i in recorder.improvements] == [made.checks]
