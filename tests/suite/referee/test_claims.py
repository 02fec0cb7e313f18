import numpy as np
import pytest

from suite.errors import ContractError
from suite.planner import Improvement, Recorder
from suite.referee.claims import as_count, as_measure, disorder, improvements, trace


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
