"""Bad scene files are refused with what, where and how to mend; good ones survive a round trip."""

import copy
import json
from pathlib import Path

import pytest
import shapely
from shapely.geometry import Polygon, box, mapping, shape

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.geojson import read_scene, write_scene
from suite.scenes.scene import Obstacle, SceneWarning, make_scene

SQUARE = [[[4, 4], [6, 4], [6, 6], [4, 6], [4, 4]]]
INFINITE = float("inf")


def feature(role: str | None, kind: str, coordinates, **properties) -> dict:
    own = properties if role is None else {"role": role, **properties}
    return {
        "type": "Feature",
        "properties": own,
        "geometry": {"type": kind, "coordinates": coordinates},
    }


GOOD = {
    "type": "FeatureCollection",
    "features": [
        feature("workspace", "Polygon", [[[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]]),
        feature("obstacle", "Polygon", SQUARE, name="pillar"),
        feature("start", "Point", [1, 1]),
        feature("goal", "Point", [9, 9]),
    ],
}


@pytest.fixture
def read(tmp_path):
    """Write a text, or a document as JSON, and read it as a scene."""

    def write_and_read(content, **options):
        path = tmp_path / "hall.geojson"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return read_scene(path, **options)

    return write_and_read


def changed(number: int, change) -> dict:
    """The good document with one feature (from 1) changed in place."""
    document = copy.deepcopy(GOOD)
    change(document["features"][number - 1])
    return document


def with_coordinates(number: int, coordinates) -> dict:
    return changed(number, lambda f: f["geometry"].update(coordinates=coordinates))


def with_features(*features: dict) -> dict:
    return {**GOOD, "features": [*GOOD["features"], *features]}


def without(number: int) -> dict:
    return {**GOOD, "features": [f for i, f in enumerate(GOOD["features"], 1) if i != number]}


def test_a_good_file_is_read(read):
    scene = read(GOOD)
    assert scene.name == "hall"
    assert [o.name for o in scene.obstacles] == ["pillar"]
    assert scene.query().start.tolist() == [1, 1]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", r"hall\.geojson, line 1, column 1: not JSON"),
        ("{", r"hall\.geojson, line 1, column 2: not JSON"),
        ("\n\n  [1,, 2]", r"hall\.geojson, line 3, column \d+: not JSON"),
        ("[" * 100_000, r"hall\.geojson: can't be read as JSON"),
        ("1" * 5000, r"hall\.geojson: can't be read as JSON"),
        ("[1, 2]", r"hall\.geojson: holds no JSON object"),
        ("null", r"hall\.geojson: holds no JSON object"),
        ("{}", "its type is None, not 'FeatureCollection'"),
        ({"type": "Polygon", "coordinates": SQUARE}, "its type is 'Polygon', not 'FeatureColl"),
        ({"type": "FeatureCollection"}, "'features' is missing"),
        ({"type": "FeatureCollection", "features": {}}, "'features' is missing or no list"),
        ({"type": "FeatureCollection", "features": []}, "0 workspaces. Give one Polygon"),
        ({"type": "FeatureCollection", "features": [None]}, "feature 1: is no GeoJSON Feature"),
    ],
)
def test_a_file_that_is_no_feature_collection_is_refused(read, content, message):
    with pytest.raises(SceneError, match=message):
        read(content)


def test_a_file_that_is_no_text_a_directory_or_not_there_is_refused(tmp_path):
    binary = tmp_path / "binary.geojson"
    binary.write_bytes(b"\xff\xfe\x00")
    for path, message in [
        (binary, "is not UTF-8 text"),
        (tmp_path, "can't be read"),
        (tmp_path / "none.geojson", "can't be read .No such file"),
    ]:
        with pytest.raises(SceneError, match=message):
            read_scene(path)


def no_role(f: dict) -> None:
    del f["properties"]["role"]


def wall_role(f: dict) -> None:
    f["properties"]["role"] = "wall"


def list_role(f: dict) -> None:
    f["properties"]["role"] = ["obstacle"]


