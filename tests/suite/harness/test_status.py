"""How a store stands, told to another shell."""

import subprocess
import sys

import pytest

from suite.errors import StoreError
from suite.harness.status import as_text, status
from suite.merge import merge
from suite.planner import PlanStatus
from suite.store import open_store
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
    assert "1 rows of other stores in conflict" in as_text(found)


def test_a_missing_store_is_an_error(tmp_path):
    with pytest.raises(StoreError, match="no such store"):
        status(tmp_path / "none.db")
