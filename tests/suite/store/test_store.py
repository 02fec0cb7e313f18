import os
import sqlite3
import subprocess
import sys
from contextlib import closing
from dataclasses import fields
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from suite.errors import StoreError
from suite.planner import Budget, PlanStatus
from suite.store.read import (
    read_events,
    read_first_measures,
    read_paths,
    read_replans,
    read_runs,
    read_sessions,
    read_simulation,
    read_simulations,
    read_traces,
    stored_cell,
)
from suite.store.record import Cell, RunRecord, World, short_hash
from suite.store.schema import columns_now
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record


@pytest.fixture
def file(tmp_path):
    return tmp_path / "deep" / "store.db"


def filled(file, *records):
    with open_store(file) as store:
        store.begin_session({"matrix": "m", "python": "3.11"})
        for record in records:
            store.add(record)


def test_a_row_comes_back_as_it_was_written(file):
    record = make_record()
    filled(file, record)
    (row,) = read_runs(file).to_dict("records")
    assert row["key"] == record.cell.key
    assert row["status"] == "solved"
    assert row["cost"] == record.cost
    assert row["gap"] == record.gap
    assert row["generation_of_best"] == 50
    assert row["budget_generations"] == 100
    assert row["settings"] == '{"population_size":50}'
    assert row["settings_hash"] == short_hash({"population_size": 50})
    assert row["details"] == '{"restarts":2.0}'
    assert not row["contended"]
    assert read_sessions(file) == [{"id": 1, "matrix": "m", "python": "3.11"}]


def test_whatever_cell_and_record_say_has_a_column_or_a_table_of_its_own():
    columns = set(columns_now("runs"))
    said = {field.name for kind in (Cell, RunRecord) for field in fields(kind)}
    elsewhere = {"cell", "budget", "improvements", "trace", "path", "simulation", "snapshots"}
    assert said - columns == elsewhere
    made = {"key", "session", "settings_hash", "world_settings", "cold"}
    assert columns - said == made | {f"budget_{field.name}" for field in fields(Budget)}


def test_no_column_is_left_empty_that_somebody_fills(file):
    world = World("slow", {"speed": 2.0}, cold=True)
    cell = make_cell(budget=Budget(1.0, 2, 3, 4.0), world=world)
    optional = {f.name for f in fields(RunRecord) if f.default is None} - {"path", "simulation"}
    filled(file, make_record(cell=cell, **dict.fromkeys(optional, 1) | {"reason": "late"}))
    assert read_runs(file).notna().all(axis=None)


SIMULATION = {
    "outcome": "reached", "opening": "left", "time": 12.5, "waiting_time": 0.5, "hits": [],
    "replans": [
        {"time": 0.0, "changed": False, "status": "solved", "cost": 20.0, "optimum": 19.0,
         "latency_s": 0.001, "generations": 15, "checks": 400, "path": [[0, 0], [1, 1]]},
        {"time": 2.0, "changed": True, "status": "enclosed", "cost": None, "optimum": None,
         "latency_s": None, "generations": None, "checks": None, "path": None},
    ],
}  # fmt: skip


def test_a_simulated_run_comes_back_with_all_its_replans(file):
    cell = make_cell(world=World("fast", {"speed": 5.0}, cold=True))
    filled(file, make_record(cell, simulation=SIMULATION), make_record(make_cell(seed=1)))
    row, static = read_runs(file).to_dict("records")
    assert (row["world"], row["world_settings"], row["cold"]) == ("fast", '{"speed":5.0}', True)
    assert not static["cold"]
    assert not isinstance(static["world"], str)
    assert read_simulations(file).to_dict("records") == [
        {"key": cell.key, "outcome": "reached", "opening": "left", "hits": 0, "end_s": 12.5,
         "waiting_s": 0.5},
    ]  # fmt: skip
    replans = read_replans(file)
    assert replans["number"].tolist() == [0, 1]
    assert replans["changed"].tolist() == [False, True]
    assert replans["latency_s"].tolist()[0] == 0.001
    assert replans[["cost", "latency_s", "generations"]].isna().to_numpy().tolist() == [
        [False] * 3, [True] * 3,
    ]  # fmt: skip
    assert read_simulation(file, cell.key) == SIMULATION
    with pytest.raises(StoreError, match="is no simulated run"):
        read_simulation(file, "no such key")