def no_properties(f: dict) -> None:
    f["properties"] = None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (no_role, "feature 2: has no role. Set properties.role to one of workspace, obstacle"),
        (no_properties, "feature 2: has no role"),
        (wall_role, "feature 2: has the unknown role 'wall'. Set properties.role"),
        (list_role, "feature 2: has the unknown role"),
    ],
)
def test_a_role_that_is_missing_or_unknown_is_refused(read, change, message):
    with pytest.raises(SceneError, match=message):
        read(changed(2, change))


@pytest.mark.parametrize("bad", [float("nan"), INFINITE, -INFINITE, 10**400, 1e300])
def test_coordinates_that_are_no_finite_metres_are_refused(read, bad):
    ring = [[4, 4], [6, 4], [bad, 6], [4, 4]]
    with pytest.raises(SceneError, match=r"pillar, vertex 3: .*must be finite numbers"):
        read(with_coordinates(2, [ring]))
    with pytest.raises(SceneError, match=r"feature 3 \(start\): .*must be finite numbers"):
        read(with_coordinates(3, [1, bad]))


@pytest.mark.parametrize("bad", [["1", "2"], [1], [], None, "1 2", [True, False], {"x": 1}])
def test_coordinates_that_are_no_numbers_are_refused(read, bad):
    with pytest.raises(SceneError, match=r"pillar, vertex 2: .* is not \[x, y\]"):
        read(with_coordinates(2, [[[4, 4], bad, [6, 6], [4, 4]]]))
    with pytest.raises(SceneError, match=r"feature 4 \(goal\): .* is not \[x, y\]"):
        read(with_coordinates(4, bad))


@pytest.mark.parametrize(
    ("coordinates", "message"),
    [
        ([[[4, 4], [6, 6], [6, 4], [4, 6], [4, 4]]], r"edges 1 and 3 cross at \(5, 5\)"),
        ([[[4, 4], [6, 6], [4, 4]]], "only 2 different vertices. A ring needs three"),
        ([[[4, 4], [5, 5], [6, 6], [4, 4]]], "its area is zero"),
        ([[]], "only 0 different vertices"),
        ([], "coordinates are missing"),
        (None, "coordinates are missing"),
        ([7], r"a ring is no list of \[x, y\]"),
        ([[[4, 4], [8, 4], [8, 8], [4, 8]], [[7, 7], [9, 7], [9, 9]]], "pillar: .*split it"),
    ],
)
def test_a_ring_that_bounds_no_polygon_is_refused(read, coordinates, message):
    with pytest.raises(SceneError, match=message):
        read(with_coordinates(2, coordinates))


@pytest.mark.parametrize("number", [1, 2])
@pytest.mark.parametrize("kind", ["Point", "LineString", None])
def test_a_polygon_of_another_geometry_type_is_refused(read, number, kind):
    with pytest.raises(SceneError, match=f"its geometry is {kind!r}; give a Polygon"):
        read(changed(number, lambda f: f["geometry"].update(type=kind)))


@pytest.mark.parametrize("number", [3, 4])
def test_a_point_of_another_geometry_type_is_refused(read, number):
    with pytest.raises(SceneError, match="its geometry is 'Polygon'; give a Point"):
        read(changed(number, lambda f: f["geometry"].update(type="Polygon")))
    with pytest.raises(SceneError, match="its geometry is None; give a Point"):
        read(changed(number, lambda f: f.update(geometry=None)))


def test_a_start_outside_or_inside_an_obstacle_is_refused(read):
    with pytest.raises(SceneError, match=r"start of query 'main': \(-1, 5\) lies outside"):
        read(with_coordinates(3, [-1, 5]))
    with pytest.raises(SceneError, match=r"goal of query 'main': \(5, 5\) lies inside pillar"):
        read(with_coordinates(4, [5, 5]))


def test_a_start_on_the_seam_of_two_obstacles_is_refused(read):
    ring = [[[6, 4], [8, 4], [8, 6], [6, 6], [6, 4]]]
    document = with_features(feature("obstacle", "Polygon", ring, name="twin"))
    document["features"][2] = feature("start", "Point", [6, 5])
    with pytest.raises(SceneError, match="lies inside pillar and twin"):
        read(document)


