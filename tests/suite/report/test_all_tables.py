import statistics

import pytest

from suite.errors import KbgaBenchError
from suite.planner import PlanStatus
from suite.report.all_tables import all_tables
from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.paper.tables import paper_static, paper_table_1, paper_tables
from suite.report.tables.summary import NARROW, summary, summary_tables
from suite.store.read import read_events, read_runs
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

OPTIMUM = 100.0


@pytest.fixture
def runs_of(tmp_path):
    """Rows as the store gives them, of records made by hand."""

    def read(*records):
        with open_store(tmp_path / "s.db") as store:
            store.begin_session({})
            for record in records:
                store.add(record)
        return read_runs(tmp_path / "s.db")

    return read


def solved(cost, *, seed=0, scene="zigzag", variant="kbga", **changes):
    cell = make_cell(scene=scene, variant=variant, seed=seed)
    return make_record(cell, cost=cost, optimum=OPTIMUM, gap=cost / OPTIMUM - 1.0, **changes)


def exhausted(*, seed=0, scene="zigzag", variant="plain-ga", **changes):
    nothing = dict.fromkeys(("cost", "gap", "time_to_best_s", "cpu_to_best_s"))
    return make_record(
        make_cell(scene=scene, variant=variant, seed=seed),
        status=PlanStatus.EXHAUSTED,
        optimum=OPTIMUM,
        **nothing | changes,
    )


def test_means_and_deviations_are_over_solved_runs_only(runs_of):
    costs = [110.0, 120.0, 160.0]
    frame = summary(
        runs_of(
            *(solved(cost, seed=i, generation_of_best=10 * i) for i, cost in enumerate(costs)),
            exhausted(seed=3, variant="kbga", generation_of_best=1000),
        )
    )
    (row,) = frame.to_dict("records")
    assert (row["scene"], row["planner"], row["runs"], row["solved"]) == ("zigzag", "kbga", 4, 3)
    assert row["success (%)"] == 75.0
    assert row["cost best"] == 110.0
    assert row["cost mean"] == pytest.approx(statistics.mean(costs))
    assert row["cost SD"] == pytest.approx(statistics.stdev(costs))
    assert row["gap mean (%)"] == pytest.approx(30.0)
    assert row["gen to best mean"] == pytest.approx(10.0)
    assert row["time to best mean (ms)"] == pytest.approx(30.0)
    assert row["time total mean (ms)"] == pytest.approx(50.0)
    assert (row["without path"], row["failed"], row["otherwise"]) == (1, 0, "1 exhausted")
    assert row["gap median (%)"] == pytest.approx(20.0)


def test_failed_are_the_runs_that_are_run_again_and_no_others(runs_of):
    ends = [status for status in PlanStatus if status is not PlanStatus.SOLVED]
    runs = runs_of(
        solved(110.0),
        *(make_record(make_cell(seed=i), status=status) for i, status in enumerate(ends, start=1)),
    )
    (row,) = summary(runs).to_dict("records")
    assert row["failed"] == len(PlanStatus.FAILURES) == 5
    # The proof that there is no path is a success; exhausted and refused ended properly.
    assert (row["solved"], row["without path"]) == (2, 7)
    note = summary_tables(runs)[0].note
    assert note.startswith("9 runs: 2 solved, 7 without path, of these 5 failed.")
    assert all(status in note for status in PlanStatus.FAILURES)


def test_the_summary_is_narrow_and_the_rows_behind_it_have_all_columns(runs_of):
    names = ("a-planner-with-a-long-name", "kbga")
    runs = runs_of(*(solved(15000.0, variant=name, wall_s=600.0) for name in names))
    few, all_ = summary_tables(runs)
    assert max(map(len, render(few, TableFormat.TABLE).splitlines())) <= 100
    assert list(few.frame.columns) == NARROW
    assert set(NARROW) < set(all_.frame.columns)
    assert all_.detail


def test_a_proof_that_there_is_no_path_is_a_success_without_a_cost(runs_of):
    frame = summary(runs_of(exhausted().__class__(make_cell(), PlanStatus.INFEASIBLE)))
    assert frame["success (%)"].tolist() == [100.0]
    assert frame["cost mean"].isna().all()


def test_one_run_has_no_deviation(runs_of):
    assert summary(runs_of(solved(110.0)))["cost SD"].isna().all()


