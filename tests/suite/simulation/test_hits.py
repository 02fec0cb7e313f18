"""Whether the robot was hit is decided in continuous time: no sample finds what it does not."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.affinity import translate
from shapely.geometry import Polygon, box

from suite.scenes.dynamics import Detection, Dynamics, Removal, constant_speed, make_motion
from suite.scenes.scene import Obstacle, Scene, make_scene
from suite.simulation.hits import BORDER, hits
from suite.simulation.trajectory import Trajectory, make_trajectory
from tests.strategies import lattice_boxes, lattice_polygons

ROOM = box(0, 0, 20, 20)
ENDS = ((20, 20), (20, 0))
SLIDING = Dynamics(constant_speed((1.0, 0.0), 0.0, 15.0))
SLIDES = Obstacle("slides", box(0, 4, 2, 6), SLIDING)


def scene_of(*obstacles: Obstacle) -> Scene:
    return make_scene("drawn", ROOM, obstacles, ENDS)


def still(x: float, y: float, duration: float = 20.0) -> Trajectory:
    return make_trajectory([(0, x, y), (duration, x, y)])


def first(scene: Scene, way: Trajectory) -> tuple[str, float] | None:
    found = hits(scene, way)
    return (found[0].obstacle, round(found[0].time, 4)) if found else None


def test_a_robot_that_stands_still_in_the_way_of_an_obstacle_is_hit():
    assert first(scene_of(SLIDES), still(8, 5)) == ("slides", 6.0)


@pytest.mark.parametrize("y", [4.0, 6.0, 7.0])
def test_one_that_it_passes_or_only_touches_is_not(y):
    assert first(scene_of(SLIDES), still(8, y)) is None


def test_one_in_front_of_which_it_stops_is_not():
    assert first(scene_of(SLIDES), still(17, 5)) is None


def test_an_obstacle_that_appears_on_the_robot_hits_it_then():
    appears = Obstacle("appears", box(7, 4, 9, 6), Dynamics(appears=3.0))
    assert first(scene_of(appears), still(8, 5)) == ("appears", 3.0)
    assert first(scene_of(appears), still(8, 5, duration=2.9)) is None
    assert first(scene_of(appears), still(8, 5, duration=3.0)) == ("appears", 3.0)


def test_one_that_was_gone_before_the_robot_came_does_not():
    gone = Obstacle("gone", box(7, 4, 9, 6), Dynamics(removal=Removal(time=3.0)))
    fast = make_trajectory([(0, 0, 5), (6, 12, 5)])
    slow = make_trajectory([(0, 0, 5), (24, 12, 5)])
    assert first(scene_of(gone), fast) is None  # it comes to x = 7 after 3.5 s
    gone_late = Obstacle("gone", box(5, 4, 9, 6), Dynamics(removal=Removal(time=3.0)))
    assert first(scene_of(gone_late), fast) == ("gone", 2.5)
    assert first(scene_of(gone_late), slow) is None


def test_what_the_robots_coming_removes_is_gone_from_that_moment():
    opens = Obstacle(
        "opens", box(7, 4, 9, 6), Dynamics(removal=Removal(place=(5.0, 5.0), distance=1.0))
    )
    assert first(scene_of(opens), make_trajectory([(0, 0, 5), (6, 12, 5)])) is None
    around = make_trajectory([(0, 0, 5), (1, 5, 8), (2, 8, 8), (3, 8, 5)])
    assert first(scene_of(opens), around) == ("opens", 2.6667)


def test_what_the_robot_does_not_know_hits_it_all_the_same():
    hidden = Obstacle("hidden", box(7, 4, 9, 6), Dynamics(detection=Detection(0.0)))
    assert first(scene_of(hidden), make_trajectory([(0, 0, 5), (10, 10, 5)])) == ("hidden", 7.0)


def test_static_obstacles_the_seam_between_two_and_the_border_count():
    walls = scene_of(Obstacle("low", box(4, 0, 6, 5)), Obstacle("high", box(4, 5, 6, 20)))
    assert first(walls, make_trajectory([(0, 0, 2), (10, 10, 2)])) == ("low", 4.0)
    found = first(walls, make_trajectory([(0, 0, 5), (10, 10, 5)]))
    assert found is not None
    assert found[1] == 4.0
    assert first(scene_of(), make_trajectory([(0, 10, 10), (10, 30, 10)])) == (BORDER, 5.0)
    assert first(scene_of(), make_trajectory([(0, 0, 0), (10, 20, 0)])) is None


def test_a_robot_and_an_obstacle_that_go_the_same_way_do_not_meet():
    way = make_trajectory([(0, 2, 5), (15, 17, 5), (20, 17, 5)])
    assert first(scene_of(SLIDES), way) is None
    slower = make_trajectory([(0, 3, 5), (30, 18, 5)])
    assert first(scene_of(SLIDES), slower) == ("slides", 2.0)


def test_hits_are_told_in_the_order_of_time_one_for_each_obstacle():
    wall = Obstacle("wall", box(10, 0, 12, 20))
    found = hits(scene_of(SLIDES, wall), make_trajectory([(0, 8, 5), (6, 8, 5), (10, 14, 5)]))
    assert [hit.obstacle for hit in found] == ["wall"]
    found = hits(scene_of(SLIDES, wall), make_trajectory([(0, 8, 5), (7, 8, 5), (11, 14, 5)]))
    assert [hit.obstacle for hit in found] == ["slides", "wall"]


# Against samples

whole = st.integers(-4, 11).map(float)
places = st.tuples(st.integers(0, 7).map(float), st.integers(0, 7).map(float))


@st.composite
def ways(draw: st.DrawFn) -> Trajectory:
    corners = draw(st.lists(places, min_size=1, max_size=4))
    times = sorted(draw(st.sets(st.integers(1, 20), min_size=len(corners), max_size=len(corners))))
    rows = [(0.0, *corners[0])]
    rows += [(float(t), *c) for t, c in zip(times, corners, strict=True)]
    return make_trajectory(rows)


@st.composite
def moving(draw: st.DrawFn) -> Obstacle:
    polygon: Polygon = draw(lattice_boxes() | lattice_polygons())
    times = sorted(draw(st.sets(st.integers(0, 20), min_size=1, max_size=3)))
    motion = make_motion([(t, draw(whole), draw(whole)) for t in times])
    removal = draw(st.none() | st.builds(Removal, time=st.sampled_from([0.0, 4.0, 11.5])))
    appears = draw(st.sampled_from([0.0, 0.0, 5.0]))
    return Obstacle("moving", polygon, Dynamics(motion, None, removal, appears))


SAMPLES = 2001
DEEPER = 1e-5
"""Metres: above a hit's depth, and far below what a lattice polygon has in it."""