def test_a_start_or_goal_alone_and_a_missing_workspace_are_refused(read):
    with pytest.raises(SceneError, match="query 'main' has no start"):
        read(without(3))
    with pytest.raises(SceneError, match="query 'main' has no goal"):
        read(without(4))
    with pytest.raises(SceneError, match="0 workspaces"):
        read(without(1))
    assert read({**GOOD, "features": GOOD["features"][:2]}).queries == ()  # a map


def test_a_start_whose_query_has_no_goal_is_refused(read):
    with pytest.raises(SceneError, match="query 'b' has no goal"):
        read(with_features(feature("start", "Point", [2, 2], query="b")))


def test_duplicates_are_refused(read):
    with pytest.raises(SceneError, match="two obstacles are named 'pillar'"):
        read(with_features(GOOD["features"][1]))
    with pytest.raises(SceneError, match="feature 5: query 'main' has two points of role 'start'"):
        read(with_features(GOOD["features"][2]))
    with pytest.raises(SceneError, match="2 workspaces"):
        read(with_features(GOOD["features"][0]))


def test_several_queries_are_read(read):
    more = [feature(r, "Point", [2, y], query="b") for r, y in (("goal", 3), ("start", 2))]
    scene = read(with_features(*more))
    assert [q.name for q in scene.queries] == ["main", "b"]
    assert scene.query("b").goal.tolist() == [2, 3]


def test_a_multipolygon_is_an_obstacle_of_several_polygons(read):
    second = [[[1, 7], [2, 7], [2, 8], [1, 7]]]
    scene = read(
        changed(
            2,
            lambda f: f.update(geometry={"type": "MultiPolygon", "coordinates": [SQUARE, second]}),
        )
    )
    assert [o.name for o in scene.obstacles] == ["pillar, polygon 1", "pillar, polygon 2"]


def test_a_hole_of_the_workspace_is_an_obstacle(read):
    room = mapping(box(0, 0, 10, 10).difference(box(7, 1, 8, 2)))
    scene = read(changed(1, lambda f: f.update(geometry=room)))
    assert [o.name for o in scene.obstacles] == ["pillar", "hole 1 of the workspace"]


def test_a_third_coordinate_is_left_out(read):
    assert read(with_coordinates(3, [1, 1, 7])).query().start.tolist() == [1, 1]


def test_an_obstacle_that_sticks_out_is_cut_with_a_warning(read):
    with pytest.warns(SceneWarning, match=r"hall\.geojson, pillar: sticks out"):
        scene = read(with_coordinates(2, [[[8, 4], [12, 4], [12, 6], [8, 6], [8, 4]]]))
    assert scene.obstacles[0].polygon.bounds == (8, 4, 10, 6)


def test_inflating_on_reading_grows_obstacles(read):
    grown = read(GOOD, inflate=0.5).obstacles[0].polygon
    # Walls move by exactly the radius; beside a corner it is two widths of the grid more.
    assert grown.intersection(shapely.box(4.1, 0, 5.9, 10)).bounds == (4.1, 3.5, 5.9, 6.5)
    assert grown.bounds == pytest.approx((3.5, 3.5, 6.5, 6.5), abs=3e-9)


def test_name_and_properties_of_the_collection_are_kept(read):
    own = {"optimum": {"main": 11.5}, "figure": 6, "mine": [1, {"two": None}]}
    scene = read({**GOOD, "name": "maze", "properties": own})
    assert scene.name == "maze"
    assert dict(scene.properties) == own
    assert scene.stored_optimum(scene.query()) == 11.5


