"""The visibility search: what it asks, and that it is as exact as the other."""

import numpy as np
from shapely.geometry import box

from suite.scenes.catalogue import load_scene, scene_names
from suite.scenes.exact import shortest_path
from suite.scenes.scene import make_scene
from suite.scenes.visibility import tangent_path


def test_without_obstacles_one_segment_is_asked_about():
    scene = make_scene("empty", box(0, 0, 10, 10), [], ((1, 2), (9, 7)))
    path, checks = tangent_path(scene, scene.query())
    assert path.tolist() == [[1, 2], [9, 7]]
    assert checks == 1


def test_a_walled_in_goal_has_no_path():
    scene = make_scene("wall", box(0, 0, 10, 10), [box(4, 0, 5, 10)], ((1, 1), (9, 9)))
    assert tangent_path(scene, scene.query())[0] is None


def test_it_finds_the_same_paths_as_the_mesh_in_the_scenes_that_ship():
    for name in scene_names():
        scene = load_scene(name)
        path, _ = tangent_path(scene, scene.query())
        np.testing.assert_array_equal(path, shortest_path(scene, scene.query()).path)
