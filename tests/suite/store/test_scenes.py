"""The scenes that a store keeps, and where its rows were asked to go."""

import itertools
import sqlite3
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest
import shapely

from suite.errors import StoreError
from suite.scenes.scene import make_scene, scene_fingerprint
from suite.store.merge import merge
from suite.store.read import read_runs
from suite.store.scenes import KeptScenes, ends_of_rows, read_queries
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

ROOM = shapely.box(0, 0, 100, 100)
BLOCKS = [shapely.box(10 * i, 10 * j, 10 * i + 5, 10 * j + 5) for i in range(10) for j in range(10)]
FROM, TO = np.meshgrid(np.arange(7.0, 97.0, 10.0), np.arange(7.0, 97.0, 10.0))


def city(queries=None, **changes):
    return make_scene("city", ROOM, changes.pop("blocks", BLOCKS), queries or {}, **changes)


def cells_of(scene, names, **changes):
    return [
        make_cell(
            scene=scene.name,
            scene_source="/nowhere/city.map",
            scene_hash=scene_fingerprint(scene, scene.query(name)),
            query=name,
            **changes,
        )
        for name in names
    ]


def filled(file, scene, cells):
    with open_store(file) as store:
        store.keep_scenes({scene.name: scene}, cells)
        store.begin_session({})
        for cell in cells:
            store.add(make_record(cell))
    return file


def count(file, table):
    with closing(sqlite3.connect(file)) as connection:
        return connection.execute(f"SELECT count(*) FROM {table}").fetchone()[0]


def size(file):
    with closing(sqlite3.connect(file)) as connection:
        connection.execute("VACUUM")
    return file.stat().st_size


def test_a_thousand_queries_of_a_map_keep_one_scene(tmp_path):
    scene, places = city(), [f"{x},{y}" for x, y in zip(FROM.flat, TO.flat, strict=True)]
    names = [f"{a}:{b}" for a, b in itertools.islice(itertools.permutations(places, 2), 1000)]
    cells = cells_of(scene, names)
    with open_store(tmp_path / "s.db") as store:
        store.keep_scenes({scene.name: scene}, cells[:1])
        one = size(tmp_path / "s.db")
        store.keep_scenes({scene.name: scene}, cells)
        store.keep_scenes({scene.name: scene}, cells)
    assert (count(tmp_path / "s.db", "scenes"), count(tmp_path / "s.db", "queries")) == (1, 1000)
    # Names, hashes and places; no tenth of what the rows of a single planner take.
    assert size(tmp_path / "s.db") - one < 1000 * 160


def test_rows_say_from_where_to_where_they_went(tmp_path):
    scene = city({"a": ((7, 7), (17, 7)), "b": ((7, 7), (97, 97))}, strata={"b": "bucket 3"})
    cells = cells_of(scene, ["b", "a", "8,8:9.25,8"])
    file = filled(tmp_path / "s.db", scene, [replace(c, position=i) for i, c in enumerate(cells)])
    runs = read_runs(file).set_index("key", drop=False)
    found = ends_of_rows(file, runs)
    assert found.index.tolist() == runs["key"].tolist()
    assert found[["start_x", "start_y", "goal_x", "goal_y"]].to_numpy().tolist() == [
        [7.0, 7.0, 97.0, 97.0],
        [7.0, 7.0, 17.0, 7.0],
        [8.0, 8.0, 9.25, 8.0],
    ]
    assert found["stratum"].tolist() == ["bucket 3", None, None]


def test_of_an_older_store_they_are_not_known(tmp_path):
    scene = city({"a": ((7, 7), (17, 7))})
    file = filled(tmp_path / "s.db", scene, cells_of(scene, ["a"]))
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.executescript("DROP TABLE queries; DROP TABLE scenes;")
    found = ends_of_rows(file)
    assert len(found) == 1
    assert found[["start_x", "goal_y"]].isna().all(axis=None)
    assert found["stratum"].tolist() == [None]
    assert read_queries(file).empty
    assert not KeptScenes(file).keeps(read_runs(file).to_dict("records")[0])


def test_each_row_has_the_scene_that_it_ran_on(tmp_path):
    before, now = city({"a": ((7, 7), (17, 7))}), city({"a": ((7, 7), (17, 7))}, blocks=BLOCKS[1:])
    file = filled(tmp_path / "s.db", before, cells_of(before, ["a"]))
    filled(file, now, cells_of(now, ["a"]))
    kept = KeptScenes(file)
    hashes = {row["scene_hash"]: kept.of(row)[0].hash for row in read_runs(file).to_dict("records")}
    assert list(hashes.values()) == [before.hash, now.hash]
    assert len(hashes) == 2


def test_two_scenes_of_one_geometry_have_their_own_names_and_queries(tmp_path):
    one, other = city({"a": ((7, 7), (17, 7))}), city({"b": ((7, 7), (17, 7))})
    file = filled(tmp_path / "s.db", one, cells_of(one, ["a"]))
    filled(file, other, cells_of(other, ["b"]))
    kept = KeptScenes(file)
    for row in read_runs(file).to_dict("records"):
        assert kept.of(row)[1].name == row["query"]


def test_merging_takes_scenes_along_and_leaves_those_that_are_there(tmp_path):
    scene = city({"a": ((7, 7), (17, 7))})
    told = city({"a": ((7, 7), (17, 7))}, properties={"description": "the same, told otherwise"})
    mine = filled(tmp_path / "mine.db", scene, cells_of(scene, ["a"]))
    its = filled(tmp_path / "its.db", told, cells_of(told, ["a", "8,8:9,8"], seed=5))
    with open_store(mine) as store:
        merge(store, [its])
    kept = KeptScenes(mine)
    rows = read_runs(mine).to_dict("records")
    found = {(row["query"], row["seed"]): dict(kept.of(row)[0].properties) for row in rows}
    assert found == {
        ("a", 0): {},
        ("a", 5): {},
        ("8,8:9,8", 5): {"description": "the same, told otherwise"},
    }
    assert count(mine, "scenes") == 2


def test_merging_from_an_older_store_takes_its_rows(tmp_path):
    scene = city({"a": ((7, 7), (17, 7))})
    its = filled(tmp_path / "its.db", scene, cells_of(scene, ["a"]))
    with closing(sqlite3.connect(its)) as connection, connection:
        connection.executescript("DROP TABLE queries; DROP TABLE scenes;")
    with open_store(tmp_path / "mine.db") as store:
        (merged,) = merge(store, [its])
    assert merged.added == 1


def test_a_damaged_scene_is_an_error_that_names_the_store(tmp_path):
    scene = city({"a": ((7, 7), (17, 7))})
    file = filled(tmp_path / "s.db", scene, cells_of(scene, ["a"]))
    (row,) = read_runs(file).to_dict("records")
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.execute("UPDATE scenes SET document = x'00'")
    with pytest.raises(StoreError, match=r"s\.db: the scene that it keeps can't be read"):
        KeptScenes(file).of(row)
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.execute("DELETE FROM scenes")
    with pytest.raises(StoreError, match=r"s\.db: the scene city of its rows is not in it"):
        KeptScenes(file).of(row)
