"""What is found about an environment before evolution: free nodes next to its corners."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from kbga.algorithm import KBGA
from kbga.encoding import is_crossing, node_x, node_y
from kbga.problem import (
    MOST_NEAR,
    NO_NODE,
    Problem,
    is_known_usable,
    is_usable,
    make_problem,
)
from kbga.settings import KBGAPlusSettings
from suite.geometry.arrangement import arrange
from suite.geometry.kernels import FIRST_EDGE, LAST_EDGE
from suite.scenes.scene import Scene
from tests.kbga.laboratory import all_near_nodes, near_nodes, random_scene, scene_of
from tests.suite.geometry.lattice import counts, pinches, random_solid


def problem_of(scene: Scene, resolution: int) -> Problem:
    return make_problem(scene.arrangement, scene.bounds, resolution)


def places(problem: Problem, nodes: list[int]) -> np.ndarray:
    lattice = problem.lattice
    number = np.array(nodes, dtype=int)
    x = lattice.x0 + lattice.unit * (number % lattice.columns)
    y = lattice.y0 + lattice.unit * (number // lattice.columns)
    return np.column_stack([x, y])


@settings(max_examples=counts(60, 5))
@given(st.integers(0, 2**32), st.sampled_from([2, 3, 5, 8, 16]))
def test_nodes_near_an_obstacle_are_free_and_next_to_its_corners(seed, resolution):
    scene = random_scene(np.random.default_rng(seed))
    problem = problem_of(scene, resolution)
    solid = scene.arrangement.solid
    bad = {(p.x, p.y) for p, _ in pinches(solid)}
    for group in range(len(problem.arrays.groups)):
        nodes = near_nodes(problem, group)
        assert len(set(nodes)) == len(nodes)
        corners = scene.arrangement.corners[scene.arrangement.corner_group == group, :2]
        cell = problem.lattice.unit
        for place in places(problem, nodes):
            assert not shapely.contains_xy(solid, *place)
            assert tuple(place) not in bad
            assert (np.abs(corners - place) / cell < 2.0 + 1e-9).all(axis=1).any()


@settings(max_examples=counts(40, 5))
@given(st.integers(0, 2**32), st.sampled_from([2, 5, 16]))
def test_corners_that_are_nodes_stand_for_themselves_and_no_crossing_beside_them(seed, resolution):
    scene = random_scene(np.random.default_rng(seed))
    problem = make_problem(scene.arrangement, scene.bounds, resolution, corner_nodes=True)
    lattice, corners = problem.lattice, scene.arrangement.corners[:, :2]
    bad = {(p.x, p.y) for p, _ in pinches(scene.arrangement.solid)}
    for group in range(len(problem.arrays.groups)):
        found = [(node_x(lattice, n), node_y(lattice, n)) for n in near_nodes(problem, group)]
        own = corners[scene.arrangement.corner_group == group]
        assert sorted(found) == sorted(c for c in map(tuple, own.tolist()) if c not in bad)


@pytest.mark.parametrize(("sides", "are_sharp"), [(4, True), (24, True), (48, False)])
def test_the_corners_of_a_polygon_are_sharp_but_those_of_an_arc_are_not(sides, are_sharp):
    turn = 2.0 * np.pi * np.arange(sides) / sides
    scene = scene_of(shapely.Polygon(np.column_stack([5 + np.cos(turn), 5 + np.sin(turn)])))
    problem = make_problem(scene.arrangement, scene.bounds, 20, corner_nodes=True)
    assert ((problem.corner_nodes[:sides] != NO_NODE) == are_sharp).all()
    crossings = [is_crossing(problem.lattice, n) for n in near_nodes(problem, 0)]
    assert sum(not found for found in crossings) >= (sides - 4 if are_sharp else 0)
    assert are_sharp or all(crossings)


@settings(max_examples=counts(40, 5))
@given(st.integers(0, 2**32))
def test_every_corner_on_a_free_lattice_node_has_that_node(seed):
    scene = random_scene(np.random.default_rng(seed))
    xmin, ymin, xmax, ymax = scene.bounds
    side = int(max(xmax - xmin, ymax - ymin))
    problem = make_problem(scene.arrangement, (xmin, ymin, xmin + side, ymin + side), side)
    bad = {(p.x, p.y) for p, _ in pinches(scene.arrangement.solid)}
    for (x, y), group in zip(
        scene.arrangement.corners[:, :2], scene.arrangement.corner_group, strict=True
    ):
        if x % 1 == 0 and y % 1 == 0 and (x, y) not in bad:
            assert int((y - ymin) * (side + 1) + x - xmin) in near_nodes(problem, int(group))


@settings(max_examples=counts(60, 5))
@given(st.integers(0, 2**32), st.sampled_from([2, 3, 5, 8, 16]), st.sampled_from([1, 2, 4]))
def test_with_a_reach_the_nodes_near_an_obstacle_are_all_free_ones_so_near_to_its_boundary(
    seed, resolution, reach
):
    scene = random_scene(np.random.default_rng(seed))
    problem = make_problem(
        scene.arrangement, scene.bounds, resolution, room=scene.workspace, reach=reach
    )
    lattice = problem.lattice
    everywhere = places(problem, list(range(lattice.columns * lattice.rows)))
    usable = [is_usable(n, problem.arrays, lattice) for n in range(len(everywhere))]
    for group in range(len(problem.arrays.groups)):
        first, last = problem.arrays.groups[group, [FIRST_EDGE, LAST_EDGE]].astype(int)
        edges = problem.arrays.boundary[first:last].reshape(-1, 2, 2)
        away = (
            shapely.distance(
                shapely.points(everywhere), shapely.multilinestrings(shapely.linestrings(edges))
            )
            if len(edges)
            else np.full(len(everywhere), np.inf)
        )
        found = near_nodes(problem, group)
        assert len(set(found)) == len(found)
        slack = 1e-9
        sure = {
            n for n in range(len(usable)) if usable[n] and away[n] < reach * lattice.unit - slack
        }
        may = {
            n for n in range(len(usable)) if usable[n] and away[n] < reach * lattice.unit + slack
        }
        assert sure <= set(found) <= may


def test_without_obstacles_there_is_nothing_to_be_near_to():
    problem = problem_of(scene_of(), 10)
    assert all_near_nodes(problem) == []


def test_a_pinch_point_is_no_place_for_a_node():
    boxes = shapely.box(3, 3, 5, 5), shapely.box(5, 5, 5.5, 5.5)
    near = near_nodes(problem_of(scene_of(*boxes), 10), 0)
    assert 5 * 11 + 5 not in near
    assert 5 * 11 + 6 in near  # beside it, next to the corner (5.5, 5)


def test_a_corner_whose_cell_is_closed_looks_one_cell_further():
    # The corners of a thin slab between two lattice lines of a lattice of 5 m cells.
    slab = scene_of(shapely.box(0, 4.9, 9, 5.1))
    free = places(problem_of(slab, 2), near_nodes(problem_of(slab, 2), 0)).tolist()
    assert [10.0, 5.0] in free
    assert [5.0, 5.0] not in free


@settings(max_examples=counts(60, 6))
@given(
    st.integers(0, 2**32),
    st.sampled_from([2, 3, 7, 10, 30]),
    st.sampled_from([0.0, 0.1, 1 / 3, 1e8]),
    st.sampled_from([1.0, 0.1, 1 / 3, 7.7]),
)
def test_the_near_nodes_of_a_group_have_room_beside_those_of_the_next(
    seed, resolution, offset, scale
):
    rng = np.random.default_rng(seed)
    room, obstacles = random_solid(rng)
    # Corners on lattice lines, beside them by a rounding, and anywhere.
    room, *obstacles = (
        shapely.transform(p, lambda xy: scale * xy + offset) for p in (room, *obstacles)
    )
    problem = make_problem(arrange(room, obstacles), room.bounds, resolution)
    groups = len(problem.near_count)
    found = {int(g): near_nodes(problem, int(g)) for g in rng.permutation(groups)}
    for group in range(groups):
        corners = problem.corner_start[group + 1] - problem.corner_start[group]
        assert len(found[group]) <= MOST_NEAR * corners
        assert near_nodes(problem, group) == found[group], "asked again, it says the same"


def test_the_corners_of_the_frame_have_near_nodes_too():
    room = shapely.box(0, 0, 10, 10).difference(shapely.box(4, 0, 6, 7))
    problem = problem_of(scene_of(room=room, ends=((1, 1), (9, 1))), 10)
    near = near_nodes(problem, 0)
    assert {7 * 11 + 4, 7 * 11 + 6} <= set(near)


def test_where_no_node_is_free_there_is_none_near_and_a_run_goes_on_all_the_same():
    # Three by three nodes: eight under a wall along the border, and one in the middle of a box.
    wall = shapely.box(0, 0, 10, 10).difference(shapely.box(0.5, 0.5, 9.5, 9.5))
    scene = scene_of(wall, shapely.box(4, 4, 6, 6))
    problem = problem_of(scene, 2)
    assert not any(is_usable(n, problem.arrays, problem.lattice) for n in range(9))
    assert all_near_nodes(problem) == []
    chosen = KBGAPlusSettings(
        resolution=2,
        population_size=6,
        max_generations=5,
        informed_share=0.5,
        corner_nodes=False,
        lattice_over="room",
    )
    ga = KBGA(scene, settings=chosen, rng=0)
    assert ga.run() is None
    assert ga.generation == 5
    around = KBGA(scene, settings=replace(chosen, corner_nodes=True), rng=0).run()
    assert around is not None
    assert set(map(tuple, around[1:-1].tolist())) <= {(4, 4), (4, 6), (6, 4), (6, 6)}


@settings(max_examples=counts(20, 3))
@given(st.integers(0, 2**32))
def test_what_is_known_of_a_node_is_what_is_found_of_it_asked_once_or_twice(seed):
    problem = problem_of(random_scene(np.random.default_rng(seed)), 8)
    for node in range(len(problem.usable)):
        usable = is_usable(node, problem.arrays, problem.lattice)
        assert is_known_usable(node, problem) == usable
        assert is_known_usable(node, problem) == usable
