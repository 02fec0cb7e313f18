"""Every planner plans anywhere on earth and in rooms of any size, or says that it can't."""

import pytest

from suite.plugins.discovery import load_planner, planner_names
from suite.scenes.scene import Scene
from tests.perf.sites import planned, sample


@pytest.fixture(scope="module")
def scenes() -> list[Scene]:
    return sample()


@pytest.mark.parametrize("name", planner_names())
def test_a_planner_holds_at_each_place_and_in_rooms_of_each_size(name, scenes):
    made = planned(load_planner(name)(), scenes)
    assert made.holds, made
    assert made.statuses["solved"] > len(scenes) / 2
