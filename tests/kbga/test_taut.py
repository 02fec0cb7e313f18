"""A path pulled taut is the shortest of its kind: the exact routes say so."""

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st

from kbga.algorithm import KBGA
from kbga.counter import ASKED, COMPUTED, make_counter
from kbga.settings import KBGAPlusSettings
from kbga.taut import pull_taut, rest_of
from suite.geometry.kernels import first_collision
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import path_length, shortest_path
from suite.scenes.homotopy import route_optima, routes_of
from suite.scenes.scene import Scene, make_scene
from tests.kbga.laboratory import random_scene
from tests.suite.geometry.lattice import counts

SEEDS = st.integers(0, 2**32)

ON_LATTICE = {"corner_nodes": False, "taut": 0.0}


def feasible_paths(scene: Scene, seed: int) -> list[np.ndarray]:
    """What a population has after three generations: paths with knots, detours and repeats."""
    ga = KBGA(
        scene, settings=KBGAPlusSettings(resolution=20, population_size=12, **ON_LATTICE), rng=seed
    )
    for _ in range(3):
        ga.step()
    return [path for path in ga.paths() if first_collision(path, scene.arrays) < 0]


def pulled(path: np.ndarray, scene: Scene) -> np.ndarray:
    return pull_taut(path, scene.arrays, make_counter())


@settings(max_examples=counts(150, 25))
@example(162594)  # a node on the goal
@given(SEEDS)
def test_a_taut_path_is_free_and_no_longer_and_bends_at_vertices_only(seed):
    scene = random_scene(np.random.default_rng(seed))
    vertices = {(x, y) for x, y in scene.arrays.vertices[:, :2].tolist()}
    for path in feasible_paths(scene, seed):
        taut = pulled(path, scene)
        assert first_collision(taut, scene.arrays) < 0
        assert path_length(taut) <= path_length(path) * (1.0 + 1e-12)
        assert (taut[[0, -1]] == path[[0, -1]]).all()
        assert {(x, y) for x, y in taut[1:-1].tolist()} <= vertices


@settings(max_examples=counts(60, 8))
@given(SEEDS)
def test_pulled_again_nothing_moves(seed):
    scene = random_scene(np.random.default_rng(seed))
    for path in feasible_paths(scene, seed):
        once = pulled(path, scene)
        assert pulled(once, scene).tolist() == once.tolist()


@pytest.mark.parametrize("name", ["unstructured", "double_u", "obstacles_20", "zigzag@twin=2"])
def test_it_is_the_shortest_of_its_route(name):
    scene = load_scene(name)
    optima = list(route_optima(scene, scene.query(), limit_ratio=1.3))
    met = 0
    for path in feasible_paths_of_the_plus(scene):
        taut = pulled(path, scene)
        before, after, *routes = routes_of(scene, [path, taut, *(r.path for r in optima)])
        assert before == after, "it passes all obstacles on the sides where the path did"
        if after in routes:
            best = optima[routes.index(after)].length
            assert path_length(taut) == pytest.approx(best, rel=1e-9)
            met += 1
    assert met > 10


def feasible_paths_of_the_plus(scene: Scene) -> list[np.ndarray]:
    found = []
    for seed in range(4):
        ga = KBGA(scene, settings=KBGAPlusSettings(max_generations=3, **ON_LATTICE), rng=seed)
        ga.run()
        found += [path for path in ga.paths() if first_collision(path, scene.arrays) < 0]
    return found


def test_a_path_around_two_boxes_that_meet_in_a_point_does_not_slip_between_them():
    boxes = [shapely.box(2, 2, 5, 5), shapely.box(5, 5, 8, 8)]
    scene = make_scene("pinched", shapely.box(0, 0, 10, 10), boxes, ((3, 7), (7, 3)))
    around = np.array([(3.0, 7.0), (1.0, 6.0), (1.0, 1.0), (6.0, 1.0), (7.0, 3.0)])
    taut = pulled(around, scene)
    assert taut.tolist() == [[3, 7], [2, 5], [2, 2], [5, 2], [7, 3]]


def test_a_path_through_its_own_start_is_cut_short():
    scene = make_scene("empty", shapely.box(0, 0, 10, 10), [], ((1, 1), (9, 1)))
    loop = np.array([(1.0, 1.0), (5.0, 1.0), (1.0, 1.0), (0.5, 1.0), (9.0, 1.0)])
    assert pulled(loop, scene).tolist() == [[1, 1], [9, 1]]


def test_no_more_is_asked_than_may_be():
    scene = load_scene("zigzag")
    ga = KBGA(scene, settings=KBGAPlusSettings(**ON_LATTICE), rng=1)
    path = ga.run()
    lengths = []
    for limit in range(60):
        counter = make_counter(limit)
        taut = pull_taut(path, scene.arrays, counter)
        assert counter[COMPUTED] == counter[ASKED] <= limit
        assert first_collision(taut, scene.arrays) < 0
        lengths.append(path_length(taut))
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[-1] == pytest.approx(shortest_path(scene, scene.query()).length, rel=1e-9)


def test_the_rest_of_a_path_begins_where_the_robot_is():
    path = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (8.0, 4.0)])
    assert rest_of(path, np.array([4.0, 1.0])).tolist() == [[4, 1], [4, 4], [8, 4]]
    assert rest_of(path, path[0]).tolist() == path.tolist()
    assert rest_of(path, path[1]).tolist() == [[4, 0], [4, 4], [8, 4]]
    assert rest_of(path, path[-1]).tolist() == [[8, 4], [8, 4]]


@pytest.mark.parametrize("name", ["maze", "clustered", "obstacles_30@twin=4"])
def test_kbga_plus_ends_at_the_optimum(name):
    scene = load_scene(name)
    ga = KBGA(scene, settings=KBGAPlusSettings(), rng=1)
    path = ga.run()
    assert path_length(path) == ga.best_cost
    assert first_collision(path, scene.arrays) < 0
    assert ga.best_cost == pytest.approx(shortest_path(scene, scene.query()).length, rel=1e-9)


def test_one_seed_gives_one_path_and_nobody_asks_more_than_the_budget():
    scene = load_scene("obstacles_40")
    chosen = KBGAPlusSettings()
    runs = [KBGA(scene, settings=chosen, rng=5, checks=3_000) for _ in range(2)]
    first, second = (ga.run() for ga in runs)
    assert first.tolist() == second.tolist()
    assert runs[0].checks == runs[1].checks == 3_000


def test_a_robot_on_its_way_keeps_what_is_left_of_its_path():
    scene = load_scene("double_u")
    chosen = KBGAPlusSettings(taut=1.1, max_generations=20)
    ga = KBGA(scene, settings=chosen, rng=3)
    path = ga.run()
    for share in (0.1, 0.5, 0.9):  # on no leg along a wall, where rounding decides
        line = shapely.LineString(path)
        place = shapely.line_interpolate_point(line, share * line.length)
        robot = np.array([place.x, place.y])
        ga.go_on(scene, robot)
        assert ga.best_cost <= (1.0 - share) * line.length * (1.0 + 1e-9)
        assert first_collision(ga.best_path, scene.arrays) < 0
        ga = KBGA(scene, settings=chosen, rng=3)
        ga.run()


@pytest.mark.parametrize(("name", "value"), [("taut", 0.5), ("taut", float("nan")), ("taut", True)])
def test_what_no_factor_can_be_is_refused(name, value):
    with pytest.raises(ValueError, match=r"taut is .*it must be 0, or 1 or more"):
        KBGAPlusSettings(**{name: value})
