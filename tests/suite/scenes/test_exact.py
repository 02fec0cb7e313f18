"""The exact path is the shortest one: by hand, by brute force, and by another library."""

import heapq
import pickle
from itertools import product

import numpy as np
import pytest
import shapely
from extremitypathfinder import PolygonEnvironment
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.affinity import affine_transform
from shapely.geometry import MultiPolygon, Point, Polygon, box
from shapely.geometry.polygon import orient

from suite.geometry.arrangement import arrange
from suite.geometry.kernels import first_collision
from suite.referee.path import Referee
from suite.scenes.exact import ExactPath, path_length, prepare, shortest_path
from suite.scenes.scene import Query, Scene, make_scene
from suite.scenes.visibility import tangent_path
from tests.suite.geometry.lattice import counts, enters, pinches, random_solid, star

ROOM = box(0, 0, 10, 10)


def solve(obstacles, start, goal, room: Polygon = ROOM) -> ExactPath:
    scene = make_scene("test", room, obstacles, {"main": (start, goal)})
    return check(scene, scene.query())


def check(scene: Scene, query: Query) -> ExactPath:
    """The exact path, once it is seen to be a path, and as long as the way back."""
    there = shortest_path(scene, query)
    back = shortest_path(scene, Query("back", query.goal, query.start))
    assert there.length == pytest.approx(back.length, rel=1e-12)
    if there.path is None:
        assert there.length == np.inf
        return there
    assert np.array_equal(there.path[[0, -1]], [query.start, query.goal])
    assert first_collision(there.path, scene.arrays) == -1
    assert there.length == path_length(there.path)
    return there


def brute_force(scene: Scene, query: Query) -> float:
    """Dijkstra over the whole visibility graph, drawn with shapely alone.

    A pinch point is a node for each of its free sectors, so that no path changes sector in it.
    """
    solid = scene.arrangement.solid
    corners = shapely.get_coordinates(solid.intersection(scene.workspace))
    xy = np.unique(np.vstack([corners, query.start, query.goal]), axis=0)
    sectors = {(p.x, p.y): free for p, free in pinches(solid)}
    pairs = [(i, j) for i, j in product(range(len(xy)), repeat=2) if i < j]
    free = ~enters(solid, np.array([[*xy[i], *xy[j]] for i, j in pairs]))
    neighbours: dict = {}
    for i, j in (pair for pair, is_free in zip(pairs, free, strict=True) if is_free):
        a, b = sector(xy[i], xy[j], sectors), sector(xy[j], xy[i], sectors)
        neighbours.setdefault((i, a), []).append((j, b))
        neighbours.setdefault((j, b), []).append((i, a))
    place = {tuple(p): i for i, p in enumerate(xy.tolist())}
    start, goal = place[tuple(query.start)], place[tuple(query.goal)]
    queue = [(0.0, start, s) for s in range(len(sectors.get(tuple(query.start), [0])))]
    done = set()
    while queue:
        length, i, s = heapq.heappop(queue)
        if i == goal:
            return length
        if (i, s) not in done:
            done.add((i, s))
            for j, t in neighbours.get((i, s), []):
                step = float(np.hypot(*(xy[j] - xy[i])))
                heapq.heappush(queue, (length + step, j, t))
    return np.inf


def sector(at: np.ndarray, towards: np.ndarray, sectors: dict) -> int:
    """Number of the free sector of a node in which the way to another node lies."""
    way = 0.05 * (towards - at) / np.hypot(*(towards - at))
    pieces = sectors.get(tuple(at), [])
    return next((k for k, p in enumerate(pieces) if p.distance(Point(at + way)) < 1e-9), 0)


def lattice_points(rng: np.random.Generator, room: Polygon, solid: MultiPolygon) -> np.ndarray:
    """Two points of the half lattice, in free space or on its boundary (which is free as well)."""
    xmin, ymin, xmax, ymax = room.bounds
    x, y = np.meshgrid(np.arange(xmin, xmax + 0.5, 0.5), np.arange(ymin, ymax + 0.5, 0.5))
    points = np.c_[x.ravel(), y.ravel()]
    inside = shapely.contains_xy(solid, points) | ~shapely.intersects_xy(room, points)
    assume(not inside.all())
    return points[~inside][rng.integers(0, (~inside).sum(), 2)]


