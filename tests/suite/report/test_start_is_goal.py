"""Where start and goal are one place, a path of any length has an infinite gap."""

import json
import re

import matplotlib.pyplot as plt
import pytest

from suite.report.all_tables import all_tables
from suite.report.figures.comparison import comparison_figures
from suite.report.figures.convergence import convergence_figures
from suite.report.figures.overview import overview_figures
from suite.report.figures.runtime import runtime_figures
from suite.report.formats import as_texts
from suite.report.html.charts import convergence_chart, ecdf_chart
from suite.report.html.page import write_report
from suite.report.statistics.anytime import steps_of
from suite.store.write import open_store
from tests.suite.report.measured_rows import frames_of, measured

HERE = {"scene": "here", "optimum": 0.0, "gap": None}


def runs_here(planner: str, *costs: float):
    """A run for each cost, in a scene of which start and goal are one place."""
    return [measured(planner, i, [(1.0, cost)], **HERE) for i, cost in enumerate(costs)]


RECORDS = [
    *runs_here("visibility-graph", 0.0, 0.0, 0.0),
    *runs_here("plain-ga", 0.0, 0.13, 0.26),
    *runs_here("kbga", 0.2, 0.13, 0.26),
    *(
        measured(p, i, [(1.0, 101.0)])
        for p in ("visibility-graph", "plain-ga", "kbga")
        for i in range(3)
    ),
]
"""plain-ga has a mean cost of 0.13 m; beside a scene of the usual kind."""


@pytest.fixture(scope="module")
def frames():
    return frames_of(*RECORDS)


@pytest.fixture(scope="module")
def tables(frames):
    runs, events = frames
    return {table.name: table for table in all_tables(runs, events=events)}


def of(table, planner, column):
    """What a table prints for a planner in the scene."""
    texts = as_texts(table)
    mine = (table.frame["scene"] == "here") & (table.frame["planner"] == planner)
    return list(texts.loc[mine.to_numpy(), column])


def test_a_mean_gap_with_any_infinite_one_is_infinite(tables):
    summary = tables["summary"]
    assert of(summary, "plain-ga", "gap mean (%)") == ["infinite"]
    assert of(summary, "plain-ga", "gap median (%)") == ["infinite"]
    assert of(summary, "kbga", "gap mean (%)") == ["infinite"]
    assert of(summary, "visibility-graph", "gap mean (%)") == ["0.00"]
    assert of(summary, "plain-ga", "cost mean") == ["0.13"]


def gaps_shown(table):
    """Planner and text of each gap that a table prints for the scene, below it or beside it."""
    texts = as_texts(table)
    if "planner" not in texts:
        return []
    if "here" in texts:
        return list(zip(texts["planner"], texts["here"], strict=True))
    columns = [name for name in texts if "gap" in str(name) and "rank" not in str(name)]
    here = texts[texts["scene"] == "here"] if "scene" in texts else texts[:0]
    return [(row["planner"], row[name]) for _, row in here.iterrows() for name in columns]


def test_no_table_prints_a_gap_of_nothing_for_a_planner_with_a_path_of_some_length(tables):
    shown = [pair for table in tables.values() for pair in gaps_shown(table)]
    assert ("visibility-graph", "0.00") in shown
    assert not [pair for pair in shown if pair[0] == "kbga" and pair[1].startswith("0.00")]
    assert not [pair for pair in shown if pair[0] == "plain-ga" and pair[1].startswith("0.00")]


def test_a_path_with_an_infinite_gap_is_a_path(tables):
    rows = tables["fixed-budget-rows"]
    assert of(rows, "kbga", "with path")[-1] == "3"
    assert set(of(rows, "kbga", "gap median (%)")) == {"infinite"}
    glance = tables["fixed-budget"].frame
    last = glance[(glance["planner"] == "kbga") & (glance["after"] == "1000 ms")]
    assert list(last["here"]) == ["infinite"]


def test_within_any_share_of_nothing_is_only_a_path_of_no_length(tables):
    rows = tables["fixed-target-rows"]
    assert set(of(rows, "kbga", "time median (ms)")) == {"never"}
    assert set(of(rows, "kbga", "reached")) == {"0"}
    assert set(of(rows, "plain-ga", "reached")) == {"1"}
    assert set(of(rows, "visibility-graph", "reached")) == {"3"}


def test_the_shorter_median_ranks_before_an_infinite_gap(tables):
    rows = tables["ranking-rows"]
    assert of(rows, "visibility-graph", "rank by gap") == ["1.00"]
    assert of(rows, "plain-ga", "rank by gap") == ["2.50"]
    assert of(rows, "kbga", "gap median (%)") == ["infinite"]


def test_figures_show_the_other_scenes_and_call_no_path_missing(frames):
    steps = steps_of(*frames)
    boxes = comparison_figures(steps)["gap-boxes"]
    titles = [axes.get_title() for axes in boxes.axes]
    assert any("zigzag" in title for title in titles)
    assert not any("here" in title for title in titles)
    for figures in (convergence_figures(steps), runtime_figures(steps), overview_figures(steps)):
        for figure in figures.values():
            figure.canvas.draw()
    plt.close("all")


def test_of_such_a_scene_alone_there_is_no_picture_of_gaps():
    steps = steps_of(*frames_of(*runs_here("kbga", 0.2, 0.1), *runs_here("plain-ga", 0.0)))
    assert comparison_figures(steps) == {}
    assert convergence_figures(steps) == {}


def test_the_charts_of_the_page_hold_no_number_that_json_has_not(frames):
    steps = steps_of(*frames)
    planners = {"visibility-graph": 0, "plain-ga": 1, "kbga": 2}
    for chart in (convergence_chart(steps, planners), ecdf_chart(steps, planners)):
        json.dumps(chart.data, allow_nan=False)
    assert "here" not in convergence_chart(steps, planners).scenes


def test_the_page_says_infinite(tmp_path):
    with open_store(tmp_path / "s.db") as store:
        store.begin_session({})
        for record in RECORDS:
            store.add(record)
    write_report(tmp_path / "s.db", tmp_path / "s.html")
    page = (tmp_path / "s.html").read_text(encoding="utf-8")
    assert re.search(r">\s*infinite\s*<", page)
