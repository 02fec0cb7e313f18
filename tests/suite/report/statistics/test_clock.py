"""What a busy machine has spoilt is in no comparison by the clock, and everybody says how much."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

from suite.planner import Budget
from suite.report.all_tables import all_tables
from suite.report.figures.comparison import comparison_figures
from suite.report.figures.convergence import counted_groups
from suite.report.figures.runtime import plot_profile, runtime_figures
from suite.report.statistics.anytime import final_gaps, on_clock
from suite.report.statistics.clock import by_the_clock, fair, outcome_stands
from suite.report.tables.budgets import budget_tables, fixed_budget
from suite.report.tables.ranking import scene_scores
from suite.report.tables.targets import fixed_target, target_tables
from suite.report.tables.versions import compare_versions
from suite.store.record import World
from tests.suite.harness.records import make_cell, make_record
from tests.suite.report.measured_rows import frames_of, measured, steps
from tests.suite.report.study_rows import run, runs_of

FAST, LATE = [(2.0, 100.5)], [(40.0, 100.5)]
TIMED = Budget(wall_s=1.0)


def table(tables, name):
    return next(table for table in tables if table.name == name)


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


@pytest.fixture
def busy():
    """Of five runs of kbga three had no core, and took twenty times as long."""
    clean = [measured("kbga", i, FAST) for i in range(2)]
    busy = [measured("kbga", i, LATE, contended=True, wall_s=0.9) for i in range(2, 5)]
    return [*clean, *busy]


def test_only_a_contended_row_is_out_and_one_that_nobody_measured_is_not():
    records = [run("a", {}, 110.0, seed=i, contended=c) for i, c in enumerate([False, True, None])]
    assert by_the_clock(runs_of(*records)).tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("budget", "stands"),
    [(TIMED, False), (Budget(wall_s=1.0, checks=5), False), (Budget(cpu_s=1.0), True),
     (Budget(generations=5), True), (Budget(), True)],
)  # fmt: skip
def test_an_outcome_falls_with_the_load_only_where_wall_time_ends_the_run(budget, stands):
    runs = runs_of(
        run("a", {}, 110.0, budget=budget, contended=True),
        run("a", {}, 110.0, budget=budget, seed=1, contended=False),
    )
    assert outcome_stands(runs).tolist() == [stands, True]


@pytest.mark.parametrize(("charge", "stands"), [("measured", False), ("zero", True)])
def test_a_world_that_waits_for_nobody_falls_with_the_load(charge, stands):
    cell = make_cell(world=World("door", {"charge": charge}))
    assert outcome_stands(runs_of(make_record(cell, contended=True))).tolist() == [stands]


def test_fair_rows_keep_costs_and_cpu_time_and_lose_wall_times():
    rows = fair(
        runs_of(
            run("a", {}, 110.0, contended=True),
            run("a", {}, 120.0, seed=1, budget=TIMED, contended=True),
            run("a", {}, 130.0, seed=2, budget=TIMED),
        )
    )
    assert rows["cost"].tolist() == [110.0, 130.0]
    assert rows["wall_s"].isna().tolist() == [True, False]
    assert rows["time_to_best_s"].isna().tolist() == [True, False]
    assert rows["cpu_s"].notna().all()


def test_times_to_a_target_are_medians_over_the_others(busy):
    (row,) = fixed_target(steps(*busy)).query("`target (%)` == 1.0").to_dict("records")
    assert row["time median (ms)"] == pytest.approx(2.0)
    assert (row["runs"], row["reached"]) == (5, 5)
    # On the other clocks load does little: these are over all five.
    assert row["checks median"] == 400.0
    assert "leave out 3 of 5 runs" in target_tables(steps(*busy))[0].note


def test_where_every_run_was_contended_no_time_is_told():
    runs = [measured("kbga", i, LATE, contended=True) for i in range(2)]
    glance = target_tables(steps(*runs))[0].frame
    assert glance["zigzag"].tolist()[:3] == ["contended (2 of 2)"] * 3
    assert fixed_budget(steps(*runs)).empty


def test_a_fixed_wall_time_counts_the_others_only(busy):
    frame = fixed_budget(steps(*busy)).set_index("budget (ms)")
    assert frame.loc[3.0, ["runs", "with path"]].tolist() == [2, 2]
    assert "leave out 3 of 5 runs" in budget_tables(steps(*busy))[-1].note


def test_ranks_by_time_are_of_the_others_and_of_scenes_where_all_have_some(busy):
    scores = scene_scores(steps(*busy))
    assert scores["time to 1 % median (ms)"].tolist() == [pytest.approx(2.0)]
    slow = [measured("prm", i, FAST, contended=True) for i in range(2)]
    everywhere = [
        measured(planner, i, FAST, scene="maze") for planner in ("kbga", "prm") for i in range(2)
    ]
    tables = all_tables(*_frames(*busy, *slow, *everywhere))
    note = table(tables, "ranking").note
    assert "rank by gap, 2 scenes" in note
    assert "rank by time, 1 scene:" in note


def _frames(*records):
    runs, events = frames_of(*records)
    return runs, None, events


def test_pictures_by_the_clock_leave_them_out_and_others_do_not(busy):
    known = steps(*busy)
    assert len(on_clock(known, "wall_s").runs) == 2
    assert len(on_clock(known, "checks").runs) == 5
    assert [len(rows) for rows in counted_groups(known, "wall_s").values()] == [2]
    assert [len(rows) for rows in counted_groups(known, "checks").values()] == [5]
    assert np.isfinite(final_gaps(known)).all()
    drawn = runtime_figures(known) | comparison_figures(known)
    assert {"ecdf", "gap-time", "gap-boxes"} <= set(drawn)


def test_pictures_of_contended_runs_alone_are_those_without_time():
    known = steps(*(measured("kbga", i, LATE, contended=True) for i in range(3)))
    assert set(comparison_figures(known)) == {"gap-boxes"}
    assert set(runtime_figures(known)) == {"ecdf"}


def test_every_table_says_how_many_rows_it_does_not_count(busy):
    ended = [measured("rrt", i, [(1.0, 300.0)], budget=TIMED, contended=i < 2) for i in range(3)]
    tables = all_tables(*_frames(*busy, *ended))
    for one in tables:
        assert "Left out: 2 rows of runs that the clock ended" in one.note, one.name
        assert "no core for themselves (rrt 2)." in one.note, one.name
    frame = table(tables, "summary").frame.set_index("planner")
    assert frame.loc["rrt", "runs"] == 1
    assert frame.loc["kbga", ["runs", "solved"]].tolist() == [5, 5]
    assert frame.loc["kbga", "time total median (ms)"] == pytest.approx(50.0)
    assert "Times leave out 3 of 6 runs" in table(tables, "summary").note


def test_rows_of_an_idle_machine_say_nothing_of_it():
    tables = all_tables(*_frames(*(measured("kbga", i, FAST) for i in range(3))))
    assert all("no core" not in one.note for one in tables)


def test_a_store_whose_rows_are_all_spoilt_has_tables_all_the_same():
    ended = [measured("rrt", i, FAST, budget=TIMED, contended=True) for i in range(3)]
    tables = all_tables(*_frames(*ended))
    assert "Left out: 3 rows" in table(tables, "summary").note


def test_load_is_no_regression():
    before = [run("a", {}, 110.0, seed=i, wall_s=0.1, time_to_best_s=0.1) for i in range(20)]
    slow = {"wall_s": 0.9, "time_to_best_s": 0.9, "contended": True}
    after = [run("a", {}, 110.0, seed=i, **slow) for i in range(20)]
    rng = np.random.default_rng(1)
    found = compare_versions(runs_of(*before), runs_of(*after), rng, with_times=True)
    assert found.worse == 0
    assert "In the new store: times leave out 20 of 20 runs" in found.table.note


def test_worse_paths_of_runs_that_load_cut_short_are_no_regression():
    def timed(cost, **changes):
        return [run("a", {}, cost, seed=i, budget=TIMED, **changes) for i in range(20)]

    rng = np.random.default_rng(1)
    busy = runs_of(*timed(150.0, contended=True))
    assert compare_versions(runs_of(*timed(110.0)), busy, rng).worse == 0
    idle = runs_of(*timed(150.0))
    assert compare_versions(runs_of(*timed(110.0)), idle, rng).worse == 1


def test_a_planner_none_of_whose_runs_had_a_core_is_not_in_the_profile_and_breaks_nothing():
    rows = [measured(name, 0, LATE, contended=name == "b", wall_s=0.9) for name in "abc"]
    scores = scene_scores(steps(*rows))
    plt.close(plot_profile(scores))
