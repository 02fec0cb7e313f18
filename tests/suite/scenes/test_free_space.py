"""An end that is not free is moved to the nearest place that is, by no more than it must."""

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.affinity import rotate, translate

from suite.errors import SceneError
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.geojson import write_scene
from suite.scenes.scene import Scene, make_scene, with_snapped_ends
from tests.strategies import SIDE, float_polygons, lattice_boxes, lattice_polygons

polygons = st.lists(lattice_boxes() | lattice_polygons() | float_polygons(), min_size=1, max_size=5)
places = st.tuples(*[st.floats(-3.0, SIDE + 3.0)] * 2)
PLACES_OF_SCENES = [(0.0, 0.0), (691608.2, 5334765.7)]


def snapping(obstacles, ends, angle=0.0, at=(0.0, 0.0), inflate=0.0) -> Scene:
    def moved(shape):
        return translate(rotate(shape, angle, origin=(0, 0)), *at)

    start, goal = (shapely.get_coordinates(moved(shapely.Point(end)))[0] for end in ends)
    scene = make_scene(
        "snapping",
        moved(shapely.box(0, 0, SIDE, SIDE)),
        [moved(obstacle) for obstacle in obstacles],
        (start, goal),
        inflate=inflate,
        keep_blocked=True,
    )
    assume(not scene.regions.is_empty)
    return with_snapped_ends(scene, "snapping")


@settings(max_examples=150)
@given(polygons, places, places, st.floats(0.0, 90.0), st.sampled_from(PLACES_OF_SCENES))
def test_ends_move_to_the_nearest_free_place_and_are_accepted(obstacles, start, goal, angle, at):
    scene = snapping(obstacles, (start, goal), angle, at)
    query = scene.query()
    assert query.blocked is None
    where = np.array([*map(np.array, (start, goal))])
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    where = where @ np.array([[cos, sin], [-sin, cos]]) + at
    for end, moved, drawn in zip((query.start, query.goal), query.moved, where, strict=True):
        assert not shapely.contains(scene.arrangement.solid, shapely.Point(end))
        nearest = shapely.distance(scene.regions, shapely.Point(drawn))
        assert np.hypot(*(end - drawn)) <= nearest + 1e-6 * SIDE
        assert moved == pytest.approx(np.hypot(*(end - drawn)), abs=1e-6)
    path = shortest_path(scene, query).path
    if path is not None:
        assert judge(scene, query, path).valid


@settings(max_examples=50)
@given(polygons, places, places)
def test_an_end_that_is_free_stays_where_it_is(obstacles, start, goal):
    scene = snapping(obstacles, (start, goal))
    free = make_scene("free", scene.workspace, scene.obstacles, scene_ends(scene))
    again = with_snapped_ends(free, "again").query()
    assert again.moved == (0.0, 0.0)
    assert np.array_equal(again.start, scene.query().start)


def scene_ends(scene: Scene):
    return scene.query().start, scene.query().goal


def test_two_points_are_moved_as_the_queries_of_the_scene_are():
    scene = load_scene("maze@snap=yes")
    query = scene.query("-1,2:200,80")
    assert (query.name, query.start.tolist(), query.goal.tolist()) == (
        "-1,2:200,80", [0.0, 2.0], [100.0, 80.0],
    )  # fmt: skip
    assert query.moved == (1.0, 100.0)


def test_a_scene_file_whose_start_lies_in_a_wall_can_be_snapped_and_else_is_refused(tmp_path):
    wall, file = shapely.box(4, 0, 6, 7), tmp_path / "wall.geojson"
    write_scene(make_scene("wall", shapely.box(0, 0, 10, 10), [wall], ((3, 1), (9, 1))), file)
    file.write_text(file.read_text().replace("[3.0, 1.0]", "[5.5, 1.0]"))
    with pytest.raises(SceneError, match="lies inside obstacle 1"):
        load_scene(str(file))
    query = load_scene(f"{file}@snap=yes").query()
    assert (query.start.tolist(), query.moved) == ([6.0, 1.0], (0.5, 0.0))


def test_ends_that_a_robot_has_no_room_at_are_snapped_to_where_it_has(tmp_path):
    scene = load_scene("maze@radius=0.5,snap=yes")
    query = scene.query("0.1,50:50,50")
    assert query.start == pytest.approx([0.5, 50.0], abs=1e-8)
    assert load_scene("maze@radius=0.5").query("0.1,50:50,50").blocked is not None
