"""`plan`, `exact` and `simulate` go where they are told, with a robot of the size that is said."""

import json

import numpy as np
import pytest
import shapely

from suite.scenes.catalogue import load_scene
from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene
from tests.suite.test_cli import error_of, kbga_bench

__all__ = ["error_of", "kbga_bench"]  # fixtures

PLAN = ("plan", "--planner", "visibility-graph")


@pytest.fixture(scope="module")
def hall(tmp_path_factory):
    """Two queries with a path and one without, in a file that a robot of 0.5 m has room in."""
    wall, cell = (
        shapely.box(4, 0, 6, 7),
        shapely.box(7, 1, 10, 4).difference(shapely.box(8, 2, 9, 3)),
    )
    ends = {"low": ((1, 1), (9, 9)), "high": ((3.8, 6), (9, 8)), "shut in": ((1, 1), (8.5, 2.5))}
    file = tmp_path_factory.mktemp("hall") / "hall.geojson"
    write_scene(make_scene("hall", shapely.box(0, 0, 10, 10), [wall, cell], ends), file)
    return file


def test_exact_goes_between_any_two_points_negative_ones_too(kbga_bench, tmp_path):
    for start in (("--start", "-3,1"), ("--start=-3,1",)):
        file = tmp_path / "room.geojson"
        write_scene(make_scene("room", shapely.box(-5, -5, 5, 5), [], {}), file)
        found = json.loads(
            kbga_bench("exact", file, *start, "--goal", "0,-3", "--format", "json").out
        )
        assert (found["query"], found["optimum"], found["status"]) == ("-3,1:0,-3", 5.0, "solved")


def test_a_robot_with_a_radius_keeps_it_from_the_walls(kbga_bench):
    said = ("maze", "--radius", 0.5, "--start", "10,20", "--goal", "45,80", "--format", "json")
    exact = json.loads(kbga_bench("exact", *said).out)
    planned = json.loads(kbga_bench(*PLAN, *said).out)
    assert planned["scene"] == exact["scene"] == "maze@radius=0.5"
    assert planned["optimum"] == exact["optimum"] == pytest.approx(planned["cost"])
    way = shapely.LineString(planned["path"])
    assert min(way.distance(o.polygon) for o in load_scene("maze").obstacles) >= 0.5 - 1e-9


def test_an_end_without_room_is_refused_with_the_reason_or_moved_on_request(kbga_bench, hall):
    said = (hall, "--query", "high", "--radius", 0.5, "--format", "json")
    for command in ("exact", PLAN):
        command = (command,) if isinstance(command, str) else command
        refused = json.loads(kbga_bench(*command, *said, code=1).out)
        assert (refused["status"], refused["optimum"]) == ("refused", None)
        assert "lies inside obstacle 1, grown by the robot's radius of 0.5 m" in refused["reason"]
        moved = json.loads(kbga_bench(*command, *said, "--snap").out)
        assert (moved["status"], moved["query"]) == ("solved", "high")
        assert moved["moved"] == pytest.approx([0.3, 0.0], abs=1e-8)
    said = kbga_bench("exact", hall, "--query", "high", "--radius", 0.5, "--snap").out
    assert "moved        the start by 0.3" in said


def test_all_queries_are_a_line_each_and_a_summary_or_a_list_for_programs(kbga_bench, hall):
    lines = kbga_bench("exact", hall, "--query", "all").out.splitlines()
    assert lines[0].startswith("hall / low: ")
    assert lines[2:] == [
        "hall / shut in: infeasible, there is no path.",
        "3 queries: 2 solved, 1 infeasible.",
    ]
    lines = kbga_bench(*PLAN, hall, "--query", "all").out.splitlines()
    assert lines[1].startswith("hall / high / visibility-graph / seed 0: solved, ")
    assert lines[3].startswith("3 queries: 2 solved, 1 infeasible. Gap: median 0.000 %, worst")
    told = json.loads(kbga_bench(*PLAN, hall, "--query", "all", "--format", "json").out)
    assert [one["query"] for one in told] == ["low", "high", "shut in"]


def test_one_query_that_fails_is_the_exit_code_of_all(kbga_bench, hall):
    said = (hall, "--query", "all", "--radius", 0.5)
    assert "3 queries: 1 solved, 2 refused." in kbga_bench("exact", *said, code=1).out
    assert "3 queries: 1 solved, 2 refused." in kbga_bench(*PLAN, *said, code=1).out


def test_a_dynamic_scene_is_simulated_or_frozen_knowingly(kbga_bench, error_of):
    for command in (("exact",), PLAN):
        assert "door: its obstacles move, hide or vanish. Let a robot drive through it with "
        assert "`simulate`, or take it as it is at a time" in error_of(*command, "door")
    found = json.loads(kbga_bench("exact", "door", "--at", 3, "--format", "json").out)
    assert found["scene"] == "door@at=3"
    assert found["status"] == "solved"


def test_a_robot_drives_between_any_two_points_and_one_of_a_size_too(kbga_bench):
    start, goal = (",".join(map(str, end)) for end in ((70.5, 6.0), (88.0, 93.0)))
    said = ("simulate", "door", "--planner", "visibility-graph", "--charge", "zero")
    arguments = (*said, "--start", start, "--goal", goal, "--radius", 0.3, "--speed", 5)
    done = json.loads(kbga_bench(*arguments, "--format", "json").out)
    assert done["scene"] == "door@radius=0.3"
    assert np.array_equal(done["trajectory"][0][1:], [70.5, 6.0])
    assert np.array_equal(done["trajectory"][-1][1:], [88.0, 93.0])
    lines = kbga_bench(*said, "--query", "all", "--speed", 5).out.splitlines()
    assert lines[0].startswith("door / visibility-graph / seed 0: solved, ")
    assert lines[1].startswith("1 query: 1 solved.")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--start", "1,2"), "--start and --goal are given together, and in place of --query"),
        (("--start", "1,2", "--goal", "3,4", "--query", "main"), "in place of --query"),
        (("--start", "1;2", "--goal", "3,4"), "--start 1;2: write x,y in metres"),
        (("--start", "1,2", "--goal", "3,4,5"), "--goal 3,4,5: write x,y in metres"),
        (("--query", "mian"), "maze: no query 'mian'. It has: main. Any two points are one"),
        (("--radius", "60"), "a robot of radius 60.0 m has no room in the workspace"),
        (("--at", "3"), "maze: stands still at all times. Leave at=3 out."),
    ],
)
def test_what_can_not_be_asked_is_said_before_anything_runs(error_of, options, message):
    for command in (("exact",), PLAN):
        assert message in error_of(*command, "maze", *options)


def test_only_one_run_is_drawn(error_of, tmp_path):
    said = error_of(*PLAN, "maze", "--query", "all", "--plot", tmp_path / "a.png")
    assert "It draws one run: name a query." in " ".join(said.split())


def test_a_map_without_queries_says_how_to_ask_for_one(error_of, tmp_path):
    (tmp_path / "map.wkt").write_text(shapely.box(0, 0, 2, 1).union(shapely.box(5, 5, 6, 6)).wkt)
    for query in ((), ("--query", "all")):
        said = error_of("exact", tmp_path / "map.wkt", *query)
        assert "map: no query" in said
        assert "Any two points are one: x,y:x,y" in said
