"""The report as a reader meets it, in Debian's chromium without a window."""

import os
import re
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from playwright.sync_api import expect, sync_playwright

from suite.harness.snapshots import chosen_generations
from suite.report.html.page import write_report
from tests.perf.many_queries import write_many
from tests.suite.report.html.stores import ran, some_store, write_store

CHROMIUM = Path("/usr/bin/chromium")
pytestmark = pytest.mark.skipif(
    not os.access(CHROMIUM, os.X_OK),
    reason=f"no {CHROMIUM}: `make browser` installs it, as root on Debian",
)

BUSY_MS = 300_000.0
"""More than anything takes on a machine that is busy."""
expect.set_options(timeout=BUSY_MS)

STEP_MS = 400
"""How long a generation is shown by a player that plays."""

ARGUMENTS = (
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
)  # fmt: skip


@pytest.fixture(scope="module")
def browser():
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield started
        started.close()


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser")
    write_report(some_store(folder / "some.db"), folder / "some.html")
    return folder / "some.html"


class Seen:
    """A page that is open, what it asked for and what it complained of.

    stands : whether its time stands still, and goes on only as a test lets it.
    """

    def __init__(self, browser, file, *, stands=False, **context):
        self.context = browser.new_context(**context)
        self.context.set_default_timeout(BUSY_MS)
        self.page = self.context.new_page()
        if stands:
            self.page.clock.install()
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(file.as_uri())
        if context.get("java_script_enabled", True):
            # Charts are drawn when plotly is unpacked.
            self.page.wait_for_function("document.documentElement.dataset.drawn === 'yes'")
        if stands:
            # In a while, so that all that a page does when it is opened is done.
            self.page.clock.pause_at(datetime.now() + timedelta(hours=1))

    def column(self, table, number):
        cells = f'[data-table="{table}"] tbody tr:not([hidden]) td:nth-child({number})'
        return self.page.locator(cells).all_text_contents()

    def traces(self, chart):
        drawn = "name => document.getElementById(name + '-plot').data"
        return self.page.evaluate(f"{drawn.replace('data', 'data.map(t => t.name)')}", chart)

    def value(self, name):
        return self.page.locator(f"[data-value={name}]").text_content()


AS_OPENED = """() => {
  for (const box of document.querySelectorAll("input[type=checkbox]"))
    box.checked = box.defaultChecked;
  for (const choice of document.querySelectorAll("select")) {
    choice.selectedIndex = 0;
    choice.dispatchEvent(new Event("change"));
  }
}"""
"""Choices are taken back. How tables are sorted is not: each test sorts for itself."""


@pytest.fixture(scope="module")
def opened(browser, report):
    page = Seen(browser, report)
    yield page
    page.context.close()


@pytest.fixture
def seen(opened, report):
    """The page, which takes seconds to open: once for all tests, who find it as it was opened."""
    opened.page.evaluate(AS_OPENED)
    yield opened
    assert opened.complaints == []
    assert opened.requests == [report.as_uri()], "nothing else is fetched"


def test_a_click_on_a_heading_sorts_by_numbers_and_another_one_turns_round(seen):
    heading = seen.page.locator('[data-table="status"] th').nth(1)
    heading.get_by_role("button").click()
    assert heading.get_attribute("aria-sort") == "ascending"
    assert seen.column("status", 2) == ["1", "6", "6"]
    heading.get_by_role("button").click()
    assert heading.get_attribute("aria-sort") == "descending"
    assert seen.column("status", 2) == ["6", "6", "1"]


def test_the_keyboard_sorts_too_and_only_one_heading_says_so(seen):
    table = seen.page.locator('[data-table="status"]')
    table.locator("th button").nth(1).click()
    table.locator("th button").nth(0).focus()
    seen.page.keyboard.press("Enter")
    assert seen.column("status", 1) == ["bad-planner", "kbga", "visibility-graph"]
    assert table.locator("th[aria-sort]").count() == 1


def test_what_is_missing_comes_last_in_both_orders(seen):
    button = seen.page.locator('[data-table="summary"] th', has_text="cost mean").locator("button")
    number = seen.page.locator('[data-table="summary"] th').all_text_contents().index("cost mean")
    for _ in range(2):
        button.click()
        costs = seen.column("summary", number + 1)
        assert costs[-1] == ""
        assert "" not in costs[:-1]
        assert [float(c) for c in costs[:-1]] in (
            sorted(map(float, costs[:-1])),
            sorted(map(float, costs[:-1]), reverse=True),
        )


def test_a_filter_keeps_the_rows_with_all_its_words_and_counts_them(seen):
    seen.page.locator("#table-fixed-target-rows summary").click()
    box = seen.page.locator("#filter-fixed-target-rows")
    total = len(seen.column("fixed-target-rows", 1))
    box.press_sequentially("KBGA zigzag")
    assert set(seen.column("fixed-target-rows", 1)) == {"zigzag"}
    assert set(seen.column("fixed-target-rows", 2)) == {"kbga"}
    shown = len(seen.column("fixed-target-rows", 1))
    count = seen.page.locator("#count-fixed-target-rows")
    assert count.text_content() == f"{shown} of {total} rows"
    box.fill("")
    assert count.text_content() == f"{total} rows"


