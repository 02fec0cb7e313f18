"""How much of a generation fits into the time that is left (:mod:`kbga.deadline`)."""

import time

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kbga.algorithm import KBGA
from kbga.deadline import PAIR, Deadline
from kbga.plugin import KBGAPlanner, KBGAPlusPlanner
from kbga.settings import KBGASettings
from suite.planner import Budget, Recorder
from suite.scenes.catalogue import load_scene


class Clock:
    """A clock that goes on by so much with each child."""

    def __init__(self, budget_s: float, child_s: float) -> None:
        self.left_s = budget_s
        self.child_s = child_s

    def left(self) -> float:
        return self.left_s

    def make(self, children: int) -> None:
        self.left_s -= children * self.child_s


@given(budget_s=st.floats(0.001, 10.0), child_s=st.floats(1e-6, 1e-3))
def test_the_time_is_exceeded_by_one_pair_at_most_where_all_children_take_the_same(
    budget_s, child_s
):
    clock = Clock(budget_s, child_s)
    deadline, total, looks = Deadline(clock.left), 0, 0
    while children := deadline.children_after(total):
        clock.make(children)
        total += children
        looks += 1
    assert clock.left_s > -1.001 * PAIR * child_s
    # Half of what is left each time, and at the end a pair each time.
    assert looks <= 8 + np.log2(budget_s / child_s + 1.0)


def test_there_is_no_time_for_a_child_when_the_time_is_over():
    assert Deadline(lambda: 0.0).children_after(0) == 0
    assert Deadline(lambda: -1.0).children_after(0) == 0


def test_children_that_take_no_time_that_a_clock_can_tell_do_not_end_it():
    deadline = Deadline(lambda: 1.0)
    assert deadline.children_after(0) == PAIR
    assert deadline.children_after(PAIR) > PAIR


def test_a_generation_stays_half_done_when_the_time_is_over():
    ga = KBGA(load_scene("maze"), rng=1)
    before = [path.tolist() for path in ga.paths()]
    looks = iter([1.0, 1.0, 0.5, 0.0, 0.0])  # run's own is the first
    ga.run(left=lambda: next(looks))
    assert ga.generation == 1
    assert [path.tolist() for path in ga.paths()] == before


def test_watching_the_clock_changes_no_path():
    settings = KBGASettings(max_generations=20)
    watched, free = (KBGA(load_scene("zigzag"), None, settings, 3) for _ in range(2))
    end = time.perf_counter() + 3600.0
    watched.run(left=lambda: end - time.perf_counter())
    free.run()
    assert watched.checks == free.checks
    assert [p.tolist() for p in watched.paths()] == [p.tolist() for p in free.paths()]


@pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="interpreted, the first population alone takes longer"
)
@pytest.mark.parametrize("planner", [KBGAPlanner, KBGAPlusPlanner])
def test_a_budget_of_time_ends_a_run_within_a_generation(planner):
    scene = load_scene("scattered_1000")
    run = planner(planner.Settings(stagnation=10**6, max_generations=10**6))
    run.warm_up()
    over = []
    for seed in range(9):
        recorder = Recorder()
        plan = run.plan(
            scene, scene.query(), Budget(cpu_s=0.2), np.random.default_rng(seed), recorder
        )
        over.append(recorder.cpu_s() / 0.2 - 1.0)
        assert plan.generations > 1
    # Processor time, and of nine runs the median: other processes may hold one up.
    assert np.median(over) <= 0.02
