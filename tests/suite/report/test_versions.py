"""Two stores before and after a change: what got better, what got worse, and what is chance."""

import numpy as np
import pytest

from suite.planner import PlanStatus
from suite.report.versions import compare_versions
from suite.store import open_store, read_runs
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


def costs(mean, *, variant="kbga", spread=1.0, seed=0, **changes):
    drawn = mean + spread * np.random.default_rng(seed).standard_normal(RUNS)
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
    assert found.summary() == "0 better, 1 worse, of 4 comparisons."


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
    assert of(found)["verdict"] == "same"