@pytest.mark.parametrize("chart", ["convergence", "ecdf"])
def test_scene_clock_and_planners_of_a_chart_can_be_chosen(seen, chart):
    figure = seen.page.locator(f"[data-chart={chart}]")
    figure.locator("select").nth(0).select_option("zigzag")
    # One that failed has no gap, and reached no target.
    failed = {"bad-planner"} if chart == "ecdf" else set()
    assert set(seen.traces(chart)) - {None} == {"kbga", "visibility-graph"} | failed
    box = figure.get_by_role("checkbox", name="kbga", exact=True)
    box.focus()
    seen.page.keyboard.press("Space")
    assert set(seen.traces(chart)) - {None} == {"visibility-graph"} | failed
    figure.locator("select").nth(1).select_option("checks")
    axis = f"document.getElementById('{chart}-plot').layout.xaxis.title.text"
    assert seen.page.evaluate(axis) == "collision checks"


def test_of_many_planners_a_few_are_chosen_from_none(seen):
    figure = seen.page.locator("[data-chart=convergence]")
    figure.get_by_role("button", name="none").click()
    assert set(seen.traces("convergence")) <= {None}
    figure.get_by_role("checkbox", name="kbga", exact=True).click()
    assert set(seen.traces("convergence")) - {None} == {"kbga"}
    figure.get_by_role("button", name="all").click()
    assert set(seen.traces("convergence")) - {None} == {"kbga", "visibility-graph"}


def test_who_is_not_in_a_chart_is_named(seen):
    figure = seen.page.locator("[data-chart=convergence]")
    figure.locator("select").nth(1).select_option("generation")
    assert seen.traces("convergence")[-1] == "kbga"
    assert "do not count: visibility-graph." in figure.locator("[data-silent]").text_content()


def test_hovering_over_a_line_gives_its_numbers(seen):
    seen.page.locator("#ecdf-plot").scroll_into_view_if_needed()
    box = seen.page.locator("#ecdf-plot .nsewdrag").bounding_box()
    seen.page.mouse.move(box["x"] + 0.95 * box["width"], box["y"] + 0.5 * box["height"], steps=5)
    layer = seen.page.locator("#ecdf-plot .hoverlayer")
    every = r"kbga : [\d.]+ %.*visibility-graph : [\d.]+ %.*bad-planner : 0 %"
    expect(layer).to_contain_text(re.compile(every))


def test_no_button_of_a_chart_sends_it_anywhere(seen):
    buttons = seen.page.locator("#ecdf-plot .modebar-btn")
    titles = buttons.evaluate_all("found => found.map(button => button.dataset.title)")
    assert titles == [
        "Download plot as a PNG", "Zoom", "Pan", "Zoom in", "Zoom out", "Reset axes",
    ]  # fmt: skip


def test_the_player_steps_by_click_and_by_keyboard(seen):
    assert seen.value("generation").startswith("0 of ")
    first = seen.page.locator("[data-population]").get_attribute("d")
    seen.page.get_by_role("button", name="Next generation").click()
    assert seen.value("generation").startswith("1 of ")
    assert seen.page.locator("[data-population]").get_attribute("d") != first
    slider = seen.page.get_by_role("slider", name="Generation")
    slider.focus()
    seen.page.keyboard.press("End")
    last = seen.value("generation")
    number, total = last.split(" of ")
    assert number == total
    shown = ran("zigzag", "kbga")
    assert seen.value("cost") == f"{shown.cost:.2f} m"
    assert seen.value("gap") == f"{100.0 * shown.gap:.2f} %"
    assert seen.page.locator("[data-best]").get_attribute("d").startswith("M")
    seen.page.keyboard.press("ArrowLeft")
    before = max(g for g in chosen_generations(100) if g < int(total))  # those that `ran` keeps
    assert seen.value("generation") == f"{before} of {total}"
    assert slider.get_attribute("aria-valuetext").startswith(f"Generation {before}")
    stage = seen.page.locator("[data-stage]").get_attribute("aria-label")
    assert stage.startswith("kbga on zigzag, seed 0. Generation")


def test_the_player_plays_to_the_end_and_can_be_paused(browser, report):
    seen = Seen(browser, report, stands=True)
    play = seen.page.locator("[data-play]")
    slider = seen.page.locator("#player-generation")
    slider.focus()
    seen.page.keyboard.press("End")
    for _ in range(2):
        seen.page.keyboard.press("ArrowLeft")
    play.click()
    assert play.text_content() == "Pause"
    play.click()
    assert play.text_content() == "Play"
    play.click()
    seen.page.clock.run_for(STEP_MS)
    assert play.text_content() == "Pause"
    seen.page.clock.run_for(STEP_MS)
    assert play.text_content() == "Play"
    number, total = seen.value("generation").split(" of ")
    assert number == total
    seen.context.close()


