"""A robot on its way: how far it gets, where it stands, and that slanted walls don't stop it."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from suite.geometry.coordinates import coordinates_of
from suite.geometry.kernels import first_collision, segment_enters
from suite.scenes.scene import make_scene
from suite.simulation.hits import hits
from suite.simulation.robot import Robot
from tests.strategies import lattice_polygons

NEAR = coordinates_of((0.0, 0.0, 10.0, 10.0))
CORNER = np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 4.0)])


def on(path: np.ndarray, speed: float = 2.0) -> Robot:
    robot = Robot(path[0], speed, NEAR)
    robot.path = path
    return robot


def test_it_follows_its_path_around_corners_at_its_speed():
    robot = on(CORNER)
    assert [p.tolist() for p in robot.drive(2.5)] == [[3, 0], [3, 2]]
    assert (robot.time, robot.place.tolist()) == (2.5, [3, 2])
    assert robot.path is not None
    assert robot.path.tolist() == [[3, 2], [3, 4]]
    assert robot.trajectory.times.tolist() == [0.0, 1.5, 2.5]


def test_it_stops_at_the_end_of_its_path():
    robot = on(CORNER)
    robot.drive(9.0)
    assert robot.has_arrived
    assert (robot.time, robot.place.tolist()) == (3.5, [3, 4])


def test_what_lies_ahead_is_what_it_then_drives():
    robot = on(CORNER)
    ahead = robot.ahead(2.5)
    assert ahead is not None
    assert ahead.tolist() == [[0, 0], [3, 0], [3, 2]]
    assert robot.time == 0.0


def test_without_a_path_it_stays():
    robot = Robot(CORNER[0], 2.0, NEAR)
    assert robot.drive(3.0) == []
    assert (robot.time, robot.place.tolist()) == (3.0, [0, 0])
    assert robot.ahead(1.0) is None


def test_in_an_obstacle_it_finds_no_place():
    scene = make_scene("s", shapely.box(0, 0, 9, 9), [shapely.box(2, 2, 4, 4)], ((0, 0), (9, 9)))
    robot = Robot(np.array([3.0, 3.0]), 1.0, NEAR)
    assert not robot.settle(scene)
    assert robot.place.tolist() == [3, 3]


@pytest.mark.parametrize("depth", [0.5 * NEAR.hit_depth, 0.9 * NEAR.hit_depth])
def test_from_what_is_less_deep_than_a_hit_it_finds_a_way_out(depth):
    scene = make_scene("s", shapely.box(0, 0, 9, 9), [shapely.box(2, 2, 4, 4)], ((0, 0), (9, 9)))
    robot = Robot(np.array([2.0 + depth, 3.0]), 1.0, NEAR)
    assert robot.settle(scene)
    assert not segment_enters(*robot.place, *robot.place, scene.arrays)


@settings(max_examples=200)
@given(
    lattice_polygons(), st.integers(0, 3), st.lists(st.floats(0.01, 0.9), min_size=1, max_size=4)
)
def test_a_robot_that_stops_along_a_wall_can_go_on_and_was_not_hit(polygon, edge, stops):
    shifted = Polygon(shapely.get_coordinates(polygon) + 1.0)
    corners = shapely.get_coordinates(shifted)
    edge %= len(corners) - 1
    scene = make_scene("s", shapely.box(0, 0, 9, 9), [shifted], ((0, 0), (9, 9)))
    path = corners[edge : edge + 2]
    robot = on(path, 1.0)
    length = float(np.hypot(*(path[1] - path[0])))
    for share in sorted(stops):
        robot.drive(share * length)
        assert robot.settle(scene)
        x, y = robot.place.tolist()
        assert not segment_enters(x, y, x, y, scene.arrays)
        assert robot.path is not None
        assert first_collision(robot.path, scene.arrays) < 0
    robot.drive(2.0 * length)
    assert robot.place.tolist() == path[1].tolist()
    assert hits(scene, robot.trajectory) == []
