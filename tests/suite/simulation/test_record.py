"""A simulation that is written down and read back is the same simulation."""

import json

import numpy as np
import pytest
from shapely.geometry import box

from baselines.visibility_graph import VisibilityGraphPlanner
from suite.scenes.dynamics import Detection, Dynamics, constant_speed
from suite.scenes.scene import Obstacle, make_scene
from suite.simulation.record import as_data, from_data
from suite.simulation.run import simulate
from suite.simulation.settings import Charge, WorldSettings
from suite.simulation.view import view_at

DOOR = Obstacle("door", box(8, 0, 12, 5), Dynamics(constant_speed((0, 0.5), 0, 4)))
HIDDEN = Obstacle("hidden", box(13, 9, 14, 20), Dynamics(detection=Detection()))
RAM = Obstacle("ram", box(0, 12, 5, 14), Dynamics(constant_speed((0, -4), 0, 1)))
SCENE = make_scene(
    "hall",
    box(0, 0, 20, 20),
    [DOOR, HIDDEN, RAM],
    ((1, 10), (19, 10)),
    properties={"gates": {"low": [[10, 0], [10, 10.5]]}},
)
WORLD = WorldSettings(2.0, 1.0, 4.0, 20.0, obstacle_speed_factor=1.5, charge=Charge.ZERO)


@pytest.fixture(scope="module")
def run():
    replanner = VisibilityGraphPlanner().replanner(np.random.default_rng(0))
    return simulate(SCENE, SCENE.query(), replanner, WORLD)


def test_it_comes_back_from_json_bit_for_bit(run):
    data = as_data(run)
    again = from_data(SCENE, json.loads(json.dumps(data)))
    assert as_data(again) == data
    assert data["hits"]
    assert data["gates"]
    assert data["detected"]
    assert again.settings == run.settings
    assert again.trajectory.xy.tolist() == run.trajectory.xy.tolist()


@pytest.mark.parametrize("time", [0.0, 0.4, 3.0, 7.7])
def test_pictures_of_it_are_the_same(run, time):
    again = from_data(SCENE, as_data(run))
    for view in zip(view_at(run, time).obstacles, view_at(again, time).obstacles, strict=True):
        assert view[0] == view[1]
    assert np.array_equal(view_at(run, time).trail, view_at(again, time).trail)
