"""The table of a sweep on maps: which of a planner's settings do best."""

import math
from dataclasses import replace

import numpy as np
import pytest

from suite.report.all_tables import all_tables
from suite.report.tables.queries import map_tables
from suite.store.record import RunRecord
from tests.suite.report.measured_rows import frames_of, measured, steps


def setting(name, costs, *, of="prm", place="town", ms=2.0) -> list[RunRecord]:
    """Runs of a setting, one a query, whose optimum is 100 m; None: no path was found."""
    records = [
        measured(
            name, 0, [] if cost is None else [(ms, cost)],
            scene=place, query=f"q{i}", scene_hash=f"{place} q{i}",
        )
        for i, cost in enumerate(costs)
    ]  # fmt: skip
    return [replace(record, cell=replace(record.cell, planner=of)) for record in records]


def sweep(*settings):
    records = [record for runs in settings for record in runs]
    runs, _ = frames_of(*records)
    found = map_tables(steps(*records), runs, np.random.default_rng(0))
    tables = {table.name: table.frame for table in found}
    return tables.get("maps-settings")


def test_the_best_setting_has_the_lowest_median_over_maps_of_the_median_gap():
    # Over all queries at once `even` would be ahead: 4 % in the median, and `uneven` 9 %.
    uneven = [
        *setting("uneven", [109.0] * 9, place="large"),
        *setting("uneven", [101.0] * 4, place="small"),
        *setting("uneven", [101.0] * 4, place="other"),
    ]
    even = [
        *setting("even", [104.0] * 9, place="large"),
        *setting("even", [104.0] * 4, place="small"),
        *setting("even", [104.0] * 4, place="other"),
    ]
    frame = sweep(even, uneven)
    assert list(frame["setting"]) == ["uneven", "even"]
    assert list(frame["rank"]) == [1, 2]
    assert list(frame["gap (%)"]) == pytest.approx([1.0, 4.0])
    assert list(frame["worst gap (%)"]) == pytest.approx([9.0, 4.0])
    assert list(frame["maps"]) == [3, 3]
    assert list(frame["queries"]) == [17, 17]


def test_of_equal_gaps_the_first_within_1_per_cent_is_the_better():
    slow, fast = (setting(f"{ms} ms", [100.5] * 5, ms=ms) for ms in (8.0, 4.0))
    never = setting("rounded", [100.5 + 1e-7] * 5, ms=2.0)
    frame = sweep(slow, fast, never)
    assert list(frame["setting"]) == ["rounded", "4.0 ms", "8.0 ms"]
    assert list(frame["cpu to 1 % (ms)"]) == pytest.approx([1.0, 2.0, 4.0])


def test_a_query_without_path_counts_as_worse_than_any_path():
    fails = setting("fails", [100.0, 100.0, None, None, None])
    frame = sweep(fails, setting("far", [150.0] * 5))
    assert list(frame["setting"]) == ["far", "fails"]
    assert list(frame["with path"]) == [5, 2]
    assert list(frame["gap (%)"]) == [pytest.approx(50.0), math.inf]


def test_only_queries_that_all_settings_of_the_planner_were_asked_count():
    whole = setting("whole", [101.0] * 4 + [150.0] * 5)
    frame = sweep(whole, setting("stopped", [102.0] * 4), setting("other", [100.0], of="rrt"))
    assert list(frame["setting"]) == ["whole", "stopped"]
    assert list(frame["queries"]) == [4, 4]


def test_planners_stand_apart_and_those_of_one_setting_are_left_out():
    frame = sweep(
        setting("prm", [103.0] * 5),
        setting("rrt-near", [102.0] * 5, of="rrt"),
        setting("kbga", [100.0] * 5, of="kbga"),
        setting("prm-large", [102.0] * 5),
        setting("rrt", [101.0] * 5, of="rrt"),
    )
    assert list(frame["planner"]) == ["prm", "prm", "rrt", "rrt"]
    assert list(frame["setting"]) == ["prm-large", "prm", "rrt", "rrt-near"]
    assert sweep(setting("prm", [101.0] * 5), setting("rrt", [101.0] * 5, of="rrt")) is None


def test_it_is_among_the_tables_of_a_store():
    runs, events = frames_of(*setting("a", [101.0] * 5), *setting("b", [102.0] * 5))
    table = next(t for t in all_tables(runs, events=events) if t.name == "maps-settings")
    assert "no path counting as infinite" in table.note
