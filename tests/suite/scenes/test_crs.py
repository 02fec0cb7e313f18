"""Coordinates of a scene are metres in the plane: what a file says else of them is refused."""

import json

import pytest

from suite.errors import SceneError
from suite.scenes.crs import check_crs
from suite.scenes.geojson import read_scene, write_scene


def named(name: str) -> dict:
    return {"type": "name", "properties": {"name": name}}


@pytest.mark.parametrize(
    "name",
    [
        "urn:ogc:def:crs:EPSG::32632",  # as geopandas and ogr2ogr write UTM
        "urn:ogc:def:crs:EPSG:8.5:25832",
        "urn:x-ogc:def:crs:EPSG:32737",
        "EPSG:3857",
        "epsg:2154",
        "http://www.opengis.net/def/crs/EPSG/0/27700",
        "https://www.opengis.net/def/crs/EPSG/0/2056",
        "urn:ogc:def:crs:EPSG::5555",  # UTM and heights
    ],
)
def test_planar_metres_are_taken_by_any_of_their_names(name):
    check_crs(named(name))


@pytest.mark.parametrize(
    "name",
    [
        "urn:ogc:def:crs:OGC:1.3:CRS84",  # what geopandas assumes, and so writes, without a crs
        "urn:ogc:def:crs:OGC::CRS84",
        "urn:ogc:def:crs:EPSG::4326",
        "EPSG:4258",
        "EPSG:2263",  # feet
        "EPSG:4978",  # geocentric
        "EPSG:5773",  # heights
        "EPSG:99999",  # none
        "urn:ogc:def:crs:ESRI::54009",
        "local",
        "",
    ],
)
def test_any_other_is_refused_and_how_to_mend_it_said(name):
    with pytest.raises(
        SceneError, match=r"not known to be planar and in metres\. Project the file"
    ):
        check_crs(named(name))


@pytest.mark.parametrize("bad", [5, "EPSG:32632", {}, {"type": "link", "properties": {}}, [1]])
def test_a_crs_that_names_none_is_refused(bad):
    with pytest.raises(SceneError, match="names none"):
        check_crs(bad)


@pytest.fixture
def hall(wall_file, tmp_path):
    """Write the scene with a wall with a crs."""

    def write(crs):
        file = tmp_path / "hall.geojson"
        file.write_text(json.dumps(json.loads(wall_file.read_text()) | {"crs": crs}))
        return file

    return write


def test_a_crs_of_metres_is_kept_when_the_scene_is_written_again(hall, tmp_path):
    utm = named("urn:ogc:def:crs:EPSG::32632")
    scene = read_scene(hall(utm))
    write_scene(scene, tmp_path / "again.geojson")
    document = json.loads((tmp_path / "again.geojson").read_text())
    assert document["crs"] == utm
    assert "crs" not in document["properties"]
    again = read_scene(tmp_path / "again.geojson")
    assert (again.hash, dict(again.properties)) == (scene.hash, dict(scene.properties))


def test_a_crs_of_degrees_is_refused_with_the_file(hall):
    with pytest.raises(SceneError, match=r"hall\.geojson: its crs 'EPSG:4326' is not known"):
        read_scene(hall(named("EPSG:4326")))


def test_a_crs_that_is_null_is_left_out(hall):
    assert "crs" not in read_scene(hall(None)).properties
