import numpy as np
import pytest

from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.tables.statistics import (
    planner_statistics,
    scene_statistics,
    scores_by_planner,
    statistics_tables,
)
from tests.suite.report.measured_rows import measured, steps

SCENES = ("zigzag", "maze")


def ending(planner, costs, scene="zigzag"):
    """Runs that end with these costs; None: without a path."""
    return [
        measured(planner, i, [(1.0, cost)] if cost else [], scene=scene)
        for i, cost in enumerate(costs)
    ]


def tables(*records):
    return statistics_tables(steps(*records), np.random.default_rng(0))


@pytest.fixture(scope="module")
def both():
    """kbga wins on zigzag, where all differ, and ties on maze."""
    records = [
        *ending("kbga", [101.0, 102.0, 103.0, 104.0]),
        *ending("rrt", [105.0, 106.0, 107.0, None]),
        *ending("kbga", [100.0] * 4, "maze"),
        *ending("rrt", [100.0] * 4, "maze"),
    ]
    return scores_by_planner(steps(*records))


def test_scores_are_gaps_by_run_and_scene_and_those_without_path_are_infinite(both):
    scenes, scores = both
    assert scenes == list(SCENES)
    assert scores["rrt"][:, 0] == pytest.approx([0.05, 0.06, 0.07, np.inf])
    assert scores["rrt"][:, 1].tolist() == [0.0] * 4


def test_a_run_without_path_is_worse_than_any_path_and_a_tie_counts_half(both):
    frame = planner_statistics(both[1], np.random.default_rng(0), "kbga").set_index("planner")
    better = "P(kbga better)"
    assert frame.loc["rrt", [better, f"{better} low", f"{better} high"]].tolist() == [0.75] * 3
    assert frame.loc["rrt", ["runs", "without path"]].tolist() == [8, 1]
    # The middle half of 0, 0, 0, 0, 5, 6, 7 and infinity.
    assert frame.loc["rrt", "gap IQM (%)"] == pytest.approx(11.0 / 4)
    assert np.isnan(frame.loc["kbga", better])


def test_another_planner_can_be_the_reference(both):
    frame = planner_statistics(both[1], np.random.default_rng(0), "rrt").set_index("planner")
    assert frame.loc["kbga", "P(rrt better)"] == 0.25
    assert scene_statistics(*both, "rrt")["P(rrt better)"].tolist() == [0.0, 0.5]


def test_scene_by_scene_p_values_are_corrected_for_all_of_them(both):
    frame = scene_statistics(*both, "kbga").set_index("scene")
    assert frame["P(kbga better)"].to_dict() == {"zigzag": 1.0, "maze": 0.5}
    # All 4 of kbga before all 4 of the other: two of the 70 orders are as far apart.
    assert frame["p"].to_dict() == pytest.approx({"zigzag": 2 / 70, "maze": 1.0})
    assert frame["Holm's p"].to_dict() == pytest.approx({"zigzag": 4 / 70, "maze": 1.0})


def test_over_a_quarter_of_failures_there_is_no_mean_gap():
    table = tables(*ending("kbga", [100.0] * 4), *ending("rrt", [100.0, 101.0, None, None]))[0]
    text = render(table, TableFormat.MARKDOWN)
    (line,) = [line for line in text.splitlines() if line.startswith("| rrt")]
    assert "none" in line
    assert "inf" not in line


def test_planners_are_compared_with_kbga_or_else_with_the_first_or_with_whom_one_asks_for():
    def title(*planners, **options):
        records = [record for name in planners for record in ending(name, [101.0])]
        found = statistics_tables(steps(*records), np.random.default_rng(0), **options)
        return found[1].title

    assert "Probability that b is better than the planner of the row" in title("b", "a")
    assert "Probability that kbga is better" in title("a", "kbga")
    assert "Probability that a is better" in title("a", "kbga", reference="a")


