"""Logs and databases that OMPL's own tools read back."""

import sqlite3
from contextlib import closing

import pytest
from ompl.tools import computeViews, readBenchmarkLog

from suite.errors import StoreError
from suite.planner import PlanStatus
from suite.report.export.ompl_log import SAMPLES, STATUSES, write_ompl_logs, write_planner_arena
from suite.store.read import read_runs
from suite.store.record import World
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

NOTHING = dict.fromkeys(("cost", "gap", "clearance", "segments", "time_to_best_s", "path"))


@pytest.fixture
def store(tmp_path):
    start = {"started_at": "2026-11-22T06:58:55+00:00", "host": "here"}
    with open_store(tmp_path / "s.db") as opened:
        opened.begin_session({"versions": {"kbga-bench": "1.2.3"}, "cpu": "abacus"})
        for seed in range(3):
            opened.add(make_record(make_cell(seed=seed), segments=4, **start))
        lost = make_cell(variant="lost planner", planner="lost", seed=1)
        opened.add(
            make_record(lost, status=PlanStatus.EXHAUSTED, improvements=(), **NOTHING | start)
        )
        opened.add(make_record(make_cell(scene="maze"), **start))
        opened.add(make_record(make_cell(world=World("w", {})), simulation={}, **start))
    return tmp_path / "s.db"


def rows(database, query):
    with closing(sqlite3.connect(database)) as connection:
        connection.row_factory = sqlite3.Row
        return [dict(row) for row in connection.execute(query)]


@pytest.fixture
def read_back(store, tmp_path, capsys):
    logs = write_ompl_logs(store, tmp_path / "logs")
    readBenchmarkLog(str(tmp_path / "back.db"), [str(log) for log in logs], False)
    computeViews(str(tmp_path / "back.db"), False)
    capsys.readouterr()
    return tmp_path / "back.db"


def test_there_is_a_log_for_each_query(store, tmp_path):
    logs = write_ompl_logs(store, tmp_path / "logs")
    assert [log.name for log in logs] == ["zigzag-main.log", "maze-main.log"]


def test_ompl_reads_every_run_back_with_what_it_was(read_back, store):
    found = rows(
        read_back,
        "SELECT runs.*, plannerConfigs.name AS planner, experiments.name AS experiment FROM runs "
        "JOIN plannerConfigs ON plannerid = plannerConfigs.id "
        "JOIN experiments ON experimentid = experiments.id ORDER BY runs.id",
    )
    ours = read_runs(store)
    ours = ours[ours["world"].isna()].to_dict("records")
    assert len(found) == len(ours) == 5
    for theirs, row in zip(found, ours, strict=True):
        assert theirs["experiment"] == f"{row['scene']}-main"
        assert theirs["planner"] == row["variant"]
        assert theirs["time"] == row["wall_s"]
        assert theirs["solved"] == (row["status"] == "solved")
        assert STATUSES[theirs["status"]] == row["status"]
        assert theirs["simplification_time"] == 0.0
        assert theirs["random_seed"] == row["seed"]
    assert [f["solution_length"] for f in found] == [156.0, 156.0, 156.0, None, 156.0]
    assert found[0]["solution_segments"] == 4


def test_the_words_for_the_status_are_told(read_back):
    words = rows(read_back, "SELECT description FROM enums WHERE name = 'status' ORDER BY value")
    assert tuple(word["description"] for word in words) == STATUSES


def test_the_experiment_says_where_it_was_run(read_back):
    one, _ = rows(read_back, "SELECT * FROM experiments")
    assert one["version"] == "kbga-bench 1.2.3"
    assert one["hostname"] == "here"
    assert one["cpuinfo"] == "abacus\n"
    assert one["date"] == "2026-11-22 06:58:55"
    assert (one["runcount"], one["totaltime"]) == (3, pytest.approx(0.2))


def test_settings_are_those_of_the_planner(read_back):
    kbga = rows(read_back, "SELECT settings FROM plannerConfigs WHERE name = 'kbga'")
    assert kbga == [{"settings": "population_size = 50\n;"}]


def test_progress_is_the_best_so_far_at_even_times(read_back):
    progress = rows(read_back, "SELECT * FROM progress WHERE runid = 1 ORDER BY time")
    assert len(progress) == SAMPLES
    assert progress[0]["best_cost"] is None
    costs = {row["best_cost"] for row in progress}
    assert costs == {None, 200.0, 156.0}
    after = [row["best_cost"] for row in progress if row["time"] >= 0.03]
    assert set(after) == {156.0}
    assert progress[-1]["iterations"] == 50
    assert rows(read_back, "SELECT * FROM progress WHERE runid = 4") == []


def test_the_views_rank_planners_by_what_they_solved(read_back):
    best = rows(
        read_back,
        "SELECT name, avg_solved FROM bestPlannerConfigs JOIN plannerConfigs ON id = plannerid",
    )
    assert best == [
        {"name": "kbga", "avg_solved": 1.0},
        {"name": "lost planner", "avg_solved": 0.0},
    ]


def test_planner_arena_gets_the_same_database(read_back, store, tmp_path, capsys):
    file = write_planner_arena(store, tmp_path / "new" / "arena.db")
    assert capsys.readouterr().out == ""
    for table in ("runs", "progress", "plannerConfigs", "experiments", "bestPlannerConfigs"):
        query = f"SELECT * FROM {table}"
        assert rows(file, query) == rows(read_back, query)
    assert [path.name for path in file.parent.iterdir()] == ["arena.db"]


def test_a_database_that_is_there_is_not_written_over(store, tmp_path):
    (tmp_path / "arena.db").write_text("precious")
    with pytest.raises(StoreError, match=r"arena\.db: is there already"):
        write_planner_arena(store, tmp_path / "arena.db")
    assert (tmp_path / "arena.db").read_text() == "precious"


def test_a_store_without_such_runs_is_an_error(tmp_path):
    with open_store(tmp_path / "e.db"):
        pass
    with pytest.raises(StoreError, match="no runs that a log could hold"):
        write_ompl_logs(tmp_path / "e.db", tmp_path / "logs")
