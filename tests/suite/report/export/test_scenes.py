"""The scenes of a store, taken out of it as files."""

import pytest
import shapely

from suite.errors import StoreError
from suite.report.export.scenes import write_scenes
from suite.scenes.catalogue import load_scene
from suite.scenes.scene import make_scene, scene_fingerprint
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record


@pytest.fixture
def store(tmp_path):
    def fill(*scenes):
        with open_store(tmp_path / "s.db") as opened:
            opened.begin_session({})
            for number, scene in enumerate(scenes):
                for query in scene.queries:
                    fingerprint = scene_fingerprint(scene, query)
                    names = {"scene": scene.name, "query": query.name, "scene_hash": fingerprint}
                    cell = make_cell(**names, position=number)
                    opened.keep_scenes({scene.name: scene}, [cell])
                    opened.add(make_record(cell))
        return tmp_path / "s.db"

    return fill


@pytest.mark.parametrize("name", ["zigzag", "door", "clustered@radius=0.35", "maze@turn=17"])
def test_a_scene_that_is_taken_out_is_the_one_that_rows_ran_on(store, tmp_path, name):
    scene = load_scene(name)
    (file,) = write_scenes(store(scene), tmp_path / "out")
    assert file == tmp_path / "out" / f"{name}.geojson"
    again = load_scene(file)
    assert (again.name, again.hash) == (scene.name, scene.hash)
    assert again.query().goal.tolist() == scene.query().goal.tolist()


def test_two_scenes_of_one_name_are_two_files_and_blocked_queries_are_in_none(store, tmp_path):
    ends = {"free": ((1, 1), (9, 9)), "blocked": ((5, 5), (9, 9))}
    room, block = shapely.box(0, 0, 10, 10), shapely.box(4, 4, 6, 6)
    before, now = (
        make_scene("a/b", room, [shape], ends, keep_blocked=True)
        for shape in (block, shapely.box(4, 4, 6, 6.5))
    )
    files = write_scenes(store(before, now), tmp_path)
    assert [file.name for file in files] == ["a_b.geojson", f"a_b-{now.hash}.geojson"]
    assert [[q.name for q in load_scene(file).queries] for file in files] == [["free"]] * 2


def test_a_store_that_keeps_none_says_how_to_mend_it(tmp_path):
    with open_store(tmp_path / "s.db") as opened:
        opened.begin_session({})
        opened.add(make_record())
    with pytest.raises(StoreError, match=r"s\.db: it keeps no scenes\. Run its matrix again"):
        write_scenes(tmp_path / "s.db", tmp_path / "out")
    assert not (tmp_path / "out").exists()
