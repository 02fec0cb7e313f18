import pytest

from suite.planner import Budget
from tests.suite.harness.records import make_cell


@pytest.mark.parametrize(
    "change",
    [
        {"scene": "other"},
        {"scene_hash": "4567"},
        {"query": "other"},
        {"variant": "other"},
        {"planner": "other"},
        {"version": "0.2.0"},
        {"settings": {"population_size": 40}},
        {"budget": Budget(generations=101)},
        {"budget": Budget(checks=100)},
        {"budget": Budget(generations=100, cpu_s=1.0)},
        {"seed": 1},
    ],
)
def test_whatever_the_outcome_depends_on_changes_the_key(change):
    assert make_cell(**change).key != make_cell().key


@pytest.mark.parametrize(
    "change", [{"position": 7}, {"scene_source": "/elsewhere/zigzag.geojson"}, {}]
)
def test_whatever_the_outcome_does_not_depend_on_leaves_the_key(change):
    assert make_cell(**change).key == make_cell().key


def test_the_order_of_settings_does_not_matter():
    one = make_cell(settings={"a": 1, "b": 2})
    other = make_cell(settings={"b": 2, "a": 1})
    assert one.key == other.key


def test_keys_of_rows_without_a_budget_of_cpu_time_are_what_they_were_before_there_was_one():
    assert make_cell().key == "f0da6b4e68b5ddd3eeb35ad784ce1bbe"
    timed = make_cell(budget=Budget(wall_s=2, checks=5))
    assert timed.key == "8917e6f9ea81eb5a4836311ce1bc455e"


@pytest.mark.parametrize(
    ("budget", "time", "load"),
    [
        (Budget(wall_s=1.0), True, True),
        (Budget(cpu_s=1.0), True, False),
        (Budget(checks=9), False, False),
    ],
)
def test_cpu_time_counts_as_time_and_other_programs_do_not_take_it_away(budget, time, load):
    cell = make_cell(budget=budget)
    assert (cell.time_counts, cell.load_counts) == (time, load)