def test_two_runs_each_have_no_p_values_at_a_glance_and_the_note_says_why():
    records = [*ending("kbga", [101.0, 102.0]), *ending("rrt", [105.0, 106.0])]
    _, glance, rows = tables(*records)
    assert glance.frame["zigzag"].tolist() == ["1.00"]
    for table in (glance, rows):
        assert "Too few runs: with 2 against 2 and 1 comparison, the smallest p" in table.note
        assert "4 runs on each side would do" in table.note
    assert rows.frame["p"].tolist() == pytest.approx([2 / 6])


def test_runs_enough_have_their_p_values_at_a_glance():
    records = [*ending("kbga", [101.0 + i for i in range(4)]), *ending("rrt", [None] * 4)]
    _, glance, _ = tables(*records)
    assert glance.frame["zigzag"].tolist() == ["1.00 (0.029)"]
    assert "Too few" not in glance.note


def test_one_planner_has_its_gap_and_one_seed_no_interval():
    (table,) = tables(*ending("a", [101.0]))
    (row,) = table.frame.to_dict("records")
    assert row["gap IQM (%)"] == pytest.approx(1.0)
    assert np.isnan(row["gap IQM (%) low"])
    assert "better" not in table.frame.columns


def test_without_a_scene_that_all_ran_or_an_optimum_there_is_nothing_to_compare():
    assert tables(*ending("a", [101.0]), *ending("b", [101.0], "maze")) == []
    assert tables(measured("a", 0, [(1.0, 101.0)], optimum=None)) == []


def test_the_same_rows_give_the_same_tables():
    records = [*ending("kbga", [101.0, 102.0, 104.0]), *ending("rrt", [101.5, 102.0, None])]
    one, two = ([render(t, TableFormat.CSV) for t in tables(*records)] for _ in range(2))
    assert one == two


def test_tables_are_fit_for_a_paper():
    records = [*ending("kbga", [101.0, 102.0]), *ending("rrt", [103.0, 104.0])]
    for table in tables(*records):
        assert r"\begin{tabular}" in render(table, TableFormat.LATEX)
        assert render(table, TableFormat.MARKDOWN).startswith("### ")


def alike(planner, cost, times=4, scene="zigzag"):
    """Runs that came out the same."""
    return ending(planner, [cost] * times, scene)


def test_a_planner_that_draws_nothing_counts_once_and_has_no_interval():
    table = tables(*ending("kbga", [101.0, 102.0, 103.0, 104.0]), *alike("grid", 101.5))[0]
    frame = table.frame.set_index("planner")
    assert frame["runs"].to_dict() == {"kbga": 4, "grid": 1}
    assert frame.loc["grid", "gap IQM (%)"] == pytest.approx(1.5)
    assert np.isnan(frame.loc["grid", "gap IQM (%) low"])
    assert frame.loc["grid", "P(kbga better)"] == 0.25
    assert frame.loc["grid", "P(kbga better) low"] < 0.25 < frame.loc["grid", "P(kbga better) high"]
    assert "count once: grid" in table.note


def test_its_one_result_is_compared_by_a_sign_test_however_often_it_was_run():
    def p_value(times):
        costs = [102.0 + i for i in range(6)]
        rows = tables(*ending("kbga", costs), *alike("grid", 101.0, times))[-1]
        assert "a sign test's" in rows.note
        return rows.frame["p"].tolist()

    # All 6 above it: twice one of 64.
    assert p_value(2) == p_value(30) == pytest.approx([2 / 64])


def test_two_planners_that_draw_nothing_need_no_test():
    records = [*ending("kbga", [101.0, 102.0, 103.0]), *alike("grid", 100.5), *alike("exact", 100)]
    found = statistics_tables(steps(*records), np.random.default_rng(0), "exact")
    rows = found[-1].frame.set_index("planner")
    assert np.isnan(rows.loc["grid", ["p", "Holm's p"]].astype(float)).all()
    # Holm's factor is the number of tests: one.
    assert rows.loc["kbga", "Holm's p"] == rows.loc["kbga", "p"] == pytest.approx(0.25)
    assert "nan" not in render(found[-2], TableFormat.MARKDOWN)
    overall = found[0].frame.set_index("planner")
    assert np.isnan(overall.loc["grid", "P(exact better) low"])
    assert "with a constant against 3 and 1 comparison" in found[-1].note
