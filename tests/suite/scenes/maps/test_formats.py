"""A map is read by its suffix."""

from pkgutil import resolve_name

import pytest

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.maps.formats import FORMATS
from suite.scenes.maps.options import OPTIONS
from suite.scenes.maps.suffixes import MAP_SUFFIXES
from tests.suite.scenes.maps.files import write_grid, write_ros


def test_the_suffixes_by_which_a_map_is_told_are_those_that_can_be_read():
    assert sorted(MAP_SUFFIXES) == sorted(FORMATS)


@pytest.mark.parametrize("form", sorted(set(FORMATS.values()), key=lambda form: form.name))
def test_each_format_has_a_reader_and_heeds_options_that_there_are(form):
    assert callable(resolve_name(form.reader))
    assert set(form.options) <= set(OPTIONS)


def test_obstacles_only_grow_when_a_map_is_simplified(tmp_path):
    for file, room in ((write_grid(tmp_path), 50.0), (write_ros(tmp_path), 20.0)):
        exact, coarse = load_scene(str(file)), load_scene(f"{file}@simplify=3")
        assert exact.workspace.area == room
        assert coarse.vertex_count <= exact.vertex_count
        assert exact.arrangement.solid.difference(coarse.arrangement.solid).area < 1e-9
    assert load_scene(f"{write_grid(tmp_path)}@simplify=3").vertex_count < 40


def test_an_option_that_says_nothing_of_a_format_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"unknown says nothing of Moving AI's grids\. It heeds"):
        load_scene(f"{write_grid(tmp_path)}@unknown=free")


def test_a_map_that_is_not_there_is_named(tmp_path):
    with pytest.raises(SceneError, match=r"none\.yaml: can't be read \(there is no such file\)"):
        load_scene(str(tmp_path / "none.yaml"))
