"""Pictures of maps: the hardest queries once, and a mark for each query and planner."""

import numpy as np
import pytest
import shapely

from suite.report.figures.files import as_png
from suite.report.figures.maps import (
    HardQuery,
    map_figures,
    plot_map,
    plot_queries,
    seen_bounds,
)
from suite.report.figures.style import LEAST_GAP, numbered
from suite.report.statistics.over_queries import query_measures
from suite.scenes.catalogue import load_scene
from suite.scenes.scene import Query, make_scene
from tests.suite.report.map_rows import asked
from tests.suite.report.measured_rows import steps


def measures_of(*records):
    return query_measures(steps(*records))


def marks(figure):
    """Of the first panel: for each planner the places of its marks."""
    drawn = (line for line in figure.axes[0].lines if line.get_marker() != "None")
    return [np.column_stack(line.get_data()) for line in drawn if len(line.get_xdata())]


def test_each_query_has_a_mark_at_its_length_and_gap_and_above_without_a_path():
    records = [
        *(asked("kbga", f"q{i}", 100.0 + i) for i in range(4)),
        *(asked("prm", f"q{i}", None if i else 110.0) for i in range(4)),
    ]
    figure = plot_queries(measures_of(*records), numbered(["kbga", "prm"]))
    ours, others = marks(figure)
    assert ours[:, 0].tolist() == [100.0] * 4
    assert ours[:, 1] == pytest.approx([LEAST_GAP, 1.0, 2.0, 3.0])
    edge = figure.axes[0].lines[0].get_ydata()[0]
    assert (others[:, 1] > edge).tolist() == [False, True, True, True]
    as_png(figure)


def test_without_a_path_there_is_no_picture():
    assert map_figures(measures_of(*(asked("kbga", f"q{i}", None) for i in range(4))), {}) == {}


def test_a_map_is_drawn_with_the_numbers_of_its_hardest_queries():
    scene = load_scene("zigzag")
    start, goal = scene.queries[0].start, scene.queries[0].goal
    path = np.array([start, [50.0, 50.0], goal])
    hard = [
        HardQuery(Query("one", start, goal), {"kbga": path, "prm": None}),
        HardQuery(Query("two", goal, start), {"kbga": path[::-1], "prm": path[::-1]}),
    ]
    figure = plot_map(scene, hard, numbered(["kbga", "prm"]), 100)
    assert [text.get_text() for text in figure.axes[0].texts] == ["1", "2"]
    lines = [line for line in figure.axes[0].lines if len(line.get_xdata()) == 3]
    assert len(lines) == 3
    legend = figure.legends[0]
    assert [text.get_text() for text in legend.get_texts()] == ["kbga", "prm"]
    assert "2 of 100 queries" in legend.get_title().get_text().replace("\n", " ")
    as_png(figure)


def test_a_map_is_shown_where_its_queries_are_and_not_where_all_is_closed():
    yard = shapely.box(40, 40, 50, 45)
    court = shapely.box(80, 80, 81, 81)
    unknown = shapely.box(0, 0, 100, 100).difference(yard).difference(court)
    scene = make_scene(
        "mostly unknown", shapely.box(0, 0, 100, 100), [unknown], ((41, 41), (49, 44))
    )
    assert seen_bounds(scene, scene.queries) == pytest.approx((39.8, 39.8, 50.2, 45.2))
    whole = load_scene("zigzag")
    assert seen_bounds(whole, whole.queries) == pytest.approx((-2.0, -2.0, 102.0, 102.0))
