"""GeoJSON that knows no roles is a map of obstacles, if its coordinates are metres."""

import json

import pytest
import shapely
from shapely.geometry import mapping

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.scene import SceneWarning

METRES = {"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}}
HOUSES = [
    shapely.box(691600, 5334700, 691620, 5334730),
    shapely.box(691640, 5334750, 691650, 5334760),
]
FEW = [shapely.box(11.5, 48.1, 11.6, 48.2)]


def document(shapes, **members) -> dict:
    features = [
        {"type": "Feature", "properties": {"height": 9}, "geometry": mapping(s)} for s in shapes
    ]
    return {"type": "FeatureCollection", "features": features, **members}


BROKEN = {
    "type": "FeatureCollection",
    "features": [
        {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1]]]}}
    ],
}


@pytest.fixture
def load(tmp_path):
    def write_and_load(content, modifiers=""):
        file = tmp_path / "houses.geojson"
        file.write_text(json.dumps(content))
        return load_scene(f"{file}{modifiers}")

    return write_and_load


def test_its_polygons_are_the_obstacles(load):
    scene = load(document(HOUSES, **METRES))
    assert [o.polygon.area for o in scene.obstacles] == [600.0, 100.0]
    assert scene.bounds == (691600.0, 5334700.0, 691650.0, 5334760.0)
    assert scene.queries == ()


def test_it_is_modified_as_any_map(load):
    scene = load(document(HOUSES, **METRES), "@radius=1,turn=90")
    assert scene.radius == 1.0
    assert scene.bounds[2] - scene.bounds[0] == pytest.approx(58.0, abs=1e-6)


def test_numbers_too_large_for_degrees_are_metres(load):
    assert load(document(HOUSES)).hash == load(document(HOUSES, **METRES)).hash


def test_a_point_among_them_is_left_out(load):
    with pytest.warns(SceneWarning, match="1 point left out"):
        load(document([*HOUSES, shapely.Point(0, 0)], **METRES))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (document(FEW), r"degrees \('OGC:CRS84'\).* -t_srs EPSG:32632 metres\.gpkg houses\.geoj"),
        (document(FEW, crs={"type": "name", "properties": {"name": "EPSG:4326"}}), "Project the"),
        (document([shapely.Point(0, 0)]), r"houses\.geojson: holds 1 point, and no polygon"),
        (BROKEN, r"houses\.geojson, feature 1: its geometry can't be read"),
    ],
)  # fmt: skip
def test_what_can_not_be_a_map_says_why(load, content, message):
    with pytest.raises(SceneError, match=message):
        load(content)


def test_a_role_anywhere_makes_it_a_scene_file_with_its_errors(load):
    content = document(HOUSES, **METRES)
    content["features"][1]["properties"]["role"] = "obstacle"
    with pytest.raises(SceneError, match=r"feature 1: has no role\. Set properties\.role"):
        load(content)
    with pytest.raises(SceneError, match="0 workspaces"):
        load(document([]))
