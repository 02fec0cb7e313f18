import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from suite.geometry.kernels import first_collision
from suite.referee.path import Referee, Verdict, judge
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene, make_scene
from tests.strategies import float_polygons, paths, scenes

ROOM = shapely.box(0, 0, 10, 10)
START, GOAL = (1.0, 5.0), (9.0, 5.0)


def room(*obstacles: shapely.Polygon) -> Scene:
    return make_scene("room", ROOM, obstacles, {"main": (START, GOAL)})


def verdict(scene: Scene, *waypoints: tuple[float, float]) -> Verdict:
    """Judge a path over these waypoints, whose first and last are the query."""
    path = np.array(waypoints, dtype=np.float64)
    return judge(scene, Query("any", path[0], path[-1]), path)


ONE_BOX = room(shapely.box(4, 2, 6, 8))
STACKED = room(shapely.box(4, 2, 6, 5), shapely.box(4, 5, 6, 8))
ON_THE_BORDER = room(shapely.box(4, 0, 6, 7))
PINCHED = room(shapely.box(2, 2, 5, 5), shapely.box(5, 5, 8, 8))
PINCHED_AT_BORDER = room(shapely.Polygon([(4, 4), (6, 4), (5, 0)]))
TOUCHING_HOLE = room(shapely.Polygon([(2, 2), (8, 2), (8, 8), (2, 8)], [[(2, 5), (5, 3), (5, 7)]]))


# What is free


def test_a_path_along_an_edge_is_free():
    assert verdict(ONE_BOX, (1, 5), (1, 8), (4, 8), (6, 8), (9, 5)).valid


def test_a_path_along_the_border_of_the_workspace_is_free():
    assert verdict(ONE_BOX, (0, 0), (10, 0), (10, 10)).valid


def test_touching_a_corner_is_not_a_collision():
    assert verdict(ONE_BOX, (2, 10), (6, 6 + 4 / 2), (8, 7)).valid
    assert verdict(ONE_BOX, (3, 9), (5, 7 + 2)).valid


def test_repeated_points_are_legal():
    assert verdict(ONE_BOX, (1, 5), (1, 5), (1, 9), (1, 9), (1, 9), (9, 9), (9, 9)).valid


def test_staying_where_one_is_is_a_path_of_length_zero():
    stay = verdict(ONE_BOX, (1, 5), (1, 5))
    assert stay.valid
    assert (stay.length, stay.clearance, stay.segments, stay.turning) == (0.0, 1.0, 0, 0.0)


def test_a_list_of_pairs_is_a_path():
    assert judge(ONE_BOX, ONE_BOX.query(), [[1, 5], [1, 9], [9, 9], [9, 5]]).valid


def test_the_referee_leaves_the_path_as_it_was():
    path = np.array([[1, 5], [1, 9], [1, 9], [9, 9], [9, 5]], dtype=np.float64)
    before = path.copy()
    judge(ONE_BOX, ONE_BOX.query(), path)
    assert np.array_equal(path, before)


# What is measured


def test_length_clearance_and_turning_of_a_known_path():
    seen = verdict(ONE_BOX, (1, 5), (1, 9), (9, 9), (9, 5))
    assert seen.length == pytest.approx(16.0, rel=1e-15)
    assert seen.clearance == pytest.approx(1.0)
    assert seen.segments == 3
    assert seen.turning == pytest.approx(math.pi)


def test_turning_back_turns_by_half_a_turn():
    assert verdict(ONE_BOX, (1, 1), (1, 9), (1, 1)).turning == pytest.approx(math.pi)


def test_nothing_is_measured_of_an_invalid_path():
    seen = verdict(ONE_BOX, (1, 5), (9, 5))
    assert (seen.length, seen.clearance, seen.segments, seen.turning) == (None, None, None, None)


# What is a foul


def test_a_path_through_an_obstacle_enters_it():
    seen = verdict(ONE_BOX, (1, 5), (3, 5), (3, 5), (7, 5), (9, 5))
    assert seen.reason == "segment 3, from (3, 5) to (7, 5), enters obstacle 1 at (4, 5)."


