"""The panel of a map on the page: its table, its hardest queries, a mark for each query."""

import json
import re
from dataclasses import replace

import pytest

from suite.report.html.evidence import read_evidence
from suite.report.html.maps import map_panels
from suite.report.html.page import render_report
from suite.report.statistics.over_queries import HARDEST
from tests.perf.many_queries import write_many
from tests.suite.report.html import test_page

QUERIES, PLANNERS, BLOCKED = 60, 3, 1


@pytest.fixture(scope="module")
def evidence(tmp_path_factory):
    return read_evidence(write_many(tmp_path_factory.mktemp("maps"), QUERIES, PLANNERS))


@pytest.fixture(scope="module")
def panel(evidence):
    (found,), left_out = map_panels(evidence, 0)
    assert left_out == 0
    return found


@pytest.fixture(scope="module")
def page(evidence):
    return render_report(evidence)


def test_a_map_has_one_panel_and_one_drawing_whatever_the_queries(page):
    reader = test_page.Reader(page)
    assert [found["data-map"] for found in reader.all("article") if "data-map" in found] == ["0"]
    assert [f["id"] for f in reader.all("g") if (f.get("id") or "").startswith("scene-")] == [
        "scene-0"
    ]
    assert "scenes" not in reader.text
    assert [row[0] for row in reader.cells["map-0"] if row] == [
        f"planner-{i}" for i in range(PLANNERS)
    ]


def test_no_table_of_the_page_has_a_row_for_each_query(page):
    cells = test_page.Reader(page).cells
    assert max(map(len, cells.values())) < QUERIES
    assert "queries" not in cells
    assert "--only queries --format csv" in page


def test_every_query_has_a_mark_of_every_planner_that_was_asked(panel):
    assert len(panel.scatter["lengths"]) == len(panel.scatter["names"]) == panel.queries == QUERIES
    assert [len(one["gaps"]) for one in panel.scatter["planners"]] == [QUERIES] * PLANNERS
    gaps = [gap for one in panel.scatter["planners"] for gap in one["gaps"]]
    assert all(gap is None or gap >= 0.0 for gap in gaps)
    assert json.dumps(panel.scatter, allow_nan=False)


def test_the_hardest_are_numbered_on_the_map_in_the_table_and_among_the_marks(panel):
    numbers = list(range(1, HARDEST + 1))
    assert [query.number for query in panel.hard] == numbers
    assert [row[0].text for row in panel.hardest.rows] == list(map(str, numbers))
    assert sorted(filter(None, panel.scatter["hard"])) == numbers
    for query, row in zip(panel.hard, panel.hardest.rows, strict=True):
        without = [path.planner for path in query.paths if path.d is None]
        told = dict(zip(panel.hardest.columns[3:], row[3:], strict=True))
        assert [name for name, cell in told.items() if cell.text == "no path"] == without


def test_ends_lie_where_the_paths_begin_and_end(panel):
    for query in panel.hard:
        for path in query.paths:
            if path.d is not None:
                points = re.findall(r"(-?\d+) (-?\d+)", path.d)
                assert tuple(tuple(map(int, points[i])) for i in (0, -1)) == query.ends


def test_queries_that_cannot_be_asked_are_counted_and_are_no_failures(page):
    cells = test_page.Reader(page).cells
    (missing,) = (row for row in cells["missing"] if row and "can't be asked" in row[0])
    assert missing[1] == str(BLOCKED)
    assert not any("outside the workspace" in text for row in cells["failures"] for text in row)
    assert [row[-1] for row in cells["status"] if row] == ["1"] * PLANNERS


def test_a_map_that_is_gone_keeps_its_table_and_its_marks(evidence, tmp_path):
    runs = evidence.steps.runs.assign(scene_source=str(tmp_path / "gone.geojson"))
    steps = replace(evidence.steps, runs=runs)
    (gone,), _ = map_panels(replace(evidence, steps=steps), 0)
    assert gone.drawing is None
    assert "can't be drawn" in gone.reason
    assert gone.scatter is not None
    assert len(gone.table.rows) == PLANNERS
