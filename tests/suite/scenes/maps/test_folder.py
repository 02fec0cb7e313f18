"""A folder stands for its maps: what belongs to a map is no map of its own."""

import pytest

from suite.errors import SceneError
from suite.scenes.maps.folder import maps_in

BESIDE = [
    *("a.map", "a.map.scen"),
    *("b.map", "b.scen"),
    *("c.mesh", "c.mesh.scen"),
    *("room.yaml", "room.pgm"),
    *("plan.png", "lone.scen", "d.geojson", "e.svg"),
    *("README.md", "d.json", "f.txt"),
]


@pytest.fixture
def folder(tmp_path):
    for name in BESIDE:
        (tmp_path / name).write_text("")
    (tmp_path / "room.yaml").write_text("image: 'room.pgm'  # beside it\nresolution: 0.1\n")
    (tmp_path / "more.map").mkdir()
    return tmp_path


def test_of_files_that_belong_together_one_stands_for_the_map(folder):
    assert [path.name for path in maps_in(folder)] == [
        *("a.map", "b.map", "c.mesh", "d.geojson", "e.svg"),
        *("lone.scen", "plan.png", "room.yaml"),
    ]


def test_a_folder_without_maps_and_what_is_no_folder_are_refused(folder, tmp_path):
    (tmp_path / "empty").mkdir()
    with pytest.raises(SceneError, match=r"empty: has no maps\. Understood are \.geojson"):
        maps_in(tmp_path / "empty")
    with pytest.raises(SceneError, match=r"a\.map: is no folder\. Name one with maps in it\."):
        maps_in(folder / "a.map")
