"""What changes about an obstacle: read from its properties, refused where it can't be, kept."""

import json
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import box

from suite.errors import SceneError
from suite.scenes.dynamics import (
    Detection,
    Dynamics,
    Removal,
    as_properties,
    constant_speed,
    make_motion,
    parse_dynamics,
)
from suite.scenes.geojson import read_scene, write_scene
from suite.scenes.scene import Obstacle, make_scene, scene_at, scene_fingerprint
from tests.suite.scenes.test_geojson import changed

ROOM = box(0, 0, 10, 10)
ENDS = ((1, 1), (9, 9))
SLIDING = Dynamics(constant_speed((1.0, 0.0), 2.0, 4.0))


def scene_of(*obstacles: Obstacle):
    return make_scene("drawn", ROOM, obstacles, ENDS)


# Motion


def test_a_motion_rests_before_its_first_time_and_after_its_last():
    motion = constant_speed((1.0, -0.5), 2.0, 4.0)
    assert motion.offset(0.0).tolist() == [0.0, 0.0]
    assert motion.offset(3.0).tolist() == [1.0, -0.5]
    assert motion.offset(99.0).tolist() == [2.0, -1.0]


def test_a_faster_motion_goes_the_same_way_from_the_same_moment():
    motion = make_motion([(2, 0, 0), (4, 4, 0), (8, 4, 8)])
    faster = motion.faster(2.0)
    assert faster.offset(2.0).tolist() == motion.offset(2.0).tolist()
    assert faster.offset(3.0).tolist() == motion.offset(4.0).tolist()
    assert faster.offset(5.0).tolist() == motion.offset(8.0).tolist()


def test_what_has_no_such_properties_is_static():
    assert parse_dynamics({"role": "obstacle", "name": "pillar"}) is None


numbers = st.integers(-9, 9).map(float)
motions = st.lists(
    st.tuples(st.integers(0, 40), numbers, numbers),
    min_size=1,
    max_size=4,
    unique_by=lambda w: w[0],
).map(lambda rows: make_motion(sorted(rows)))
removals = st.builds(Removal, time=st.floats(0, 50)) | st.builds(
    Removal, st.none() | st.floats(0, 50), st.tuples(numbers, numbers), st.floats(0, 5)
)
dynamics = st.builds(
    Dynamics,
    st.none() | motions,
    st.none() | st.builds(Detection, st.none() | st.floats(0, 20)),
    st.none() | removals,
    st.sampled_from([0.0, 3.5]),
)


@given(dynamics)
def test_dynamics_survive_being_written_and_read(wanted):
    data = json.loads(json.dumps(as_properties(wanted)))
    found = parse_dynamics(data)
    assert as_properties(found) == data
    if found is not None:
        assert [found.offset(t).tolist() for t in range(45)] == [
            wanted.offset(t).tolist() for t in range(45)
        ]


# Scene files


@pytest.fixture
def refusal(tmp_path):
    """What is said of the good file with these properties of its pillar."""

    def refused(**properties) -> str:
        path = tmp_path / "hall.geojson"
        path.write_text(json.dumps(changed(2, lambda f: f["properties"].update(properties))))
        with pytest.raises(SceneError) as caught:
            read_scene(path)
        return str(caught.value)

    return refused


@pytest.mark.parametrize(
    ("properties", "message"),
    [
        ({"motion": 3}, "its motion is 3. Give an object of waypoints, or velocity, start"),
        ({"motion": {"speed": 3}}, "its motion: unknown key 'speed'. It may have: waypoints,"),
        ({"motion": {}}, "its motion has to have either waypoints or a velocity."),
        ({"motion": {"waypoints": []}}, "its waypoints have the shape (0,). Give [[t, dx, dy]"),
        ({"motion": {"waypoints": [[0, "a", 0]]}}, "its waypoints are no table of numbers."),
        ({"motion": {"waypoints": [[0, 1]]}}, "its waypoints have the shape (1, 2)."),
        ({"motion": {"waypoints": [[5, 0, 0], [5, 1, 0]]}}, "its waypoints are [5.0, 5.0]."),
        ({"motion": {"waypoints": [[-1, 0, 0]]}}, "its waypoints are [-1.0]. They must rise"),
        ({"motion": {"waypoints": [[0, 1e99, 0]]}}, "a waypoint is not finite or beyond 1e+09"),
        ({"motion": {"waypoints": [[0, 0, 0]], "stop": 3}}, "has waypoints and more"),
        ({"motion": {"velocity": [1, 0]}}, "its motion has a velocity and no stop."),
        ({"motion": {"velocity": 1, "stop": 3}}, "its velocity is 1. Give [vx, vy], metres"),
        ({"motion": {"velocity": [1, 0], "start": 3, "stop": 3}}, "Give a later stop."),
        ({"detection": True}, "its detection is True. Give an object of range."),
        ({"detection": {"range": -1}}, "its range is -1. Give a finite number, 0 or more."),
        ({"removal": {}}, "its removal names neither a time nor a place. Give one of them."),
        ({"removal": {"place": [1, 1]}}, "its removal has to have place and distance together."),
        ({"removal": {"time": True}}, "its time is True. Give a finite number, 0 or more."),
        ({"appears": "later"}, "its appears is 'later'. Give a finite number, 0 or more."),
    ],
)
def test_bad_dynamics_are_refused_with_what_where_and_how_to_mend(refusal, properties, message):
    said = refusal(**properties)
    assert said.startswith("hall.geojson, pillar: ")
    assert message in said


