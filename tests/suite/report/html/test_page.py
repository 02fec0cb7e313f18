"""The page as a file: the same bytes, nothing from elsewhere, and a page whatever the store."""

import os
import re
import shutil
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

import pytest
import shapely

from suite.errors import KbgaBenchError
from suite.harness.cell import run_cell
from suite.harness.single import cell_for, world_for
from suite.planner import PlanStatus
from suite.report.all_tables import read_tables
from suite.report.figures.style import NOTHING
from suite.report.formats import as_texts
from suite.report.html.page import write_report
from suite.report.html.shades import contrast
from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene
from tests.suite.commands import in_own_process
from tests.suite.harness.records import make_cell, make_record
from tests.suite.report.html.stores import failed, ran, some_store, write_store


class Reader(HTMLParser):
    """What a page says: its tags with attributes, its headings, and the texts of its sections."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text: dict[str, str] = {"": ""}
        self.cells: dict[str, list[list[str]]] = {}
        self._section, self._open, self._row, self._table = "", "", False, ""
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        self.tags.append((tag, found))
        self._open = tag
        if tag == "section" and not (found.get("id") or "").startswith("table-"):
            self._section = found["id"] or ""
            self.text[self._section] = ""
        if tag == "table":
            self._table = found["data-table"] or ""
            self.cells[self._table] = []
        if tag == "tr" and self._table:
            self.cells[self._table].append([])
        if tag == "td":
            self.cells[self._table][-1].append("")

    def handle_endtag(self, _tag):
        self._open = ""

    def handle_data(self, data):
        if self._open in ("script", "style"):
            return
        self.text[self._section] += data
        if self._open == "td":
            self.cells[self._table][-1][-1] += data

    def all(self, *names):
        return [found for tag, found in self.tags if tag in names]


def report_of(store: Path) -> Reader:
    write_report(store, store.with_suffix(".html"))
    return Reader(store.with_suffix(".html").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    return some_store(tmp_path_factory.mktemp("report") / "some.db")


@pytest.fixture(scope="module")
def page(store):
    return report_of(store)


@pytest.mark.slow
def test_the_same_store_gives_the_same_bytes_also_in_another_process(page, store, tmp_path):
    env = {**os.environ, "PYTHONHASHSEED": "7"}
    in_own_process("report", store, "-o", tmp_path / "again.html", env=env)
    assert (tmp_path / "again.html").read_bytes() == store.with_suffix(".html").read_bytes()


def test_it_only_reads_the_store(store, tmp_path):
    copy = shutil.copy(store, tmp_path / "copy.db")
    before = copy.read_bytes()
    report_of(copy)
    assert copy.read_bytes() == before


def test_nothing_in_it_comes_from_elsewhere(page, store):
    named = [found.get(name) for _, found in page.tags for name in ("src", "href", "srcset")]
    assert {name[:5] for name in named if name and not name.startswith("#")} <= {"data:"}
    (policy,) = (m["content"] for m in page.all("meta") if "http-equiv" in m)
    assert policy.startswith("default-src 'none';")
    assert store.with_suffix(".html").stat().st_size < 10e6


def test_headings_come_in_order_and_links_lead_somewhere(page):
    levels = [int(tag[1]) for tag, _ in page.tags if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(b - a <= 1 for a, b in pairwise(levels))
    ids = [found["id"] for _, found in page.tags if "id" in found]
    assert len(ids) == len(set(ids))
    targets = {found["href"][1:] for found in page.all("a", "use")}
    assert targets <= set(ids)


def test_pictures_have_words_and_controls_have_labels(page):
    pictures = [f for f in page.all("svg") if f.get("role") == "img"] + page.all("img")
    # The player's is written by its script.
    words = [f.get("alt") or f.get("aria-label") for f in pictures if "data-stage" not in f]
    assert len(words) == 2
    assert all("kbga 15" in text for text in words), "the costs are in it"
    labelled = {found.get("for") for found in page.all("label")}
    controls = [f for f in page.all("input", "select") if f.get("type") != "checkbox"]
    assert {f["id"] for f in controls} <= labelled
    (html,) = page.all("html")
    assert html == {"lang": "en"}


def test_every_table_of_the_store_is_there_as_it_is_printed(page, store):
    tables = read_tables(store)
    assert len(tables) > 5
    for table in tables:
        printed = as_texts(table).to_numpy().tolist()
        assert [row for row in page.cells[table.name] if row] == printed, table.name


def test_the_overview_counts_by_status(page):
    assert "13 runs of mine: 3 planners in 2 scenes, 3 seeds. 12 runs ended" in page.text[""]
    assert [row for row in page.cells["status"] if row] == [
        ["kbga", "6", "6", "0"],
        ["visibility-graph", "6", "6", "0"],
        ["bad-planner", "1", "0", "1"],
    ]


def test_failures_are_told_with_their_reason_and_nothing_in_it_is_taken_for_markup(page):
    (row,) = (row for row in page.cells["failures"] if row)
    assert row[:5] == ["bad-planner", "error", "1", "zigzag", "ValueError: <b>no</b> & no"]
    assert len(row[5]) == 32
    assert page.all("b") == []
    assert "Traceback (most recent call last)" in page.text["failures"]


def test_runs_that_failed_come_before_those_that_only_found_nothing(tmp_path):
    lost = [failed(PlanStatus.EXHAUSTED, None, seed=seed) for seed in range(3)]
    broken = failed(PlanStatus.CRASHED, "signal 11", seed=3)
    page = report_of(write_store(tmp_path / "s.db", [*lost, broken]))
    rows = [row[1:3] for row in page.cells["failures"] if row]
    assert rows == [["crashed", "1"], ["exhausted", "3"]]


def test_no_two_tables_have_the_same_heading(store, tmp_path):
    write_report(store, tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    headings = re.findall(r"<h3>(.*?)</h3>", page)
    assert len(headings) > 10
    assert len(set(headings)) == len(headings)


def test_gaps_have_colours_on_which_their_numbers_are_read(page):
    styles = [found["style"] for found in page.all("td") if found.get("style")]
    pairs = [re.findall("#[0-9a-f]{6}", style) for style in styles]
    # Three planners in two scenes; one of them has no path in the one, and no run in the other.
    assert len(pairs) == 6
    assert all(contrast(*pair) >= 4.5 for pair in pairs)
    assert [ground for ground, _ in pairs].count(NOTHING) == 2


def test_a_table_can_be_of_another_reference(store, tmp_path):
    write_report(store, tmp_path / "r.html", reference="visibility-graph")
    text = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "probability that visibility-graph is better than the planner of the row" in text


def test_what_is_missing_is_counted(page):
    counts = {row[0]: row[1:3] for row in page.cells["missing"] if row}
    assert counts["runs that a matrix wants and that were not done"] == ["2", "never-run 2"]
    assert counts["runs with a path and no count of generations"] == ["6", "visibility-graph 6"]
    assert counts["rows that are outdated"] == ["0", ""]


def test_the_provenance_names_machine_versions_settings_and_commit(page):
    text = page.text["provenance"]
    for words in ("somewhere, a processor, 2 cores", "numpy 2.0.0", "0123456789, with changes"):
        assert words in text
    assert "population_size = 50" in text


def test_every_plot_says_how_to_read_it(page):
    for section in ("convergence", "ecdf", "player"):
        assert "How to read it: " in page.text[section]


# Bad input


def sections_of(page):
    return {found["id"] for found in page.all("section") if "id" in found}


def test_an_empty_store_is_a_page_that_says_so(tmp_path):
    page = report_of(write_store(tmp_path / "empty.db", wanted=[make_cell()]))
    assert "holds no runs yet" in page.text[""]
    assert "no gap to show" in page.text["convergence"]
    assert ["runs that a matrix wants and that were not done", "1"] in [
        row[:2] for row in page.cells["missing"]
    ]


def test_one_run_is_enough(tmp_path):
    page = report_of(write_store(tmp_path / "one.db", [ran("zigzag", "kbga")]))
    assert "1 run of mine: 1 planner in 1 scene, 1 seed. 1 run ended" in page.text[""]
    record = ran("zigzag", "kbga")
    gap = f"{100.0 * (record.cost / record.optimum - 1.0):.2f}"
    assert page.cells["gaps"][1] == ["kbga", gap]
    assert "Every run ended with a path" in page.text["failures"]


def test_without_populations_the_player_says_how_to_get_them(tmp_path):
    page = report_of(write_store(tmp_path / "one.db", [ran("zigzag", "visibility-graph")]))
    assert "The store holds no populations." in page.text["player"]


@pytest.mark.parametrize("status", ["infeasible", "exhausted", "timed_out"])
def test_where_no_run_found_a_path_there_are_sentences_instead_of_charts(tmp_path, status):
    records = [failed(PlanStatus(status), seed=seed) for seed in range(2)]
    page = report_of(write_store(tmp_path / "none.db", records))
    assert "no gap to show" in page.text["convergence"]
    assert page.cells["status"][1] == ["kbga", "2", "2"]
    failures = [row[1] for row in page.cells.get("failures", []) if row]
    assert failures == ([] if status == PlanStatus.INFEASIBLE else [status])


def test_a_scene_without_a_path_has_no_gap_but_a_map(tmp_path, closed_file):
    records = [ran(closed_file, "visibility-graph"), ran("zigzag", "kbga")]
    page = report_of(write_store(tmp_path / "closed.db", records))
    assert "no optimum is known" in page.text["scenes"]
    assert ["scenes without an optimum", "1", "closed"] in [r[:3] for r in page.cells["missing"]]
    assert len([f for f in page.all("svg") if f.get("role") == "img"]) == 3, "two maps, a player"


def wall_scene(file: Path, height: float) -> Path:
    wall = shapely.box(4, 0, 6, height)
    write_scene(make_scene("w", shapely.box(0, 0, 10, 10), [wall], ((1, 3), (9, 3))), file)
    return file


def test_a_scene_that_changed_or_is_gone_is_told_of_and_not_drawn(tmp_path):
    file = wall_scene(tmp_path / "w.geojson", 7)
    store = write_store(tmp_path / "s.db", [ran(file, "visibility-graph")])
    file.unlink()
    assert "It can't be drawn: " in report_of(store).text["scenes"]


def test_rows_of_a_scene_that_changed_since_are_not_drawn_on_it(tmp_path):
    record = ran("zigzag", "kbga")
    other = make_record(make_cell(scene_hash="of before"), snapshots=record.snapshots)
    page = report_of(write_store(tmp_path / "s.db", [other]))
    assert "has changed since" in page.text["scenes"]
    assert ["scenes that are gone or have changed since", "1", "zigzag"] in [
        row[:3] for row in page.cells["missing"]
    ]


def test_names_with_signs_of_markup_are_texts(tmp_path):
    record = make_record(make_cell(variant="</script><i>&'\""))
    page = report_of(write_store(tmp_path / "s.db", [record]))
    assert page.all("i") == []
    assert "</script><i>&'\"" in page.text["scenes"]


def test_a_file_that_cannot_be_a_page_is_refused_beforehand(store, tmp_path):
    with pytest.raises(KbgaBenchError, match=r"reports are \.html"):
        write_report(store, tmp_path / "x.pdf")
    with pytest.raises(KbgaBenchError, match="there is no folder"):
        write_report(store, tmp_path / "none" / "x.html")
    with pytest.raises(KbgaBenchError, match="no such store"):
        write_report(tmp_path / "none.db", tmp_path / "x.html")


def test_simulated_runs_are_shown_as_sheets_and_tables(tmp_path):
    cell = cell_for("door", "visibility-graph", seed=0, world=world_for("door", {}, cold=False))
    page = report_of(write_store(tmp_path / "door.db", [run_cell(cell)]))
    (image,) = page.all("img")
    assert "guided by visibility-graph" in image["alt"]
    assert image["src"].startswith("data:image/png;base64,")
    assert "simulations" in page.cells
    # Of a drive there is no single gap: charts would say that no run found a path.
    assert "convergence" not in page.text
