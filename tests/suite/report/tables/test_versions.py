"""Two stores before and after a change: what got better, what got worse, and what is chance."""

import numpy as np
import pytest

from suite.planner import PlanStatus
from suite.report.tables.versions import compare_versions
from suite.store.read import read_runs
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

RUNS = 20


@pytest.fixture
def runs_of(tmp_path):
    def read(*records):
        file = tmp_path / f"{len(list(tmp_path.iterdir()))}.db"
        with open_store(file) as store:
            store.begin_session({})
            for record in records:
                store.add(record)
        return read_runs(file)

    return read


def costs(mean, *, variant="kbga", spread=1.0, seed=0, runs=RUNS, **changes):
    drawn = mean + spread * np.random.default_rng(seed).standard_normal(runs)
    return [
        make_record(make_cell(seed=i, variant=variant), cost=cost, **changes)
        for i, cost in enumerate(drawn)
    ]


def changes(old, new, **options):
    return compare_versions(old, new, np.random.default_rng(1), **options)


def of(found, measure="cost (m)"):
    frame = found.table.frame
    (row,) = frame[frame["measure"] == measure].to_dict("records")
    return row


def test_a_shorter_path_is_better_by_its_change_and_interval(runs_of):
    found = changes(runs_of(*costs(200.0)), runs_of(*costs(190.0, seed=1)))
    row = of(found)
    assert row["verdict"] == "better"
    assert row["change (%)"] == pytest.approx(-5.0, abs=0.3)
    assert row["low (%)"] < row["change (%)"] < row["high (%)"] < 0.0
    assert (found.better, found.worse) == (1, 0)


def test_a_longer_path_is_worse(runs_of):
    found = changes(runs_of(*costs(190.0)), runs_of(*costs(200.0, seed=1)))
    assert (found.better, found.worse) == (0, 1)
    assert found.summary() == (
        "0 better, 1 worse, 1 same, of 2 comparisons; 2 of times are not counted."
    )


def test_the_same_rows_are_the_same(runs_of):
    runs = runs_of(*costs(190.0))
    found = changes(runs, runs)
    assert set(found.table.frame["verdict"]) == {"same"}
    assert of(found)["p"] == 1.0


def test_failures_are_the_worst_that_can_happen(runs_of):
    lost = [
        make_record(make_cell(seed=i), status=PlanStatus.EXHAUSTED, cost=None) for i in range(RUNS)
    ]
    found = changes(runs_of(*costs(190.0)), runs_of(*lost))
    assert of(found)["verdict"] == "worse"
    assert np.isnan(of(found)["new"])


def test_of_many_questions_chance_answers_none(runs_of):
    names = [f"p{i}" for i in range(20)]
    old, new = (
        runs_of(
            *(r for i, n in enumerate(names) for r in costs(190.0, variant=n, seed=100 * k + i))
        )
        for k in (1, 2)
    )
    found = changes(old, new)
    assert (found.better, found.worse) == (0, 0)


def test_times_decide_only_if_they_are_asked_to(runs_of):
    old = runs_of(*costs(190.0, spread=0.0, wall_s=0.1, time_to_best_s=0.1))
    new = runs_of(*costs(190.0, spread=0.0, wall_s=0.2, time_to_best_s=0.2))
    found = changes(old, new)
    assert of(found, "time total (ms)")["verdict"] == "worse"
    assert found.worse == 0
    assert "do not count for the exit code" in found.table.note
    assert changes(old, new, with_times=True).worse == 2


def test_what_only_one_of_them_has_is_counted_in_the_note(runs_of):
    old = runs_of(*costs(190.0), *costs(190.0, variant="gone"))
    found = changes(old, runs_of(*costs(190.0)))
    assert "1 scenes and planners are in the old store only" in found.table.note
    assert set(found.table.frame["planner"]) == {"kbga"}


def test_stores_with_nothing_in_common_give_an_empty_table(runs_of):
    found = changes(runs_of(), runs_of(*costs(190.0)))
    assert found.table.frame.empty
    assert (found.better, found.worse) == (0, 0)


def test_one_run_each_has_no_interval(runs_of):
    found = changes(runs_of(*costs(190.0)[:1]), runs_of(*costs(191.0)[:1]))
    assert np.isnan(of(found)["low (%)"])
    assert of(found)["verdict"] == "not shown"


def of_planners(number, mean, *, runs, seed=0, **changes):
    """Runs of so many planners that all are alike."""
    return [
        record
        for i in range(number)
        for record in costs(mean, variant=f"p{i}", runs=runs, seed=seed + i, **changes)
    ]


def test_a_difference_that_so_few_runs_cannot_show_is_not_called_the_same(runs_of):
    found = changes(
        runs_of(*of_planners(12, 190.0, runs=5)), runs_of(*of_planners(12, 150.0, runs=5, seed=50))
    )
    frame = found.table.frame
    cost = frame[frame["measure"] == "cost (m)"]
    assert (cost["high (%)"] < -20.0).all()
    assert set(cost["verdict"]) == {"not shown"}
    # Of the 252 orders of 5 and 5 the two that are farthest apart, times 12 comparisons.
    assert cost["p"].min() == pytest.approx(12 * 2 / 252)
    assert "with 5 against 5 and 12 comparisons, the smallest p" in found.summary()
    assert "is 0.095 after Holm's correction" in found.summary()
    assert "6 runs on each side would do" in found.summary()


def test_so_many_runs_as_it_says_would_do_do(runs_of):
    old, new = (
        runs_of(*of_planners(12, mean, runs=6, seed=seed))
        for mean, seed in ((190.0, 0), (150.0, 50))
    )
    found = changes(old, new)
    assert found.better == 12
    assert "Too few" not in found.summary()


def test_equal_costs_of_a_planner_without_chance_are_no_surer_than_others(runs_of):
    # By the normal distribution p would be 0.048 here.
    old, new = (runs_of(*of_planners(12, mean, runs=5, spread=0.0)) for mean in (190.0, 180.0))
    assert changes(old, new).better == 0


def test_if_only_some_measures_have_too_few_runs_they_are_named(runs_of):
    def runs(seed):
        counted = costs(190.0, runs=3, seed=seed)
        uncounted = costs(190.0, runs=3, seed=seed, variant="other", checks=None)
        return runs_of(*counted, *uncounted)

    told = changes(runs(0), runs(1)).summary()
    assert "cost (m), time to best (ms), time total (ms): Too few runs: with 3 against 3" in told
    assert "checks: Too few runs: with 3 against 3 and 1 comparison, " in told
