"""A matrix takes the maps of a folder for scenes, which it names, or the command that runs it."""

from dataclasses import asdict

import pytest

from suite.errors import MatrixError
from suite.harness.matrix import load_matrix
from suite.plugins.discovery import load_planner

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


def test_settings_are_tuned_on_other_queries_of_the_same_maps(maps):
    asked, tuning = (load_matrix(name, maps=[maps]) for name in ("real-maps", "real-maps-tuning"))
    assert [len(queries) for queries in tuning.queries] == [10, 10]
    for ours, theirs in zip(asked.queries, tuning.queries, strict=True):
        assert {query.name for query in ours}.isdisjoint(query.name for query in theirs)


def test_what_is_called_tuned_was_a_candidate_beside_the_planner_as_it_comes(maps):
    asked, tuning = (load_matrix(name, maps=[maps]) for name in ("real-maps", "real-maps-tuning"))
    tuned = [v for v in asked.variants if v.name.endswith("-tuned")]
    candidates = {v.name: (v.plugin.name, v.settings) for v in tuning.variants}
    assert {v.plugin.name for v in tuned} == {planner for planner, _ in candidates.values()}
    assert all((v.plugin.name, v.settings) in candidates.values() for v in tuned)
    defaults = {v.plugin.name: asdict(load_planner(v.plugin.name).Settings()) for v in tuned}
    assert all(candidates[name] == (name, settings) for name, settings in defaults.items())


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
