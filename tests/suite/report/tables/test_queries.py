"""The tables of maps: one row for each map and planner, over its queries."""

import math

import numpy as np
import pytest

from suite.report.all_tables import all_tables
from suite.report.tables.queries import map_tables
from tests.suite.report.map_rows import asked, blocked
from tests.suite.report.measured_rows import frames_of, measured, steps

COSTS = [100.0, 101.0, 102.0, 103.0, 109.0]


def town(planner="kbga", costs=COSTS, **more):
    return [asked(planner, f"q{i}", cost, **more) for i, cost in enumerate(costs)]


def tables_of(*records):
    runs, _ = frames_of(*records)
    found = map_tables(steps(*records), runs, np.random.default_rng(0))
    return {table.name: table.frame for table in found}


def row_of(*records, planner="kbga"):
    return tables_of(*records)["maps-rows"].set_index("planner").loc[planner]


def test_a_map_and_planner_have_one_row_however_many_queries_and_seeds():
    found = tables_of(*town(), *town(seed=1), *town("prm"))
    assert list(found["maps"]["planner"]) == ["kbga", "prm"]
    assert set(found["maps"]["scene"]) == {"town"}


def test_gaps_are_told_over_queries():
    row = row_of(*town())
    assert row["gap median (%)"] == pytest.approx(2.0)
    assert row["gap mean (%)"] == pytest.approx(3.0)
    assert row["gap 90th (%)"] == row["gap 99th (%)"] == row["gap worst (%)"] == pytest.approx(9.0)
    assert 0.0 < row["low (%)"] < 3.0 < row["high (%)"] <= 9.0


def test_a_query_weighs_the_same_however_many_seeds_it_had():
    more = [asked("kbga", "q4", 109.0, seed) for seed in range(1, 9)]
    assert row_of(*town(), *more)["gap mean (%)"] == pytest.approx(3.0)


def test_the_same_rows_give_the_same_intervals():
    assert tables_of(*town())["maps"].equals(tables_of(*town())["maps"])


def test_a_query_without_path_is_counted_and_is_in_no_gap():
    row = row_of(*town(costs=[*COSTS, None]))
    assert (row["solved"], row["with path"]) == ("5 of 6", 5)
    assert row["success (%)"] == pytest.approx(100.0 * 5 / 6)
    assert row["gap mean (%)"] == pytest.approx(3.0)


def test_a_time_is_never_where_half_of_the_queries_or_more_did_not_come_so_near():
    row = row_of(*town())
    assert row["to 5 % (ms)"] == pytest.approx(2.0)
    assert row["to 2 % (ms)"] == pytest.approx(2.0)
    assert row["to 1 % (ms)"] == math.inf
    assert row_of(*town(costs=[100.0, 100.0, None, None, None]))["to 5 % (ms)"] == math.inf


def test_queries_that_cannot_be_asked_are_told_beside_and_are_nobodys_failure():
    records = [*town(), *town("prm"), blocked("kbga", "gate"), blocked("prm", "gate")]
    runs, events = frames_of(*records)
    tables = {table.name: table for table in all_tables(runs, events=events)}
    maps = tables["maps"].frame.set_index("planner").loc["kbga"]
    assert (maps["solved"], maps["blocked"]) == ("5 of 5", 1)
    assert list(tables["summary"].frame["runs"]) == [5, 5]
    assert "2 rows of 1 query that can't be asked" in tables["summary"].note
    assert "blocked" not in tables_of(*town())["maps"]


def test_planners_are_compared_query_by_query():
    better, worse = town("kbga"), town("prm", [cost + 1.0 for cost in COSTS[:4]] + [None])
    row = tables_of(*better, *worse)["maps-paired"].iloc[0]
    assert (row["planner"], row["queries"]) == ("prm", 5)
    assert (row["better"], row["equal"], row["worse"]) == (5, 0, 0)
    assert row["P(kbga better)"] == 1.0
    assert row["Holm's p"] == pytest.approx(2 * 0.5**5)
    same = tables_of(*town("kbga"), *town("prm"))["maps-paired"].iloc[0]
    assert (same["equal"], same["P(kbga better)"], same["Holm's p"]) == (5, 0.5, 1.0)


def test_short_and_long_queries_stand_apart():
    records = [
        asked("kbga", f"q{i}", length * (1.0 + gap), optimum=length)
        for i, (length, gap) in enumerate(
            zip([50.0, 10.0, 40.0, 20.0, 30.0], [0.05] + [0.01] * 4, strict=True)
        )
    ]
    frame = tables_of(*records)["maps-lengths"]
    assert list(frame["queries by length"]) == [
        "shortest fourth", "second", "third", "longest fourth",
    ]  # fmt: skip
    assert list(frame["queries"]) == [2, 1, 1, 1]
    assert list(frame["from (m)"]) == [10.0, 30.0, 40.0, 50.0]
    assert frame["gap worst (%)"].to_list() == pytest.approx([1.0, 1.0, 1.0, 5.0])


def test_query_by_query_there_are_files_and_nothing_on_the_page():
    runs, events = frames_of(*town(), *town("prm"))
    tables = all_tables(runs, events=events)
    assert {table.name for table in tables if not table.on_page} == {"queries"}
    queries = next(table for table in tables if table.name == "queries")
    assert queries.detail
    assert len(queries.frame) == 10
    assert list(queries.frame["query"].unique()) == [f"q{i}" for i in range(5)]
    longest = max(len(table.frame) for table in tables if table.on_page)
    assert longest < 2 * 5 * 4


def test_scenes_of_few_queries_are_no_maps():
    runs, events = frames_of(*town(costs=COSTS[:3]), measured("kbga", 0, [(1.0, 101.0)]))
    names = {table.name for table in all_tables(runs, events=events)}
    assert names.isdisjoint({"maps", "maps-rows", "maps-paired", "maps-settings", "queries"})


def test_tests_over_runs_leave_maps_out_and_say_so():
    single = [measured(p, s, [(1.0, 101.0 + s)]) for p in ("kbga", "prm") for s in range(3)]
    runs, events = frames_of(*town(), *town("prm"), *single)
    tables = {table.name: table for table in all_tables(runs, events=events)}
    assert list(tables["statistics"].frame["runs"]) == [3, 3]
    assert "maps-paired" in tables["statistics"].note
    runs, events = frames_of(*town(), *town("prm"))
    assert "statistics" not in {table.name for table in all_tables(runs, events=events)}
