"""The picture of latencies and ways shows every planner, and what it measures."""

import matplotlib.pyplot as plt
import pandas as pd
import pytest

from suite.report.figures.replanning import plot_replanning

PLANNERS = ("kbga", "slow", "lost")


@pytest.fixture
def figure():
    runs = pd.DataFrame(
        [
            {"key": f"{w}{p}", "scene": "door", "world": w, "variant": p, "gap": gap}
            for w in ("one", "two")
            for p, gap in zip(PLANNERS, (0.0, 0.5, None), strict=True)
        ]
    )
    replans = pd.DataFrame(
        [
            {"key": key, "latency_s": seconds}
            for key in runs["key"]
            if "lost" not in key
            for seconds in (0.001, 0.003, 0.2)
        ]
    )
    made = plot_replanning(runs, replans)
    yield made
    plt.close(made)


def test_each_world_has_a_row_of_two_panels_with_all_planners(figure):
    assert len(figure.axes) == 4
    titles = [axes.get_title(loc="left") for axes in figure.axes[::2]]
    assert titles == ["door, one", "door, two"]
    for axes in figure.axes[::2]:
        assert [label.get_text() for label in axes.get_yticklabels()] == list(PLANNERS)


def test_a_dot_is_the_median_and_a_cross_the_worst_in_milliseconds(figure):
    lines = {line.get_marker(): line.get_xdata() for line in figure.axes[0].lines}
    assert float(lines["o"][0]) == pytest.approx(3.0)
    assert float(lines["x"][0]) == pytest.approx(200.0)


def test_ways_are_per_cent_above_the_exact_follower(figure):
    rings = [line.get_xdata().tolist() for line in figure.axes[1].lines if line.get_marker() == "o"]
    assert rings == [[0.0], [50.0], []]


def test_it_says_how_to_read_it(figure):
    assert "a cross for the worst" in figure.get_supxlabel()
