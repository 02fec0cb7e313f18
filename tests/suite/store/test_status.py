"""How a store stands, told to another shell."""

import sqlite3
import subprocess
import sys
from contextlib import closing

import pytest

from suite.errors import StoreError
from suite.planner import PlanStatus
from suite.store.merge import merge
from suite.store.status import as_text, status
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

CELLS = [make_cell(seed=seed, variant=name) for name in ("kbga", "other") for seed in range(3)]


@pytest.fixture
def file(tmp_path):
    with open_store(tmp_path / "s.db") as store:
        store.want("walls", CELLS)
        store.begin_session({"matrix": "walls", "pid": 7, "host": "h", "started_at": "now"})
        store.add(make_record(CELLS[0]))
        store.add(make_record(CELLS[1], status=PlanStatus.CRASHED))
        store.add(make_record(CELLS[3]))
        store.add(make_record(make_cell(seed=99)))
    return tmp_path / "s.db"


def test_it_counts_what_is_wanted_done_and_missing(file):
    found = status(file)
    assert {name: found[name] for name in ("wanted", "done", "missing", "other")} == {
        "wanted": 6, "done": 3, "missing": 3, "other": 1,
    }  # fmt: skip
    assert found["by_status"] == {"crashed": 1, "solved": 2}
    assert found["planners"] == {
        "kbga": {"wanted": 3, "done": 2, "succeeded": 1, "failed": 1},
        "other": {"wanted": 3, "done": 1, "succeeded": 1, "failed": 0},
    }
    assert found["writer"] is None
    assert "kbga: 2 of 3, 1 succeeded, 1 failed" in as_text(found)


def test_planners_are_in_the_order_of_the_matrix_whichever_row_came_first(tmp_path):
    names = ("zeta", "alpha", "mid")
    cells = [make_cell(variant=name, position=i) for i, name in enumerate(names)]
    with open_store(tmp_path / "s.db") as store:
        store.want("walls", cells)
        store.begin_session({})
        for cell in reversed(cells):
            store.add(make_record(cell))
    assert list(status(tmp_path / "s.db")["planners"]) == list(names)


def test_a_store_of_before_the_order_was_kept_is_read_and_written(file):
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.execute("ALTER TABLE wanted DROP COLUMN position")
    assert set(status(file)["planners"]) == {"kbga", "other"}
    with open_store(file) as store:
        store.want("walls", [make_cell(variant=name, position=i) for i, name in enumerate("ba")])
    assert list(status(file)["planners"]) == ["b", "a"]


def test_failed_rows_are_named_with_their_keys(file):
    (failed,) = status(file)["failures"]
    assert failed == {
        "key": CELLS[1].key, "name": "zigzag / kbga / seed 1", "status": "crashed", "reason": None,
    }  # fmt: skip
    assert f"    {CELLS[1].key[:8]}  zigzag / kbga / seed 1  crashed" in as_text(status(file))


def test_of_many_failed_rows_the_first_are_named(tmp_path):
    with open_store(tmp_path / "s.db") as store:
        store.begin_session({})
        for seed in range(7):
            cell = make_cell(seed=seed, position=seed)
            store.add(make_record(cell, status=PlanStatus.ERROR, reason="Trace\nValueError: no"))
    said = as_text(status(tmp_path / "s.db"))
    assert said.count("error: ValueError: no") == 5
    assert "seed 4  error" in said
    assert "and 2 more" in said


def test_a_matrix_that_is_run_anew_wants_what_it_wants_now(file):
    with open_store(file) as store:
        store.want("walls", CELLS[:1])
        store.want("more", CELLS[:2])
    found = status(file)
    assert (found["wanted"], found["done"], found["other"]) == (2, 2, 2)


def test_it_names_the_process_that_is_writing(file):
    with open_store(file):
        # Of another process: a lock is no lock for the one that holds it.
        code = "import sys; from suite.cli import main; main()"
        told = subprocess.run(
            [sys.executable, "-c", code, "status", str(file)],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
    assert "process 7 on h is running walls, since now" in told
    assert "nobody is writing" in as_text(status(file))


def test_it_counts_conflicts(file, tmp_path):
    with open_store(tmp_path / "b.db") as other:
        other.begin_session({})
        other.add(make_record(CELLS[0], cost=1.0))
    with open_store(file) as store:
        merge(store, [tmp_path / "b.db"])
    found = status(file)
    assert found["conflicts"] == 1
    assert "1 rows of merged stores had another outcome" in as_text(found)


def test_a_missing_store_is_an_error(tmp_path):
    with pytest.raises(StoreError, match="no such store"):
        status(tmp_path / "none.db")