SAVED = """{
"type": "FeatureCollection",
"name": null,
"features": [
{"type": "Feature", "properties": {"role": "workspace", "name": null, "motion": null,
  "detection": null, "removal": null, "appears": null, "query": null}, "geometry":
  {"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]]}},
{"type": "Feature", "properties": {"role": "obstacle", "name": null, "motion": null,
  "detection": null, "removal": null, "appears": null, "query": null}, "geometry":
  {"type": "Polygon", "coordinates": [[[4, 4], [6, 4], [6, 6], [4, 6], [4, 4]]]}},
{"type": "Feature", "properties": {"role": "obstacle", "name": "bar", "motion":
  {"waypoints": [[0, 0, 0], [9, 1, 0]], "velocity": null, "start": null, "stop": null},
  "detection": {"range": null}, "removal": {"time": 5, "place": null, "distance": null},
  "appears": null, "query": null}, "geometry":
  {"type": "Polygon", "coordinates": [[[1, 7], [2, 7], [2, 8], [1, 7]]]}},
{"type": "Feature", "properties": {"role": "start", "name": null, "motion": null,
  "detection": null, "removal": null, "appears": null, "query": null}, "geometry":
  {"type": "Point", "coordinates": [1, 1]}},
{"type": "Feature", "properties": {"role": "goal", "name": "", "motion": null, "detection": null,
  "removal": null, "appears": null, "query": ""}, "geometry":
  {"type": "Point", "coordinates": [8, 8]}}],
"properties": {"optimum": null, "world": null, "gates": null}
}"""
"""With a column for each property that any feature has, as geopandas saves them."""


def test_what_is_null_is_left_out(read):
    scene = read(SAVED)
    assert scene.name == "hall"
    assert [o.name for o in scene.obstacles] == ["obstacle 1", "bar"]
    pillar, bar = scene.obstacles
    assert pillar.dynamics is None
    assert bar.dynamics.motion.offset(9).tolist() == [1, 0]
    assert (bar.dynamics.detection.range, bar.dynamics.removal.time) == (None, 5.0)
    assert [q.name for q in scene.queries] == ["main"]
    assert scene.stored_optimum(scene.query()) is None
    assert dict(scene.properties) == {}


def test_a_collection_without_properties_may_say_so(read):
    assert dict(read({**GOOD, "properties": None}).properties) == {}
    with pytest.raises(SceneError, match=r"its properties are \[1\]. Give an object"):
        read({**GOOD, "properties": [1]})


def test_a_byte_order_mark_is_skipped(tmp_path):
    file = tmp_path / "hall.geojson"
    file.write_bytes(b"\xef\xbb\xbf" + json.dumps(GOOD).encode())
    assert read_scene(file).name == "hall"


@pytest.mark.parametrize("bad", ["abc", 7, [1], {"main": "abc"}, {"main": -1}, {"main": True}])
def test_an_optimum_that_is_no_length_is_refused(read, bad):
    with pytest.raises(SceneError, match=r"'optimum'.* is .*leave it out: it is computed"):
        read({**GOOD, "properties": {"optimum": bad}})


@pytest.mark.parametrize(
    "bad", ["abc", {"left": 1}, {"left": [[0, 0]]}, {"left": [[0, 0], [1, "2"]]}]
)
def test_a_gate_that_is_no_segment_is_refused(read, bad):
    with pytest.raises(SceneError, match=r"(gates|gate 'left').* is .*segment"):
        read({**GOOD, "properties": {"gates": bad}})


@pytest.mark.parametrize(
    "bad", [["a"], {"a": 1}, True, "two\nlines", "x" * 201, float("nan"), "\x00", "\ud800"]
)
def test_a_name_that_is_no_line_of_text_is_refused(read, bad):
    mend = "Give a text of one line"
    with pytest.raises(SceneError, match=rf"the collection: its name is .*{mend}"):
        read({**GOOD, "name": bad})
    with pytest.raises(SceneError, match=rf"feature 2: its name is .*{mend}"):
        read(changed(2, lambda f: f["properties"].update(name=bad)))
    with pytest.raises(SceneError, match=rf"feature 3, query: its name is .*{mend}"):
        read(changed(3, lambda f: f["properties"].update(query=bad)))


def test_an_error_shows_the_beginning_of_a_long_value(read):
    with pytest.raises(SceneError) as caught:
        read(changed(2, lambda f: f["properties"].update(role=["wall"] * 10_000)))
    assert len(str(caught.value)) < 250


