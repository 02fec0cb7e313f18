"""A dynamic scene stands still only where somebody says at what time."""

import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import scene_at


@pytest.mark.parametrize("name", ["door", "unknown_obstacles", "moving-3"])
@pytest.mark.parametrize("time", [0.0, 4.5])
def test_a_frozen_scene_has_the_obstacles_of_that_time(name, time):
    frozen = load_scene(f"{name}@at={time:g}")
    assert not frozen.is_dynamic
    assert frozen.name == f"{name}@at={time:g}"
    drawn = shapely.union_all([o.polygon for o in scene_at(load_scene(name), time).obstacles])
    still = shapely.union_all([o.polygon for o in frozen.obstacles])
    assert still.symmetric_difference(drawn).area < 1e-6


def test_scenes_of_two_times_are_two_scenes():
    hashes = {load_scene(f"door{at}").hash for at in ("", "@at=0", "@at=3", "@at=4")}
    assert len(hashes) == 4


def test_a_frozen_scene_can_be_moved_and_scaled_and_its_robot_can_have_a_size():
    still = load_scene("door@at=3")
    moved = load_scene("door@at=3,turn=20,scale=2")
    length = shortest_path(still, still.query()).length
    assert shortest_path(moved, moved.query()).length == pytest.approx(2.0 * length)
    wide = load_scene("door@at=3,radius=0.5")
    path = shapely.LineString(shortest_path(wide, wide.query()).path)
    assert min(path.distance(o.polygon) for o in still.obstacles) >= 0.5 - 1e-9


def test_an_end_in_an_obstacle_at_that_time_blocks_the_query_and_no_more():
    door = load_scene("door")
    inside = next(o for o in scene_at(door, 3.0).obstacles if o.polygon.area > 1.0)
    x, y = np.array(inside.polygon.representative_point().coords[0]).tolist()
    assert "lies inside" in load_scene("door@at=3").query(f"{x},{y}:5,5").blocked


def test_what_never_moves_is_not_frozen():
    with pytest.raises(SceneError, match=r"^maze: stands still at all times\. Leave at=3 out\.$"):
        load_scene("maze@at=3")
