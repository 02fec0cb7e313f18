"""A matrix takes the maps of a folder for scenes, which it names, or the command that runs it."""

import pytest

from suite.errors import MatrixError
from suite.harness.matrix import load_matrix

ROOM = "POLYGON ((0 0, 20 0, 20 2, 18 2, 18 1, 0 1, 0 0))"
YARD = "MULTIPOLYGON (((0 0, 30 0, 30 1, 0 1, 0 0)), ((9 5, 20 5, 20 30, 9 30, 9 5)))"

MATRIX = """
{scenes}
{queries}
seeds = 1

[[planner]]
planner = "visibility-graph"
"""


@pytest.fixture
def maps(tmp_path):
    folder = tmp_path / "maps"
    folder.mkdir()
    (folder / "room.wkt").write_text(ROOM)
    (folder / "yard.wkt").write_text(YARD)
    return folder


@pytest.fixture
def matrix_of(tmp_path):
    def write(scenes, queries="queries = { random = 3, seed = 1 }"):
        (tmp_path / "m.toml").write_text(MATRIX.format(scenes=scenes, queries=queries))
        return tmp_path / "m.toml"

    return write


def test_a_folder_stands_for_its_maps_with_its_modifiers(maps, matrix_of):
    found = load_matrix(matrix_of('scenes = ["maps@radius=0.3"]'))
    assert [scene.name for scene in found.scenes] == ["room@radius=0.3", "yard@radius=0.3"]
    assert [len(queries) for queries in found.queries] == [3, 3]
    assert len(found.cells()) == 6


def test_the_command_adds_a_folder_to_the_scenes(maps, matrix_of):
    alone = load_matrix(matrix_of(""), maps=[maps])
    assert [scene.name for scene in alone.scenes] == ["room", "yard"]
    beside = load_matrix(matrix_of('scenes = ["zigzag"]'), maps=[maps])
    assert [scene.name for scene in beside.scenes] == ["zigzag", "room", "yard"]


def test_the_matrix_of_real_maps_asks_a_hundred_queries_of_each(maps):
    found = load_matrix("real-maps", maps=[maps])
    assert [len(queries) for queries in found.queries] == [100, 100]
    assert all(query.blocked is None for queries in found.queries for query in queries)


def test_without_any_scene_it_says_what_to_give(matrix_of):
    with pytest.raises(MatrixError, match=r"none\. Name some, or a folder of maps with --maps"):
        load_matrix(matrix_of(""))


def test_what_is_wrong_with_the_maps_of_the_command_is_an_error_in_words(maps, matrix_of, tmp_path):
    alone = matrix_of("")
    with pytest.raises(MatrixError, match=r"m\.toml, --maps: .*nowhere: is no folder"):
        load_matrix(alone, maps=[tmp_path / "nowhere"])
    with pytest.raises(MatrixError, match=r"m\.toml, scenes: room: is a map without queries"):
        load_matrix(matrix_of("", queries=""), maps=[maps])
    (maps / "spoiled.map").write_text("type octile")
    with pytest.raises(MatrixError, match=r"m\.toml, scenes: '.*spoiled\.map': spoiled\.map"):
        load_matrix(alone, maps=[maps])