def test_an_empty_store_has_an_empty_summary(runs_of):
    assert summary(runs_of()).empty
    assert [t.name for t in all_tables(runs_of())] == ["summary", "summary-rows"]


def test_rows_of_a_scene_that_changed_are_left_out_and_counted(runs_of):
    before = make_record(make_cell(scene_hash="old", seed=0), started_at="2026-01-01T00:00:00")
    after = make_record(make_cell(scene_hash="new", seed=1), started_at="2026-01-02T00:00:00")
    again = make_record(make_cell(scene_hash="new", seed=2), started_at="2026-01-02T00:00:01")
    other = make_record(make_cell(scene="maze", seed=3), started_at="2026-01-01T00:00:00")
    table = all_tables(runs_of(before, after, again, other))[0]
    assert table.frame.set_index("scene")["runs"].to_dict() == {"zigzag": 2, "maze": 1}
    assert "Left out: 1 rows" in table.note


def table_1(runs_of):
    runs = runs_of(
        solved(156.0, seed=0),
        solved(158.0, seed=1),
        solved(300.0, seed=0, variant="plain-ga", claimed_cost=300.0),
        exhausted(seed=1, claimed_cost=500.0),
    )
    return paper_table_1(runs).set_index(["quantity", "statistic"])


def test_table_1_has_the_paper_beside_ours(runs_of):
    frame = table_1(runs_of)
    cost = frame.loc[("best found path cost", "mean")]
    assert cost.tolist() == [156.31, 157.0, 352.35, 300.0]
    sd = frame.loc[("best found path cost", "sd")]
    assert (sd["paper with"], sd["paper without"]) == (0.47, 42.36)
    assert sd["ours with"] == pytest.approx(statistics.stdev([156.0, 158.0]))
    generations = frame.loc[("generations needed", "mean")]
    assert (generations["paper with"], generations["paper without"]) == (52.0, 346.0)


def test_table_1_counts_feasible_runs_and_shows_penalised_costs_apart(runs_of):
    frame = table_1(runs_of)
    assert frame.loc[("feasible runs", ""), "ours without"] == 1
    assert frame.loc[("number of runs", ""), "ours without"] == 2
    assert frame.loc[("cost, all runs, penalties included", "mean"), "ours without"] == 400.0


def test_static_results_show_both_of_the_papers_contradicting_deviations(runs_of):
    frame = paper_static(runs_of(solved(156.0), solved(157.0, seed=1)))
    cost = frame[frame["quantity"] == "cost"]
    assert cost["paper SD"].tolist() == [1.99, 0.47]
    assert cost["paper's place"].tolist() == ["section III-B", "Table 1"]
    assert cost["ours mean"].tolist() == [156.5, 156.5]
    assert cost["paper best"].tolist() == [155.89, 155.89]
    assert cost["feasible"].tolist() == ["2 of 2", "2 of 2"]
    times = frame[frame["quantity"] == "time needed (s)"]
    assert times["paper SD"].tolist() == [1.37, 0.77]


def test_static_results_of_clustered_and_of_the_numbers_of_obstacles(runs_of):
    frame = paper_static(
        runs_of(solved(160.0, scene="clustered"), solved(120.0, scene="obstacles_30"))
    )
    cost = frame[(frame["scene"] == "clustered") & (frame["quantity"] == "cost")]
    assert cost["paper best"].tolist() == [160.50]
    assert cost["paper mean"].isna().all()
    time = frame[(frame["scene"] == "obstacles_30") & (frame["quantity"] == "time needed (s)")]
    assert time["paper mean"].tolist() == [11.54]


def test_both_readings_of_the_generations_stand_beside_the_papers(runs_of):
    run = solved(156.0, generation_of_best=30, generations=45)
    runs = runs_of(run, exhausted(generations=100))
    static = paper_static(runs)
    static = static[static["paper's place"] == "Table 1"].set_index("quantity")
    assert static.loc["generations needed", "ours mean"] == 30.0
    assert static.loc["generations until the stop", "ours mean"] == 45.0
    assert static.loc["generations needed", "cut off"] == 0
    table = paper_table_1(runs).set_index(["quantity", "statistic"])
    assert table.loc[("generations until the stop", "mean"), "ours with"] == 45.0
    assert table.loc[("runs cut off by a limit", ""), "ours without"] == 1, "by its budget of 100"
    stop = runs.assign(settings='{"generations_counted": "stop"}')
    needed = paper_static(stop).set_index("quantity").loc["generations needed", "ours mean"]
    assert set(needed) == {45.0}
    assert "generations until the best" in set(paper_table_1(stop)["quantity"])


