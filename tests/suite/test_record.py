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