def test_a_shortcut_over_a_corner_enters_the_obstacle():
    assert not verdict(ONE_BOX, (4, 1), (7, 4)).valid


def test_a_waypoint_in_an_obstacle_enters_it():
    assert "enters obstacle 1 at (4, 5)" in str(verdict(ONE_BOX, (1, 5), (5, 5)).reason)


def test_staying_inside_an_obstacle_is_not_free():
    assert verdict(ONE_BOX, (5, 5), (5, 5)).reason == "start and goal (5, 5) are not in free space."


def test_the_seam_between_two_obstacles_is_closed():
    seen = verdict(STACKED, (1, 5), (9, 5))
    assert seen.reason == (
        "segment 1, from (1, 5) to (9, 5), runs between obstacle 1 and obstacle 2 "
        "from (4, 5), where they touch."
    )
    assert not verdict(STACKED, (1, 5), (4, 5), (6, 5), (9, 5)).valid
    assert verdict(STACKED, (1, 5), (4, 5), (1, 6)).valid


def test_the_slit_between_an_obstacle_and_the_border_is_closed():
    seen = verdict(ON_THE_BORDER, (1, 0), (9, 0))
    assert seen.reason == (
        "segment 1, from (1, 0) to (9, 0), runs between obstacle 1 and the border of the "
        "workspace from (4, 0), where they touch."
    )
    assert verdict(ON_THE_BORDER, (1, 0), (4, 0), (4, 7), (6, 7), (6, 0), (9, 0)).valid


def test_a_pinch_point_is_closed_to_a_straight_path():
    seen = verdict(PINCHED, (4, 6), (6, 4))
    assert seen.reason == (
        "segment 1, from (4, 6) to (6, 4), slips through (5, 5), "
        "a single point in which obstacle 1 and obstacle 2 touch."
    )


@pytest.mark.parametrize("waypoints", [
    [(4, 6), (5, 5), (6, 4)],
    [(2, 6), (5, 5), (6, 4)],
    [(2, 5), (5, 5), (8, 5)],  # along an edge of one, then along an edge of the other
    [(5, 8), (5, 5), (5, 2)],
    [(4, 6), (5, 5), (5, 5), (6, 4)],
])  # fmt: skip
def test_a_pinch_point_is_closed_to_a_path_that_bends_in_it(waypoints):
    assert "slips through (5, 5)" in str(verdict(PINCHED, *waypoints).reason)


@pytest.mark.parametrize("waypoints", [
    [(4, 6), (5, 5), (3, 7)],
    [(4, 6), (5, 5), (4, 6)],
    [(2, 5), (5, 5), (5, 8)],  # along both edges that bound one sector
    [(4, 6), (5, 5), (5, 5), (4, 7)],
])  # fmt: skip
def test_a_path_may_touch_a_pinch_point_and_stay_in_its_sector(waypoints):
    assert verdict(PINCHED, *waypoints).valid


def test_a_path_may_start_and_end_in_a_pinch_point():
    assert verdict(PINCHED, (5, 5), (6, 4)).valid
    assert verdict(PINCHED, (4, 6), (5, 5)).valid
    assert verdict(PINCHED, (5, 5), (2, 8), (5, 5), (5, 5)).valid


def test_a_path_that_starts_in_a_pinch_point_may_not_pass_it_later():
    assert not verdict(PINCHED, (5, 5), (4, 6), (5, 5), (6, 4)).valid


def test_a_pinch_point_on_the_border_is_closed():
    seen = verdict(PINCHED_AT_BORDER, (1, 0), (9, 0))
    assert "in which obstacle 1 and the border of the workspace touch" in str(seen.reason)
    assert verdict(PINCHED_AT_BORDER, (1, 0), (5, 0), (4, 4), (6, 4), (5, 0), (9, 0)).valid


def test_a_hole_that_touches_the_outline_is_closed_there():
    assert not verdict(TOUCHING_HOLE, (1, 5), (4, 5)).valid
    assert verdict(TOUCHING_HOLE, (3, 5), (2, 5), (4, 5)).valid


def test_a_path_that_leaves_the_workspace_is_not_free():
    seen = verdict(ONE_BOX, (1, 5), (1, 11), (9, 11), (9, 5))
    assert seen.reason == "segment 1, from (1, 5) to (1, 11), leaves the workspace at (1, 10)."


