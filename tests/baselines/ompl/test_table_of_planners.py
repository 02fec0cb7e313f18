"""The table in the package's docstring says what there is."""

import re

import pytest
from ompl import base as ob
from ompl import geometric as og

import baselines.ompl
from suite.plugins.discovery import load_planner, planner_names

ROWS = re.findall(
    r"^(ompl-\w+|\(left out\)) +(\w+) *(anytime|one-shot)?", baselines.ompl.__doc__, flags=re.M
)


def test_every_planner_of_the_wheel_is_in_the_table():
    planners = {
        name
        for name, value in vars(og).items()
        if isinstance(value, type) and issubclass(value, ob.Planner)
    }
    assert {wheel for _, wheel, _ in ROWS} == planners


def test_every_plugin_is_in_the_table():
    plugins = [name for name, _, _ in ROWS if name.startswith("ompl-")]
    assert sorted(plugins) == [name for name in planner_names() if name.startswith("ompl-")]


@pytest.mark.parametrize("row", [row for row in ROWS if row[2]], ids=lambda row: row[0])
def test_a_row_says_what_the_planner_says(row):
    name, wheel, kind = row
    planner = load_planner(name)
    assert planner.ompl_class is getattr(og, wheel)
    assert planner.abilities.anytime == (kind == "anytime")


def test_what_is_said_to_be_missing_is_missing():
    listed = re.search(r"Not bound in the wheel [\d.]+:(.*?)\.\n", baselines.ompl.__doc__, re.S)
    names = [name.strip() for name in listed[1].split(",")]
    assert len(names) > 10
    for name in names:
        assert not hasattr(og, name.replace("*", "star").replace("#", "sharp"))


def test_a_validator_is_not_asked_how_far_a_colliding_motion_is_free():
    # Why KPIECE stays out. When this fails, the wheel has learnt it: add the three as rows.
    assert ob.MotionValidator.checkMotion.__doc__.count("checkMotion(") == 1
