import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.geojson import read_scene, write_scene
from suite.scenes.scattered import GAP, scattered
from suite.scenes.scene import scene_fingerprint

SIZES = (1, 2, 3, 5, 17, 40, 100)


@pytest.fixture(
    scope="module",
    params=[(n, seed) for n in SIZES for seed in range(4)],
    ids="{0[0]}-{0[1]}".format,
)
def scene(request):
    return scattered(*request.param)


def polygons(scene):
    return np.array([o.polygon for o in scene.obstacles])


def covered(scene):
    return shapely.area(polygons(scene)).sum() / scene.workspace.area


def least_distance(scene):
    """Between two obstacles, or from one to the border, the start or the goal."""
    query = scene.query()
    others = [scene.workspace.exterior, *shapely.points([query.start, query.goal])]
    shapes = np.array([*polygons(scene), *others])
    table = shapely.distance(shapes[:, None], shapes)[: len(scene.obstacles)]
    return table[table > 0.0].min(), np.count_nonzero(table == 0.0)


def test_the_same_seed_gives_the_same_scene():
    one, two = scattered(60, 3), scattered(60, 3)
    assert one.hash == two.hash
    assert scene_fingerprint(one, one.query()) == scene_fingerprint(two, two.query())


def test_another_seed_or_number_gives_another_scene():
    scenes = [scattered(60, 3), scattered(60, 4), scattered(61, 3)]
    first = {polygons(scene)[0].wkb for scene in scenes}
    assert len(first) == 3


def test_a_scene_has_the_number_of_parts_that_was_asked_for(scene):
    assert scene.part_count == scene.properties["obstacles"]


def test_no_obstacle_touches_another_one_the_border_the_start_or_the_goal(scene):
    distance, touching = least_distance(scene)
    assert touching == len(scene.obstacles)  # each itself
    assert distance >= GAP * 100.0 / np.sqrt(max(scene.part_count, 20))


def test_the_straight_line_is_blocked(scene):
    line = shapely.LineString([scene.query().start, scene.query().goal])
    assert line.relate_pattern(scene.arrangement.solid, "T********")


def test_there_is_a_path_and_the_referee_agrees_on_its_length(scene):
    query = scene.query()
    found = shortest_path(scene, query)
    assert judge(scene, query, found.path).length == pytest.approx(found.length, rel=1e-12)
    assert found.length > np.hypot(*(query.goal - query.start))


def test_obstacles_are_drawn_in_whole_centimetres(scene):
    xy = shapely.get_coordinates(polygons(scene))
    assert (np.round(xy, 2) == xy).all()


def test_a_scene_is_like_the_last_one_of_the_papers_series():
    like, scenes = load_scene("obstacles_40"), [scattered(40, seed) for seed in range(10)]
    for scene in scenes:
        assert scene.bounds == like.bounds
        assert scene.query().start.tolist() == like.query().start.tolist()
        assert scene.query().goal.tolist() == like.query().goal.tolist()
    assert np.mean([covered(s) for s in scenes]) == pytest.approx(covered(like), abs=0.03)
    number = np.mean([len(s.obstacles) for s in scenes])
    assert number == pytest.approx(len(like.obstacles), abs=3)


def test_nearly_half_of_the_obstacles_are_concave():
    shapes = polygons(scattered(300, 1))
    concave = shapely.area(shapes) < 0.999 * shapely.area(shapely.convex_hull(shapes))
    assert 0.35 < concave.mean() < 0.55


def test_no_obstacle_is_a_splinter():
    shapes = polygons(scattered(300, 1))
    boxes = shapely.get_coordinates(shapely.minimum_rotated_rectangle(shapes)).reshape(-1, 5, 2)
    sides = np.hypot(*np.diff(boxes[:, :3], axis=1).T)
    assert (sides.min(axis=0) > 0.3 * sides.max(axis=0)).all()


def test_3000_obstacles_are_apart_cover_the_same_share_and_leave_a_path():
    scene = scattered(3000, 0)
    assert scene.part_count == 3000
    assert covered(scene) == pytest.approx(covered(load_scene("obstacles_40")), abs=0.02)
    shapes = polygons(scene)
    near = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=0.3)
    assert (near[0] == near[1]).all()
    found = shortest_path(scene, scene.query())
    assert judge(scene, scene.query(), found.path).length == pytest.approx(found.length, rel=1e-12)


def test_a_scene_says_how_it_was_made():
    properties = scattered(50, 7).properties
    assert {k: v for k, v in properties.items() if k != "description"} == {
        "generated": True,
        "generator": "scattered",
        "obstacles": 50,
        "seed": 7,
    }
    assert "50 convex parts" in properties["description"]


def test_a_scene_kept_as_a_file_is_the_same_scene(tmp_path):
    scene = scattered(40, 2)
    write_scene(scene, tmp_path / "kept.geojson")
    kept = read_scene(tmp_path / "kept.geojson")
    assert scene_fingerprint(kept, kept.query()) == scene_fingerprint(scene, scene.query())
    assert (kept.name, kept.properties) == (scene.name, scene.properties)


@pytest.mark.parametrize(("obstacles", "seed"), [(0, 0), (-3, 0), (10_001, 0), (5, -1)])
def test_numbers_out_of_range_are_refused_with_the_range(obstacles, seed):
    with pytest.raises(SceneError, match=r"^scattered scene: .* Give"):
        scattered(obstacles, seed)
