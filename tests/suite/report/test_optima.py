"""A path that is shorter than the shortest stops every table, before anything is written."""

import pytest

from suite.errors import KbgaBenchError
from suite.report.all_tables import all_tables, read_tables
from suite.report.export.ompl_log import write_ompl_logs
from suite.report.html.page import write_report
from suite.report.optima import check_optima, check_replans
from suite.report.results_folder import write_results
from suite.store.read import read_replans, read_runs
from suite.store.record import World
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record
from tests.suite.report.study_rows import run, runs_of


def below(metres: float, **changes):
    """A run whose path has so much less than the optimum of 100 m."""
    return run("kbga", {}, 100.0 - metres, **changes)


def test_the_row_is_named_and_how_to_mend_it_said():
    runs = runs_of(run("kbga", {}, 101.0), below(13.15, seed=1))
    key = runs["key"].iloc[1]
    message = (
        rf"row {key} \(zigzag / main / kbga / seed 1\): its path has 86.85 m, less than the "
        r"shortest, of 100 m \(-13.2 %\)\. .*Run its matrix again with --force"
    )
    with pytest.raises(KbgaBenchError, match=message):
        all_tables(runs)


@pytest.fixture
def store(tmp_path):
    file = tmp_path / "s.db"
    with open_store(file) as opened:
        opened.begin_session({})
        opened.add(make_record(make_cell(), cost=134.6, optimum=155.0))
    return file


@pytest.mark.parametrize("write", [write_report, write_ompl_logs, write_results])
def test_nothing_is_written(store, tmp_path, write):
    with pytest.raises(KbgaBenchError, match="less than the shortest"):
        write(store, tmp_path / "written.html")
    assert not (tmp_path / "written.html").exists()


def test_no_table_is_made(store):
    with pytest.raises(KbgaBenchError, match="less than the shortest"):
        read_tables(store)


def test_what_rounding_does_is_allowed_and_no_more():
    # Sums in another order; and each of four segments with ends rounded where float64 is coarse.
    check_optima(runs_of(below(1e-12), below(9e-8, seed=1), below(1.3e-7, seed=2, segments=4)))
    with pytest.raises(KbgaBenchError, match="less than the shortest"):
        check_optima(runs_of(below(2e-7, segments=4)))


def test_what_rounding_does_is_shown_as_no_gap():
    assert runs_of(below(1e-12, gap=-1e-14))["gap"].tolist() == [0.0]


def test_a_query_with_two_optima_is_refused():
    runs = runs_of(run("kbga", {}, 160.0), run("plain-ga", {}, 160.0, optimum=155.0))
    with pytest.raises(KbgaBenchError, match=r"the same query has the optima 100 m and 155 m"):
        check_optima(runs)


def test_the_same_scene_in_other_places_may_have_other_optima():
    one = make_record(make_cell(scene_hash="0"), cost=160.0)
    check_optima(runs_of(one, make_record(make_cell(scene_hash="1"), cost=160.0, optimum=120.0)))


def test_a_row_that_is_left_out_as_outdated_stops_nothing():
    old = run("kbga", {"population_size": 1}, 87.0, started_at="2025-01-01T00:00:00")
    assert all_tables(runs_of(old, run("kbga", {}, 101.0, seed=1)))


def test_an_update_of_a_simulated_run_with_a_path_below_its_optimum_is_refused(tmp_path):
    replan = {
        "time": 2.0, "changed": False, "status": "solved", "cost": 19.0, "optimum": 20.0,
        "latency_s": 0.1, "generations": None, "checks": None,
    }  # fmt: skip
    with open_store(tmp_path / "s.db") as opened:
        opened.begin_session({})
        opened.add(make_record(make_cell(), simulation={"replans": [replan]}))
    replans = read_replans(tmp_path / "s.db")
    with pytest.raises(KbgaBenchError, match=r"update at 2.0 s: its path has 19 m, less than"):
        check_replans(replans)
    check_replans(replans.assign(optimum=19.0))


def test_a_robot_that_is_luckier_than_the_exact_one_is_no_mistake(tmp_path):
    driven = make_record(make_cell(world=World("fast", {"speed": 5.0})), cost=150.0)
    with open_store(tmp_path / "s.db") as opened:
        opened.begin_session({})
        opened.add(driven)
    runs = read_runs(tmp_path / "s.db")
    check_optima(runs)
    assert runs["gap"].iloc[0] == pytest.approx(150.0 / 155.0 - 1.0)