def test_the_measures_of_the_first_generation_come_without_the_whole_trace(file):
    record, silent = make_record(), make_record(make_cell(seed=1), trace=())
    filled(file, record, silent)
    first = read_first_measures(file)
    assert first.index.tolist() == [record.cell.key]
    assert (first["best"].iloc[0], first["mean"].iloc[0]) == (200.0, 300.0)
    assert first["diversity"].isna().all()


def test_runs_that_described_nothing_have_no_first_measures(file):
    filled(file)
    assert read_first_measures(file).empty


def test_paths_come_back_bit_for_bit(file):
    record = make_record()
    filled(file, record)
    np.testing.assert_array_equal(read_paths(file)[record.cell.key], record.path)


def test_events_and_traces_come_back(file):
    record = make_record()
    filled(file, record)
    events = read_events(file)
    assert events["cost"].tolist() == [200.0, 156.0]
    assert events["generation"].tolist() == [1, 50]
    traces = read_traces(file)
    assert traces["best"].tolist() == [200.0, 156.0]
    assert np.isnan(traces["mean"].iloc[1])
    assert traces["key"].eq(record.cell.key).all()


def test_a_row_without_anything_is_kept_too(file):
    record = make_record(
        status=PlanStatus.CRASHED,
        **dict.fromkeys(("cost", "gap", "generations", "path", "contended")),
        improvements=(),
        trace=(),
    )
    filled(file, record)
    assert read_runs(file)["cost"].isna().all()
    assert read_paths(file) == {}
    assert read_traces(file).empty


def test_a_key_can_be_written_once_and_a_failed_row_leaves_nothing(file):
    filled(file, make_record())
    with open_store(file) as store:
        store.begin_session({})
        with pytest.raises(StoreError, match="can't be added"):
            store.add(make_record())
        # events collide, the row itself does not: all of it must be undone
        store._connection.execute(
            "INSERT INTO events VALUES (?, 1, 0, 0, 0, 0, 0)", (make_cell(seed=1).key,)
        )
        store._connection.commit()
        with pytest.raises(StoreError, match="can't be added"):
            store.add(make_record(make_cell(seed=1)))
    assert len(read_runs(file)) == 1
    assert set(read_paths(file)) == {make_cell().key}


def test_rows_need_a_session(file):
    with open_store(file) as store, pytest.raises(StoreError, match="begin a session"):
        store.add(make_record())


def test_rows_come_in_the_order_of_their_matrix(file):
    filled(file, *(make_record(make_cell(seed=s, position=9 - s)) for s in range(5)))
    assert read_runs(file)["seed"].tolist() == [4, 3, 2, 1, 0]


def test_an_empty_store_reads_as_empty_tables(file):
    filled(file)
    assert read_runs(file).empty
    assert read_events(file).empty
    assert read_traces(file).empty


def test_a_missing_store_is_an_error_that_names_it(file):
    with pytest.raises(StoreError, match=r"store\.db: there is no such store"):
        read_runs(file)
    with pytest.raises(StoreError, match="there is no such store"):
        open_store(file, create=False)
    assert not file.exists()


def test_another_file_is_not_touched(tmp_path):
    file = tmp_path / "notes.txt"
    file.write_text("not a database, and long enough to be looked at by SQLite" * 20)
    before = file.read_bytes()
    with pytest.raises(StoreError, match="is no store"):
        open_store(file)
    with pytest.raises(StoreError, match="is no store"):
        read_runs(file)
    assert file.read_bytes() == before


def test_another_database_is_not_touched(tmp_path):
    file = tmp_path / "other.db"
    with sqlite3.connect(file) as other:
        other.execute("CREATE TABLE t (x)")
    before = file.read_bytes()
    with pytest.raises(StoreError, match=r"no store of kbga-bench"):
        open_store(file)
    assert file.read_bytes() == before


def test_another_version_of_the_schema_is_refused(file):
    filled(file)
    with sqlite3.connect(file) as connection:
        connection.execute("PRAGMA user_version = 99")
    with pytest.raises(StoreError, match="version 99"):
        read_runs(file)


def test_a_folder_is_no_store(tmp_path):
    with pytest.raises(StoreError, match="can't be opened"):
        open_store(tmp_path)


def test_a_store_that_another_process_writes_to_says_so(file, monkeypatch):
    filled(file)
    other = sqlite3.connect(file)
    other.execute("BEGIN IMMEDIATE")
    monkeypatch.setattr("suite.store.connection.BUSY_S", 0.1)
    with open_store(file) as store, pytest.raises(StoreError, match="another process"):
        store.begin_session({})
    other.close()


