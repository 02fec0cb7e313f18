"""`import` brings a map in by one command, says what it found, and never writes half of it."""

import json

import pytest

from suite.scenes.catalogue import load_scene
from suite.scenes.geojson import read_scene
from tests.suite.scenes.maps.drawings import svg
from tests.suite.scenes.maps.files import write_grid, write_ros
from tests.suite.scenes.maps.test_mesh import OPEN_3, SCEN
from tests.suite.scenes.real_maps import FOLDER, MISSING, REASON
from tests.suite.test_cli import error_of, kbga_bench

__all__ = ["error_of", "kbga_bench"]  # fixtures

HALL = svg('<path d="M110 20 h20 v300 h-20 z"/><circle cx="300" cy="200" r="40"/>')


@pytest.fixture
def hall(tmp_path):
    file = tmp_path / "hall.svg"
    file.write_text(HALL)
    return file


def test_a_map_is_written_as_the_scene_that_it_is(kbga_bench, hall, tmp_path):
    file = tmp_path / "hall.geojson"
    done = kbga_bench("import", hall, "-o", file)
    assert done.out.splitlines() == [
        "hall: 2 obstacles of 76 vertices in 400 x 300 m, 90.8 % free in 2 regions that no path "
        "joins; no queries",
        str(file),
    ]
    assert read_scene(file).hash == load_scene(hall).hash
    assert read_scene(file).queries == ()


def test_its_options_are_modifiers_of_the_name(kbga_bench, hall, tmp_path):
    file = tmp_path / "hall.geojson"
    options = ("--scale", 0.05, "--radius", "0.3", "--threshold", 0.5, "--simplify", 1)
    kbga_bench("import", hall, *options, "-o", file)
    modified = f"{hall}@threshold=0.5,simplify=1,scale=0.05,radius=0.3"
    again, scene = read_scene(file), load_scene(modified)
    assert (again.hash, again.name, again.radius) == (scene.hash, scene.name, 0.3)
    kbga_bench("import", modified, "-o", tmp_path / "other.geojson")
    assert (tmp_path / "other.geojson").read_text() == file.read_text()


def test_queries_come_along_blocked_ones_too(kbga_bench, tmp_path):
    (tmp_path / "level.mesh").write_text(OPEN_3)
    (tmp_path / "level.scen").write_text(SCEN.format(8.94427190999916))
    file = tmp_path / "level.geojson"
    done = kbga_bench("import", tmp_path / "level.mesh", "-o", file, "--format", "json")
    told = json.loads(done.out)
    assert (told["queries"], told["blocked"], told["free_share"]) == (2, 1, 0.75)
    assert done.err.strip() == str(file)
    found = json.loads(kbga_bench("exact", file, "--query", "0-1", "--format", "json").out)
    assert found["optimum"] == pytest.approx(8.94427190999916)


def test_grids_of_both_kinds_are_imported(kbga_bench, tmp_path):
    grid, ros = write_grid(tmp_path), write_ros(tmp_path)
    kbga_bench("import", grid, "-o", tmp_path / "grid.geojson")
    assert len(read_scene(tmp_path / "grid.geojson").queries) == 3
    kbga_bench("import", ros, "--unknown", "free", "-o", tmp_path / "ros.geojson")
    assert read_scene(tmp_path / "ros.geojson").hash == load_scene(f"{ros}@unknown=free").hash


def test_a_planner_runs_on_what_was_imported_and_on_the_map_itself(kbga_bench, hall, tmp_path):
    file = tmp_path / "hall.geojson"
    kbga_bench("import", hall, "-o", file)
    plan = ("--planner", "visibility-graph", "--start", "200,20", "--goal", "350,250")
    lengths = [
        json.loads(kbga_bench("plan", scene, *plan, "--format", "json").out)["cost"]
        for scene in (file, hall)
    ]
    assert lengths[0] == lengths[1] > 274.0


def test_what_is_there_is_overwritten_only_by_a_map_that_could_be_read(error_of, hall, tmp_path):
    file = tmp_path / "hall.geojson"
    file.write_text("mine")
    hall.write_text(HALL.replace("</svg>", ""))
    assert "hall.svg: no XML" in error_of("import", hall, "-o", file)
    assert "Missing option '--output'" in error_of("import", hall)
    assert file.read_text() == "mine"


def test_a_map_is_not_written_over_itself(error_of, tmp_path):
    file = tmp_path / "houses.geojson"
    file.write_text("mine")
    assert "is the map itself. Name another file." in error_of("import", file, "-o", file)
    assert "scene files are .geojson, .json" in error_of("import", file, "-o", tmp_path / "a.svg")
    assert file.read_text() == "mine"


def test_an_unknown_suffix_is_answered_with_what_is_understood(error_of, tmp_path):
    file = tmp_path / "hall.step"
    file.write_text("ISO-10303-21;")
    for name in (file, "hall.step"):
        error = error_of("exact", name)
        assert "no format of maps has the suffix '.step'" in error
        for told in (".geojson, .json (scene files)", ".mesh (polygon meshes)", ".yaml, .yml (ROS"):
            assert told in error


@pytest.mark.skipif(MISSING, reason=REASON)
@pytest.mark.parametrize(
    ("name", "obstacles", "queries"),
    [
        ("arena.map", 6, 160),
        ("Denver_1_256.map", 60, 830),
        ("tb3_sandbox.yaml", 10, 0),
        ("warehouse.svg", 88, 0),
        ("ironharvest_scene_mp_2p_01.mesh", 274, 2000),
    ],
)
def test_each_public_map_is_imported_by_one_command(kbga_bench, tmp_path, name, obstacles, queries):
    file = tmp_path / "map.geojson"
    told = json.loads(kbga_bench("import", FOLDER / name, "-o", file, "--format", "json").out)
    assert (told["obstacles"], told["queries"], told["blocked"]) == (obstacles, queries, 0)
    assert read_scene(file).hash == told["hash"]