@settings(max_examples=20)
@given(moving(), ways())
def test_the_first_hit_is_the_one_that_fine_samples_find(obstacle, way):
    scene = scene_of(obstacle)
    found = hits(scene, way)
    times = np.linspace(0.0, way.end, SAMPLES)
    inside = [depth_at(obstacle, way, time) > DEEPER for time in times.tolist()]
    if any(inside):
        sampled = times[int(np.argmax(inside))]
        assert found, f"not noticed, though the robot was inside at {sampled} s"
        assert found[0].time <= sampled
    if found:
        time = found[0].time
        assert (obstacle.dynamics or Dynamics()).is_there(time)
        offset = (obstacle.dynamics or Dynamics()).offset(time)
        touched = translate(obstacle.polygon, *offset).distance(shapely.Point(found[0].place))
        assert touched < DEEPER, "not at the obstacle when it is said to be hit"
        step = times[1] - times[0]
        before = [depth for t, depth in zip(times, inside, strict=True) if t < time - step]
        assert not any(before)
        # Soon after, it is inside: some of many samples of the next little while are.
        soon = np.linspace(time, min(time + 0.05, way.end), 200).tolist()
        assert max(depth_at(obstacle, way, t) for t in soon) > 0.0


def depth_at(obstacle: Obstacle, way: Trajectory, time: float) -> float:
    """How deep the robot is in the obstacle at a time, metres; 0 outside."""
    dynamics = obstacle.dynamics or Dynamics()
    if not dynamics.is_there(time):
        return 0.0
    point = shapely.Point(way.at(time)[0] - dynamics.offset(time))
    if not obstacle.polygon.contains(point):
        return 0.0
    return float(obstacle.polygon.boundary.distance(point))