WRITER = """
import sys, time
from pathlib import Path
from suite.store.write import open_store
with open_store(Path(sys.argv[1])) as store:
    store.begin_session({"matrix": "walls", "pid": 4711, "host": "here", "started_at": "noon"})
    print("open", flush=True)
    time.sleep(3600)
"""


def test_the_second_writer_is_told_who_is_the_first_until_that_one_is_gone(file):
    first = subprocess.Popen([sys.executable, "-c", WRITER, str(file)], stdout=subprocess.PIPE)
    try:
        assert first.stdout.readline() == b"open\n"
        with pytest.raises(StoreError) as caught:
            open_store(file)
        assert "process 4711 on here, walls, since noon" in str(caught.value)
        assert "Wait for it, or name another store." in str(caught.value)
        # Reading goes on.
        assert read_runs(file).empty
    finally:
        first.kill()
        first.wait()
    with open_store(file):
        pass


FILLER = """
import resource, sys
from pathlib import Path
from suite.errors import StoreError
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record
with open_store(Path(sys.argv[1])) as store:
    store.begin_session({})
    resource.setrlimit(resource.RLIMIT_FSIZE, (400_000, 400_000))
    try:
        for seed in range(10_000):
            store.add(make_record(make_cell(seed=seed)))
    except StoreError as error:
        print(seed, error)
"""


def test_a_disk_that_can_take_no_more_is_an_error_and_nothing_is_corrupted(file):
    told = subprocess.run(
        [sys.executable, "-c", FILLER, str(file)], capture_output=True, text=True, check=True
    ).stdout
    number, _, words = told.partition(" ")
    assert str(file) in words
    assert "full" in words
    with closing(sqlite3.connect(file)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert len(read_runs(file)) == int(number) > 10


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_cannot_be_written_is_an_error_that_says_so(file):
    filled(file, make_record())
    file.parent.chmod(0o500)
    try:
        with pytest.raises(StoreError, match="can't be opened or written"):
            open_store(file)
        assert len(read_runs(file)) == 1
    finally:
        file.parent.chmod(0o700)


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="there is no /proc")
def test_a_file_system_that_takes_no_files_is_an_error_that_says_so():
    with pytest.raises(StoreError, match=r"/proc/store\.db: can't be opened or written"):
        open_store(Path("/proc/store.db"))


ADDED = ("computed_checks", "attempts", "budget_cpu_s")


def test_computed_checks_and_cpu_budgets_come_back_beside_what_they_belong_to(file):
    cell = make_cell(budget=Budget(cpu_s=2.0))
    filled(file, make_record(cell, checks=900, computed_checks=40), make_record(make_cell(seed=1)))
    runs = read_runs(file)
    assert runs["computed_checks"].tolist() == [40, pd.NA]
    assert runs["budget_cpu_s"].iloc[0] == 2.0
    assert np.isnan(runs["budget_cpu_s"].iloc[1])
    names = list(runs.columns)
    assert names[names.index("checks") + 1] == "computed_checks"
    assert stored_cell(runs.to_dict("records")[0]).key == cell.key
    assert stored_cell(runs.to_dict("records")[1]).key == make_cell(seed=1).key


def older(file):
    """Make a store what it was before these columns."""
    with closing(sqlite3.connect(file)) as connection, connection:
        for name in ADDED:
            connection.execute(f"ALTER TABLE runs DROP COLUMN {name}")


def test_an_older_store_is_read_as_it_is_and_written_with_the_new_columns(file):
    filled(file, make_record())
    names = list(read_runs(file).columns)
    older(file)
    runs = read_runs(file)
    assert list(runs.columns) == names
    assert runs[list(ADDED)].isna().all(axis=None)
    assert stored_cell(runs.to_dict("records")[0]).key == make_cell().key
    with open_store(file) as store:
        assert store.attempts() == {make_cell().key: 1}
        store.begin_session({})
        store.add(make_record(make_cell(seed=1), computed_checks=12))
    runs = read_runs(file)
    assert list(runs.columns) == names
    assert runs["computed_checks"].tolist() == [pd.NA, 12]


def test_contended_rows_are_named_and_their_attempts_counted(file):
    filled(file, make_record(contended=True), make_record(make_cell(seed=1)))
    with open_store(file) as store:
        assert store.contended() == {make_cell().key}
        store.count_attempt(make_cell().key)
    assert read_runs(file)["attempts"].tolist() == [2, 1]
