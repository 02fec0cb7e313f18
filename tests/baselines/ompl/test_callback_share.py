import numpy as np
import pytest

from baselines.ompl import adapter, collision
from baselines.ompl.collision import CHECKS_BETWEEN_SAMPLES, ExactCollision
from baselines.ompl.oneshot import FMTPlanner, RRTConnectPlanner
from baselines.ompl.roadmap import PRMstarPlanner
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
    monkeypatch.setattr(collision, "CHECKS_BETWEEN_SAMPLES", between)
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
        mean_s(planner, seed, monkeypatch, CHECKS_BETWEEN_SAMPLES)
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


def test_the_share_is_the_time_of_an_answer_times_their_number(slow_kernel):
    made = run(RRTConnectPlanner(), SCENES["one box"], Budget(checks=10_000))
    ends = 2  # checked before the run, uncounted
    share = made.details["callback_share"]
    assert share == pytest.approx(made.checks / (made.checks + ends), rel=1e-6)


@pytest.mark.parametrize("checks", [2, 50, 5000])
def test_every_row_of_two_checks_or_more_has_a_share(checks):
    made = run(RRTstarPlanner(), SCENES["one box"], Budget(checks=checks))
    assert 0.0 < made.details["callback_share"] < 1.0


def test_a_row_of_one_check_has_none():
    made = run(RRTstarPlanner(), SCENES["one box"], Budget(checks=1))
    assert "callback_share" not in made.details