def same_after_a_round_trip(scene, path: Path) -> bool:
    write_scene(scene, path)
    again = read_scene(path)
    return (
        again.hash == scene.hash
        and again.name == scene.name
        and dict(again.properties) == dict(scene.properties)
        and [o.name for o in again.obstacles] == [o.name for o in scene.obstacles]
        and [(q.name, *q.start, *q.goal) for q in again.queries]
        == [(q.name, *q.start, *q.goal) for q in scene.queries]
    )


def test_a_round_trip_keeps_everything(tmp_path):
    scene = make_scene(
        "two queries",
        Polygon([(0, 0), (10.1, 0), (10, 10 / 3), (-1 / 7, 9.9)], [[(5, 1), (6, 1), (6, 2)]]),
        [Obstacle("ring", box(2, 2, 4, 4).difference(box(2.5, 2.5, 3.1, 3.3))), box(6, 3, 7, 4)],
        {"main": ((0.1, 0.2), (9.3, 1 / 3)), "b": ((2.7, 2.7), (0, 0))},
        properties={"figure": 6, "optimum": {"main": 1.1}, "text": "½ m"},
    )
    assert same_after_a_round_trip(scene, tmp_path / "out.geojson")


def test_a_round_trip_keeps_obstacles_that_were_cut_at_a_slanted_border(tmp_path):
    room = Polygon([(0, 0), (10, 0.7), (9.3, 8.9), (0.1, 7.7)])
    with pytest.warns(SceneWarning):
        scene = make_scene(
            "cut",
            room,
            [Polygon([(x, 5), (x + 0.6, 5), (x + 0.3, 12)]) for x in (1, 2.1, 3.3, 4.7, 7.9)],
            {"main": ((1, 1), (2, 2))},
        )
    assert same_after_a_round_trip(scene, tmp_path / "out.geojson")  # a warning is an error here


def test_a_scene_without_properties_or_obstacles_can_be_written(tmp_path):
    scene = make_scene("empty", box(0, 0, 1, 1), [], {"main": ((0, 0), (1, 1))})
    assert same_after_a_round_trip(scene, tmp_path / "out.geojson")


def test_a_written_file_is_plain_geojson(tmp_path):
    scene = make_scene("one", box(0, 0, 9, 9), [box(1, 1, 2, 2)], {"main": ((0, 0), (9, 9))})
    write_scene(scene, tmp_path / "out.geojson")
    document = json.loads((tmp_path / "out.geojson").read_text())
    assert document["type"] == "FeatureCollection"
    roles = [f["properties"]["role"] for f in document["features"]]
    assert roles == ["workspace", "obstacle", "start", "goal"]
    assert shape(document["features"][1]["geometry"]).equals(box(1, 1, 2, 2))


def test_a_file_that_cannot_be_written_is_an_error_with_the_reason(tmp_path):
    scene = make_scene("one", box(0, 0, 9, 9), [], {"main": ((0, 0), (9, 9))})
    with pytest.raises(SceneError, match="can't be written"):
        write_scene(scene, tmp_path / "nowhere" / "out.geojson")


@pytest.mark.parametrize("name", ["größe 7 ½ m²", "a\u00a0b", "家", 7, 1.0])
def test_a_name_may_be_any_line_of_text_or_a_number(read, name, tmp_path):
    scene = read({**GOOD, "name": name})
    assert scene.name == str(name)
    assert same_after_a_round_trip(scene, tmp_path / "out.geojson")


def round_trip(scene, folder):
    file = folder / "again.geojson"
    write_scene(scene, file)
    again = read_scene(file)
    assert (again.name, again.hash, again.radius) == (scene.name, scene.hash, scene.radius)
    assert dict(again.properties) == dict(scene.properties)
    for query, other in zip(scene.queries, again.queries, strict=True):
        assert (query.name, query.stratum) == (other.name, other.stratum)
        assert (query.blocked is None) == (other.blocked is None)
        assert (query.start.tolist(), query.goal.tolist()) == (
            other.start.tolist(),
            other.goal.tolist(),
        )
    return json.loads(file.read_text())


