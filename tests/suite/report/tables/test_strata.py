"""The table of strata: each planner on the easy and on the hard queries of a map."""

import math

import numpy as np
import pytest
import shapely

from suite.report.all_tables import read_tables
from suite.report.statistics.over_queries import only_maps, query_measures
from suite.report.tables.strata import MOST_ON_PAGE, strata_table
from suite.scenes.scene import make_scene, scene_fingerprint
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record
from tests.suite.report.map_rows import asked
from tests.suite.report.measured_rows import steps


def table_of(records, strata):
    """Of records of the map ``town``, whose queries are of these strata."""
    found = steps(*records)
    named = [strata.get(query) for query in found.runs["query"]]
    found.runs["stratum"] = np.array(named, dtype=object)
    shown = only_maps(found)
    return strata_table(shown, query_measures(shown))


STRATA = {f"q{i}": "2" if i < 4 else "10" for i in range(6)}


def town(planner="kbga", costs=(101.0, 102.0, 103.0, 109.0, 100.0, None), **more):
    return [asked(planner, f"q{i}", cost, **more) for i, cost in enumerate(costs)]


def test_each_stratum_of_a_map_has_a_row_for_each_planner_the_smaller_number_first():
    frame = table_of([*reversed(town()), *town("prm")], STRATA).frame
    assert list(zip(frame["stratum"], frame["planner"], strict=True)) == [
        ("2", "kbga"),
        ("2", "prm"),
        ("10", "kbga"),
        ("10", "prm"),
    ]
    assert set(frame["scene"]) == {"town"}


def test_gaps_and_counts_are_those_of_the_stratum_alone():
    easy, hard = table_of(town(), STRATA).frame.to_dict("records")
    assert (easy["queries"], easy["solved"], easy["optimum (m)"]) == (4, 4, 100.0)
    assert easy["gap median (%)"] == pytest.approx(2.0)
    assert easy["gap 95th (%)"] == easy["gap worst (%)"] == pytest.approx(9.0)
    assert (hard["queries"], hard["solved"], hard["gap worst (%)"]) == (2, 1, 0.0)


def test_the_95th_percentile_leaves_out_one_in_twenty():
    costs = [100.0 + i for i in range(1, 21)]
    (row,) = table_of(town(costs=costs), dict.fromkeys(map("q{}".format, range(20)), "1")).frame[
        ["gap 95th (%)", "gap worst (%)"]
    ].to_numpy()  # fmt: skip
    assert row == pytest.approx([19.0, 20.0])


def test_times_are_medians_over_the_queries():
    easy, hard = table_of(town(), STRATA).frame.to_dict("records")
    assert easy["to best (ms)"] == pytest.approx(2.0)
    # Two of four queries never came within 2 %.
    assert easy["to 2 % (ms)"] == math.inf
    assert hard["to 2 % (ms)"] == math.inf
    assert hard["to best (ms)"] == pytest.approx(2.0)


def test_runs_without_a_core_of_their_own_have_cpu_time_alone_and_are_counted():
    table = table_of(town(contended=True), STRATA)
    assert table.frame[["to best (ms)", "to 2 % (ms)"]].isna().all(axis=None)
    assert "Times leave out 6 of 6 runs" in table.note
    apart = table_of(town(), STRATA).frame["cpu to best (ms)"]
    assert table.frame["cpu to best (ms)"].equals(apart)


def test_a_query_weighs_the_same_however_many_seeds_it_had():
    more = [asked("kbga", "q3", 109.0, seed) for seed in range(1, 9)]
    assert table_of([*town(), *more], STRATA).frame.equals(table_of(town(), STRATA).frame)


def test_queries_of_no_stratum_are_in_no_row():
    frame = table_of(town(), {"q0": "easy"}).frame
    assert frame[["stratum", "queries"]].to_numpy().tolist() == [["easy", 1]]


def test_without_strata_there_is_no_table():
    assert table_of(town(), {}) is None
    found = steps(*town())
    assert strata_table(found, query_measures(found)) is None


def test_a_table_of_many_strata_is_a_file_alone():
    costs = [101.0] * (MOST_ON_PAGE + 1)
    strata = {f"q{i}": str(i) for i in range(len(costs))}
    assert not table_of(town(costs=costs), strata).on_page
    few = table_of(town(costs=costs[1:]), strata)
    assert few.on_page
    assert few.detail


def test_the_strata_come_out_of_the_scene_that_the_store_keeps(tmp_path):
    ends = {f"{i // 3}-{i}": ((1, 1), (9, 1 + i)) for i in range(6)}
    scene = make_scene(
        "hall", shapely.box(0, 0, 10, 10), [], ends, strata={name: name[0] for name in ends}
    )
    cells = [
        make_cell(scene="hall", scene_source="/nowhere/hall.map", query=q.name,
                  scene_hash=scene_fingerprint(scene, q))
        for q in scene.queries
    ]  # fmt: skip
    with open_store(tmp_path / "s.db") as store:
        store.keep_scenes({"hall": scene}, cells)
        store.begin_session({})
        for cell in cells:
            store.add(make_record(cell))
    (table,) = (t for t in read_tables(tmp_path / "s.db") if t.name == "maps-strata")
    assert table.frame[["stratum", "queries"]].to_numpy().tolist() == [["0", 3], ["1", 3]]
