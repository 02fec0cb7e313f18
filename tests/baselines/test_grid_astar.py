"""A* on a grid finds the grid's shortest path, along free segments only."""

from itertools import product

import numpy as np
import pytest
import shapely
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from baselines.grid_astar import GridAstarPlanner, GridAstarSettings
from suite.geometry.kernels import first_collision
from suite.planner import Budget, Plan, PlanStatus, Recorder
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import path_length
from suite.scenes.scene import Scene, make_scene

ROOM = shapely.box(0, 0, 10, 10)


def plan(scene: Scene, **settings) -> Plan:
    planner = GridAstarPlanner(GridAstarSettings(**settings))
    rng = np.random.default_rng(0)
    return planner.plan(scene, scene.query(), Budget(), rng, Recorder())


def is_free(scene: Scene, a, b) -> bool:
    return first_collision(np.array([a, b]), scene.arrays) < 0


def grid_optimum(scene: Scene, side: float, count: int) -> float:
    """Length from start to goal over the grid, by Dijkstra of scipy on all edges at once.

    Start and goal are joined to the centres that they see less than three cells away, the goal to
    the nearest.
    """
    centres = [(side * (i + 0.5), side * (j + 0.5)) for i, j in product(range(count), repeat=2)]
    points = np.array([*centres, scene.query().start, scene.query().goal])
    start, goal = len(centres), len(centres) + 1
    weights = np.zeros((len(points), len(points)))
    for i, j in product(range(len(centres)), repeat=2):
        if i < j and np.max(np.abs(points[i] - points[j])) < 1.5 * side:
            weights[i, j] = weights[j, i] = is_free(scene, *points[[i, j]])
    for end in (start, goal):
        cell = np.floor(points[end] / side)
        near = [
            i
            for i in range(len(centres))
            if np.max(np.abs(np.floor(points[i] / side) - cell)) <= 2
            and is_free(scene, *points[[end, i]])
        ]
        if end == goal:
            near = [min(near, key=lambda i: np.hypot(*(points[i] - points[goal])))]
        weights[near, end] = weights[end, near] = 1.0
    lengths = np.hypot(*(points[:, None] - points).transpose(2, 0, 1))
    return float(dijkstra(csr_array(weights * lengths), indices=start)[goal])


@pytest.mark.parametrize(
    "name",
    [
        "obstacles_20",
        *(pytest.param(n, marks=pytest.mark.slow) for n in ("unstructured", "obstacles_40")),
    ],
)
def test_the_raw_path_is_the_shortest_of_the_grid(name):
    scene = load_scene(name)
    made = plan(scene, resolution=25, smooth=False)
    # 99 / 70 for the square root of 2, and whole numbers for the way from the start.
    assert made.claimed_cost == pytest.approx(grid_optimum(scene, 4.0, 25), abs=0.1)


def test_pulling_taut_shortens_the_path_and_keeps_it_free():
    scene = load_scene("clustered")
    raw, taut = plan(scene, smooth=False), plan(scene)
    assert judge(scene, scene.query(), taut.path).valid
    assert taut.claimed_cost < raw.claimed_cost
    assert len(taut.path) < len(raw.path) / 5


def test_a_taut_path_is_the_straight_line_where_it_is_free():
    scene = make_scene("empty", ROOM, [], ((1, 1), (9, 3)))
    assert plan(scene).path.tolist() == [[1, 1], [9, 3]]


def test_a_wall_thinner_than_a_cell_stops_the_grid():
    wall = shapely.box(4.999, 0, 5.001, 10)
    scene = make_scene("thin wall", ROOM, [wall], ((1, 5), (9, 5)))
    made = plan(scene, resolution=10)
    assert (made.status, made.path) == (PlanStatus.EXHAUSTED, None)


@pytest.mark.parametrize(("resolution", "solved"), [(10, False), (100, True)])
def test_a_gap_needs_a_grid_that_is_fine_enough(resolution, solved):
    # From 4.6 to 4.9 there is no centre at resolution 10, where they lie at 4.5 and 5.5.
    walls = [shapely.box(3, 0, 7, 4.6), shapely.box(3, 4.9, 7, 10)]
    scene = make_scene("gap", ROOM, walls, ((1, 1), (9, 1)))
    made = plan(scene, resolution=resolution)
    assert made.status is (PlanStatus.SOLVED if solved else PlanStatus.EXHAUSTED)


def test_centres_in_pinch_points_are_left_out():
    # At resolution 10 the point (4.5, 4.5) is a centre; its diagonal neighbours are free.
    boxes = [shapely.box(0, 4.5, 4.5, 10), shapely.box(4.5, 0, 10, 4.5)]
    scene = make_scene("pinch", ROOM, boxes, ((1, 1), (9, 9)))
    assert plan(scene, resolution=10).status is PlanStatus.EXHAUSTED


def test_cells_are_square_in_a_room_that_is_not():
    room = shapely.box(-3, 2, 27, 9)
    scene = make_scene("long", room, [shapely.box(9, 2, 11, 8)], ((-3, 2), (27, 2)))
    made = plan(scene, resolution=30)
    assert judge(scene, scene.query(), made.path).valid
    assert made.claimed_cost == pytest.approx(path_length(made.path))


def test_the_budget_ends_the_pulling_but_not_the_path():
    scene = load_scene("maze")
    planner, rng = GridAstarPlanner(), np.random.default_rng(0)
    raw = plan(scene, smooth=False)
    budget = Budget(checks=raw.checks + 500)
    made = planner.plan(scene, scene.query(), budget, rng, Recorder())
    assert made.checks <= budget.checks
    assert judge(scene, scene.query(), made.path).valid
    assert plan(scene).claimed_cost < made.claimed_cost <= raw.claimed_cost


@pytest.mark.parametrize("resolution", [0, 4001])
def test_a_resolution_that_the_package_can_not_count_is_refused(resolution):
    with pytest.raises(ValueError, match=f"resolution is {resolution}. It must be 1 to 4000 cells"):
        GridAstarSettings(resolution=resolution)
