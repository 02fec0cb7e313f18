import json
import shutil
import warnings
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely
from numba import njit

from suite.errors import SceneError
from suite.geometry.kernels import first_collision, segment_enters
from suite.scenes.catalogue import (
    aligned_names,
    dynamic_names,
    generated_names,
    has_scene,
    load_scene,
    scene_file,
    scene_names,
)
from suite.scenes.exact import shortest_path
from suite.scenes.homotopy import route_optima
from suite.simulation.settings import WorldSettings

FIGURES = {
    "unstructured": "6",
    "maze": "7",
    "zigzag": "8",
    "double_u": "9",
    "clustered": "10",
    "obstacles_20": "14",
    "obstacles_30": "14",
    "obstacles_40": "14",
}
BEST_OF_PAPER = {
    "unstructured": 117.56,
    "maze": 411.67,
    "zigzag": 155.89,
    "double_u": 152.01,
    "clustered": 160.50,
}
RESOLUTIONS = (50, 64, 100, 128, 200, 256, 400)
"""Lattices that a planner may lay over the workspace: units per side."""
ON_CROSSING, MOST_ON_CROSSINGS = 0.02, 0.05
"""Metres from a crossing within which a corner lies on it, and the share of corners that may."""
SERIES = ("obstacles_20", "obstacles_30", "obstacles_40")

every_scene = pytest.mark.parametrize("name", scene_names())


def test_the_catalogue_is_in_the_papers_order():
    assert scene_names() == list(FIGURES)


def test_the_catalogue_names_exactly_the_files_that_are_shipped():
    shipped = {f.stem for f in scene_file("maze").parent.glob("*.geojson")}
    assert shipped == {*scene_names(), *dynamic_names(), *aligned_names()}


