"""What is found about an environment before evolution: free nodes next to its corners."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from kbga.problem import Problem, make_problem
from suite.scene import Scene
from tests.kbga.laboratory import all_near_nodes, near_nodes, random_scene, scene_of
from tests.suite.geometry.lattice import counts, pinches


def problem_of(scene: Scene, resolution: int) -> Problem:
    return make_problem(scene.arrangement, scene.bounds, resolution)


def places(problem: Problem, nodes: list[int]) -> np.ndarray:
    lattice = problem.lattice
    number = np.array(nodes, dtype=int)
    x = lattice.x0 + lattice.dx * (number % lattice.side)
    y = lattice.y0 + lattice.dy * (number // lattice.side)
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
        cell = np.array([problem.lattice.dx, problem.lattice.dy])
        for place in places(problem, nodes):
            assert not shapely.contains_xy(solid, *place)
            assert tuple(place) not in bad
            assert (np.abs(corners - place) / cell < 2.0 + 1e-9).all(axis=1).any()


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