def float_points(rng: np.random.Generator, scene: Scene) -> np.ndarray:
    points = rng.uniform(0, 10, (100, 2))
    return points[~shapely.intersects_xy(scene.arrangement.solid, points)][:2]


# By oracles


@settings(max_examples=40)
@given(st.integers(0, 2**32))
def test_exact_is_brute_force_where_obstacles_touch_overlap_and_enclose(seed):
    rng = np.random.default_rng(seed)
    room, obstacles = random_solid(rng)
    start, goal = lattice_points(rng, room, arrange(room, obstacles).solid)
    scene = make_scene("random", room, obstacles, {"main": (start, goal)})
    assert check(scene, scene.query()).length == pytest.approx(
        brute_force(scene, scene.query()), rel=1e-12
    )


def assert_agrees_with_visibility_search_and_referee(scene: Scene, query: Query) -> None:
    found, (path, _) = check(scene, query), tangent_path(scene, query)
    if path is None:
        assert found.path is None
        return
    assert found.length == pytest.approx(path_length(path), rel=1e-12)
    verdict = Referee(scene).judge(query, found.path)
    assert verdict.valid, verdict.reason
    assert verdict.length == pytest.approx(found.length, rel=1e-12)


@settings(max_examples=counts(60, 5))
@given(st.integers(0, 2**32))
def test_exact_is_the_visibility_search_where_obstacles_touch_overlap_and_enclose(seed):
    rng = np.random.default_rng(seed)
    room, obstacles = random_solid(rng)
    ends = lattice_points(rng, room, arrange(room, obstacles).solid)
    scene = make_scene("random", room, obstacles, {"main": ends})
    assert_agrees_with_visibility_search_and_referee(scene, scene.query())


ROOMS = [
    pytest.param(1e-4, (0.0, 0.0), id="a millimetre"),
    pytest.param(1.0, (5e6, 5e6), id="ten metres, far away"),
    pytest.param(1e5, (3e8, -2e8), id="1,000 km"),
]


@pytest.mark.parametrize(("scale", "shift"), ROOMS)
def test_exact_is_the_visibility_search_in_rooms_of_any_size_place_and_turn(scale, shift):
    with_path = 0
    for seed in range(counts(12, 2)):
        rng = np.random.default_rng(seed)
        turn = rng.uniform(0.0, 2.0 * np.pi)
        a, b = scale * np.cos(turn), scale * np.sin(turn)
        drawn = [star(rng, rng.uniform(0, 10, 2), rng.uniform(0.5, 2.5)) for _ in range(9)]
        drawn = [p for o in drawn for p in shapely.get_parts(o.intersection(ROOM)) if p.area > 0]
        solid = shapely.union_all(drawn)
        points = rng.uniform(0, 10, (100, 2))
        ends = points[shapely.distance(solid, shapely.points(points)) > 0.01][:2]
        room, *drawn, ends = (
            affine_transform(shape, (a, -b, b, a, *shift))
            for shape in (ROOM, *drawn, shapely.MultiPoint(ends))
        )
        scene = make_scene("random", room, drawn, tuple(shapely.get_coordinates(ends)))
        assert_agrees_with_visibility_search_and_referee(scene, scene.query())
        with_path += shortest_path(scene, scene.query()).path is not None
    assert with_path > 0


def test_without_a_mesh_the_visibility_search_stands_in():
    scene = make_scene("one box", ROOM, [box(4, 0, 6, 7)], ((0, 3), (10, 3)))
    wanted = shortest_path(scene, scene.query())
    vars(scene)["mesh"] = None  # as where free space can't be cut into triangles
    found = shortest_path(scene, scene.query())
    assert found.path.tolist() == wanted.path.tolist()
    assert found.length == wanted.length


def test_preparing_is_done_once_for_a_scene():
    scene = make_scene("one box", ROOM, [box(4, 0, 6, 7)], ((0, 3), (10, 3)))
    mesh = prepare(scene)
    shortest_path(scene, scene.query())
    assert mesh is not None
    assert prepare(scene) is mesh


