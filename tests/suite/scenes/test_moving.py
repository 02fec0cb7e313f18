"""Moving scenes: drawn from a seed, of every kind of change, startable, kept as files."""

import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import has_scene, load_scene, scene_file
from suite.scenes.dynamics import as_properties
from suite.scenes.exact import shortest_path
from suite.scenes.geojson import read_scene, write_scene
from suite.scenes.moving import TIME_LIMIT, moving
from suite.scenes.scene import Query, scene_at, scene_fingerprint
from suite.simulation.settings import world_settings
from suite.simulation.trajectory import make_trajectory
from suite.simulation.world import World

SEEDS = range(30)


@pytest.fixture(scope="module", params=SEEDS)
def scene(request):
    return moving(request.param)


def changes():
    """The dynamics of all obstacles of all scenes that have any."""
    obstacles = [obstacle for seed in SEEDS for obstacle in moving(seed).obstacles]
    return [o.dynamics for o in obstacles if o.dynamics is not None]


def test_the_same_seed_gives_the_same_scene():
    one, two = moving(3), moving(3)
    assert scene_fingerprint(one, one.query()) == scene_fingerprint(two, two.query())
    assert one.properties == two.properties


def test_another_seed_gives_another_scene():
    assert len({moving(seed).hash for seed in SEEDS}) == len(SEEDS)


def test_start_and_goal_are_free_at_time_0(scene):
    solid = scene_at(scene, 0.0).arrangement.solid
    for end in (scene.query().start, scene.query().goal):
        assert solid.distance(shapely.Point(end)) >= 0.99


def test_at_first_the_robot_has_a_way_in_what_it_knows(scene):
    still = make_trajectory([(0.0, *scene.query().start)])
    known = World(scene, world_settings(scene)).look(still)
    assert np.isfinite(shortest_path(known, scene.query()).length)


def test_some_robots_have_no_way_once_all_is_known():
    ways = [shortest_path(scene_at(s, 0.0), s.query()).path for s in map(moving, SEEDS)]
    assert {way is None for way in ways} == {True, False}


def test_some_obstacles_stay_and_some_change(scene):
    assert {o.dynamics is None for o in scene.obstacles} == {True, False}


def test_its_world_is_what_a_simulation_takes(scene):
    assert world_settings(scene).time_limit == TIME_LIMIT


def test_every_kind_of_change_occurs():
    found = changes()
    assert any(d.motion is not None for d in found)
    assert any(d.detection is not None and d.detection.range is None for d in found)
    assert any(d.detection is not None and d.detection.range is not None for d in found)
    assert any(d.removal is not None and d.removal.time is None for d in found)
    assert any(d.removal is not None and d.removal.place is None for d in found)
    assert any(
        d.removal is not None and None not in (d.removal.time, d.removal.place) for d in found
    )
    assert any(d.appears > 0.0 for d in found)
    assert any(d.motion is not None and d.detection is not None for d in found)


def test_motions_have_several_waypoints_stops_and_different_speeds():
    motions = [d.motion for d in changes() if d.motion is not None]
    assert max(len(motion.times) for motion in motions) >= 5
    speeds = [
        np.hypot(*np.diff(motion.offsets, axis=0).T) / np.diff(motion.times) for motion in motions
    ]
    assert any(0.0 in of_one for of_one in speeds)
    assert any(len(set(of_one[of_one > 0.0].round(3))) > 1 for of_one in speeds)
    assert max(of_one.max() for of_one in speeds) < 10.0


def test_in_the_end_some_goals_can_be_reached_and_some_can_not():
    def is_open(seed: int) -> bool:
        scene = moving(seed)
        end = scene_at(scene, TIME_LIMIT)
        query: Query = scene.query()
        if end.arrangement.solid.contains(shapely.Point(query.goal)):
            return False
        return bool(np.isfinite(shortest_path(end, query).length))

    assert {is_open(seed) for seed in SEEDS} == {True, False}


def test_a_scene_kept_as_a_file_is_the_same_scene(scene, tmp_path):
    write_scene(scene, tmp_path / "kept.geojson")
    kept = read_scene(tmp_path / "kept.geojson")
    assert scene_fingerprint(kept, kept.query()) == scene_fingerprint(scene, scene.query())
    assert (kept.name, kept.properties) == (scene.name, scene.properties)


def test_it_is_found_by_its_name():
    assert has_scene("moving-7")
    assert load_scene("moving-7").hash == moving(7).hash
    assert load_scene("moving-7").name == "moving-7"
    with pytest.raises(SceneError, match=r"moving-7: is generated .* `kbga-bench generate`"):
        scene_file("moving-7")


def test_it_keeps_its_changes_when_it_grows_by_the_robots_radius():
    point, disc = load_scene("moving-7"), load_scene("moving-7", inflate=0.5)
    assert disc.properties == point.properties
    assert [as_properties(o.dynamics) for o in disc.obstacles] == [
        as_properties(o.dynamics) for o in point.obstacles
    ]


@pytest.mark.parametrize("name", ["moving", "moving-", "moving-x", "movin-0"])
def test_a_misspelt_name_is_answered_with_the_nearest_one(name):
    with pytest.raises(SceneError, match=r"Did you mean 'moving-0'\?$"):
        load_scene(name)


def test_a_negative_seed_is_refused():
    with pytest.raises(SceneError, match=r"^moving scene: seed is -1. Give 0 or more\.$"):
        moving(-1)