def test_a_dynamic_scene_survives_a_round_trip(tmp_path):
    scene = scene_of(
        Obstacle("a", box(2, 2, 4, 4), Dynamics(make_motion([(0, 0, 0), (5, 2, 1)]))),
        Obstacle("b", box(5, 5, 6, 6), Dynamics(detection=Detection())),
        Obstacle("c", box(7, 1, 8, 2), Dynamics(removal=Removal(place=(5.0, 5.0), distance=1.0))),
        Obstacle("d", box(1, 7, 2, 8)),
    )
    write_scene(scene, tmp_path / "drawn.geojson")
    again = read_scene(tmp_path / "drawn.geojson")
    assert again.hash == scene.hash
    properties = [as_properties(o.dynamics) for o in again.obstacles]
    assert properties == [as_properties(o.dynamics) for o in scene.obstacles]
    assert again.obstacles[3].dynamics is None


# Scenes


def test_the_fingerprint_of_a_static_scene_is_what_it_was_before_there_were_dynamics():
    scene = read_good()
    assert scene_fingerprint(scene, scene.query()) == "c927e82304a37a63"


def read_good():
    obstacles = [Obstacle("pillar", box(4, 4, 6, 6))]
    return make_scene("hall", ROOM, obstacles, ENDS)


def test_dynamics_are_part_of_the_fingerprint():
    hashes = {
        scene_of(Obstacle("a", box(2, 2, 4, 4), d)).hash
        for d in (None, SLIDING, SLIDING.faster(2.0), Dynamics(detection=Detection()))
    }
    assert len(hashes) == 4


def test_a_pickled_dynamic_scene_is_the_same():
    scene = scene_of(Obstacle("a", box(2, 2, 4, 4), SLIDING))
    assert pickle.loads(pickle.dumps(scene)).hash == scene.hash


def test_a_scene_at_a_time_is_static_and_has_what_is_there_where_it_is():
    scene = scene_of(
        Obstacle("slides", box(2, 2, 4, 4), SLIDING),
        Obstacle("comes", box(5, 5, 6, 6), Dynamics(appears=3.0)),
        Obstacle("goes", box(7, 1, 8, 2), Dynamics(removal=Removal(time=3.0))),
        Obstacle("stays", box(1, 7, 2, 8)),
    )
    bounds = {
        time: {o.name: o.polygon.bounds for o in scene_at(scene, time).obstacles}
        for time in (0.0, 3.0)
    }
    assert bounds[0.0].keys() == {"slides", "goes", "stays"}
    assert bounds[3.0].keys() == {"slides", "comes", "stays"}
    assert bounds[0.0]["slides"] == (2, 2, 4, 4)
    assert bounds[3.0]["slides"] == (3, 2, 5, 4)
    assert not scene_at(scene, 0.0).is_dynamic


def test_what_is_left_out_is_not_there():
    scene = scene_of(Obstacle("a", box(2, 2, 4, 4), SLIDING), Obstacle("b", box(6, 6, 7, 7)))
    assert [o.name for o in scene_at(scene, 0.0, without={"a"}).obstacles] == ["b"]


def test_what_moves_out_of_the_workspace_is_cut_there_and_comes_back_whole():
    motion = make_motion([(0, 0, 0), (10, 9, 0), (20, 0, 0)])
    scene = scene_of(Obstacle("a", box(2, 2, 4, 4), Dynamics(motion)))
    assert scene_at(scene, 7.0 / 0.9).obstacles[0].polygon.bounds == pytest.approx((9, 2, 10, 4))
    assert scene_at(scene, 10.0).obstacles == ()
    assert scene_at(scene, 20.0).obstacles[0].polygon.bounds == (2, 2, 4, 4)


def test_what_moves_may_be_drawn_outside():
    motion = constant_speed((1.0, 0.0), 0.0, 10.0)
    scene = scene_of(Obstacle("a", box(-3, 4, -1, 6), Dynamics(motion)))
    assert scene_at(scene, 0.0).obstacles == ()
    assert scene_at(scene, 2.0).obstacles[0].polygon.bounds == (0, 4, 1, 6)
    assert scene_at(scene, 5.0).obstacles[0].polygon.bounds == (2, 4, 4, 6)
    assert np.isfinite(scene.arrangement.corners).all()


def test_an_inflated_scene_keeps_its_dynamics():
    obstacle = Obstacle("a", box(2, 2, 4, 4), SLIDING)
    scene = make_scene("drawn", ROOM, [obstacle], ENDS, inflate=0.5)
    assert scene.obstacles[0].dynamics is SLIDING


@pytest.mark.parametrize("end", [(1, 1), (9, 9)])
def test_start_and_goal_need_to_be_free_at_time_0_only(end):
    x, y = end
    on_it = box(x - 1, y - 1, x + 1, y + 1)
    later = Obstacle("later", on_it, Dynamics(appears=3.0))
    leaves_first = Obstacle("elsewhere", on_it, Dynamics(make_motion([(0, 4, 0), (9, 0, 0)])))
    assert len(scene_of(later).obstacles) == len(scene_of(leaves_first).obstacles) == 1
    beside = box(x - 1, 4, x + 1, 6)
    comes_first = make_motion([(0, 0, y - 5), (9, 0, 0)])
    with pytest.raises(SceneError, match=r"lies inside on it\. Move it to free space\."):
        scene_of(Obstacle("on it", beside, Dynamics(comes_first)))


@pytest.mark.parametrize("bad", [[["0", "1", "2"]], [[True, False, True]], [[0, 0, 10**400]]])
def test_waypoints_that_are_no_numbers_are_refused(bad):
    with pytest.raises(SceneError, match="its waypoints are no table of numbers"):
        parse_dynamics({"motion": {"waypoints": bad}})


def test_the_place_of_a_wrong_number_in_a_pair_is_named():
    with pytest.raises(SceneError, match=r"its velocity is '2'\. Give a finite number"):
        parse_dynamics({"motion": {"velocity": [1, "2"], "stop": 3}})