@pytest.mark.parametrize("far", ["20", "1000000000", "1e+300", "-1e+308"])
def test_a_path_far_outside_the_workspace_is_not_free(far):
    seen = verdict(ONE_BOX, (1, 5), (1, float(far)), (9, float(far)), (9, 5))
    assert f"point 2, (1, {far}), lies outside the workspace." == seen.reason


def test_a_path_must_begin_exactly_at_the_start():
    path = [(np.nextafter(1.0, 2.0), 5), (1, 9), (9, 9), (9, 5)]
    assert "not at the start (1, 5)" in str(judge(ONE_BOX, ONE_BOX.query(), path).reason)


def test_a_path_must_end_exactly_at_the_goal():
    path = [(1, 5), (1, 9), (9, 9)]
    reason = judge(ONE_BOX, ONE_BOX.query(), path).reason
    assert reason == "ends at (9, 9), not at the goal (9, 5): they are 4 m apart."


class Hostile:
    def __array__(self, *args, **kwargs):
        raise KeyboardInterrupt if args == ("never",) else RuntimeError("no array today")


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        (None, "there is no path."),
        ([], "shape (0,)"),
        (np.empty((0, 2)), "0 points"),
        (np.array([[1.0, 5.0]]), "1 points"),
        (np.array([1.0, 5.0, 9.0, 5.0]), "shape (4,)"),
        (np.ones((4, 3)), "shape (4, 3)"),
        (np.ones((2, 2, 2)), "shape (2, 2, 2)"),
        ([[1, 5], [2]], "not a path"),
        (np.array([[1, 5], [9, 5]], dtype=object), "array of object"),
        ([["1", "5"], ["9", "5"]], "not a path"),
        (np.array([[1, 5], [9, 5]], dtype=complex), "array of complex128"),
        ("straight ahead", "not a path"),
        (Hostile(), "no array today"),
        ([[1, 5], [np.nan, 9], [9, 5]], "point 2 is (nan, 9)"),
        ([[1, 5], [2, np.inf], [9, 5]], "point 2 is (2, inf)"),
    ],
)
def test_what_is_no_path_is_rejected_with_a_reason(path, reason):
    seen = judge(ONE_BOX, ONE_BOX.query(), path)
    assert not seen.valid
    assert reason in str(seen.reason)


# One meaning of free space for everybody


@settings(max_examples=300, deadline=None)
@given(st.data())
def test_the_kernel_and_the_referee_agree_on_a_lattice(data):
    scene = data.draw(scenes())
    referee = Referee(scene)
    for _ in range(5):
        path = data.draw(paths(scene))
        seen = referee.judge(Query("any", path[0], path[-1]), path)
        assert seen.valid == (first_collision(path, scene.arrays) == -1), seen.reason


@settings(max_examples=100, deadline=None)
@given(st.data())
def test_the_kernel_and_the_referee_agree_on_floats(data):
    scene = data.draw(scenes(float_polygons()))
    referee = Referee(scene)
    for _ in range(5):
        path = data.draw(paths(scene))
        seen = referee.judge(Query("any", path[0], path[-1]), path)
        assert seen.valid == (first_collision(path, scene.arrays) == -1), seen.reason


@settings(max_examples=200, deadline=None)
@given(scenes())
def test_the_referee_accepts_every_exact_path_and_its_length(scene):
    found = shortest_path(scene, scene.query())
    assume(found.path is not None)
    seen = judge(scene, scene.query(), found.path)
    assert seen.valid, seen.reason
    assert seen.length == pytest.approx(found.length, rel=1e-12)


@settings(max_examples=100, deadline=None)
@given(scenes())
def test_what_is_closed_is_what_the_obstacles_cover(scene):
    # The referee takes the arrangement's word for what is closed; here it is held to the drawing.
    drawn = shapely.union_all([o.polygon for o in scene.obstacles])
    closed = shapely.intersection(scene.arrangement.solid, scene.workspace)
    assert shapely.symmetric_difference(drawn, closed).area < 1e-6
