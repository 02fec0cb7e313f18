import gc
import subprocess
import sys
import time
import weakref
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely

from baselines.ompl.adapter import Problem
from baselines.ompl.oneshot import (
    BFMTPlanner,
    FMTPlanner,
    RRTConnectPlanner,
    RRTPlanner,
    SimplifiedPlanner,
)
from baselines.ompl.roadmap import PRMPlanner, PRMstarPlanner
from baselines.ompl.shortcut import ShortcutPlanner
from baselines.ompl.watched import (
    AORRTCPlanner,
    BITstarPlanner,
    InformedRRTstarPlanner,
    RRTstarPlanner,
    SORRTstarPlanner,
)
from suite.planner import Budget, PlanStatus, Recorder, refusal
from suite.referee.path import Referee
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query
from tests.baselines.ompl.laboratory import RING, SCENES, run, scene_of

PLANNERS = (
    RRTstarPlanner,
    InformedRRTstarPlanner,
    SORRTstarPlanner,
    BITstarPlanner,
    AORRTCPlanner,
    PRMPlanner,
    PRMstarPlanner,
    RRTPlanner,
    RRTConnectPlanner,
    FMTPlanner,
    BFMTPlanner,
    ShortcutPlanner,
)

WITH_ITERATIONS = (RRTstarPlanner, InformedRRTstarPlanner, SORRTstarPlanner, BITstarPlanner)

each = pytest.mark.parametrize("planner", [p() for p in PLANNERS], ids=lambda p: p.name)


# Paths


@each
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


@each
def test_a_longer_run_comes_close_to_the_optimum_of_a_paper_scene(planner):
    scene = load_scene("obstacles_20")
    made = run(planner, scene, Budget(checks=8000))
    seen = Referee(scene).judge(scene.query(), made.path)
    assert seen.valid, seen.reason
    # The first path that is found may pass the obstacles on the wrong side, however simple.
    bound = 1.25 if isinstance(planner, SimplifiedPlanner) else 1.1
    assert 1.0 <= seen.length / shortest_path(scene, scene.query()).length < bound


@each
def test_an_enclosed_goal_is_exhausted_and_never_solved(planner):
    scene = scene_of([RING], (1, 5), (6, 6))
    for budget in (Budget(checks=2000), Budget(wall_s=0.05)):
        made = run(planner, scene, budget)
        assert (made.status, made.path, made.claimed_cost) == (PlanStatus.EXHAUSTED, None, None)


@each
def test_a_seam_encloses_too(planner):
    walls = [shapely.box(4, 0, 6, 5), shapely.box(4, 5, 6, 10)]
    assert run(planner, scene_of(walls, (1, 5), (9, 5)), Budget(checks=2000)).path is None


@each
@pytest.mark.parametrize(("start", "goal"), [((5, 5), (1, 1)), ((1, 1), (5, 5))])
def test_ends_inside_an_obstacle_are_infeasible_and_raise_nothing(planner, start, goal):
    query = Query("inside", np.array(start, dtype=float), np.array(goal, dtype=float))
    made = run(planner, SCENES["one box"], Budget(checks=100), query=query)
    assert (made.status, made.path) == (PlanStatus.INFEASIBLE, None)


# Anytime


@each
@pytest.mark.parametrize("budget", [Budget(checks=10_000), Budget(cpu_s=0.3)], ids=str)
def test_improvements_fall_and_the_last_is_the_path(planner, budget):
    recorder = Recorder()
    made = run(planner, SCENES["one box"], budget, recorder=recorder)
    assert made.path is not None
    costs = [i.cost for i in recorder.improvements]
    assert all(after < before for before, after in pairwise(costs))
    assert costs[-1] == pytest.approx(made.claimed_cost, rel=1e-6)
    assert all(0 < i.checks <= made.checks for i in recorder.improvements)


@each
def test_planners_that_count_iterations_say_in_which_the_best_was_found(planner):
    made = run(planner, SCENES["one box"], Budget(checks=5000))
    if isinstance(planner, WITH_ITERATIONS):
        assert 0 < made.generation_of_best <= made.generations
    else:
        assert (made.generation_of_best, made.generations) == (None, None)


# Budgets


@each
@pytest.mark.parametrize("checks", [1, 10, 1234])
def test_a_budget_of_checks_is_never_exceeded(planner, checks):
    assert run(planner, SCENES["one box"], Budget(checks=checks)).checks <= checks


@each
def test_a_budget_of_wall_time_is_kept_within_reason(planner):
    began = time.process_time()
    run(planner, load_scene("maze"), Budget(wall_s=0.2))
    # What is refused here is a planner that does not stop, and not a machine that gives it little.
    assert time.process_time() - began < 5.0


