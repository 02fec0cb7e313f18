"""The package extremitypathfinder is exact, or it is refused."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from baselines.extremity import ExtremityPlanner, ExtremitySettings, pinches, regions_of
from suite.planner import Budget, Plan, PlanStatus, Recorder
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene, make_scene
from tests.strategies import SIDE, float_polygons, scenes

ROOM = shapely.box(0, 0, 10, 10)
PINCHED = [shapely.box(2, 0, 4, 5), shapely.box(4, 5, 6, 9)]


def plan(scene: Scene) -> Plan:
    rng = np.random.default_rng(0)
    return ExtremityPlanner().plan(scene, scene.query(), Budget(), rng, Recorder())


def scene_of(obstacles, start=(1, 1), goal=(9, 1)) -> Scene:
    return make_scene("room", ROOM, obstacles, (start, goal))


def agrees_or_is_refused(scene: Scene, seed: int) -> None:
    points = np.random.default_rng(seed).uniform(0, SIDE, (100, 2))
    free = points[~shapely.intersects_xy(scene.arrangement.solid, points)]
    assume(len(free) > 1)
    scene = replace(scene, queries=(Query("open", *free[:2]),))
    pinched = [p for region in regions_of(scene, scene.query()) for p in pinches(region)]
    refusal = ExtremityPlanner().refuse(scene, scene.query(), Budget())
    assert (refusal is not None) == (pinched != [])
    if refusal is not None:
        return
    wanted, made = shortest_path(scene, scene.query()), plan(scene)
    assert (made.status is PlanStatus.SOLVED) == (wanted.path is not None)
    if made.path is None:
        assert made.status is PlanStatus.INFEASIBLE
    else:
        assert made.claimed_cost == pytest.approx(wanted.length, rel=1e-9, abs=1e-9)


@settings(max_examples=60)
@given(scenes(), st.integers(0, 2**32))
def test_it_is_exact_where_obstacles_overlap_and_touch_each_other_and_the_border(scene, seed):
    agrees_or_is_refused(scene, seed)


@settings(max_examples=30)
@given(scenes(float_polygons()), st.integers(0, 2**32))
def test_it_is_exact_among_triangles_anywhere(scene, seed):
    agrees_or_is_refused(scene, seed)


@pytest.mark.parametrize(("start", "goal"), [((3, 0), (4, 1)), ((4, 1), (1, 2))])
def test_an_end_on_an_edge_is_refused_by_name(start, goal):
    wedge = shapely.Polygon([(0, 0), (0, 1), (3, 0)])
    scene = scene_of([wedge, shapely.box(0, 2, 2, 3)], start, goal)
    what, (x, y) = ("start", start) if start == (3, 0) else ("goal", goal)
    said = ExtremityPlanner().refuse(scene, scene.query(), Budget())
    assert said == (
        "extremitypathfinder does not see all that it should from an edge, and the "
        f"{what} ({x}, {y}) lies on one. Move it into the open."
    )


def test_from_an_edge_it_does_miss_ways_so_that_the_refusal_is_needed():
    wedge = shapely.Polygon([(0, 0), (0, 1), (3, 0)])
    scene = scene_of([wedge], (3, 0), (4, 0))
    assert plan(scene).status is PlanStatus.EXHAUSTED


@pytest.mark.parametrize("name", ["maze", "double_u", "obstacles_20"])
def test_it_is_exact_on_scenes_of_the_paper(name):
    made = plan(load_scene(name))
    assert made.claimed_cost == pytest.approx(
        load_scene(name).stored_optimum(load_scene(name).query())
    )


@pytest.mark.parametrize(
    "obstacles",
    [
        [shapely.box(3, 2, 5, 6), shapely.box(5, 2, 7, 6)],
        [shapely.box(3, 2, 5, 6), shapely.box(4, 4, 7, 8)],
        [shapely.box(3, 0, 5, 6)],
        [shapely.box(3, 3, 7, 7).difference(shapely.box(4, 4, 6, 6))],
    ],
    ids=["a seam", "an overlap", "joined to the border", "a hole in an obstacle"],
)
def test_what_the_package_forbids_is_mended_by_handing_it_free_space(obstacles):
    scene = scene_of(obstacles)
    assert ExtremityPlanner().refuse(scene, scene.query(), Budget()) is None
    assert plan(scene).claimed_cost == pytest.approx(shortest_path(scene, scene.query()).length)


def test_obstacles_that_meet_in_a_point_are_refused_with_the_point():
    scene = scene_of(PINCHED)
    said = ExtremityPlanner().refuse(scene, scene.query(), Budget())
    assert said == (
        "extremitypathfinder would slip through the point (4, 5), in which obstacles meet. "
        "Let them overlap or keep them apart."
    )


def test_a_path_that_slips_through_a_point_is_never_returned():
    # As a robot on its way may ask for, without asking whether the planner refuses.
    scene = scene_of(PINCHED, (3, 7), (5, 3))
    assert len(regions_of(scene, scene.query())) == 1
    made = plan(scene)
    assert (made.status, made.path) == (PlanStatus.EXHAUSTED, None)


def test_a_scene_with_more_vertices_than_the_setting_allows_is_refused():
    scene = load_scene("double_u")
    few = ExtremityPlanner(ExtremitySettings(most_vertices=10))
    assert few.refuse(scene, scene.query(), Budget()) == (
        "extremitypathfinder would prepare 23 vertices, which takes it long; most_vertices is 10. "
        "Raise it if you have the time."
    )
    assert ExtremityPlanner().refuse(scene, scene.query(), Budget()) is None
    with pytest.raises(ValueError, match=r"most_vertices is 0\. It must be 1 or more"):
        ExtremitySettings(most_vertices=0)


def test_time_that_is_over_ends_a_preparation_that_would_take_minutes():
    scene = load_scene("scattered_500")
    recorder, rng = Recorder(), np.random.default_rng(0)
    budget = Budget(wall_s=0.5)
    made = ExtremityPlanner().plan(scene, scene.query(), budget, rng, recorder)
    assert made.status is PlanStatus.EXHAUSTED
    # Of its own time: a busy machine gives it less in a second.
    assert recorder.cpu_s() < 30.0


def test_a_pinch_in_another_piece_of_free_space_refuses_nothing():
    ring = shapely.box(5, 5, 10, 10).difference(shapely.box(6, 6, 9, 9))
    inner = [shapely.box(6.5, 6.5, 7, 7), shapely.box(7, 7, 7.5, 7.5)]
    scene = scene_of([ring, *inner])
    assert ExtremityPlanner().refuse(scene, scene.query(), Budget()) is None
