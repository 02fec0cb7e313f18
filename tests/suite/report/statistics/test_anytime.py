import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suite.planner import Improvement, PlanStatus
from suite.report.statistics.anytime import (
    cost_at,
    final_gaps,
    first_within,
    gap_at,
    gaps,
    groups_of,
    only,
)
from tests.suite.report.measured_rows import measured, steps

TWO = [(2.0, 150.0), (8.0, 104.0)]


def test_a_run_costs_what_its_last_improvement_cost():
    found = steps(measured("a", 0, TWO))
    at = {ms: cost_at(found, "wall_s", ms / 1e3)[0] for ms in (1, 2, 5, 8, 900)}
    assert at == {1: np.inf, 2: 150.0, 5: 150.0, 8: 104.0, 900: 104.0}
    assert gap_at(found, "wall_s", 0.9) == pytest.approx([0.04])


@pytest.mark.parametrize(
    ("clock", "early", "late"),
    [("wall_s", 0.002, 0.008), ("cpu_s", 0.001, 0.004), ("generation", 2, 8), ("checks", 20, 80)],
)
def test_every_clock_says_when_a_target_was_reached(clock, early, late):
    found = steps(measured("a", 0, TWO), measured("b", 0, []))
    assert first_within(found, clock, 0.5).tolist() == [early, np.inf]
    assert first_within(found, clock, 0.05).tolist() == [late, np.inf]
    assert first_within(found, clock, 0.01).tolist() == [np.inf, np.inf]


def test_a_run_without_an_accepted_path_has_no_steps_whatever_it_reported():
    reported = measured("a", 0, TWO, cost=None, status=PlanStatus.INVALID)
    found = steps(reported, measured("b", 0, []))
    assert np.isinf(cost_at(found, "wall_s", 1.0)).all()
    assert np.isinf(final_gaps(found)).all()


def test_no_report_counts_for_less_than_the_referee_measured():
    found = steps(measured("a", 0, [(2.0, 90.0)], cost=110.0))
    assert cost_at(found, "wall_s", 1.0).tolist() == [110.0]
    assert first_within(found, "wall_s", 0.05).tolist() == [np.inf]


def test_a_run_that_reported_nothing_has_its_path_when_it_ends():
    found = steps(measured("a", 0, [(2.0, 104.0)], improvements=()))
    assert first_within(found, "wall_s", 0.05).tolist() == [0.05]
    assert first_within(found, "checks", 0.05).tolist() == [500.0]


def test_a_run_that_ended_with_a_better_path_than_reported_has_it_at_the_end():
    found = steps(measured("a", 0, TWO, cost=101.0))
    assert cost_at(found, "wall_s", 0.049).tolist() == [104.0]
    assert cost_at(found, "wall_s", 0.05).tolist() == [101.0]


def test_who_does_not_count_is_neither_early_nor_late():
    silent = (Improvement(0.002, 0.002, 104.0, None, 5),)
    found = steps(measured("a", 0, TWO, improvements=silent, generations=None))
    assert np.isnan(first_within(found, "generation", 0.05)).all()
    assert np.isnan(cost_at(found, "generation", 10)).all()
    assert first_within(found, "wall_s", 0.05).tolist() == [0.002]


def test_a_run_that_died_is_judged_by_the_optimum_that_its_neighbours_know():
    died = measured("b", 0, [], status=PlanStatus.CRASHED, optimum=None)
    assert steps(measured("a", 0, TWO), died).optimum.tolist() == [100.0, 100.0]


def test_without_an_optimum_there_is_no_gap_and_no_target():
    found = steps(measured("a", 0, TWO, optimum=None))
    assert np.isnan(final_gaps(found)).all()
    assert np.isnan(first_within(found, "wall_s", 0.05)).all()
    assert cost_at(found, "wall_s", 1.0).tolist() == [104.0]


def test_start_and_goal_may_be_one_place():
    assert gaps(np.array([0.0, 1.0]), np.zeros(2)).tolist() == [0.0, np.inf]
    found = steps(measured("a", 0, [(1.0, 0.0)], optimum=0.0, gap=0.0))
    assert first_within(found, "wall_s", 0.01).tolist() == [0.001]


def test_rounding_is_no_gap():
    assert gaps(np.array([100.0 + 1e-12, 100.0 - 1e-12]), np.full(2, 100.0)).tolist() == [0.0, 0.0]


def test_events_of_other_runs_are_left_out_and_order_does_not_matter():
    mine, other = measured("a", 0, TWO), measured("b", 1, [(1.0, 100.0)])
    both = steps(other, mine)
    some = only(both, (both.runs["variant"] == "a").to_numpy())
    assert cost_at(some, "wall_s", 0.003).tolist() == [150.0]
    assert {name: rows.tolist() for name, rows in groups_of(both, np.ones(2, bool)).items()} == {
        ("zigzag", "b"): [0], ("zigzag", "a"): [1],
    }  # fmt: skip


@st.composite
def improvements(draw):
    """Times that rise, ms, and costs that fall, metres."""
    times = draw(st.lists(st.integers(1, 40), unique=True, max_size=6))
    costs = draw(st.lists(st.integers(100, 160), unique=True, min_size=6, max_size=6))
    falling = sorted(costs, reverse=True)
    return [(float(ms), float(cost)) for ms, cost in zip(sorted(times), falling, strict=False)]


@settings(max_examples=20, deadline=None)
@given(st.lists(improvements(), min_size=1, max_size=4), st.sampled_from([0.0, 0.05, 0.2, 0.5]))
def test_a_target_is_reached_by_then_if_and_only_if_the_gap_at_that_time_is_as_small(runs, target):
    found = steps(*(measured("a", i, reports) for i, reports in enumerate(runs)))
    first = first_within(found, "wall_s", target)
    for ms in (1, 5, 20, 40):
        near = gap_at(found, "wall_s", ms / 1e3) <= target + 1e-9
        assert (near == (first <= ms / 1e3)).all()