@each
def test_the_clock_of_the_run_is_the_recorders(planner):
    class Late(Recorder):
        def wall_s(self) -> float:
            return 1.0

    made = run(planner, load_scene("maze"), Budget(wall_s=0.9), recorder=Late())
    assert made.checks < 2000


@each
def test_the_first_limit_that_is_reached_ends_the_run(planner):
    assert run(planner, SCENES["one box"], Budget(wall_s=60.0, checks=500)).checks <= 500
    assert run(planner, SCENES["one box"], Budget(wall_s=0.05, checks=10**9)).checks < 10**9


@each
def test_a_budget_of_cpu_time_is_kept(planner):
    # A busy machine takes wall time from a run, but gives it no CPU time.
    recorder = Recorder()
    run(planner, load_scene("maze"), Budget(cpu_s=0.1), recorder=recorder)
    assert recorder.cpu_s() < 1.0


@each
def test_a_spent_cpu_clock_ends_the_run_at_once(planner):
    class Late(Recorder):
        def cpu_s(self) -> float:
            return 1.0

    made = run(planner, load_scene("maze"), Budget(cpu_s=0.9), recorder=Late())
    assert made.checks < 2000


@each
def test_a_search_that_goes_on_asks_exactly_as_often_as_its_budget_allows(planner):
    scene = scene_of([RING], (1, 5), (6, 6))
    made = run(planner, scene, Budget(checks=3000))
    assert made.checks == 3000
    assert made.computed_checks is None  # no answer comes from memory


@each
def test_without_a_budget_the_default_of_the_settings_ends_the_run(planner):
    short = type(planner)(planner.Settings(default_wall_s=0.05))
    assert run(short, SCENES["one box"], Budget()).checks > 0


@each
def test_generations_alone_are_refused_with_a_reason(planner):
    scene = SCENES["one box"]
    reason = refusal(planner, scene, scene.query(), Budget(generations=10))
    kept = "Give one that it keeps: checks, cpu_s, wall_s."
    assert reason == f"{planner.name} keeps no budget of generations. {kept}"
    for budget in (Budget(), Budget(checks=1), Budget(generations=10, wall_s=1.0)):
        assert refusal(planner, scene, scene.query(), budget) is None


# Randomness


@each
def test_another_seed_gives_another_path(planner):
    paths = [run(planner, SCENES["one box"], Budget(checks=4000), seed).path for seed in (1, 2)]
    assert not np.array_equal(*paths)


PROGRAM = """
import os, sys, numpy as np
from suite.plugins.discovery import load_planner
from suite.planner import Budget, Recorder
from suite.scenes.catalogue import load_scene
scene = load_scene("obstacles_20")
when, *names = sys.argv[1:]
planners = {name: load_planner(name) for name in names}
for name in names:
    if os.fork() == 0:
        break
    if os.wait()[1] != 0:
        sys.exit(1)
else:
    sys.exit(0)
planner = planners[name]()
if when == "after another run":
    planner.warm_up()
recorder = Recorder()
rng = np.random.default_rng(7)
plan = planner.plan(scene, scene.query(), Budget(checks=5000), rng, recorder)
print(name, plan.path.tobytes().hex(), [(i.cost, i.checks) for i in recorder.improvements])
"""


@pytest.fixture(scope="module")
def told():
    """What each planner's run gave in a process of its own that began with it, and in one that had
    another run before: copies of two processes, which have different addresses.
    """

    def ask(when):
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM, when, *(planner.name for planner in PLANNERS)],
            capture_output=True, text=True, check=True, cwd=Path(__file__).parents[3],
        )  # fmt: skip
        assert done.stderr == ""  # OMPL's log and nanobind's reports of leaks stay away
        return dict(line.split(" ", 1) for line in done.stdout.splitlines())

    return ask("first of all"), ask("after another run")


@each
def test_same_seed_and_checks_give_the_same_path_in_another_process(planner, told):
    first, second = (each_of[planner.name] for each_of in told)
    assert first == second
    assert len(first) > 100


@each
def test_ten_runs_in_one_process_are_the_same(planner):
    scene = load_scene("obstacles_20")
    paths = [run(planner, scene, Budget(checks=3000), seed=5).path.tobytes() for _ in range(10)]
    assert len(set(paths)) == 1


# Memory


@each
@pytest.mark.parametrize("checks", [80, pytest.param(3000, marks=pytest.mark.slow)])
def test_nothing_of_a_run_stays_in_memory(planner, checks, monkeypatch):
    alive = []
    set_up = Problem.set_up

    def remember(problem):
        alive.extend((weakref.ref(problem), weakref.ref(problem.collision)))
        set_up(problem)

    monkeypatch.setattr(Problem, "set_up", remember)
    run(planner, load_scene("obstacles_20"), Budget(checks=checks))
    gc.collect()
    assert alive
    assert [reference() for reference in alive] == [None] * len(alive)
