"""Measures of each query: seeds first, then queries; and which queries are the hardest."""

import math

import pytest

from suite.report.statistics.over_queries import hardest, only_maps, query_measures, time_to
from tests.suite.report.map_rows import asked
from tests.suite.report.measured_rows import measured, steps

OTHERS = [asked("kbga", f"other {i}", 100.0) for i in range(3)]


def of_query(name, *records):
    measures = query_measures(steps(*records, *OTHERS))
    return measures[measures["query"] == name].set_index("variant")


def test_seeds_of_a_query_are_one_row_with_the_mean_gap_of_those_with_a_path():
    row = of_query(
        "a", asked("kbga", "a", 101.0), asked("kbga", "a", 103.0, 1), asked("kbga", "a", None, 2)
    ).loc["kbga"]
    assert (row["runs"], row["solved"], row["found"]) == (3, 2, 2)
    assert row["gap"] == pytest.approx(0.02)
    assert row["cost"] == pytest.approx(102.0)
    assert row["optimum"] == 100.0


def test_a_time_is_the_median_over_seeds_and_infinite_where_half_never_came_so_near():
    half = of_query("a", asked("kbga", "a", 101.0), asked("kbga", "a", 104.0, 1)).loc["kbga"]
    assert half[time_to(0.05)] == pytest.approx(0.002)
    assert half[time_to(0.02)] == math.inf


def test_a_run_without_a_core_has_no_say_in_times_and_all_in_the_gap():
    rows = of_query("a", asked("kbga", "a", 101.0), asked("kbga", "a", None, 1, contended=True))
    assert rows.loc["kbga", time_to(0.01)] == pytest.approx(0.002)
    assert rows.loc["kbga", f"cpu {time_to(0.01)}"] == math.inf
    assert rows.loc["kbga", "runs"] == 2


def test_only_scenes_of_many_queries_are_maps():
    found = steps(*OTHERS, asked("kbga", "a", 101.0), measured("kbga", 0, [(1.0, 101.0)]))
    assert set(only_maps(found).runs["scene"]) == {"town"}
    assert len(only_maps(found, maps=False).runs) == 1


def test_the_hardest_are_those_that_most_planners_fail_then_those_of_the_largest_best_gap():
    records = [
        asked("kbga", "easy", 100.0), asked("prm", "easy", 150.0),
        asked("kbga", "wide", 104.0), asked("prm", "wide", 103.0),
        asked("kbga", "wider", 105.0), asked("prm", "wider", 104.0),
        asked("kbga", "failed", None), asked("prm", "failed", 101.0),
    ]  # fmt: skip
    measures = query_measures(steps(*records))
    assert hardest(measures, 9) == ["failed", "wider", "wide", "easy"]
    assert hardest(measures, 2) == ["failed", "wider"]


def test_among_queries_that_somebody_solves_exactly_the_mean_gap_decides():
    records = [
        asked(planner, query, cost)
        for query, costs in {"a": (100.0, 101.0), "b": (100.0, 109.0), "c": (100.0, 105.0)}.items()
        for planner, cost in zip(("exact", "kbga"), costs, strict=True)
    ]
    assert hardest(query_measures(steps(*records))) == ["b", "c", "a"]
