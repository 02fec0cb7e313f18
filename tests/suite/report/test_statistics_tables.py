import numpy as np
import pytest

from suite.report.statistics_tables import (
    planner_statistics,
    scene_statistics,
    scores_by_planner,
    statistics_tables,
)
from suite.report.table import Format, render
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


def test_scores_are_gaps_by_run_and_scene_and_failures_are_infinite(both):
    scenes, scores = both
    assert scenes == list(SCENES)
    assert scores["rrt"][:, 0] == pytest.approx([0.05, 0.06, 0.07, np.inf])
    assert scores["rrt"][:, 1].tolist() == [0.0] * 4


def test_a_failed_run_is_worse_than_any_path_and_a_tie_counts_half(both):
    frame = planner_statistics(both[1], np.random.default_rng(0)).set_index("planner")
    assert frame.loc["rrt", "kbga better"] == 0.75
    assert (frame.loc["rrt", "kbga better low"], frame.loc["rrt", "kbga better high"]) == (
        0.75,
        0.75,
    )
    assert frame.loc["rrt", ["runs", "failed"]].tolist() == [8, 1]
    # The middle half of 0, 0, 0, 0, 5, 6, 7 and infinity.
    assert frame.loc["rrt", "gap IQM (%)"] == pytest.approx(11.0 / 4)
    assert np.isnan(frame.loc["kbga", "kbga better"])


def test_scene_by_scene_p_values_are_corrected_for_all_of_them(both):
    frame = scene_statistics(*both).set_index("scene")
    assert frame["kbga better"].to_dict() == {"zigzag": 1.0, "maze": 0.5}
    # All 4 of kbga before all 4 of the other: two of the 70 orders are as far apart.
    assert frame["p"].to_dict() == pytest.approx({"zigzag": 2 / 70, "maze": 1.0})
    assert frame["Holm's p"].to_dict() == pytest.approx({"zigzag": 4 / 70, "maze": 1.0})


def test_over_a_quarter_of_failures_there_is_no_mean_gap():
    table = tables(*ending("kbga", [100.0] * 4), *ending("rrt", [100.0, 101.0, None, None]))[0]
    text = render(table, Format.MARKDOWN)
    (line,) = [line for line in text.splitlines() if line.startswith("| rrt")]
    assert "none" in line
    assert "inf" not in line


def test_planners_are_compared_with_kbga_or_else_with_the_first():
    assert (
        "Probability that b is better"
        in tables(*ending("b", [101.0]), *ending("a", [102.0]))[1].title
    )
    assert (
        "Probability that kbga is" in tables(*ending("a", [1.0]), *ending("kbga", [1.0]))[1].title
    )


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
    one, two = ([render(t, Format.CSV) for t in tables(*records)] for _ in range(2))
    assert one == two


def test_tables_are_fit_for_a_paper():
    records = [*ending("kbga", [101.0, 102.0]), *ending("rrt", [103.0, 104.0])]
    for table in tables(*records):
        assert r"\begin{tabular}" in render(table, Format.LATEX)
        assert render(table, Format.MARKDOWN).startswith("### ")