def test_a_scene_that_was_sent_elsewhere_is_solved_there():
    scene = make_scene("one box", ROOM, [box(4, 0, 6, 7)], ((0, 3), (10, 3)))
    here = shortest_path(scene, scene.query())
    sent = pickle.loads(pickle.dumps(scene))
    assert shortest_path(sent, sent.query()).path.tolist() == here.path.tolist()


def test_exact_is_extremitypathfinder_among_disjoint_polygons():
    compared = 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        apart: list[Polygon] = []
        while len(apart) < 8:
            polygon = star(rng, rng.uniform(1.5, 8.5, 2), 1.4)
            if all(polygon.distance(p) > 0.05 for p in apart):
                apart.append(polygon)
        scene = make_scene("random", ROOM, apart, {"corner": ((0, 0), (10, 10))})
        other = PolygonEnvironment()
        other.store(
            orient(ROOM).exterior.coords[:-1],
            [orient(p, -1).exterior.coords[:-1] for p in apart],
        )
        for _ in range(5):
            query = Query("random", *float_points(rng, scene))
            _, length = other.find_shortest_path(tuple(query.start), tuple(query.goal))
            # they read the vertices as drawn, we on the grid of 1e-9 m
            assert check(scene, query).length == pytest.approx(length, abs=1e-7)
            compared += 1
    assert compared == 60


# By hand


def test_without_obstacles_the_path_is_the_straight_line():
    found = solve([], (1, 2), (9, 7))
    assert found.path.tolist() == [[1, 2], [9, 7]]


def test_a_path_bends_around_the_nearer_corners():
    found = solve([box(4, 0, 6, 7)], (0, 3), (10, 3))
    assert found.path.tolist() == [[0, 3], [4, 7], [6, 7], [10, 3]]
    assert found.length == pytest.approx(2 + 2 * np.hypot(4, 4))


def test_a_path_bends_around_the_notch_of_the_workspace():
    room = Polygon([(0, 0), (10, 0), (10, 10), (5, 4), (0, 10)])
    assert solve([], (0, 10), (10, 10), room).path.tolist() == [[0, 10], [5, 4], [10, 10]]


def test_a_path_may_follow_edges_and_the_border():
    assert solve([box(3, 3, 6, 6)], (1, 3), (9, 3)).path.tolist() == [[1, 3], [9, 3]]
    assert solve([box(3, 3, 6, 6)], (0, 0), (0, 10)).path.tolist() == [[0, 0], [0, 10]]


def test_start_and_goal_in_one_place_are_a_path_of_no_length():
    for point in [(1, 1), (4, 0), (4, 7), (0, 0), (5, 7)]:
        found = solve([box(4, 0, 6, 7)], point, point)
        assert found.path.tolist() == [list(point)] * 2
        assert found.length == 0.0


@pytest.mark.parametrize("start", [(4, 4), (5, 4), (4, 5), (6, 6)])
@pytest.mark.parametrize("goal", [(6, 4), (6, 6), (5, 6), (6, 5)])
def test_start_and_goal_may_lie_on_corners_and_edges(start, goal):
    scene = make_scene("one", ROOM, [box(4, 4, 6, 6)], {"main": (start, goal)})
    found = check(scene, scene.query())
    assert found.length == pytest.approx(brute_force(scene, scene.query()), rel=1e-12)


def test_no_vertex_comes_twice_when_start_and_goal_are_corners():
    found = solve([box(4, 4, 6, 6)], (4, 4), (6, 6))
    assert len(found.path) == 3
    assert (np.hypot(*np.diff(found.path, axis=0).T) > 0).all()


def test_a_walled_in_goal_has_no_path():
    walls = [box(3, 3, 8, 4), box(3, 7, 8, 8), box(3, 4, 4, 7), box(7, 4, 8, 7)]
    found = solve(walls, (1, 1), (5, 5))
    assert found.path is None
    assert found.length == np.inf


