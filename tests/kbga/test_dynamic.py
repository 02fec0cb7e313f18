"""A population in a changed environment: kept, evaluated anew, and its best left alone."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import box

from kbga import KBGA, KBGAPlusSettings, KBGASettings
from kbga.dynamic import disturb, renumber_corners, restart
from kbga.encoding import is_crossing, make_lattice, node_x, node_y, path_of
from kbga.evolution import best_feasible
from kbga.memory import empty_memory
from kbga.plugin import KBGAPlanner
from suite.planner import Budget, PlanStatus, Recorder
from suite.referee.path import judge
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene
from tests.kbga.laboratory import Laboratory, check, laboratory, random_scene, scene_of
from tests.suite.geometry.lattice import counts

SEEDS = st.integers(0, 2**32)
SMALL = KBGASettings(population_size=20, resolution=20, max_generations=counts(40, 4))
WALL = box(4, 0, 6, 8)
AT_START = np.array([1.0, 1.0])


def evolved(scene: Scene, seed: int = 1, settings: KBGASettings = SMALL) -> KBGA:
    ga = KBGA(scene, settings=settings, rng=seed)
    assert ga.run() is not None
    return ga


def best(ga: KBGA) -> np.ndarray:
    assert ga.best_path is not None
    return ga.best_path


# The kernels


def restarted(lab: Laboratory, place: np.ndarray) -> Laboratory:
    lab.problem = lab.problem._replace(memory=empty_memory())
    restart(lab.population, *place.tolist(), lab.problem, lab.rates.penalty, lab.counter)
    return replace(lab, query=Query("main", place, lab.query.goal))


@settings(max_examples=counts(40, 4))
@given(SEEDS, st.tuples(st.integers(0, 5), st.integers(0, 5)))
def test_records_are_true_after_a_restart_from_anywhere(seed, place):
    lab = laboratory(random_scene(np.random.default_rng(seed)), seed)
    for _ in range(2):
        lab.next_generation()
    check(restarted(lab, np.array(place, dtype=np.float64)))


@settings(max_examples=counts(150, 8))
@given(SEEDS, st.floats(0.0, 1.0))
def test_a_path_stays_the_same_from_where_the_robot_is_on_it(seed, share):
    lab = laboratory(random_scene(np.random.default_rng(seed)), seed)
    path = path_of(lab.population, 0)
    line = shapely.LineString(path)
    place = shapely.get_coordinates(line.interpolate(share, normalized=True))[0]
    left = path_of(restarted(lab, place).population, 0)
    assert left[0].tolist() == place.tolist()
    # It is the end of the path, from a segment on that the place lies on (it may cross itself).
    rest = left[1:]
    assert np.array_equal(rest, path[len(path) - len(rest) :])
    segment = shapely.LineString(path[len(path) - len(rest) - 1 :][:2])
    assert segment.distance(shapely.Point(place)) < 1e-9


@given(SEEDS)
def test_the_spared_chromosome_is_not_disturbed_and_records_stay_true(seed):
    lab = laboratory(random_scene(np.random.default_rng(seed)), seed)
    before = path_of(lab.population, 3)
    disturb(lab.population, 3, 1.0, lab.problem, lab.rates, lab.fresh_draws(), lab.counter)
    assert np.array_equal(path_of(lab.population, 3), before)
    check(lab)


@given(SEEDS)
def test_a_corner_keeps_its_place_in_a_changed_environment_or_moves_to_the_lattice(seed):
    rng = np.random.default_rng(seed)
    bounds = (0.0, 0.0, 10.0, 10.0)
    before = make_lattice(bounds, 10, corners=rng.uniform(0.0, 10.0, (6, 2)))
    kept = rng.permutation(6)[:3]
    after = make_lattice(bounds, 10, corners=before.corners[kept])
    lab = laboratory(scene_of(WALL), seed)
    size = int(lab.population.chromosomes["intermediate"][0])
    crossings = before.columns * before.rows
    for k in range(1, size + 1):
        corner = int(rng.integers(6))
        lab.population.nodes["gene"][0, k] = crossings + corner
        lab.population.nodes["x"][0, k], lab.population.nodes["y"][0, k] = before.corners[corner]
    places = path_of(lab.population, 0)
    renumber_corners(lab.population, before, after)
    for k in range(1, size + 1):
        gene, place = lab.genes(0)[k - 1], path_of(lab.population, 0)[k]
        assert place.tolist() == [node_x(after, gene), node_y(after, gene)]
        if is_crossing(after, gene):
            assert places[k].tolist() not in after.corners.tolist()
            assert (np.abs(place - places[k]) <= 0.5 * after.unit).all()
        else:
            assert place.tolist() == places[k].tolist()


def test_with_nodes_at_corners_a_robot_on_its_way_meets_new_and_moved_obstacles():
    scenes = [scene_of(WALL), scene_of(WALL, box(3, 7, 5, 9.5)), scene_of(box(4.5, 0, 6, 8.25))]
    ga = KBGA(scenes[0], settings=KBGAPlusSettings(lattice_over="room"), rng=1)
    ga.run()
    for scene, start in zip(
        [*scenes[1:], scenes[0]], ((1.0, 2.0), (2.0, 3.0), (3.0, 3.5)), strict=True
    ):
        ga.go_on(scene, np.array(start))
        path = ga.run()
        query = Query("main", np.array(start), scene.query().goal)
        assert judge(scene, query, path).valid
        exact = shortest_path(scene, query).length
        assert ga.best_cost == pytest.approx(exact, rel=1e-9)


# Going on


def test_an_obstacle_beside_the_best_path_leaves_it_unchanged():
    for seed in range(counts(10, 1)):
        ga = evolved(scene_of(WALL), seed, KBGASettings())
        exact = shortest_path(scene_of(WALL), scene_of(WALL).query()).length
        known, cost = best(ga), ga.best_cost
        ga.go_on(scene_of(WALL, box(1, 5, 2, 6)), AT_START)
        assert ga.best_cost == cost
        assert np.array_equal(best(ga), known)
        ga.run()
        assert np.array_equal(best(ga), known) or exact - 1e-9 <= ga.best_cost < cost


def test_an_obstacle_in_the_way_is_avoided():
    before, after = scene_of(WALL), scene_of(WALL, box(3, 7, 5, 9.5))
    ga = evolved(before)
    ga.go_on(after, AT_START)
    assert ga.best_path is None or judge(after, after.query(), ga.best_path).valid
    path = ga.run()
    assert judge(after, after.query(), path).valid


def test_where_an_obstacle_was_removed_a_better_path_is_found():
    before, after = scene_of(WALL, box(3, 7, 5, 9.5)), scene_of(WALL)
    ga = evolved(before)
    cost = ga.best_cost
    ga.go_on(after, AT_START)
    ga.run()
    assert ga.best_cost < cost


def test_from_where_the_robot_is_the_best_path_is_no_longer_than_what_was_left_of_it():
    scene = scene_of(WALL)
    ga = evolved(scene)
    line = shapely.LineString(best(ga))
    for share in (0.2, 0.4, 0.6, 0.8):
        place = shapely.get_coordinates(line.interpolate(share * line.length))[0].round(9)
        ga.go_on(scene, place)
        ga.run()
        assert best(ga)[0].tolist() == place.tolist()
        assert ga.best_cost <= (1.0 - share) * line.length + 1e-6


def test_while_nothing_changes_but_the_place_nothing_is_disturbed():
    scene = scene_of(WALL)
    ga = evolved(scene)
    before = ga._rng.bit_generator.state
    ga.go_on(scene, np.array([1.5, 1.5]))
    assert ga._rng.bit_generator.state == before


def test_a_change_disturbs_the_population_unless_its_probability_is_zero():
    scene, same = scene_of(WALL), scene_of(WALL)
    for probability in (0.0, 0.9):
        chosen = KBGASettings(population_size=20, change_mutation_probability=probability)
        ga = evolved(scene, settings=chosen)
        before = ga.paths()
        ga.go_on(same, AT_START)
        kept = [any(np.array_equal(p, q) for q in before) for p in ga.paths()]
        assert all(kept) == (probability == 0.0)
        assert any(kept), "the best is spared"


def test_generations_checks_and_the_best_count_from_the_change_on():
    ga = evolved(scene_of(WALL))
    ga.run(trace=True)
    ga.go_on(scene_of(WALL, box(8, 3, 9, 4)), AT_START)
    assert (ga.generation, ga.generation_of_best) == (0, 0)
    assert 0 < ga.checks < 20 * SMALL.max_nodes
    ga.run(trace=True)
    assert ga.trace()["generation"].tolist() == list(range(ga.generation + 1))


def test_the_best_path_is_put_back_if_the_population_has_lost_it():
    scene = scene_of(WALL)
    ga = evolved(scene)
    known = best(ga)
    nodes, chromosomes = ga.population
    nodes[:] = nodes[int(chromosomes["cost"].argmax())]
    chromosomes[:] = chromosomes[int(chromosomes["cost"].argmax())]
    chromosomes["infeasible"] = 1
    ga.go_on(scene, AT_START)
    assert np.array_equal(best(ga), known)
    assert best_feasible(ga.population, 0, SMALL.population_size) == 0


def test_another_workspace_is_refused():
    ga = evolved(scene_of(WALL))
    with pytest.raises(ValueError, match=r"the workspace is \(0\.0, 0\.0, 9\.0, 10\.0\)"):
        ga.go_on(scene_of(room=box(0, 0, 9, 10)), AT_START)


# Behind the plugin interface


def test_the_replanner_keeps_its_population_and_the_same_seed_gives_the_same_plans():
    before, after = scene_of(WALL), scene_of(WALL, box(3, 7, 5, 9.5))

    def plans(seed: int) -> list[np.ndarray | None]:
        replanner = KBGAPlanner(SMALL).replanner(np.random.default_rng(seed))
        first = replanner.begin(before, before.query(), Budget(), Recorder())
        second = replanner.update(after, after.query(), Budget(), Recorder())
        assert (first.status, second.status) == (PlanStatus.SOLVED, PlanStatus.SOLVED)
        assert second.checks is not None
        return [first.path, second.path]

    for one, same in zip(plans(3), plans(3), strict=True):
        assert np.array_equal(one, same)


def test_a_budget_holds_for_each_plan():
    scene = scene_of(WALL)
    endless = KBGASettings(population_size=20, resolution=20, stagnation=10**6)
    replanner = KBGAPlanner(endless).replanner(np.random.default_rng(1))
    budget = Budget(generations=3)
    plans = [replanner.begin(scene, scene.query(), budget, Recorder())]
    plans += [replanner.update(scene, scene.query(), budget, Recorder()) for _ in range(2)]
    assert [plan.generations for plan in plans] == [3, 3, 3]