def test_the_excess_over_the_best_stands_beside_the_cost(runs_of):
    frame = paper_static(runs_of(solved(103.0, scene="maze")))
    cost = frame[frame["quantity"] == "cost"]
    assert cost["paper over best (%)"].tolist() == pytest.approx([1.70], abs=0.01)
    assert cost["ours over optimum (%)"].tolist() == pytest.approx([3.0])


def test_our_own_planner_has_columns_of_its_own_where_it_was_run(runs_of):
    paper = [solved(156.0), exhausted()]
    with_plus = runs_of(*paper, solved(155.8, variant="kbga-plus"))
    static, table = paper_static(with_plus), paper_table_1(with_plus)
    cost = static[static["quantity"] == "cost"]
    assert set(cost["ours mean"]) == {156.0}
    assert set(cost["ours mean, kbga-plus"]) == {155.8}
    assert table["ours with, kbga-plus"].tolist()[:3] == [1, 1, 155.8]
    without = with_plus[with_plus["variant"] != "kbga-plus"]
    for frame in (paper_static(without), paper_table_1(without)):
        assert not any("plus" in column for column in frame)


def test_tables_that_the_runs_cannot_answer_are_left_out(runs_of):
    names = [table.name for table in paper_tables(runs_of(solved(156.0)))]
    assert names == ["paper-static"]


def test_every_table_of_times_says_that_the_papers_machine_was_another(runs_of):
    runs = runs_of(solved(156.0), exhausted())
    notes = {table.name: table.note for table in paper_tables(runs)}
    for name in ("paper-table-1", "paper-static"):
        assert "Pentium III" in notes[name]


@pytest.fixture
def every_table(runs_of, tmp_path):
    """Of two planners on the paper's scene, twice."""
    when = {"started_at": "2026-01-01T00:00:00"}
    runs = runs_of(
        *(solved(156.0 + seed, seed=seed, **when) for seed in range(2)),
        *(exhausted(seed=seed, **when) for seed in range(2)),
    )
    events = read_events(tmp_path / "s.db")
    return [all_tables(runs, events=events) for _ in range(2)]


def test_the_summary_comes_first_then_the_ranking_and_the_paper_last(every_table):
    names = [table.name for table in every_table[0]]
    assert names[0] == "summary"
    assert names.index("ranking") < names.index("fixed-target") < names.index("statistics")
    assert names[-3:] == ["paper-figures", "paper-table-1", "paper-static"]


def test_the_same_rows_give_the_same_bytes(every_table):
    one, two = ([render(t, TableFormat.CSV) for t in tables] for tables in every_table)
    assert one == two


def test_no_two_tables_have_the_same_name_or_title(every_table):
    names, titles = zip(*((t.name, t.title) for t in every_table[0]), strict=True)
    assert len(set(names)) == len(names) > 10
    assert len(set(titles)) == len(titles)


def test_without_events_there_is_no_ranking_and_there_are_no_statistics(runs_of):
    names = {table.name for table in all_tables(runs_of(solved(156.0), exhausted()))}
    assert not names & {"ranking", "statistics", "fixed-target"}


def test_settings_of_our_own_are_no_answer_to_the_paper(runs_of):
    population = '{"population_size": 50}'
    runs = runs_of(solved(110.0, scene="mine")).assign(settings=population)
    assert "paper-figures" not in [table.name for table in all_tables(runs)]
    runs = runs_of(solved(156.0, scene="zigzag")).assign(settings=population)
    (figures,) = (table.frame for table in all_tables(runs) if table.name == "paper-figures")
    assert "population_size" in set(figures["figure"])


def test_a_reference_that_nobody_ran_is_refused_with_the_names_that_there_are(runs_of):
    with pytest.raises(KbgaBenchError, match=r"no planner 'rrt' .* Take one of: kbga, plain-ga"):
        all_tables(runs_of(solved(156.0), exhausted()), reference="rrt")