def test_a_goal_walled_in_by_corners_that_touch_has_no_path():
    walls = [
        Polygon([(5, 1), (9, 5), (9, 1)]),
        Polygon([(9, 5), (5, 9), (9, 9)]),
        Polygon([(5, 9), (1, 5), (1, 9)]),
        Polygon([(1, 5), (5, 1), (1, 1)]),
    ]
    assert solve(walls, (0, 0), (5, 5)).path is None


def test_a_wall_from_border_to_border_leaves_no_path():
    assert solve([box(4, 0, 5, 10)], (1, 1), (9, 9)).path is None


def test_a_start_in_a_pinch_point_may_leave_into_each_of_its_sectors():
    wall = [Polygon([(3, 0), (7, 0), (5, 5)]), Polygon([(3, 10), (7, 10), (5, 5)])]
    assert solve(wall, (5, 5), (1, 5)).length == 4.0
    assert solve(wall, (5, 5), (9, 5)).length == 4.0
    assert solve(wall, (1, 5), (9, 5)).path is None


def test_an_end_in_solid_has_no_path():
    scene = make_scene("one box", ROOM, [box(4, 4, 6, 6)], ((1, 1), (9, 9)))
    free, closed = np.array([1.0, 1.0]), np.array([5.0, 5.0])
    for ends in ((free, closed), (closed, free), (closed, closed)):
        assert shortest_path(scene, Query("into", *ends)).path is None


def test_a_goal_deep_in_a_pocket_is_found_and_so_is_the_way_out():
    walls = [box(2, 2, 8, 3), box(2, 3, 3, 8), box(7, 3, 8, 8)]
    found = solve(walls, (6, 0), (5, 4))  # and back: see check()
    assert found.path.tolist() == [[6, 0], [8, 2], [8, 8], [7, 8], [5, 4]]


# The four mistakes that gave wrong optima on the real maps


def test_a_vertex_on_the_open_segment_blocks_it_where_the_wall_lies_on_both_sides():
    wall = Polygon([(2, 4), (5, 4), (8, 4), (8, 6), (5, 6), (2, 6)])
    found = solve([wall], (5, 1), (5, 9))
    assert found.length == pytest.approx(2 + 2 * np.hypot(3, 3))


def test_pixels_along_a_diagonal_block_the_way_through_their_corners():
    pixels = [box(i, 9 - i, i + 1, 10 - i) for i in range(1, 10)]
    found = solve(pixels, (2, 2), (8, 8))
    assert found.path.tolist() == [[2, 2], [1, 8], [1, 9], [2, 9], [8, 8]]


def test_routes_along_collinear_corners_are_not_pruned():
    slope = 0.3
    teeth = [
        Polygon([(x, 0), (x + 0.4, 0), (x + 0.2, 0.1 + slope * (x + 0.2))])
        for x in (1.1, 2.3, 3.7, 4.9, 6.1, 8.3)
    ]
    start, goal = (0.0, 0.1), (10.0, 0.1 + 10 * slope)
    straight = float(np.hypot(10, 10 * slope))
    assert solve(teeth, start, goal).length == pytest.approx(straight, rel=1e-9)


def test_routes_along_corners_that_are_collinear_exactly_are_not_pruned():
    steps = [box(i, 0, i + 1, i) for i in range(1, 9)]
    found = solve(steps, (0, 0), (10, 8))
    assert found.length == pytest.approx(np.hypot(8, 8) + 2)


def test_no_path_walks_round_outside_the_workspace():
    baffles = [box(2, 0, 3, 9), box(5, 1, 6, 10), box(8, 0, 9, 9)]
    scene = make_scene("baffles", ROOM, baffles, {"main": ((0, 0), (10, 0))})
    found = check(scene, scene.query())
    assert scene.workspace.covers(shapely.LineString(found.path))
    assert found.length == pytest.approx(brute_force(scene, scene.query()), rel=1e-12)
    assert found.length > 30


def test_no_path_squeezes_between_obstacles_that_touch_in_a_point():
    touching = [box(0, 0, 5, 5), box(5, 5, 9, 9)]
    found = solve(touching, (4, 6), (6, 4))
    assert found.length > 10
    assert not (found.path == [5, 5]).all(axis=1).any()
