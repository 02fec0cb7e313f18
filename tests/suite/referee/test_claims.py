import numpy as np
import pytest

from suite.errors import ContractError
from suite.planner import Improvement, Plan, PlanStatus, Recorder
from suite.referee.claims import as_count, as_measure, disorder, improvements, plain_plan, trace


def reports(*costs_and_times):
    return [Improvement(time, time, cost, None, None) for cost, time in costs_and_times]


@pytest.mark.parametrize("value", [np.int64(3), np.float32(3.0), 3.0])
def test_a_count_becomes_a_whole_number_of_pythons_own(value):
    assert as_count(value, "checks") == 3
    assert type(as_count(value, "checks")) is int


@pytest.mark.parametrize("value", [-1, float("nan"), float("inf"), 2**63, "3", "many", [3], 1j])
def test_what_is_no_count_is_refused_by_name(value):
    with pytest.raises(ContractError, match=r"checks is .* It must be a whole number, 0 or more"):
        as_count(value, "checks")


def test_measures_stay_whole_or_become_floats():
    kept = [as_measure(value, "best") for value in (np.int32(4), np.float32(0.5), 2.0)]
    assert kept == [4, 0.5, 2.0]
    assert [type(value) for value in kept] == [int, float, float]


def test_a_measure_that_is_no_number_is_refused_by_name():
    recorder = Recorder()
    recorder.describe_generation({"phase": "repair"})
    with pytest.raises(ContractError, match="the measure 'phase' is 'repair'"):
        trace(recorder)


def test_counts_of_reports_come_out_as_pythons_own():
    recorder = Recorder()
    recorder.improved(np.float32(2.5), generation=np.int64(1), checks=np.int32(9))
    (report,) = improvements(recorder, recorder.wall_s())
    assert [type(v) for v in (report.cost, report.generation, report.checks)] == [float, int, int]


def test_what_is_no_improvement_is_refused():
    recorder = Recorder()
    recorder.improvements.append((1.0, 2.0))
    with pytest.raises(ContractError, match="holds a tuple"):
        improvements(recorder, 1.0)


@pytest.mark.parametrize(
    ("listed", "wrong"),
    [
        (reports((3.0, 0.1), (3.0, 0.2)), "3 m after 3 m"),
        (reports((3.0, 0.2), (2.0, 0.1)), "0.1 s after one of 0.2 s"),
        (reports((3.0, -0.1)), "a time of -0.1 s"),
        (reports((3.0, 1.1)), "a time of 1.1 s in a run of 1 s"),
        (reports((float("nan"), 0.1)), "a cost of nan m"),
        (reports((float("inf"), 0.1)), "a cost of inf m"),
    ],
)
def test_costs_fall_and_times_rise_within_the_run(listed, wrong):
    assert wrong in disorder(listed, 1.0)


def test_reports_in_order_are_left_in_peace():
    assert disorder(reports((3.0, 0.1), (2.0, 0.1), (1.5, 0.9)), 1.0) is None


def test_a_plan_comes_out_in_numbers_of_pythons_own_with_its_path_as_it_was():
    path = np.zeros((2, 2), dtype=np.float32)
    plan = plain_plan(
        Plan("solved", path, np.float32(0.5), np.int64(7), 3.0, np.int32(9), {1: np.int8(4)}, 2)
    )
    assert plan.path is path
    assert plan.status is PlanStatus.SOLVED
    counts = (plan.generations, plan.generation_of_best, plan.checks, plan.computed_checks)
    assert counts == (7, 3, 9, 2)
    assert {type(count) for count in counts} == {int}
    assert (plan.claimed_cost, plan.details) == (0.5, {"1": 4.0})
    assert {type(plan.claimed_cost), type(plan.details["1"])} == {float}


@pytest.mark.parametrize(
    ("returned", "wrong"),
    [
        (None, "plan returned NoneType. It must return a Plan."),
        (
            Plan(PlanStatus.CRASHED),
            "plan returned the status .*crashed.*. It may claim solved, infeasible, exhausted.",
        ),
        (Plan("done"), "plan returned the status 'done'"),
        (Plan(PlanStatus.SOLVED), "plan says 'solved' and returns no path."),
        (Plan(PlanStatus.EXHAUSTED, generations=-1), "generations of the plan is -1"),
        (Plan(PlanStatus.EXHAUSTED, generation_of_best="3"), "generation_of_best of the plan is"),
        (Plan(PlanStatus.EXHAUSTED, computed_checks=3), "computed_checks of the plan are 3"),
        (Plan(PlanStatus.EXHAUSTED, claimed_cost="3.5"), "claimed_cost of the plan is '3.5'"),
        (Plan(PlanStatus.EXHAUSTED, details=None), "details of the plan are a NoneType"),
        (Plan(PlanStatus.EXHAUSTED, details={"mood": "good"}), "the detail 'mood' of the plan is"),
    ],
)
def test_what_is_no_well_formed_plan_is_refused_with_what_is_wrong(returned, wrong):
    with pytest.raises(ContractError, match=wrong):
        plain_plan(returned)


def test_a_plan_says_why_there_is_no_path_and_nothing_of_one_that_there_is():
    why = "no way: the goal is walled in."
    assert plain_plan(Plan(PlanStatus.INFEASIBLE, reason=why)).reason == why
    assert plain_plan(Plan(PlanStatus.EXHAUSTED)).reason is None
    solved = Plan(PlanStatus.SOLVED, np.zeros((2, 2)), reason=why)
    assert plain_plan(solved).reason is None


def test_a_reason_that_is_no_sentence_is_refused():
    with pytest.raises(ContractError, match=r"the reason of the plan is a int\. It must be"):
        plain_plan(Plan(PlanStatus.EXHAUSTED, reason=3))
