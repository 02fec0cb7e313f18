import numpy as np
import pytest

from suite.harness.cell import run_cell, stream
from suite.harness.single import cell_for
from suite.planner import Budget, PlanStatus, Recorder
from tests.suite.harness.records import make_cell


@pytest.fixture
def run(hostile, wall_file):
    def run_planner(name, source=None, **arguments):
        return run_cell(cell_for(str(source or wall_file), name, seed=1, **arguments))

    return run_planner


def test_a_good_run_is_measured_and_judged(run):
    record = run("wanderer")
    assert record.status is PlanStatus.SOLVED
    assert record.cost > record.optimum
    assert record.gap == pytest.approx(record.cost / record.optimum - 1)
    assert (record.generations, record.generation_of_best, record.checks) == (5, 3, 9)
    assert [e.cost for e in record.improvements] == [100.0, 50.0]
    assert record.time_to_best_s == record.improvements[-1].wall_s
    assert 0.0 < record.time_to_best_s <= record.wall_s
    assert record.trace == ({"best": 50.0, "mean": 60.0},)
    assert record.clearance == 0.0


def test_the_referee_does_not_believe_the_claimed_cost(run):
    record = run("wanderer")
    assert record.claimed_cost == 1.0
    assert record.claim_differs
    assert record.cost > 8.0


def test_the_exact_solver_has_no_gap(run):
    record = run("visibility-graph")
    assert record.gap == pytest.approx(0.0, abs=1e-12)
    assert not record.claim_differs


@pytest.mark.parametrize(
    ("planner", "status", "reason"),
    [
        ("raises", PlanStatus.ERROR, "RuntimeError: no luck today"),
        ("system-exits", PlanStatus.ERROR, "SystemExit: 3"),
        ("eats-memory", PlanStatus.OUT_OF_MEMORY, "MemoryError"),
        ("returns-none", PlanStatus.ERROR, "plan returned NoneType. It must return a Plan."),
        ("returns-no-path", PlanStatus.ERROR, "says 'solved' and returns no path"),
        ("returns-nan", PlanStatus.INVALID, "must be finite"),
        ("returns-text", PlanStatus.INVALID, "not a path"),
        ("cheats", PlanStatus.INVALID, "enters obstacle 1"),
        ("says-crashed", PlanStatus.ERROR, "plan returned the status"),
        ("claims-infeasible", PlanStatus.INVALID, "claims that there is no path"),
        ("refuses", PlanStatus.REFUSED, "not on a Monday"),
    ],
)
def test_every_misbehaviour_is_a_row_with_its_reason(run, planner, status, reason):
    record = run(planner)
    assert record.status is status
    assert reason in record.reason
    assert record.cost is None
    assert record.gap is None


def test_an_exhausted_run_keeps_what_the_planner_says_and_has_no_cost(run):
    record = run("gives-up")
    assert record.status is PlanStatus.EXHAUSTED
    assert (record.cost, record.time_to_best_s) == (None, None)
    assert (record.claimed_cost, record.generation_of_best) == (1234.5, 2)


def test_infeasible_is_the_right_answer_where_there_is_no_path(run, closed_file):
    record = run("claims-infeasible", closed_file)
    assert record.status is PlanStatus.INFEASIBLE
    assert record.optimum is None


def test_a_refused_run_starts_no_clock(hostile, wall_file):
    started = []
    record = run_cell(
        cell_for(str(wall_file), "refuses", seed=0), before_plan=lambda: started.append(1)
    )
    assert not started
    assert record.wall_s is None


def test_a_budget_that_the_planner_does_not_keep_is_refused_by_the_harness(hostile, wall_file):
    record = run_cell(cell_for(str(wall_file), "wanderer", seed=0, budget=Budget(checks=200)))
    assert record.status is PlanStatus.REFUSED
    assert record.reason == (
        "wanderer keeps no budget of checks. Give one that it keeps: generations."
    )


def test_what_a_planner_reports_is_there_for_the_caller_afterwards(hostile, wall_file):
    recorder = Recorder()
    run_cell(cell_for(str(wall_file), "wanderer", seed=0), recorder=recorder)
    assert len(recorder.improvements) == 2


def test_same_cell_same_path_another_seed_another_path(hostile, wall_file):
    def path(seed):
        return run_cell(cell_for(str(wall_file), "wanderer", seed=seed)).path

    np.testing.assert_array_equal(path(4), path(4))
    assert not np.array_equal(path(4), path(5))


@pytest.mark.parametrize("change", [{"scene": "b"}, {"query": "b"}, {"variant": "b"}, {"seed": 9}])
def test_scene_query_variant_and_seed_choose_the_stream(change):
    assert stream(make_cell()).random() != stream(make_cell(**change)).random()


def test_a_scene_that_changed_after_the_matrix_was_read_is_an_error(wall_file):
    cell = cell_for(str(wall_file), "visibility-graph", seed=0)
    changed = make_cell(
        scene_source=cell.scene_source, planner="visibility-graph", settings={}, scene_hash="f00"
    )
    record = run_cell(changed)
    assert record.status is PlanStatus.ERROR
    assert "the scene has changed since its rows were made, or wanted" in record.reason


def test_checks_that_were_asked_stand_beside_those_that_were_computed(run, tmp_path):
    record = run("drowsy", settings={"folder": str(tmp_path)})
    assert (record.checks, record.computed_checks) == (7, 3)
    assert run("wanderer").computed_checks is None


def test_nobody_computes_what_was_not_asked(run):
    record = run("computes-more-than-it-asks")
    assert record.status is PlanStatus.ERROR
    assert "computed_checks of the plan are 4, and its checks 3" in record.reason


def test_a_run_that_waited_is_contended(run):
    assert run("sleeper").contended
