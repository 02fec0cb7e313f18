"""A results folder of a map: one picture of it, one of its queries, one CSV query by query."""

import json
from pathlib import Path

import pandas as pd
import pytest

from suite.report import results_folder
from suite.report.kinds import Part
from suite.report.results_folder import write_results
from tests.perf.many_queries import write_many

QUERIES, PLANNERS = 12, 2


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    store = write_many(folder, QUERIES, PLANNERS)
    written = write_results(store, folder / "out", leave_out={Part.COMPARISONS})
    return {file.name: file for file in written}


def test_a_map_and_its_queries_are_a_picture_each(files):
    assert [name for name in files if name.endswith(".png")] == ["queries.png", "yard.png"]


def test_each_planner_on_each_query_has_a_row_in_one_file(files):
    rows = pd.read_csv(files["queries.csv"])
    assert len(rows) == QUERIES * PLANNERS
    assert rows["query"].nunique() == QUERIES
    assert "queries.md" not in files


def test_every_other_table_is_short(files):
    tables = [file for name, file in files.items() if name.endswith(".csv")]
    long = [file.name for file in tables if len(pd.read_csv(file)) >= QUERIES * PLANNERS]
    assert long == ["queries.csv"]


def test_the_rows_name_no_folder_and_the_manifest_says_where_maps_come_in(files):
    sources = pd.read_parquet(files["runs.parquet"])["scene_source"]
    assert set(sources) == {Path(source).name for source in sources}
    made_by = json.loads(files["manifest.json"].read_text())["made_by"]
    assert made_by[0].endswith(" --maps MAPS --store STORE")


def test_pictures_of_maps_and_long_tables_can_be_left_out(tmp_path, monkeypatch):
    monkeypatch.setattr(results_folder, "LONG", 1000)  # bytes: twelve queries are no long table yet
    store = write_many(tmp_path, QUERIES, PLANNERS)
    parts = {Part.COMPARISONS, Part.SCENE_PICTURES, Part.LONG_TABLES}
    names = {file.name for file in write_results(store, tmp_path / "out", leave_out=parts)}
    assert [name for name in names if name.endswith(".png")] == ["queries.png"]
    assert "maps.csv" in names
    assert "queries.csv" not in names
