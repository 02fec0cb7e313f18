"""Stores that several machines filled, taken into one: nothing is lost, nothing is doubled."""

import json
import sqlite3
from contextlib import closing

import numpy as np
import pytest

from suite.errors import StoreError
from suite.planner import Budget
from suite.store.merge import merge
from suite.store.read import (
    read_conflicts,
    read_events,
    read_paths,
    read_runs,
    read_sessions,
    read_simulation,
)
from suite.store.record import World
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record


@pytest.fixture
def store_of(tmp_path):
    def fill(name, *records, machine=""):
        with open_store(tmp_path / name) as store:
            store.begin_session({"host": machine or name})
            for record in records:
                store.add(record)
        return tmp_path / name

    return fill


def of(seed, **changes):
    return make_record(make_cell(seed=seed), **changes)


def test_rows_that_are_missing_are_added_with_all_that_belongs_to_them(store_of):
    moving = make_record(make_cell(seed=9, world=World("w", {})), simulation={"outcome": "reached"})
    mine, other = store_of("a", of(0), of(1)), store_of("b", of(1), of(2), moving)
    with open_store(mine) as store:
        (done,) = merge(store, [other])
    assert (done.added, done.same, done.conflicts) == (2, 1, ())
    runs = read_runs(mine)
    assert sorted(runs["seed"]) == [0, 1, 2, 9]
    assert len(read_events(mine)) == 2 * 4
    assert np.array_equal(read_paths(mine)[of(2).cell.key], of(2).path)
    assert read_simulation(mine, moving.cell.key) == {"outcome": "reached"}
    hosts = {s["id"]: s["host"] for s in read_sessions(mine)}
    assert [hosts[i] for i in runs.sort_values("seed")["session"]] == ["a", "a", "b", "b"]


def test_a_row_with_another_outcome_is_kept_beside_and_named(store_of):
    better = of(0, cost=150.0, path=np.zeros((2, 2)))
    mine, other = store_of("a", of(0)), store_of("b", better)
    for _ in range(2):
        with open_store(mine) as store:
            (done,) = merge(store, [other])
        assert [cell.key for cell in done.conflicts] == [better.cell.key]
    assert read_runs(mine)["cost"].tolist() == [156.0]
    (conflict,) = read_conflicts(mine).to_dict("records")
    assert (conflict["key"], conflict["source"]) == (better.cell.key, str(other))
    assert json.loads(conflict["row"])["cost"] == 150.0


def test_another_path_of_the_same_cost_is_a_conflict_too(store_of):
    mine, other = store_of("a", of(0)), store_of("b", of(0, path=np.ones((2, 2))))
    with open_store(mine) as store:
        (done,) = merge(store, [other])
    assert len(done.conflicts) == 1


def test_times_may_differ(store_of):
    mine, other = store_of("a", of(0)), store_of("b", of(0, wall_s=99.0))
    with open_store(mine) as store:
        (done,) = merge(store, [other])
    assert (done.same, done.conflicts) == (1, ())


TIMED = Budget(wall_s=1.0)


def other_outcomes(store_of, *cells):
    """What a merge says of two stores that differ in these cells."""
    mine = store_of("a", *(make_record(cell) for cell in cells))
    other = store_of("b", *(make_record(cell, cost=150.0) for cell in cells))
    with open_store(mine) as store:
        return merge(store, [other])[0]


def test_another_outcome_is_to_be_expected_where_time_counts_and_alarming_elsewhere(store_of):
    driven = World("w", {"charge": "measured"})
    free = make_cell(seed=4, world=World("w", {"charge": "zero"}))
    timed = [
        make_cell(seed=1, budget=TIMED, variant="rrt"),
        make_cell(seed=2, budget=TIMED, variant="rrt"),
        make_cell(seed=3, world=driven),
    ]
    done = other_outcomes(store_of, *timed, free)
    assert [cell.seed for cell in done.alarming] == [4]
    said = done.as_text()
    assert "0 rows added, 0 were there with the same outcome, 4 with another one." in said
    assert "3 rows came out otherwise, as is to be expected where time counts" in said
    assert "rrt 2, kbga 1" in said
    assert "1 row should be the same bit for bit" in said
    assert "\n    zigzag / w / kbga / seed 4\n" in said


def test_rows_that_time_alone_makes_differ_are_no_alarm(store_of):
    done = other_outcomes(store_of, make_cell(budget=TIMED))
    assert done.alarming == ()
    assert "bit for bit" not in done.as_text()


def test_of_many_rows_that_differ_it_is_said_how_many_each_planner_has(store_of):
    cells = [make_cell(seed=i % 4, variant="ab"[i // 4], position=i) for i in range(8)]
    said = other_outcomes(store_of, *cells).as_text()
    assert "8 rows should be the same" in said
    assert "a 4, b 4; the first of them is zigzag / a / seed 0" in said
    assert len(said.splitlines()) == 4


def test_several_stores_are_taken_in_one_after_the_other(store_of):
    mine, sources = store_of("a"), [store_of("b", of(0)), store_of("c", of(0), of(1))]
    with open_store(mine) as store:
        first, second = merge(store, sources)
    assert (first.added, second.added, second.same) == (1, 1, 1)


@pytest.mark.parametrize("bad", ["itself", "missing", "no store"])
def test_nothing_is_taken_in_if_one_of_the_stores_is_none(store_of, tmp_path, bad):
    mine, good = store_of("a"), store_of("b", of(0))
    (tmp_path / "text").write_text("no store, but long enough to have a header" * 9)
    source = {"itself": mine, "missing": tmp_path / "x", "no store": tmp_path / "text"}[bad]
    with open_store(mine) as store, pytest.raises(StoreError, match=source.name):
        merge(store, [good, source])
    assert read_runs(mine).empty


def test_the_other_store_is_not_written_to(store_of):
    mine, other = store_of("a"), store_of("b", of(0))
    before = other.read_bytes()
    with open_store(mine) as store:
        merge(store, [other])
    assert other.read_bytes() == before


def test_all_columns_come_along(store_of):
    record = of(0, stderr="last words", details={"x": 1.5}, clearance=0.25)
    mine, other = store_of("a"), store_of("b", record)
    with open_store(mine) as store:
        merge(store, [other])
    one, two = (read_runs(file).drop(columns="session") for file in (mine, other))
    assert one.astype("object").fillna("-").equals(two.astype("object").fillna("-"))


def test_conflicts_that_the_other_store_had_are_kept(store_of):
    first, second = store_of("b", of(0)), store_of("c", of(0, cost=1.0))
    with open_store(first) as store:
        merge(store, [second])
    mine = store_of("a")
    with open_store(mine) as store:
        merge(store, [first])
    assert read_conflicts(mine)["source"].tolist() == [str(second)]


def test_other_computed_checks_are_another_outcome(store_of):
    mine, other = store_of("a", of(0, computed_checks=9)), store_of("b", of(0, computed_checks=8))
    with open_store(mine) as store:
        (done,) = merge(store, [other])
    assert len(done.conflicts) == 1


def test_a_store_that_is_older_than_a_column_is_taken_in_without_it(store_of):
    mine, other = store_of("a", of(0, computed_checks=9)), store_of("b", of(0), of(1))
    with closing(sqlite3.connect(other)) as connection, connection:
        for name in ("computed_checks", "attempts", "budget_cpu_s"):
            connection.execute(f"ALTER TABLE runs DROP COLUMN {name}")
    with open_store(mine) as store:
        (done,) = merge(store, [other])
    assert (done.added, done.same, done.conflicts) == (1, 1, ())
