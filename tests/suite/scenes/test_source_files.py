"""Which files a scene is read from, and whether their bytes are what they were."""

import shutil

import pytest

from suite.scenes.catalogue import scene_file
from suite.scenes.source_files import files_digest


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "hall.yaml").write_text("image: 'grey/plan one.pgm'  # drawn\nresolution: 0.05\n")
    (tmp_path / "grey").mkdir()
    for name in ("hall.pgm", "grey/plan one.pgm", "city.map", "city.map.scen", "other.pgm"):
        (tmp_path / name).write_text(name)
    return tmp_path


@pytest.mark.parametrize(
    ("source", "changed", "differs"),
    [
        ("hall.yaml", "hall.yaml", True),
        ("hall.yaml", "grey/plan one.pgm", True),
        ("hall.yaml@radius=0.2,turn=3", "grey/plan one.pgm", True),
        ("hall.yaml", "other.pgm", False),
        ("city.map", "city.map.scen", True),
        ("city.map", "city.db", False),
        ("city.map", "hall.yaml", False),
    ],
)
def test_the_files_of_a_map_are_told_by_their_names(folder, source, changed, differs):
    before = files_digest(str(folder / source))
    with (folder / changed).open("a") as file:
        file.write("# more\n")
    assert (files_digest(str(folder / source)) != before) is differs


def test_it_is_the_same_wherever_they_lie(folder, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("there") / "maps"
    shutil.copytree(folder, elsewhere)
    assert files_digest(str(folder / "city.map")) == files_digest(str(elsewhere / "city.map"))


def test_scenes_of_the_catalogue_have_files_but_those_of_a_seed(tmp_path):
    assert files_digest("zigzag@twin=3") == files_digest(str(scene_file("zigzag")))
    assert files_digest("scattered_30-2") is files_digest(str(tmp_path / "gone.json")) is None
