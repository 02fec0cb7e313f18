"""What the charts and the player hold: the numbers of the store, thinned but true."""

import numpy as np
import pytest

from suite.report.figures.runtime import TARGETS
from suite.report.figures.style import numbered
from suite.report.html.appearance import COLOURS, PLANNERS_AT_MOST, appearance
from suite.report.html.charts import ALL_SCENES, LINES_AT_MOST, convergence_chart, ecdf_chart
from suite.report.html.evidence import read_evidence
from suite.report.html.player import played_runs
from suite.report.html.scenes import SCENES_AT_MOST, scene_pictures
from suite.report.statistics.anytime import steps_of
from suite.store.read import read_events, read_paths, read_runs
from tests.suite.harness.records import make_cell, make_record
from tests.suite.report.html.stores import failed, some_store, write_store


@pytest.fixture(scope="module")
def evidence(tmp_path_factory):
    return read_evidence(some_store(tmp_path_factory.mktemp("charts") / "some.db"))


def lines_of(chart, **wanted):
    chosen = [
        line["trace"]
        for line in chart.lines
        if all(line[name] == value for name, value in wanted.items())
    ]
    return [trace for trace in chosen if trace.get("name")]


def test_a_line_ends_at_the_median_gap_of_its_runs(evidence):
    chart = convergence_chart(evidence.steps, evidence.planners)
    runs = evidence.steps.runs
    for scene in ("zigzag", "double_u"):
        (line,) = lines_of(chart, scene=scene, clock="wall_s", planner="kbga")
        gaps = runs.loc[(runs["place"] == scene) & (runs["variant"] == "kbga"), "gap"]
        assert line["customdata"][-1] == pytest.approx(100 * gaps.median(), rel=1e-3, abs=1e-6)
        assert line["y"] == sorted(line["y"], reverse=True)


def test_a_share_is_that_of_all_runs_and_targets_those_of_failed_runs_too(evidence):
    chart = ecdf_chart(evidence.steps, evidence.planners)
    runs = evidence.steps.runs
    (line,) = lines_of(chart, scene=ALL_SCENES, clock="wall_s", planner="kbga")
    reached = [(runs.loc[runs["variant"] == "kbga", "gap"] <= t).mean() for t in TARGETS]
    assert line["y"][-1] == pytest.approx(100 * np.mean(reached), rel=1e-3)
    (line,) = lines_of(chart, scene=ALL_SCENES, clock="wall_s", planner="bad-planner")
    assert set(line["y"]) == {0.0}


def test_a_chart_has_room_for_so_many_scenes_and_says_how_many_it_left_out(tmp_path):
    records = [
        make_record(make_cell(scene=f"scene {i}", variant=f"planner {j}"))
        for i in range(30)
        for j in range(20)
    ]
    file = write_store(tmp_path / "many.db", records)
    steps = steps_of(read_runs(file), read_events(file))
    planners = numbered(steps.runs["variant"])
    chart = convergence_chart(steps, planners)
    assert len(chart.scenes) == LINES_AT_MOST // 20 < SCENES_AT_MOST
    assert chart.left_out == 30 - len(chart.scenes)
    assert len(ecdf_chart(steps, planners).scenes) == len(chart.scenes) + 1


def test_without_a_path_there_is_no_chart(tmp_path):
    found = read_evidence(write_store(tmp_path / "none.db", [failed()]))
    assert convergence_chart(found.steps, found.planners) is None
    assert ecdf_chart(found.steps, found.planners) is None


def test_the_player_ends_with_the_cost_of_the_row_and_its_measures(evidence):
    played, left_out = played_runs(evidence, scene_pictures(evidence)[0])
    assert (len(played), left_out) == (6, 0)
    costs = dict(zip(evidence.runs["key"], evidence.runs["cost"], strict=True))
    by_label = {
        f"{row['variant']} on {row['scene']}, seed {row['seed']}": row["key"]
        for row in evidence.runs.to_dict("records")
    }
    for run in played:
        last = run.frames[-1]
        assert last["cost"] == pytest.approx(costs[by_label[run.label]], abs=1e-3)
        assert run.frames[0]["g"] == 0
        assert all(0.0 <= frame["share"] <= 1.0 for frame in run.frames)
        assert all(frame["n"] == 50 for frame in run.frames)


def test_a_picture_shows_the_cheapest_path_where_it_is(evidence):
    zigzag = scene_pictures(evidence)[0][0]
    runs = evidence.steps.runs
    mine = runs[(runs["place"] == "zigzag") & (runs["variant"] == "kbga")]
    best = mine.loc[mine["cost"].idxmin()]
    (shown,) = (path for path in zigzag.paths if path.planner == "kbga")
    assert shown.cost == best["cost"]
    # The workspace is 100 m wide and drawn 1000 units wide; y points down in the picture.
    xy = read_paths(evidence.store)[best["key"]]
    units = np.array([pair.split() for pair in shown.d[1:].split("L")], dtype=float)
    np.testing.assert_allclose(units / 10.0, np.column_stack([xy[:, 0], 100 - xy[:, 1]]), atol=0.05)


def luminance(colour):
    """Relative luminance, as WCAG 2.1 defines it."""
    parts = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    linear = np.where(parts <= 0.03928, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def test_lines_stand_out_from_the_page_and_from_each_other():
    assert all(1.05 / (luminance(colour) + 0.05) >= 3.0 for colour in COLOURS)
    assert len({appearance(i) for i in range(PLANNERS_AT_MOST)}) == PLANNERS_AT_MOST
