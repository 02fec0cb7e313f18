"""A scene as a document: read back, it is the same to the bit."""

import dataclasses
import json
import pickle
import zlib

import numpy as np
import pytest
import shapely
import shapely.affinity
from hypothesis import given
from hypothesis import strategies as st

from suite.errors import SceneError
from suite.scenes.catalogue import aligned_names, dynamic_names, load_scene, scene_names
from suite.scenes.exact import shortest_path
from suite.scenes.kept import SUFFIX, digest_of, pack_scene, text_of, unpack_scene
from suite.scenes.scene import make_scene

NAMES = [
    *scene_names(),
    *dynamic_names(),
    *aligned_names(),
    "scattered_30-2",
    "moving-3",
    "maze@turn=17,shift=0.37:-0.1",
    "clustered@radius=0.35",
    "zigzag@twin=3,scale=1.0137,radius=0.2",
    "door@radius=0.3",
]


def again(scene):
    return unpack_scene(pack_scene(scene), "here")


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_comes_back_to_the_bit(name):
    scene = load_scene(name)
    back = again(scene)
    assert (back.name, back.hash, back.radius) == (scene.name, scene.hash, scene.radius)
    assert dict(back.properties) == dict(scene.properties)
    assert [o.name for o in back.obstacles] == [o.name for o in scene.obstacles]
    for one, other in zip(scene.queries, back.queries, strict=True):
        assert (one.name, one.blocked, one.stratum) == (other.name, other.blocked, other.stratum)
        assert (
            one.start.tobytes() + one.goal.tobytes() == other.start.tobytes() + other.goal.tobytes()
        )
    assert pickle.dumps(as_bytes(back.arrangement)) == pickle.dumps(as_bytes(scene.arrangement))
    assert digest_of(pack_scene(back)) == digest_of(pack_scene(scene))


def as_bytes(arrangement):
    """All that an arrangement holds, as bytes and texts."""
    parts = (getattr(arrangement, f.name) for f in dataclasses.fields(arrangement))
    return [_as_bytes(part) for part in parts]


def _as_bytes(part):
    if isinstance(part, np.ndarray):
        return part.dtype.str, part.shape, part.tobytes()
    if isinstance(part, shapely.Geometry):
        return part.wkb_hex
    if isinstance(part, tuple | list):
        return [_as_bytes(each) for each in part]
    return repr(part)


NUMBERS = st.floats(-1e6, 1e6, allow_subnormal=False).map(lambda x: x + 0.0)


@given(NUMBERS, NUMBERS, st.floats(0.5, 1e3), st.floats(0.0, 6.3))
def test_so_does_one_of_any_coordinates(x, y, size, angle):
    room = shapely.box(x, y, x + 10 * size, y + 10 * size)
    block = shapely.affinity.rotate(
        shapely.box(x + 4 * size, y + 3 * size, x + 6 * size, y + 7 * size), angle, use_radians=True
    )
    scene = make_scene("any", room, [block], ((x + size, y + size), (x + 9 * size, y + 9 * size)))
    back = again(scene)
    assert back.hash == scene.hash
    assert shortest_path(back, back.query()).length == shortest_path(scene, scene.query()).length


def test_queries_that_are_blocked_or_of_a_stratum_stay_so_and_any_two_points_are_one():
    scene = make_scene(
        "map",
        shapely.box(0, 0, 10, 10),
        [shapely.box(4, 0, 6, 7)],
        {"inside": ((5, 5), (9, 9)), "free": ((1, 1), (9, 9))},
        strata={"free": "bucket 7"},
        keep_blocked=True,
    )
    back = again(scene)
    assert back.query("inside").blocked == scene.query("inside").blocked is not None
    assert (back.query("free").blocked, back.query("free").stratum) == (None, "bucket 7")
    assert back.query("1,1:9,2").goal.tolist() == [9.0, 2.0]


def test_a_map_without_queries_is_kept():
    scene = make_scene("map", shapely.box(0, 0, 10, 10), [], {})
    assert again(scene).queries == ()


def test_a_file_of_it_is_a_scene_and_is_not_grown_twice(tmp_path):
    scene = load_scene("clustered@radius=0.35")
    file = tmp_path / f"s{SUFFIX}"
    file.write_bytes(pack_scene(scene))
    assert load_scene(str(file)).hash == scene.hash != load_scene("clustered").hash


def test_what_is_in_it_is_geojson():
    collection = json.loads(text_of(pack_scene(load_scene("zigzag"))))
    assert collection["type"] == "FeatureCollection"
    roles = [feature["properties"]["role"] for feature in collection["features"]]
    assert (roles[0], roles[-2:]) == ("workspace", ["start", "goal"])


def test_what_is_damaged_is_refused():
    document = pack_scene(load_scene("zigzag"))
    text = text_of(document)
    first = json.loads(text)["features"][1]["geometry"]["coordinates"][0][0][0]
    other = text.replace(str(first), str(first + 0.125))
    assert other != text
    with pytest.raises(SceneError, match="here: the scene that it keeps as zigzag is damaged"):
        unpack_scene(zlib.compress(other.encode()), "here")
    with pytest.raises(SceneError, match="here: the scene that it keeps can't be read"):
        unpack_scene(document[:-9], "here")


def test_a_file_that_is_missing_is_said(tmp_path):
    with pytest.raises(SceneError, match=r"gone\.kept: can't be read"):
        load_scene(str(tmp_path / "gone.kept"))
