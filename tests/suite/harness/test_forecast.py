"""What would be run, and about how long."""

import pytest

from suite.harness.forecast import NOTHING, forecast, forecast_matrix
from suite.harness.matrix import load_matrix
from suite.harness.run import Which
from suite.planner import Budget
from suite.store.read import read_runs
from suite.store.record import World
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

UNLIMITED = {"budget": Budget()}


@pytest.fixture
def rows(tmp_path):
    with open_store(tmp_path / "s.db") as store:
        store.begin_session({})
        store.add(make_record(wall_s=2.0))
        store.add(make_record(make_cell(seed=1), wall_s=4.0))
    return read_runs(tmp_path / "s.db")


def test_a_variant_takes_as_long_as_it_did_on_that_scene(rows):
    told = forecast(5, [make_cell(seed=2), make_cell(seed=3)], rows, jobs=2)
    assert (told.wanted, told.there, told.runs) == (5, 3, 2)
    assert told.seconds == pytest.approx(3.0, abs=0.1)


def test_on_another_scene_it_takes_as_long_as_on_those_that_are_known(rows):
    told = forecast(1, [make_cell(scene="maze")], rows, jobs=1)
    assert told.seconds == pytest.approx(3.0, abs=0.1)


@pytest.mark.parametrize("budget", [Budget(wall_s=1.5), Budget(cpu_s=1.5)])
def test_a_variant_that_never_ran_is_given_its_budget(budget):
    told = forecast(1, [make_cell(budget=budget)], NOTHING, jobs=1)
    assert told.seconds == pytest.approx(1.5, abs=0.1)


@pytest.mark.parametrize(
    "changes", [UNLIMITED, {"budget": Budget(wall_s=1.0), "world": World("w", {})}]
)
def test_what_nobody_knows_is_said(changes):
    told = forecast(1, [make_cell(**changes)], NOTHING, jobs=1)
    assert told.parts[0].known == 0
    assert "kbga: 1 runs, nobody knows how long" in told.as_text()


def test_the_sum_says_of_how_many_runs_nobody_knows():
    cells = [make_cell(budget=Budget(wall_s=1.5), variant="timed"), make_cell(**UNLIMITED)]
    said = forecast(2, cells, NOTHING, jobs=1).as_text()
    assert "In all at least 2 s with 1 jobs; 1 runs are not in that" in said
    alone = forecast(1, cells[1:], NOTHING, jobs=1).as_text()
    assert "In all nobody knows how long, with 1 jobs." in alone


def test_planners_are_in_the_order_of_the_matrix():
    cells = [make_cell(variant=name, position=9 - i) for i, name in enumerate("abc")]
    assert [part.variant for part in forecast(3, cells, NOTHING, 1).parts] == ["c", "b", "a"]


def test_a_matrix_is_forecast_without_a_store_and_nothing_is_written(tmp_path):
    matrix, file = load_matrix("plus"), tmp_path / "none.db"
    told = forecast_matrix(matrix, file, jobs=None, quick=True, which=Which.MISSING)
    assert told.runs == told.wanted == len(matrix.cells(quick=True))
    assert list(tmp_path.iterdir()) == []
