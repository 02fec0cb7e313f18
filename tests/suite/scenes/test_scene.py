"""Bad scenes are refused with what, where and how to mend; good ones keep together."""

import pickle

import numpy as np
import pytest
import shapely
from shapely.affinity import rotate, scale, translate
from shapely.geometry import Point, Polygon, box

from suite.errors import SceneError
from suite.scenes.scene import Obstacle, Scene, SceneWarning, make_scene, scene_fingerprint

ROOM = box(0, 0, 10, 10)
ENDS = {"main": ((0.5, 0.5), (9.5, 9.5))}


def scene_of(*obstacles: Polygon | Obstacle, room: Polygon = ROOM, queries=ENDS, **rest) -> Scene:
    return make_scene("test", room, obstacles, queries, **rest)


def test_a_ring_that_crosses_itself_is_refused_with_its_edges_and_the_place():
    bowtie = Polygon([(1, 1), (3, 3), (3, 1), (1, 3)])
    with pytest.raises(
        SceneError, match=r"test, obstacle 1: edges 1 and 3 cross at \(2, 2\)\. List"
    ):
        scene_of(bowtie)


def test_a_hole_that_crosses_itself_is_refused_with_its_edges_and_the_place():
    hole = [(2, 2), (4, 6), (4, 2), (2, 6)]
    with pytest.raises(SceneError, match=r"edges 1 and 3 cross at \(3, 4\)"):
        scene_of(Polygon([(1, 1), (8, 1), (8, 8), (1, 8)], [hole]))


def test_one_crossing_among_2000_edges_is_found():
    turns = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
    circle = 5 + 4 * np.c_[np.cos(turns), np.sin(turns)]
    circle[[700, 701]] = circle[[701, 700]]
    with pytest.raises(SceneError, match="edges 700 and 702 cross"):
        scene_of(Polygon(circle))


def test_a_ring_that_runs_back_on_itself_is_refused_with_the_place():
    with pytest.raises(SceneError, match=r"obstacle 1: .*\[.*\].*split it"):
        scene_of(Polygon([(1, 1), (5, 1), (5, 3), (5, 1), (3, 1), (3, 4)]))


@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")  # shapely, of NaN
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e300])
def test_coordinates_that_are_no_finite_metres_are_refused(bad):
    with pytest.raises(SceneError, match=r"obstacle 1: vertex 2 is .*must be finite"):
        scene_of(Polygon([(1, 1), (2, bad), (2, 2)]))
    with pytest.raises(SceneError, match=r"start of query 'main': .*must be finite"):
        scene_of(queries={"main": ((bad, 1), (2, 2))})


def test_fewer_than_three_vertices_are_refused():
    with pytest.raises(SceneError, match="obstacle 1: only 2 different vertices"):
        scene_of(Polygon([(1, 1), (2, 2), (1, 1), (2, 2)]))
    with pytest.raises(SceneError, match="obstacle 1: only 0 different vertices"):
        scene_of(Polygon())


@pytest.mark.parametrize(
    "corners",
    [
        np.array([(2, 2), (4, 2), (4, 6), (2, 6)]),
        np.array([(2, 2), (2, 6), (4, 6), (4, 2)], dtype=np.float32),  # clockwise
        [[2, 2], [4, 2], [4, 6], [2, 6], [2, 2]],  # closed
    ],
)
def test_an_obstacle_may_be_an_array_of_its_vertices(corners):
    (obstacle,) = scene_of(corners).obstacles
    assert obstacle.name == "obstacle 1"
    assert obstacle.polygon.equals(box(2, 2, 4, 6))
    assert scene_of(Obstacle("pillar", corners)).obstacles[0].polygon.equals(box(2, 2, 4, 6))


def test_the_workspace_may_be_an_array_of_its_vertices():
    scene = scene_of(room=np.array([(0, 0), (10, 0), (10, 10), (0, 10)]))
    assert scene.workspace.equals(ROOM)


