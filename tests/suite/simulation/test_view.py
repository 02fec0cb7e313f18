"""What a picture of a moment shows: what is there then, what the robot knows, where it goes."""

import numpy as np
import pytest
from shapely.geometry import box

from baselines.visibility_graph import VisibilityGraphPlanner
from suite.scenes.dynamics import Detection, Dynamics, Removal, constant_speed
from suite.scenes.exact import path_length
from suite.scenes.scene import Obstacle, make_scene
from suite.simulation.run import Simulation, simulate
from suite.simulation.settings import Charge, WorldSettings
from suite.simulation.view import Sight, View, update_times, view_at

WORLD = WorldSettings(2.0, 1.0, 4.0, 20.0, charge=Charge.ZERO)
DOOR = Obstacle("door", box(8, 0, 12, 5), Dynamics(constant_speed((0, 0.5), 0, 4)))
HIDDEN = Obstacle("hidden", box(13, 9, 14, 20), Dynamics(detection=Detection()))
UNSEEN = Obstacle("unseen", box(2, 0, 3, 1), Dynamics(detection=Detection(0.5)))
GONE = Obstacle("gone", box(1, 17, 3, 19), Dynamics(removal=Removal(time=3.0)))
LATE = Obstacle("late", box(4, 17, 6, 19), Dynamics(appears=3.0))


def run_among(*obstacles: Obstacle, world: WorldSettings = WORLD) -> Simulation:
    scene = make_scene("drawn", box(0, 0, 20, 20), obstacles, ((1, 10), (19, 10)))
    replanner = VisibilityGraphPlanner().replanner(np.random.default_rng(0))
    return simulate(scene, scene.query(), replanner, world)


@pytest.fixture(scope="module")
def run() -> Simulation:
    return run_among(Obstacle("wall", box(8, 14, 12, 20)), DOOR, HIDDEN, UNSEEN, GONE, LATE)


def sights(view: View) -> dict[str, Sight]:
    return {seen.name: seen.sight for seen in view.obstacles}


def test_what_moves_is_where_it_is_at_that_moment(run):
    places = {
        time: next(seen.polygon for seen in view_at(run, time).obstacles if seen.name == "door")
        for time in (0.0, 2.5, 9.0)
    }
    assert [polygon.bounds[1] for polygon in places.values()] == [0.0, 1.25, 2.0]
    assert sights(view_at(run, 9.0))["door"] is Sight.MOVING


def test_what_is_removed_or_not_there_yet_is_not_shown(run):
    assert {"gone", "late"} & sights(view_at(run, 2.9)).keys() == {"gone"}
    assert {"gone", "late"} & sights(view_at(run, 3.0)).keys() == {"late"}


def test_an_obstacle_is_undetected_until_the_update_that_detects_it(run):
    seen_at = run.detected["hidden"]
    assert seen_at in update_times(run)
    assert sights(view_at(run, seen_at - 0.01))["hidden"] is Sight.UNDETECTED
    assert sights(view_at(run, seen_at))["hidden"] is Sight.STILL
    assert sights(view_at(run, run.trajectory.end))["unseen"] is Sight.UNDETECTED


def test_way_so_far_and_path_ahead_meet_in_the_robot_at_every_moment(run):
    for time in np.linspace(0.0, run.trajectory.end, 97)[:-1]:
        view = view_at(run, float(time))
        np.testing.assert_allclose(view.robot, run.trajectory.at(time)[0], atol=1e-12)
        np.testing.assert_array_equal(view.path[0], view.robot)
        np.testing.assert_array_equal(view.path[-1], run.query.goal)


def test_the_path_ahead_shrinks_by_what_the_robot_drives():
    run = run_among()
    lengths = [path_length(view_at(run, time).path) for time in (0.0, 0.5, 1.0, 4.25)]
    np.testing.assert_allclose(lengths, [18.0, 17.0, 16.0, 9.5], atol=1e-6)


def test_at_the_goal_nothing_lies_ahead(run):
    last = view_at(run, run.trajectory.end)
    assert last.path is None
    np.testing.assert_array_equal(last.robot, run.query.goal)


def test_a_robot_that_has_to_wait_has_no_path():
    shut = Obstacle("gate", box(9, 0, 11, 20), Dynamics(removal=Removal(time=2.5)))
    run = run_among(shut)
    assert [view_at(run, time).path is None for time in (0.0, 1.5, 2.0, 3.0)] == [
        True, True, True, False,
    ]  # fmt: skip


def test_at_an_update_the_path_is_the_answer_even_if_it_comes_a_moment_later():
    run = run_among(DOOR, world=WorldSettings(2.0, 1.0, 4.0, 20.0, charge=Charge.MEASURED))
    assert run.courses[0].time > 0.0
    np.testing.assert_array_equal(view_at(run, 0.0).path, run.replans[0].path)


def test_the_robot_looks_at_updates_and_not_at_its_arrival():
    assert update_times(run_among()) == [float(second) for second in range(9)]