def test_a_file_may_state_the_robots_radius_by_which_it_grows_when_it_is_read(read):
    stated = {**GOOD, "properties": {"radius": 0.5, "optimum": {"main": 12.0}}}
    scene = read(stated)
    assert scene.radius == 0.5
    assert scene.hash == read(GOOD, inflate=0.5).hash != read(GOOD).hash
    assert dict(scene.properties) == {}
    assert read(stated, inflate=0.0).hash == read(GOOD).hash
    assert read(stated, inflate=0.7).hash == read(GOOD, inflate=0.7).hash


def test_the_radius_in_a_name_goes_before_the_one_that_the_file_states(tmp_path):
    plain, stated = tmp_path / "plain.geojson", tmp_path / "hall.geojson"
    plain.write_text(json.dumps(GOOD))
    stated.write_text(json.dumps({**GOOD, "properties": {"radius": 0.5}}))
    for modifiers, same in [
        ("", "@radius=0.5"),
        ("@radius=0.2", "@radius=0.2"),
        ("@radius=0", ""),
        ("@shift=3", "@shift=3,radius=0.5"),
        ("@scale=2", "@scale=2,radius=0.5"),
        ("@scale=2,radius=0", "@scale=2"),
    ]:
        assert load_scene(f"{stated}{modifiers}").hash == load_scene(f"{plain}{same}").hash


@pytest.mark.parametrize("key", ["radius", "grown_by"])
@pytest.mark.parametrize("bad", [-1, "0.2", None, True, [1], 1e300])
def test_a_radius_that_is_none_is_refused(read, key, bad):
    document = {**GOOD, "properties": {key: bad}}
    if bad is None:
        assert read(document).radius == 0.0
        return
    with pytest.raises(SceneError, match=rf"its property '{key}' is .*Give the robot's, in metres"):
        read(document)


def test_a_grown_scene_is_written_as_it_is_and_not_grown_again(read, tmp_path):
    scene = read({**GOOD, "properties": {"radius": 0.5, "description": "a hall"}})
    written = round_trip(scene, tmp_path)
    assert written["properties"] == {"description": "a hall", "grown_by": 0.5}
    grown_more = read_scene(tmp_path / "again.geojson", inflate=0.25)
    assert grown_more.radius == 0.75
    assert grown_more.obstacles[0].polygon.covers(scene.obstacles[0].polygon)


def test_what_has_grown_keeps_its_radius_when_it_is_modified(read, tmp_path):
    write_scene(read(GOOD, inflate=0.5), tmp_path / "grown.geojson")
    for modifiers, radius in [("@turn=90", 0.5), ("@scale=2", 1.0), ("@radius=0.25", 0.75)]:
        assert load_scene(f"{tmp_path / 'grown.geojson'}{modifiers}").radius == radius
        assert load_scene(f"{tmp_path / 'grown.geojson'}@shift=1{modifiers}").radius == radius


def test_blocked_queries_survive_writing_and_reading(tmp_path):
    ends = {"near": ((3.8, 5), (9, 9)), "in": ((5, 5), (9, 9)), "free": ((1, 1), (9, 9))}
    wall, room = box(4, 4, 6, 6), box(0, 0, 10, 10)
    strata = {"near": "short", "free": "7"}
    kept = make_scene("hall", room, [wall], ends, strata=strata, keep_blocked=True)
    assert [q.blocked is None for q in kept.queries] == [True, False, True]
    round_trip(kept, tmp_path)
    grown = make_scene("hall", room, [wall], ends, strata=strata, inflate=0.5)
    assert [q.blocked is None for q in grown.queries] == [False, False, True]
    round_trip(grown, tmp_path)


def test_an_end_in_an_obstacle_of_a_file_drawn_by_hand_is_still_refused(read):
    with pytest.raises(SceneError, match=r"start of query 'main': \(5, 5\) lies inside pillar"):
        read(with_coordinates(3, [5, 5]))