def test_the_callers_vertices_stay_their_own():
    corners = np.array([(2.0, 2.0), (4.0, 2.0), (4.0, 6.0)])
    scene = scene_of(corners)
    corners[0] = 3.0
    assert scene.obstacles[0].polygon.bounds == (2, 2, 4, 6)


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (np.zeros((4, 3)), r"its shape is \(4, 3\)\. Give a shapely Polygon, or its vertices"),
        (np.zeros(8), r"its shape is \(8,\)\. Give"),
        (np.zeros((1, 4, 2)), r"its shape is \(1, 4, 2\)\. Give"),
        ([(1, 1), (2, 2, 2)], r"it is no array of numbers\. Give"),
        ("a wall", r"it is no array of numbers\. Give"),
        (None, r"its shape is \(\)\. Give"),
        (shapely.MultiPolygon([box(1, 1, 2, 2), box(3, 3, 4, 4)]), r"it is a MultiPolygon\. Give"),
        (np.array([(1, 1), (2, np.nan), (2, 2)]), r"vertex 2 is \(2.0, nan\)\. .*finite"),
        (np.array([(1, 1), (2, 1), (2, -np.inf)]), r"vertex 3 is \(2.0, -inf\)\. .*finite"),
        (np.zeros((0, 2)), "only 0 different vertices"),
        (np.array([(1, 1), (2, 2)]), "only 2 different vertices. A ring needs three"),
        (np.array([(1, 1), (2, 2), (1, 1), (2, 2)]), "only 2 different vertices"),
        (np.array([(1, 1), (2, 2), (4, 4)]), "its area is zero"),
        (np.array([(1, 1), (3, 3), (3, 1), (1, 3)]), r"edges 1 and 3 cross at \(2, 2\)"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_vertices_that_make_no_polygon_are_refused_with_what_and_where(bad, message):
    with pytest.raises(SceneError, match=f"^test, obstacle 2: {message}"):
        scene_of(box(6, 6, 7, 7), bad)
    with pytest.raises(SceneError, match=f"^test, workspace: {message}"):
        scene_of(room=bad)


def test_zero_area_is_refused():
    with pytest.raises(SceneError, match="obstacle 1: its area is zero"):
        scene_of(Polygon([(1, 1), (2, 2), (4, 4)]))


def test_an_obstacle_narrower_than_the_grid_is_refused():
    with pytest.raises(SceneError, match="obstacle 1: narrower than 1e-09 m"):
        scene_of(box(1, 1, 1 + 1e-11, 8))


def test_a_workspace_smaller_than_the_grid_is_refused():
    with pytest.raises(SceneError, match="workspace: narrower"):
        scene_of(room=box(0, 0, 10, 1e-10), queries={"main": ((0, 0), (9, 0))})


def test_a_small_room_so_far_away_that_coordinates_cannot_tell_it_is_refused():
    room = box(5e6, 5e6, 5e6 + 1e-3, 5e6 + 1e-3)
    with pytest.raises(SceneError, match=r"workspace: 0.001 m wide, at .*\. Shift the scene"):
        scene_of(room=room, queries={"main": ((5e6, 5e6), (5e6, 5e6))})


@pytest.mark.parametrize("turn", range(0, 360, 15))
def test_a_start_beside_the_wall_is_free_at_the_coordinates_of_a_map(turn):
    def placed(shape: Polygon | Point) -> Polygon | Point:
        return translate(rotate(shape, turn + 0.7, origin=(40, 30)), 691608.2, 5334765.7)

    room, *walls = (placed(box(*b)) for b in ((0, 0, 80, 60), (10, 10, 30, 50), (30, 20, 55, 45)))
    ends = [placed(Point(p)).coords[0] for p in ((3, 3), (77, 57))]
    scene = make_scene("yard", room, walls, tuple(ends))
    assert len(scene.arrangement.groups) == 1
    assert scene.arrangement.groups[0].area == pytest.approx(20 * 40 + 25 * 25, rel=1e-8)


def test_a_refused_start_is_printed_so_that_it_is_found_on_the_map():
    room, pillar = box(461500, 5638000, 461600, 5638100), box(461520, 5638010, 461530, 5638020)
    with pytest.raises(SceneError, match=r"\(461523\.25, 5638012\.125\) lies inside obstacle 1"):
        scene_of(pillar, room=room, queries=((461523.25, 5638012.125), (461510, 5638010)))


def test_start_or_goal_outside_the_workspace_is_refused():
    with pytest.raises(SceneError, match=r"goal of query 'main': \(11, 5\) lies outside the works"):
        scene_of(queries={"main": ((1, 1), (11, 5))})
    with pytest.raises(SceneError, match=r"start of query 'b': \(-99, 5\) lies outside"):
        scene_of(queries={"a": ((1, 1), (1, 5)), "b": ((-99, 5), (1, 1))})


def test_start_or_goal_inside_an_obstacle_is_refused_with_its_name():
    with pytest.raises(SceneError, match=r"start of query 'main': \(3, 3\) lies inside pillar\."):
        scene_of(Obstacle("pillar", box(2, 2, 4, 4)), queries={"main": ((3, 3), (9, 9))})


def test_a_start_on_the_seam_of_two_obstacles_is_refused_with_both_names():
    with pytest.raises(SceneError, match="inside obstacle 1 and obstacle 2"):
        scene_of(box(2, 2, 4, 6), box(4, 2, 6, 6), queries={"main": ((4, 3), (9, 9))})


def test_a_start_in_the_slit_along_the_border_is_refused():
    with pytest.raises(SceneError, match="inside obstacle 1"):
        scene_of(box(2, 0, 4, 6), queries={"main": ((3, 0), (9, 9))})


@pytest.mark.parametrize("point", [(2, 2), (3, 2), (0, 0), (10, 4), (4, 6)])
def test_start_and_goal_may_lie_on_corners_edges_and_the_border(point):
    scene = scene_of(box(2, 2, 4, 6), queries={"main": (point, point)})
    assert tuple(scene.query().start) == point


def test_a_start_on_a_vertex_or_border_that_no_grid_holds_is_free():
    for denominator in (3, 7, 9, 11, 13):
        for numerator in range(1, denominator):
            edge = numerator / denominator
            room, obstacle = box(0, 0, edge, 1), box(edge / 3, edge / 7, edge / 2, edge / 1.7)
            xmin, ymin, xmax, ymax = obstacle.bounds
            ends = [(edge, 0.1), (xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]
            scene_of(obstacle, room=room, queries={str(p): (p, ends[0]) for p in ends})


def test_a_scene_without_a_query_is_a_map_in_which_any_two_points_are_one():
    scene = scene_of(box(4, 4, 6, 6), queries={})
    assert scene.queries == ()
    with pytest.raises(SceneError, match=r"no query\. Any two points are one: x,y:x,y for start"):
        scene.query()
    query = scene.query("1,1:9.5,-0")
    assert (query.name, query.start.tolist(), query.goal.tolist(), query.blocked) == (
        ("1,1:9.5,-0", [1.0, 1.0], [9.5, 0.0], None)
    )
    assert "goal of query '1,1:5,5': (5, 5) lies inside obstacle 1" in (
        scene.query("1,1:5,5").blocked or ""
    )


def test_of_queries_that_are_not_there_a_dozen_is_named():
    scene = scene_of(queries={f"q{i}": ((1, 1), (9, 9)) for i in range(20)})
    with pytest.raises(SceneError, match=r"no query 'r'\. It has: q0, .*, q11 and 8 more\."):
        scene.query("r")


@pytest.mark.parametrize("point", ["ab", (1, 2, 3), 7, None, ("a", "b")])
def test_a_start_that_is_no_point_is_refused(point):
    with pytest.raises(SceneError, match="start of query 'main'"):
        scene_of(queries={"main": (point, (1, 1))})


@pytest.mark.parametrize("pair", [((1, 1), (9, 1)), np.array([(1, 1), (9, 1)])])
def test_a_pair_of_points_alone_is_the_query_main(pair):
    scene = scene_of(queries=pair)
    assert [q.name for q in scene.queries] == ["main"]
    assert (scene.query().start.tolist(), scene.query().goal.tolist()) == ([1, 1], [9, 1])


@pytest.mark.parametrize("bad", [(), ((1, 1),), ((1, 1), (2, 2), (3, 3)), 7, None])
def test_what_is_no_pair_of_points_is_refused(bad):
    with pytest.raises(SceneError, match=r"test, query 'main': .* Give \(start, goal\)"):
        scene_of(queries=bad)
    with pytest.raises(SceneError, match=r"test, query 'a': .* Give \(start, goal\)"):
        scene_of(queries={"a": bad})


def test_duplicate_obstacle_names_are_refused():
    with pytest.raises(SceneError, match="two obstacles are named 'a'"):
        scene_of(Obstacle("a", box(1, 1, 2, 2)), Obstacle("a", box(3, 3, 4, 4)))


def test_obstacles_that_stick_out_are_cut_with_a_warning():
    with pytest.warns(SceneWarning, match="test, obstacle 1: sticks out of the workspace"):
        scene = scene_of(box(8, 4, 14, 6))
    assert scene.obstacles[0].polygon.equals(box(8, 4, 10, 6))
    assert scene.arrangement.solid.contains(shapely.Point(10, 5))


def test_an_obstacle_outside_is_dropped_with_a_warning():
    with pytest.warns(SceneWarning, match="nothing of it is left"):
        assert scene_of(box(20, 20, 30, 30)).obstacles == ()


def test_an_obstacle_cut_in_two_becomes_two():
    arch = Polygon([(2, 8), (2, 12), (8, 12), (8, 8), (7, 8), (7, 11), (3, 11), (3, 8)])
    with pytest.warns(SceneWarning):
        scene = scene_of(arch)
    assert [o.name for o in scene.obstacles] == ["obstacle 1 (1)", "obstacle 1 (2)"]


@pytest.mark.parametrize("angle", [1, 10, 33.3, 45, 77])
def test_an_obstacle_laid_against_a_slanted_border_does_not_stick_out(angle):
    room, wall = (rotate(p, angle, origin=(0, 0)) for p in (ROOM, box(10 / 3, 5, 10, 6)))
    middle = rotate(shapely.Point(1, 1), angle, origin=(0, 0)).coords[0]
    scene = scene_of(wall, room=room, queries={"main": (middle, middle)})
    assert scene.obstacles[0].polygon is wall
    assert len(scene.arrays.contacts) > 0


def test_holes_of_the_workspace_become_obstacles():
    scene = scene_of(room=ROOM.difference(box(4, 4, 6, 6)))
    assert scene.workspace.equals(ROOM)
    assert [o.name for o in scene.obstacles] == ["hole 1 of the workspace"]
    assert scene.obstacles[0].polygon.equals(box(4, 4, 6, 6))


def test_a_goal_that_cannot_be_reached_is_no_error():
    wall = [box(4, 4, 8, 5), box(4, 7, 8, 8), box(4, 5, 5, 7), box(7, 5, 8, 7)]
    assert scene_of(*wall, queries={"main": ((1, 1), (6, 6))}).query().goal.tolist() == [6, 6]


def test_inflating_grows_obstacles_and_shrinks_the_workspace():
    scene = scene_of(box(4, 4, 6, 6), inflate=0.5)
    assert scene.bounds == (0.5, 0.5, 9.5, 9.5)
    assert scene.obstacles[0].polygon.bounds == (3.5, 3.5, 6.5, 6.5)
    grown = scene_of(box(4, 4, 6, 6), inflate=0.5, queries={"a": ((3.7, 5), (9, 9))})
    assert "(3.7, 5) lies inside obstacle 1, grown by the robot's radius of 0.5 m" in (
        grown.query("a").blocked or ""
    )
    outside = scene_of(inflate=0.5, queries={"a": ((1, 1), (9.7, 9))}).query("a").blocked
    assert "(9.7, 9) lies outside the workspace, (0.5, 0.5) to (9.5, 9.5), made smaller" in (
        outside or ""
    )


def test_queries_that_can_not_be_asked_are_kept_on_request_and_say_why():
    queries = {"a": ((5, 5), (9, 9)), "b": ((1, 1), (9, 9))}
    scene = scene_of(box(4, 4, 6, 6), queries=queries, keep_blocked=True, strata={"b": "easy"})
    a, b = scene.queries
    assert "start of query 'a': (5, 5) lies inside obstacle 1. Move it to free" in (a.blocked or "")
    assert (b.blocked, a.stratum, b.stratum) == (None, None, "easy")


def test_inflating_rounds_the_reflex_corners_of_the_workspace():
    room = Polygon([(0, 0), (10, 0), (10, 10), (5, 10), (5, 5), (0, 5)])
    near = {"main": ((5.75, 4.25), (9, 9))}  # 1.06 m from the corner (5, 5)
    assert scene_of(room=room, queries=near, inflate=1.0).query().start.tolist() == [5.75, 4.25]


def test_inflating_by_too_much_or_by_nonsense_is_refused():
    with pytest.raises(SceneError, match="no room in the workspace"):
        scene_of(inflate=6.0)
    for radius in (-1.0, np.nan, np.inf):
        with pytest.raises(SceneError, match="Give a radius"):
            scene_of(inflate=radius)


def test_several_queries_are_found_by_name():
    scene = scene_of(queries={"a": ((1, 1), (2, 2)), "b": ((3, 3), (4, 4))})
    assert scene.query().name == "a"
    assert scene.query("b").goal.tolist() == [4, 4]
    with pytest.raises(SceneError, match=r"no query 'c'\. It has: a, b"):
        scene.query("c")


def test_the_hash_depends_on_geometry_and_not_on_names():
    one = scene_of(Obstacle("a", box(1, 1, 2, 2)))
    same = make_scene("other", ROOM, [Obstacle("b", box(1, 1, 2, 2))], ENDS)
    moved = scene_of(Obstacle("a", box(1, 1, 2, 2.5)))
    assert one.hash == same.hash != moved.hash


def test_the_fingerprint_depends_on_geometry_and_query():
    scene = scene_of(queries={"a": ((1, 1), (2, 2)), "b": ((1, 1), (2, 3)), "c": ((1, 1), (2, 2))})
    a, b, c = (scene_fingerprint(scene, q) for q in scene.queries)
    assert a == c != b


def test_minus_zero_and_zero_are_one_place():
    a = scene_of(queries={"main": ((0.0, 1.0), (2, 2))})
    b = scene_of(queries={"main": ((-0.0, 1.0), (2, 2))})
    assert scene_fingerprint(a, a.query()) == scene_fingerprint(b, b.query())


def test_a_scene_survives_pickling():
    scene = scene_of(box(4, 4, 6, 6), properties={"optimum": {"main": 13.0}})
    corners = scene.arrangement.corners
    again = pickle.loads(pickle.dumps(scene))
    assert (again.name, again.hash) == (scene.name, scene.hash)
    assert again.stored_optimum(again.query()) == 13.0
    assert np.array_equal(again.arrangement.corners, corners)
    assert all(np.array_equal(a, b) for a, b in zip(again.arrays, scene.arrays, strict=True))
    # numba takes a writable array for another type, and would compile every kernel again
    assert not any(a.flags.writeable for a in again.arrays)
    assert not again.query().start.flags.writeable
    with pytest.raises(TypeError):
        again.properties["optimum"] = {}


def test_points_and_arrays_are_read_only():
    scene = scene_of(box(4, 4, 6, 6))
    with pytest.raises(ValueError, match="read-only"):
        scene.query().start[0] = 5.0
    with pytest.raises(ValueError, match="read-only"):
        scene.arrays.vertices[0] = 5.0


def test_the_callers_arrays_stay_their_own():
    start = np.array([1.0, 1.0])
    scene = scene_of(queries={"main": (start, start)})
    start[0] = 3.0
    assert scene.query().start.tolist() == [1.0, 1.0]


def test_vertices_and_convex_parts_are_counted():
    ell = Polygon([(1, 1), (4, 1), (4, 2), (2, 2), (2, 4), (1, 4)])
    holed = box(5, 5, 9, 9).difference(box(6, 6, 8, 8))
    assert scene_of(ell).vertex_count == 6
    assert scene_of(ell).part_count == 2
    assert scene_of(holed).vertex_count == 8
    assert scene_of().part_count == 0


def test_scenes_in_millimetres_and_kilometres_work_alike():
    for size in (1e-3, 1e3):
        room, obstacle = (scale(p, size, size, origin=(0, 0)) for p in (ROOM, box(4, 4, 6, 6)))
        scene = scene_of(obstacle, room=room, queries={"main": ((size, size), (9 * size, size))})
        assert len(scene.arrangement.corners) == 4
