"""A row that is run again from its own record."""

import pytest

from suite.harness.cell import run_cell
from suite.harness.rerun import compare
from suite.harness.single import cell_for, world_for
from suite.planner import Budget, PlanStatus
from suite.scenes.catalogue import load_scene
from suite.store.row_names import cell_of
from suite.store.scenes import scene_at_hand
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record


@pytest.fixture
def store(tmp_path):
    def keep(*records):
        with open_store(tmp_path / "s.db") as opened:
            opened.begin_session({})
            for record in records:
                opened.add(record)
        return tmp_path / "s.db"

    return keep


COUNTED = Budget(generations=5)


@pytest.mark.parametrize(
    ("planner", "budget", "settings"),
    [
        ("kbga", COUNTED, {"population_size": 20}),
        ("kbga", None, {"repair_limit": "inf", "adaptation_rate": 0.1}),
        ("ompl-rrtstar", Budget(checks=300), {"goal_bias": 0.25}),
        ("visibility-graph", None, {}),
    ],
)
def test_the_record_of_a_row_is_enough_to_run_the_same_cell(store, planner, budget, settings):
    cell = cell_for("zigzag", planner, seed=3, budget=budget, settings=settings)
    record = run_cell(cell)
    file = store(record)
    again = cell_of(file, cell.key[:6])
    assert again.key == cell.key
    found = compare(file, run_cell(again))
    assert found.same
    assert found.must_be_same
    assert "the same bit for bit" in found.words


def test_a_simulated_row_is_repeated_in_its_world(store):
    world = world_for("door", {"charge": "zero", "speed": 5.0}, cold=True)
    cell = cell_for("door", "kbga", seed=3, world=world)
    file = store(run_cell(cell))
    again = cell_of(file, cell.key)
    assert again.key == cell.key
    found = compare(file, run_cell(again))
    assert (found.same, found.must_be_same, found.distance) == (True, True, 0.0)


@pytest.mark.parametrize("modifiers", ["", "@radius=0.3", "@turn=20,radius=0.3"])
def test_a_row_of_two_points_on_a_map_is_repeated_when_the_map_is_gone(tmp_path, modifiers):
    file = tmp_path / "yard.wkt"
    file.write_text(
        "MULTIPOLYGON (((4 0, 6 0, 6 7, 4 7, 4 0)), ((0 9.9, 10 9.9, 10 10, 0 10, 0 9.9)))"
    )
    cell = cell_for(f"{file}{modifiers}", "kbga", seed=1, query="2,3:8,3", budget=COUNTED)
    with open_store(tmp_path / "s.db") as opened:
        opened.keep_scenes({cell.scene: load_scene(cell.scene_source)}, [cell])
        opened.begin_session({})
        opened.add(run_cell(cell))
    file.unlink()
    with scene_at_hand(tmp_path / "s.db", cell_of(tmp_path / "s.db", cell.key)) as again:
        record = run_cell(again)
    assert record.status is PlanStatus.SOLVED, record.reason
    assert compare(tmp_path / "s.db", record).same


def test_a_row_that_comes_out_otherwise_says_how_far(store):
    cell = cell_for("zigzag", "visibility-graph", seed=0)
    record = run_cell(cell)
    moved = record.path + 0.5
    file = store(make_record(cell, path=moved, cost=150.0))
    found = compare(file, record)
    assert (found.same, found.must_be_same) == (False, True)
    assert found.distance == pytest.approx(0.5 * 2**0.5)
    assert f"150.000000 m before, {record.cost:.6f} m now" in found.words
    assert "it should be the same" in found.words


def test_a_row_whose_budget_is_time_may_come_out_otherwise(store):
    cell = make_cell(budget=Budget(wall_s=0.1))
    file = store(make_record(cell))
    found = compare(file, make_record(cell, path=None, cost=None))
    assert (found.same, found.must_be_same, found.distance) == (False, False, None)
    assert "that is to be expected" in found.words
