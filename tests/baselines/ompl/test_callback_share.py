import numpy as np
import pytest

from baselines.ompl import adapter, collision, watched
from baselines.ompl.callbacks import way_s
from baselines.ompl.collision import CHECKS_BETWEEN_PAUSES, ExactCollision
from baselines.ompl.oneshot import FMTPlanner, RRTConnectPlanner
from baselines.ompl.roadmap import PRMPlanner, PRMstarPlanner
from baselines.ompl.watched import RRTstarPlanner
from suite.planner import Budget
from suite.scenes.catalogue import load_scene
from tests.baselines.ompl.laboratory import SCENES, run


def mean_s(planner, seed: int, monkeypatch, between: int) -> float:
    """Mean time of an answer in a run, where one answer in so many is timed."""
    kept = []

    def make(*args):
        kept.append(ExactCollision(*args))
        return kept[0]

    monkeypatch.setattr(adapter, "ExactCollision", make)
    monkeypatch.setattr(collision, "CHECKS_BETWEEN_PAUSES", between)
    run(planner, load_scene("clustered"), Budget(checks=6000), seed)
    return kept[0].mean_s()


@pytest.mark.parametrize(
    "planner",
    [p() for p in (RRTConnectPlanner, FMTPlanner, PRMstarPlanner, RRTstarPlanner)],
    ids=lambda p: p.name,
)
def test_the_sample_agrees_with_the_time_of_every_answer(planner, monkeypatch):
    # Counted runs: both ask the same questions.
    ratios = [
        mean_s(planner, seed, monkeypatch, CHECKS_BETWEEN_PAUSES)
        / mean_s(planner, seed, monkeypatch, 1)
        for seed in range(5)
    ]
    assert 0.6 < np.median(ratios) < 1.7


@pytest.fixture
def slow_kernel(monkeypatch):
    """A clock that only the kernel moves, by 500 ns a check; OMPL itself takes no time at all."""
    clock = {"ns": 0}

    def kernel(*args):
        clock["ns"] += 500
        return real(*args)

    real = collision.segment_enters_tables
    monkeypatch.setattr(collision, "segment_enters_tables", kernel)
    monkeypatch.setattr(collision, "perf_counter_ns", lambda: clock["ns"])
    monkeypatch.setattr(adapter.time, "perf_counter", lambda: clock["ns"] * 1e-9)
    monkeypatch.setattr(adapter, "way_s", lambda: 0.0)
    return clock


def share_of_connect() -> tuple[float, int]:
    made = run(RRTConnectPlanner(), SCENES["one box"], Budget(checks=10_000))
    return made.details["callback_share"], made.checks


def test_the_share_is_the_time_of_an_answer_times_their_number(slow_kernel):
    share, checks = share_of_connect()
    uncounted = slow_kernel["ns"] / 500 - checks
    assert share == pytest.approx(checks / (checks + uncounted), rel=1e-6)


def test_the_way_into_python_and_back_counts_with_each_answer(slow_kernel, monkeypatch):
    without, _ = share_of_connect()
    monkeypatch.setattr(adapter, "way_s", lambda: 500e-9)  # as long as the kernel
    assert share_of_connect()[0] == pytest.approx(2 * without, rel=1e-6)


def test_reading_the_best_cost_counts(slow_kernel, monkeypatch):
    def look(watch):
        slow_kernel["ns"] += 10_000
        real(watch)

    real = watched.Watch.look
    monkeypatch.setattr(watched.Watch, "look", look)
    share = run(RRTstarPlanner(), SCENES["one box"], Budget(checks=5000)).details["callback_share"]
    assert share > 0.99  # nothing else takes time here


def test_the_samples_that_prm_draws_in_python_count_with_the_way(slow_kernel, monkeypatch):
    monkeypatch.setattr(adapter, "way_s", lambda: 500e-9)
    made = run(PRMPlanner(), SCENES["one box"], Budget(checks=5000))
    assert made.details["callback_share"] > 2.01


def test_the_way_into_python_and_back_takes_a_fraction_of_a_microsecond():
    assert 1e-8 < way_s() < 1e-5  # generous: the machine may be busy


@pytest.mark.parametrize("checks", [2, 50, 5000])
def test_every_row_of_two_checks_or_more_has_a_share(checks):
    made = run(RRTstarPlanner(), SCENES["one box"], Budget(checks=checks))
    assert 0.0 < made.details["callback_share"] < 1.0


def test_a_row_of_one_check_has_none():
    made = run(RRTstarPlanner(), SCENES["one box"], Budget(checks=1))
    assert "callback_share" not in made.details
