"""What the pictures of how planners compare show, and that they are made of whatever there is."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

from suite.planner import PlanStatus
from suite.report.figures.comparison import comparison_figures
from suite.report.figures.convergence import convergence_figures, plot_convergence
from suite.report.figures.files import save
from suite.report.figures.overview import overview_figures
from suite.report.figures.ranks import joined, rank_figures
from suite.report.figures.runtime import plot_ecdf, runtime_figures
from suite.report.figures.style import LEAST_GAP
from suite.report.statistics.anytime import Steps
from tests.suite.report.measured_rows import measured, steps

SCENES = ("zigzag", "maze", "double_u")
NAMES = {
    "convergence-time", "convergence-generations", "convergence-checks", "ecdf",
    "performance-profile", "gap-boxes", "gap-time", "critical-difference", "overview",
}  # fmt: skip


def figures_of(found: Steps) -> dict[str, plt.Figure]:
    made = (
        overview_figures, convergence_figures, runtime_figures, comparison_figures, rank_figures,
    )  # fmt: skip
    return {name: figure for make in made for name, figure in make(found).items()}


def records(scene):
    falling = [[(2.0, 150.0), (8.0 + i, 101.0)] for i in range(3)]
    ends = {
        "kbga": falling,
        "slow": [[(30.0, 100.5)], [(40.0, 100.7)], []],
        "fails": [[], [], []],
        "visibility-graph": [[(0.5, 100.0)]] * 3,
    }
    return [
        measured(planner, seed, reports, scene=scene)
        for planner, runs in ends.items()
        for seed, reports in enumerate(runs)
    ]


@pytest.fixture(scope="module")
def found():
    return steps(*(record for scene in SCENES for record in records(scene)))


@pytest.fixture(scope="module")
def figures(found):
    made = figures_of(found)
    yield made
    for figure in made.values():
        plt.close(figure)


def legend_of(figure):
    (legend,) = figure.legends
    return [text.get_text() for text in legend.get_texts()], legend.get_title().get_text()


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_runs_with_paths_have_every_figure_and_each_says_how_to_read_it(figures):
    assert set(figures) == NAMES
    for figure in figures.values():
        assert len(legend_of(figure)[1]) > 60
        assert figure.get_suptitle()


def test_planners_are_told_apart_by_colour_line_and_marker(figures):
    lines = [line for line in figures["ecdf"].axes[0].lines if len(line.get_xdata()) > 2]
    assert len({line.get_color() for line in lines}) == 4
    assert len({line.get_marker() for line in lines}) == 4
    # Dashes of different lengths have one name.
    assert {line.get_linestyle() for line in lines} == {"-", "--", "-."}


def test_a_median_begins_when_half_of_the_runs_have_a_path(found):
    figure = plot_convergence(found, "wall_s")
    names = legend_of(figure)[0]
    lines = dict(zip(names, figure.axes[0].lines, strict=True))
    x, y = lines["slow"].get_data()
    # Two of three have a path after 40 ms, not one.
    assert np.isnan(y[x < 40.0]).all()
    assert y[x > 41.0] == pytest.approx(0.7)
    assert np.isnan(lines["fails"].get_ydata()).all()
    # The exact solver has no gap, and a logarithmic axis no 0.
    assert np.nanmin(lines["visibility-graph"].get_ydata()) == LEAST_GAP
    plt.close(figure)


def test_who_does_not_count_generations_is_not_drawn_and_named(found):
    silent = [measured("prm", i, [(1.0, 101.0)], improvements=(), generations=None) for i in "12"]
    figure = convergence_figures(steps(*silent, *records("zigzag")))["convergence-generations"]
    names, how_to_read = legend_of(figure)
    assert "prm" not in names
    assert " ".join(how_to_read.split()).endswith("without a count of generations: prm.")
    plt.close("all")


def test_the_share_of_runs_and_targets_that_were_never_reached_is_missing_to_1():
    figure = plot_ecdf(steps(measured("a", 0, [(1.0, 100.0)]), measured("a", 1, [])))
    for axes in figure.axes:
        (line,) = axes.lines
        assert line.get_ydata()[-1] == 0.5
    plt.close(figure)


def test_failures_of_a_planner_without_a_count_of_checks_are_no_line_at_0():
    found = [measured("a", 0, [(1.0, 100.0)], improvements=(), checks=None), measured("a", 1, [])]
    figure = plot_ecdf(steps(*found, measured("b", 0, [(1.0, 100.0)])))
    assert [len(axes.lines) for axes in figure.axes] == [2, 1]
    plt.close(figure)


def test_boxes_say_how_many_runs_found_a_path_where_not_all_did(figures):
    for axes in figures["gap-boxes"].axes[:3]:
        assert texts(axes) == ["2/3", "0/3"]


def test_the_exact_solvers_median_time_is_the_limit(figures):
    for axes in figures["gap-time"].axes[:3]:
        dashed = [li.get_xdata()[0] for li in axes.lines if li.get_linestyle() == "--"]
        assert dashed == pytest.approx([0.5])
    ticks = figures["gap-time"].axes[0].get_yticklabels()
    assert ticks[-1].get_text() == "no path"


def test_the_fastest_planner_stands_at_1_in_the_profile(figures):
    axes = figures["performance-profile"].axes[0]
    curves = dict(zip(legend_of(figures["performance-profile"])[0], axes.lines, strict=True))
    x, y = curves["visibility-graph"].get_data()
    assert y[x <= 1.0].max() == 1.0
    assert curves["fails"].get_ydata().max() == 0.0
    # 40 ms, two of three runs, over half a millisecond.
    assert curves["slow"].get_xdata()[1] == pytest.approx(80.0)


def test_the_diagram_of_ranks_names_all_planners_and_the_critical_difference(figures):
    by_gap, by_time = figures["critical-difference"].axes
    for axes in (by_gap, by_time):
        assert {"kbga", "slow", "fails", "visibility-graph"} <= {
            word for text in texts(axes) for word in text.split()
        }
        # Demsar (2006), Table 5: 2.569 for four; times sqrt(4 * 5 / (6 * 3)).
        assert "CD = 2.71" in texts(axes)


def test_planners_that_do_not_differ_are_joined_in_the_largest_groups():
    # Demsar (2006), Figure 1: CD 1.25 joins nobody but 1.964 to 3.143.
    assert joined([1.964, 2.0, 2.893, 3.143], 1.25) == [(0, 3)]
    assert joined([1.0, 2.0, 3.0, 4.0], 1.5) == [(0, 1), (1, 2), (2, 3)]
    assert joined([1.0, 3.0], 1.5) == []


def test_the_overview_has_every_planner_and_scene_in_the_order_of_the_ranks(figures):
    gaps, times = figures["overview"].axes
    planners = ["visibility-graph", "kbga", "slow", "fails"]
    assert [label.get_text() for label in gaps.get_yticklabels()] == planners
    assert [label.get_text() for label in gaps.get_xticklabels()] == list(SCENES)
    a_row = len(SCENES)
    assert texts(gaps)[::a_row] == ["0.00", "1.00", "0.60, 67 %", "no path"]
    assert texts(times)[::a_row] == ["0.5", "9", "40", "-"]


def test_the_overview_says_of_forty_planners_what_lines_can_no_longer_tell():
    rows = [
        measured(f"p{i}", 0, [(1.0, 101.0 + i)], scene=scene) for i in range(40) for scene in "ab"
    ]
    made = figures_of(steps(*rows))
    assert set(made) == {"overview"}
    assert len(made["overview"].axes[0].get_yticklabels()) == 40
    plt.close("all")


@pytest.mark.parametrize("name", sorted(NAMES))
def test_figures_are_small_files(figures, tmp_path, name):
    save(figures[name], tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size < 150_000


def test_the_same_runs_give_the_same_bytes(found, tmp_path):
    for name in "ab":
        save(rank_figures(found)["critical-difference"], tmp_path / f"{name}.svg")
        save(convergence_figures(found)["convergence-time"], tmp_path / f"{name}.pdf")
        plt.close("all")
    for suffix in (".svg", ".pdf"):
        first, second = ((tmp_path / f"{name}{suffix}").read_bytes() for name in "ab")
        assert first == second


ONE = measured("a", 0, [(1.0, 101.0)])
FAILED = [measured(p, 0, [], status=PlanStatus.ERROR, optimum=None) for p in "abc"]


@pytest.mark.parametrize(
    ("rows", "names"),
    [
        ([], set()),
        (FAILED, set()),
        ([measured("a", 0, [(1.0, 101.0)], optimum=None)], set()),
        ([ONE], NAMES - {"performance-profile", "critical-difference", "overview"}),
        ([ONE, *FAILED[1:]], NAMES - {"critical-difference", "overview"}),
        ([measured(f"p{i}", 0, [(1.0, 101.0)]) for i in range(13)], set()),
    ],
    ids=["no run", "all failed", "no optimum", "one run", "one path", "too many planners"],
)
def test_what_there_is_not_is_not_drawn(rows, names, tmp_path):
    made = figures_of(steps(*rows))
    assert set(made) == names
    for name, figure in made.items():
        save(figure, tmp_path / f"{name}.png")


def test_of_very_many_scenes_the_first_are_drawn_and_the_others_counted(tmp_path):
    rows = [measured("a", 0, [(1.0, 101.0)], scene=f"scattered_{i}") for i in range(18)]
    made = figures_of(steps(*rows))
    assert len(made["gap-boxes"].axes) == 16
    assert "2 more scenes are not drawn" in made["convergence-time"].get_suptitle()
    plt.close("all")