def test_another_run_is_played_on_its_own_scene(seen):
    room = seen.page.locator("[data-room]").get_attribute("href")
    seen.page.get_by_label("Run", exact=True).select_option("kbga on double_u, seed 0")
    assert seen.page.locator("[data-room]").get_attribute("href") != room
    seen.page.get_by_role("button", name="Last generation").click()
    assert seen.value("cost") == f"{ran('double_u', 'kbga').cost:.2f} m"


def test_a_narrow_window_is_not_scrolled_sideways(browser, report):
    narrow = Seen(browser, report, viewport={"width": 400, "height": 800})
    narrow.page.locator("#ecdf-plot .main-svg").first.wait_for()
    assert narrow.page.evaluate("document.documentElement.scrollWidth") == 400
    narrow.context.close()


def test_readers_who_want_no_motion_get_a_slower_player(browser, report):
    calm = Seen(browser, report, stands=True, reduced_motion="reduce")
    style = "getComputedStyle(document.documentElement).scrollBehavior"
    assert calm.page.evaluate(style) == "auto"
    calm.page.locator("[data-play]").click()
    calm.page.clock.run_for(3 * STEP_MS)
    assert calm.value("generation").startswith("0 of ")
    calm.page.clock.run_for(STEP_MS)
    assert calm.value("generation").startswith("1 of ")
    calm.context.close()


def test_tables_and_pictures_are_there_without_scripts(browser, report):
    bare = Seen(browser, report, java_script_enabled=False)
    assert bare.page.get_by_text("need JavaScript").is_visible()
    assert bare.page.locator(".picture svg.map").first.is_visible()
    assert bare.column("status", 1) == ["kbga", "visibility-graph", "bad-planner"]
    bare.context.close()


def test_printed_the_controls_are_gone_and_the_tables_whole(browser, report):
    printed = Seen(browser, report)
    printed.page.emulate_media(media="print")
    assert not printed.page.locator("nav").is_visible()
    assert not printed.page.locator("[data-chart=ecdf] .controls").is_visible()
    region = printed.page.locator("#table-summary .scroll")
    assert region.evaluate("e => getComputedStyle(e).maxHeight") == "none"
    assert printed.page.pdf().startswith(b"%PDF")
    printed.context.close()


def test_an_empty_store_makes_no_complaint(browser, tmp_path):
    write_report(write_store(tmp_path / "e.db"), tmp_path / "e.html")
    empty = Seen(browser, tmp_path / "e.html")
    assert empty.page.get_by_text("holds no runs yet").is_visible()
    assert empty.complaints == []
    empty.context.close()


@pytest.fixture(scope="module")
def town(browser, tmp_path_factory):
    folder = tmp_path_factory.mktemp("town")
    write_report(write_many(folder, 60, 3), folder / "town.html")
    page = Seen(browser, folder / "town.html")
    yield page
    assert page.complaints == []
    assert len(page.requests) == 1
    page.context.close()


@pytest.fixture
def map_panel(town):
    town.page.evaluate(AS_OPENED)
    town.page.locator("[data-map] [data-all=yes]").click()
    return town.page.locator("[data-map]")


def shown(panel, what):
    found = "found => found.filter(e => e.getClientRects().length).map(e => e.dataset.%s)"
    return set(panel.locator(f"[data-{what}]").evaluate_all(found % what))


def test_a_query_that_is_chosen_is_alone_on_its_map(town, map_panel):
    everything = {str(number) for number in range(1, 9)}
    assert shown(map_panel, "query") == everything
    map_panel.get_by_label("Queries of the picture").select_option("3")
    assert shown(map_panel, "query") == {"3"}
    numbers = "document.getElementById('map-0-plot').layout.annotations.map(a => a.text)"
    assert "<b>3</b>" in town.page.evaluate(numbers)


def test_planners_of_a_map_are_chosen_for_the_picture_and_the_marks_alike(town, map_panel):
    map_panel.get_by_role("checkbox", name="planner-1").click()
    assert "planner-1" not in shown(map_panel, "planner")
    assert town.traces("map-0") == ["planner-0", "planner-2"]
    map_panel.get_by_role("button", name="none").click()
    assert shown(map_panel, "planner") == set()
    assert town.traces("map-0") == []


PLACE_OF = """number => {
  const plot = document.getElementById("map-0-plot");
  const { xaxis, yaxis } = plot._fullLayout;
  const { x, y, meta } = plot.data[0];
  const i = meta.indexOf(number);
  const box = plot.getBoundingClientRect();
  return [box.x + xaxis._offset + xaxis.d2p(x[i]), box.y + yaxis._offset + yaxis.d2p(y[i])];
}"""


def test_a_mark_tells_its_query_and_a_click_on_a_hard_one_shows_it_on_the_map(town, map_panel):
    map_panel.locator(".plot").scroll_into_view_if_needed()
    x, y = town.page.evaluate(PLACE_OF, 2)
    town.page.mouse.move(x, y, steps=3)
    hover = map_panel.locator(".hoverlayer")
    expect(hover).to_contain_text(re.compile(r"[\d.,-]+:[\d.,-]+.* m, (gap [\d.e-]+ %|no path)"))
    town.page.mouse.click(x, y)
    expect(map_panel.get_by_label("Queries of the picture")).to_have_value("2")
    assert shown(map_panel, "query") == {"2"}
