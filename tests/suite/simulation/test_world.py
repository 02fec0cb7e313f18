"""What the robot knows at each update: where it looks, what it remembers, what its coming opens."""

import pytest
from shapely.geometry import box

from suite.errors import SceneError
from suite.scenes.dynamics import Detection, Dynamics, Removal, constant_speed
from suite.scenes.scene import Obstacle, Scene, make_scene
from suite.simulation.settings import Charge, WorldSettings, world_settings
from suite.simulation.trajectory import make_trajectory
from suite.simulation.world import World

ROOM = box(0, 0, 20, 20)
SLIDES = Obstacle("slides", box(0, 4, 2, 6), Dynamics(constant_speed((1.0, 0.0), 0.0, 15.0)))
HIDES = Obstacle("hides", box(10, 8, 12, 12), Dynamics(detection=Detection()))
NEAR = Obstacle("near", box(10, 8, 12, 12), Dynamics(detection=Detection(2.0)))
OPENS = Obstacle("opens", box(10, 8, 12, 12), Dynamics(removal=Removal(None, (5.0, 10.0), 1.0)))


def scene_of(*obstacles: Obstacle, **properties) -> Scene:
    return make_scene("drawn", ROOM, obstacles, ((0, 0), (20, 20)), properties=properties)


def world_of(*obstacles: Obstacle) -> World:
    return World(scene_of(*obstacles), WorldSettings(sensing_range=5.0))


def names(scene: Scene) -> list[str]:
    return [o.name for o in scene.obstacles]


def test_an_unknown_obstacle_is_known_from_the_update_at_which_it_is_in_range():
    world = world_of(HIDES)
    rows = [(0.0, 0.0, 10.0)]
    assert names(world.look(make_trajectory(rows))) == []
    rows.append((2.0, 5.0, 10.0))
    assert names(world.look(make_trajectory(rows))) == ["hides"]
    rows.append((4.0, 0.0, 10.0))
    assert names(world.look(make_trajectory(rows))) == ["hides"], "what it knows it keeps"


def test_an_obstacles_own_range_goes_before_the_robots():
    world = world_of(NEAR)
    assert names(world.look(make_trajectory([(0, 6, 10)]))) == []
    assert names(world.look(make_trajectory([(0, 6, 10), (1, 8, 10)]))) == ["near"]


def test_what_the_robots_coming_removes_is_gone_though_it_came_between_two_updates():
    world = world_of(OPENS)
    assert names(world.look(make_trajectory([(0, 2, 10)]))) == ["opens"]
    assert names(world.look(make_trajectory([(0, 2, 10), (2, 8, 10)]))) == []


def test_a_moving_obstacle_is_where_it_is_at_the_update():
    known = world_of(SLIDES).look(make_trajectory([(0, 9, 9), (3, 9, 9)]))
    assert known.obstacles[0].polygon.bounds == (3, 4, 5, 6)


def test_what_did_not_change_is_the_same_object():
    world = world_of(SLIDES, HIDES)
    at = [world.look(make_trajectory([(0, 0, 0), (t, 0, 0)])) for t in (0.0, 1.0, 15.0, 16.0)]
    assert at[0] is not at[1]
    assert at[2] is at[3], "it has come to rest"


def test_obstacles_are_as_fast_as_wanted():
    world = World(scene_of(SLIDES), WorldSettings(obstacle_speed_factor=2.0))
    known = world.look(make_trajectory([(0, 9, 9), (3, 9, 9)]))
    assert known.obstacles[0].polygon.bounds == (6, 4, 8, 6)


# Settings


def test_a_scene_holds_defaults_and_a_run_may_differ():
    scene = scene_of(world={"speed": 3.0, "interval": 0.5})
    settings = world_settings(scene, {"interval": 1.0, "speed": None, "charge": "zero"})
    assert settings == WorldSettings(speed=3.0, interval=1.0, charge=Charge.ZERO)


@pytest.mark.parametrize(
    ("world", "message"),
    [
        ({"spee": 3}, "'world': unknown key 'spee'. It may have: speed, interval,"),
        ([], r"'world': it is \[\]. Give a table."),
        ({"speed": 0}, "speed is 0.0. It must be a finite number, above 0."),
        ({"interval": "2"}, "interval is '2'. Give a number."),
        ({"sensing_range": -1}, "sensing_range is -1.0. It must be a finite number, 0 or more."),
    ],
)
def test_bad_settings_are_refused_with_what_where_and_how_to_mend(world, message):
    with pytest.raises(SceneError, match=f"drawn, its property .*{message}"):
        world_settings(scene_of(world=world))
