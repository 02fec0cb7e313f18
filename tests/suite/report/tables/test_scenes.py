"""The table of scenes: how large they are, and what preparing them and their optima took."""

import sqlite3
from contextlib import closing

import pandas as pd
import pytest
import shapely

from suite.report.all_tables import all_tables, read_tables
from suite.report.tables.scenes import scenes_table
from suite.scenes.scene import make_scene, scene_fingerprint
from suite.store.read import read_runs
from suite.store.scenes import sizes_of_scenes
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record
from tests.suite.report.map_rows import asked, blocked
from tests.suite.report.measured_rows import frames_of

UNKNOWN = pd.DataFrame(columns=["scene", "vertices", "obstacles", "free_share"])


def table_of(*records, sizes=UNKNOWN):
    return scenes_table(frames_of(*records)[0], sizes)


def row_of(*records, sizes=UNKNOWN):
    (row,) = table_of(*records, sizes=sizes).frame.to_dict("records")
    return row


def took(query, exact_s, planner="kbga", prepare_s=0.5, **more):
    return asked(planner, query, 101.0, exact_s=exact_s, prepare_s=prepare_s, **more)


def test_the_optimum_of_each_query_counts_once_whoever_asked_and_how_often():
    records = [took("a", 0.001), took("b", 0.003), took("c", 0.020)]
    records += [took("c", 0.020, seed=seed) for seed in range(1, 5)] + [took("c", 0.02, "prm")]
    row = row_of(*records)
    assert (row["scene"], row["queries"]) == ("town", 3)
    assert row["exact median (ms)"] == pytest.approx(3.0)
    assert row["exact worst (ms)"] == pytest.approx(20.0)
    assert row["prepare (ms)"] == pytest.approx(500.0)


def test_queries_that_cannot_be_asked_are_none_of_it():
    assert row_of(took("a", 0.001), blocked("kbga", "gate"))["queries"] == 1


def test_what_the_rows_do_not_say_is_empty_and_a_table_of_nothing_is_none():
    row = row_of(took("a", None), took("b", None))
    assert row["prepare (ms)"] == pytest.approx(500.0)
    assert pd.isna(row["exact median (ms)"])
    assert pd.isna(row["vertices"])
    assert table_of(took("a", None, prepare_s=None)) is None
    assert "keeps no drawing of 1 scene" in table_of(took("a", 0.1)).note


@pytest.fixture
def store(tmp_path):
    """Of a scene of two obstacles that overlap, in a room of 100 m2, and of another one."""
    room, boxes = shapely.box(0, 0, 10, 10), [shapely.box(2, 2, 4, 4), shapely.box(3, 2, 5, 4)]
    ends = {"a": ((1, 1), (9, 1)), "b": ((1, 1), (9, 9))}
    scenes = {
        "hall": make_scene("hall", room, boxes, ends),
        "yard": make_scene("yard", room, boxes[:1], ends),
    }
    cells = [
        make_cell(scene=scene.name, scene_source="/nowhere/hall.map", query=query.name,
                  scene_hash=scene_fingerprint(scene, query))
        for scene in scenes.values()
        for query in scene.queries
    ]  # fmt: skip
    with open_store(tmp_path / "s.db") as writer:
        writer.keep_scenes(scenes, cells)
        writer.begin_session({})
        for cell in cells:
            writer.add(make_record(cell, prepare_s=0.25, exact_s=0.002))
    return tmp_path / "s.db"


def test_sizes_come_from_the_scenes_that_a_store_keeps_without_their_files(store):
    (table,) = (t for t in read_tables(store) if t.name == "scenes")
    frame = table.frame.set_index("scene")
    assert list(frame.index) == ["hall", "yard"]
    columns = ["vertices", "obstacles", "free (%)", "queries", "prepare (ms)", "exact worst (ms)"]
    assert frame.loc["hall", columns].tolist() == [8, 2, pytest.approx(94.0), 2, 250.0, 2.0]
    assert frame.loc["yard", columns[:3]].tolist() == [4, 1, pytest.approx(96.0)]


def test_a_scene_that_can_not_be_read_has_no_size_and_stops_no_table(store):
    with closing(sqlite3.connect(store)) as connection, connection:
        connection.execute(
            "UPDATE scenes SET document = x'00' WHERE digest = "
            "(SELECT digest FROM queries WHERE scene = 'hall' LIMIT 1)"
        )
    assert sizes_of_scenes(store, read_runs(store))["scene"].tolist() == ["yard"]
    (table,) = (t for t in read_tables(store) if t.name == "scenes")
    assert table.frame["vertices"].isna().tolist() == [True, False]


def test_without_the_scenes_there_is_no_table(store):
    assert "scenes" not in {table.name for table in all_tables(read_runs(store))}