@every_scene
def test_a_scene_loads_without_a_warning(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene = load_scene(name)
    assert scene.name == name
    assert [q.name for q in scene.queries] == ["main"]
    assert scene.bounds == (0.0, 0.0, 100.0, 100.0)


@every_scene
def test_a_scene_says_that_it_is_a_reconstruction_and_of_which_figure(name):
    properties = load_scene(name).properties
    assert properties["reconstruction"] is True
    assert properties["figure"] == FIGURES[name]
    assert "reconstructed" in properties["description"]
    assert properties.get("paper_best") == BEST_OF_PAPER.get(name)


@pytest.mark.parametrize("name", [*dynamic_names(), "door_aligned", "unknown_obstacles_aligned"])
def test_a_dynamic_scene_loads_without_a_warning_and_says_what_it_is(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene = load_scene(name)
    assert scene.is_dynamic
    assert scene.properties["reconstruction"] is True
    assert "reconstructed" in scene.properties["description"].lower()
    assert set(scene.properties["world"]) <= set(WorldSettings.__slots__)
    assert scene.properties["gates"]


def share_on_crossings(name: str, resolution: int) -> float:
    """Of a scene's corners, those that lie on a crossing of a lattice."""
    xy = np.vstack([shapely.get_coordinates(o.polygon)[:-1] for o in load_scene(name).obstacles])
    unit = 100.0 / resolution
    return np.mean(np.hypot(*(xy - unit * np.round(xy / unit)).T) <= ON_CROSSING)


@pytest.mark.parametrize("name", [*scene_names(), *dynamic_names()])
def test_no_lattice_has_its_crossings_on_the_corners_of_a_scene(name):
    shares = {r: share_on_crossings(name, r) for r in RESOLUTIONS}
    assert {r: share for r, share in shares.items() if share > MOST_ON_CROSSINGS} == {}


@pytest.mark.parametrize("name", aligned_names())
def test_the_corners_of_the_controls_lie_on_crossings(name):
    assert [share_on_crossings(name, r) for r in (100, 200, 400)] == [1.0, 1.0, 1.0]


@pytest.mark.parametrize("name", ["maze", "zigzag", "double_u", *dynamic_names()])
def test_a_redrawn_scene_and_its_control_say_what_they_are(name):
    drawn, control = load_scene(name), load_scene(f"{name}_aligned")
    assert "no corner lies on a lattice" in drawn.properties["description"]
    assert control.properties["description"].startswith("A control")
    assert control.properties["figure"] == drawn.properties["figure"]
    assert [o.name for o in control.obstacles] == [o.name for o in drawn.obstacles]


@pytest.mark.parametrize("name", ["maze", "zigzag", "double_u"])
def test_a_redrawn_scene_is_about_as_hard_as_its_control(name):
    drawn, control = load_scene(name), load_scene(f"{name}_aligned")
    ratio = drawn.stored_optimum(drawn.query()) / control.stored_optimum(control.query())
    assert ratio == pytest.approx(1.0, abs=0.005)
    bends = [len(shortest_path(scene, scene.query()).path) for scene in (drawn, control)]
    assert bends[0] == bends[1]


@pytest.mark.parametrize("name", [*scene_names(), *aligned_names()[:3]])
def test_the_stored_optimum_is_the_exact_one(name):
    scene = load_scene(name)
    exact = shortest_path(scene, scene.query())
    assert scene.stored_optimum(scene.query()) == pytest.approx(exact.length, abs=1e-9, rel=0)


@pytest.mark.parametrize(("name", "best"), BEST_OF_PAPER.items())
def test_the_optimum_is_close_below_the_best_cost_of_the_paper(name, best):
    scene = load_scene(name)
    ratio = shortest_path(scene, scene.query()).length / best
    assert 0.985 <= ratio <= 1.0


@every_scene
def test_the_straight_line_is_blocked(name):
    scene = load_scene(name)
    query = scene.query()
    line = shapely.LineString([query.start, query.goal])
    assert line.relate_pattern(scene.arrangement.solid, "T********")


@pytest.mark.parametrize("name", ["unstructured", "maze", "zigzag", "double_u", "clustered"])
def test_a_random_path_is_hardly_ever_feasible(name):
    scene, query, rng = load_scene(name), load_scene(name).query(), np.random.default_rng(6)
    feasible = 0
    for _ in range(1000):
        waypoints = rng.integers(0, 101, (rng.integers(1, 9), 2)).astype(np.float64)
        path = np.vstack([query.start, waypoints, query.goal])
        feasible += first_collision(path, scene.arrays) == -1
    assert feasible <= 2


@every_scene
def test_start_and_goal_have_room_around_them(name):
    scene = load_scene(name)
    for point in (scene.query().start, scene.query().goal):
        assert scene.arrangement.solid.distance(shapely.Point(point)) > 1.0


@every_scene
def test_a_gap_between_obstacles_is_open_or_closed_but_never_a_slit(name):
    groups = [*load_scene(name).arrangement.groups, shapely.box(0, 0, 100, 100).exterior]
    for i, group in enumerate(groups):
        for other in groups[i + 1 :]:
            distance = group.distance(other)
            assert distance == 0.0 or distance >= 1.5


@njit
def _best_lattice_path(xy, arrays, limit):
    """Length of the best path from node 0 to node 1 that bends at nodes; inf if above the limit."""
    rest = np.hypot(xy[:, 0] - xy[1, 0], xy[:, 1] - xy[1, 1])
    cost = np.full(xy.shape[0], np.inf)
    closed = np.zeros(xy.shape[0], dtype=np.bool_)
    cost[0] = 0.0
    while True:
        i = np.argmin(np.where(closed, np.inf, cost + rest))
        if i == 1 or closed[i] or not np.isfinite(cost[i]):
            return cost[1]
        closed[i] = True
        for j in range(xy.shape[0]):
            way = cost[i] + np.hypot(xy[i, 0] - xy[j, 0], xy[i, 1] - xy[j, 1])
            if way >= cost[j] or way + rest[j] > limit:
                continue
            if not segment_enters(xy[i, 0], xy[i, 1], xy[j, 0], xy[j, 1], arrays):
                cost[j] = way


def best_lattice_gap(name: str) -> float:
    """Gap of the best path that bends at crossings of a 100 by 100 lattice; inf if above 5 %."""
    scene = load_scene(name)
    query, corners = scene.query(), scene.arrangement.corners[:, :2]
    around = np.array([(dx, dy) for dx in range(-1, 3) for dy in range(-1, 3)])
    nodes = np.unique((np.floor(corners)[:, None] + around).reshape(-1, 2), axis=0)
    optimum = shortest_path(scene, query).length
    xy = np.vstack([query.start, query.goal, nodes])
    return _best_lattice_path(xy, scene.arrays, 1.05 * optimum) / optimum - 1.0


@every_scene
def test_a_100_by_100_lattice_is_fine_enough_for_every_scene(name):
    """The paper (III) says so of its environments; its chromosomes bend at integer points only.

    Its mean cost in the maze is 1.7 % above its best. Here the lattice alone takes 2.5 % on zigzag.
    """
    assert best_lattice_gap(name) <= 0.026


@pytest.mark.parametrize("name", ["maze", "zigzag", "double_u"])
def test_such_a_lattice_holds_the_optimum_of_a_control_but_not_of_its_scene(name):
    assert best_lattice_gap(f"{name}_aligned") == pytest.approx(0.0, abs=1e-9)
    assert best_lattice_gap(name) > 0.01


@pytest.mark.parametrize("name", SERIES)
def test_the_series_has_the_number_of_parts_in_its_name(name):
    assert load_scene(name).part_count == int(name.removeprefix("obstacles_"))


@pytest.mark.parametrize(("small", "large"), list(pairwise(SERIES)))
def test_each_scene_of_the_series_holds_the_one_before(small, large):
    few, many = load_scene(small), load_scene(large)
    shapes = {o.polygon.wkb for o in many.obstacles}
    assert {o.polygon.wkb for o in few.obstacles} < shapes
    assert few.query().start.tolist() == many.query().start.tolist()
    assert few.query().goal.tolist() == many.query().goal.tolist()
    assert few.stored_optimum(few.query()) <= many.stored_optimum(many.query())


def test_clustered_has_four_routes_within_seven_per_cent_of_the_best():
    scene = load_scene("clustered")
    assert len(route_optima(scene, scene.query(), limit_ratio=1.07, most=4)) == 4


def test_maze_has_one_route_within_seven_per_cent_of_the_best():
    scene = load_scene("maze")
    assert len(route_optima(scene, scene.query(), limit_ratio=1.07)) == 1


def test_every_wall_of_zigzag_and_maze_is_joined_to_the_border():
    for name in ("zigzag", "maze"):
        scene = load_scene(name)
        for group in scene.arrangement.groups:
            assert group.intersects(scene.workspace.exterior)


def test_an_unknown_name_is_answered_with_the_catalogue_and_the_nearest_name():
    with pytest.raises(SceneError) as error:
        load_scene("mase")
    assert str(error.value) == (
        "no scene 'mase'. Catalogue: unstructured, maze, zigzag, double_u, clustered, "
        "obstacles_20, obstacles_30, obstacles_40. Dynamic: door, unknown_obstacles. Generated: "
        "scattered_100, scattered_300, scattered_1000, scattered_3000, moving-0, or scattered_N-S "
        "for N obstacles and seed S, moving-S for seed S, or a family's name and -S: scattered, "
        "maze, office, zigzag, bug_trap, spiral, narrow, forest, city, clutter, "
        "rooms_with_clutter. Controls: maze_aligned, zigzag_aligned, double_u_aligned, "
        "door_aligned, unknown_obstacles_aligned. "
        "Did you mean 'maze'?"
    )


def test_a_generated_scene_is_found_by_its_name():
    assert all(has_scene(name) for name in generated_names())
    assert not set(generated_names()) & set(scene_names())
    scene = load_scene("scattered_30-7")
    assert (scene.name, scene.part_count) == ("scattered_30-7", 30)
    assert load_scene("scattered_30").name == load_scene("scattered_30-0").name == "scattered_30"


def test_a_generated_scene_grows_by_the_robots_radius():
    point, disc = load_scene("scattered_30"), load_scene("scattered_30", inflate=0.5)
    assert disc.properties == point.properties
    assert disc.arrangement.solid.area > point.arrangement.solid.area


def test_a_generated_scene_has_no_file_and_says_how_to_get_one():
    with pytest.raises(SceneError, match=r"scattered_100: is generated .* `kbga-bench generate`"):
        scene_file("scattered_100")


def test_a_misspelt_generated_name_is_answered_with_the_nearest_one():
    with pytest.raises(SceneError, match=r"Did you mean 'scattered_300'\?$"):
        load_scene("scatered_300")


@pytest.mark.parametrize("name", ["scattered_0", "scattered_99999-3"])
def test_a_generated_name_out_of_range_says_the_range(name):
    with pytest.raises(SceneError, match=r"Give 1 to 10000\.$"):
        load_scene(name)


def test_a_name_that_resembles_nothing_gets_no_suggestion():
    with pytest.raises(SceneError, match=r"unknown_obstacles_aligned\.$"):
        scene_file("xyzzy")


def test_a_scene_named_by_path_is_read_from_there(tmp_path, monkeypatch):
    mine = tmp_path / "mine.geojson"
    document = json.loads(scene_file("maze").read_text(encoding="utf-8"))
    document["name"] = "mine"
    mine.write_text(json.dumps(document), encoding="utf-8")
    shutil.copy(mine, tmp_path / "plain")
    monkeypatch.chdir(tmp_path)
    for path in (mine, str(mine), "mine.geojson", "./plain", Path("plain")):
        assert load_scene(path).name == "mine"


def test_a_missing_file_is_named_in_the_error():
    with pytest.raises(SceneError, match=r"nowhere\.json: can't be read"):
        load_scene("nowhere.json")


def test_the_robots_radius_lengthens_the_way():
    point, disc = load_scene("double_u"), load_scene("double_u", inflate=1.0)
    assert shortest_path(disc, disc.query()).length > shortest_path(point, point.query()).length
    assert disc.stored_optimum(disc.query()) is None
