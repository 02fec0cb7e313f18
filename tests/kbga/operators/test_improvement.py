"""Improvement moves a node of a feasible path to a better place, and never to a worse one."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from kbga.operators.improvement import _move
from kbga.problem import is_usable
from tests.kbga.laboratory import (
    check,
    detour,
    laboratory,
    neighbours,
    random_scene,
    scene_of,
    with_paths,
)
from tests.suite.geometry.lattice import counts

WALL = shapely.box(4, 2, 6, 8)
ENDS = ((0, 5), (10, 5))


@settings(max_examples=counts(80, 8))
@given(st.integers(0, 2**32), st.sampled_from([1, 3, 8]), st.sampled_from([3, 10, 30]))
def test_only_feasible_paths_are_improved_and_they_never_get_dearer(seed, radius, resolution):
    lab = laboratory(
        random_scene(np.random.default_rng(seed)),
        seed,
        improvement_radius=radius,
        resolution=resolution,
        initial_nodes=3,
    )
    for i in range(10):
        before, cost, feasible = lab.genes(i), lab.cost(i), lab.is_feasible(i)
        if lab.improve(i):
            assert feasible
            assert lab.is_feasible(i)
            assert lab.cost(i) < cost
            assert sum(a != b for a, b in zip(before, lab.genes(i), strict=True)) == 1
        else:
            assert (lab.genes(i), lab.cost(i)) == (before, cost)
    check(lab)


def test_a_node_comes_to_rest_at_the_corner_of_the_obstacle():
    low = shapely.box(4, 2, 6, 6)
    for seed in range(10):
        lab = with_paths(laboratory(scene_of(low, ends=ENDS), seed), [(3, 9), (7, 9)])
        for _ in range(20):
            lab.improve(0)
        assert lab.genes(0) == [6 * 11 + 4, 6 * 11 + 6]
        check(lab)


@settings(max_examples=counts(60, 6))
@given(st.integers(0, 2**32), st.sampled_from([5, 10, 30]))
def test_a_radius_of_0_is_one_step_to_the_best_of_the_eight_neighbours(seed, resolution):
    scene = random_scene(np.random.default_rng(seed))
    lab = laboratory(scene, seed, improvement_radius=0, resolution=resolution, remembers=False)
    for i in range(10):
        before = lab.genes(i)
        known = lab.population.nodes[i].copy()
        if not lab.improve(i):
            assert lab.genes(i) == before
            continue
        (k,) = (k for k, (a, b) in enumerate(zip(before, lab.genes(i), strict=True), 1) if a != b)
        taken = lab.genes(i)[k - 1]
        assert taken in neighbours(lab, before[k - 1])
        lengths = {
            gene: float(detour(lab, known[k - 1], gene, known[k + 1])["length"].sum())
            for gene in neighbours(lab, before[k - 1])
            if gene not in before
            and is_usable(gene, lab.problem.arrays, lab.problem.lattice)
            and (detour(lab, known[k - 1], gene, known[k + 1])["depth"] == 0.0).all()
        }
        assert lengths[taken] == pytest.approx(min(lengths.values()))
        assert lab.population.nodes["settled"][i].sum() == 0, "nothing is remembered"
    check(lab)


def test_an_infeasible_path_is_left_alone():
    lab = with_paths(laboratory(scene_of(WALL, ends=ENDS)), [(5, 5)])
    checks = int(lab.counter[0])
    assert not lab.improve(0)
    assert lab.counter[0] == checks


def test_a_settled_node_is_not_tried_again_until_a_neighbour_changes():
    lab = with_paths(laboratory(scene_of(WALL, ends=ENDS)), [(4, 8), (6, 8)])
    while not lab.population.nodes["settled"][0, 1:3].all():
        lab.improve(0)
    checks = int(lab.counter[0])
    assert not lab.improve(0)
    assert lab.counter[0] == checks
    assert lab.mutate(0)
    assert not lab.population.nodes["settled"][0, 1:3].any()


def test_a_node_whose_better_places_are_taken_is_not_called_settled():
    # They may be free later, without anything changing beside the node.
    taken = [(6, 0), (5, 0), (4, 0)]
    lab = laboratory(scene_of(ends=((0, 0), (0, 0))))
    with_paths(lab, [(5, 1), (10, 0), *taken], [(5, 1), (10, 0)])
    lab.population.nodes["settled"][0, 2:6] = 1
    assert not lab.improve(0)
    assert lab.population.nodes["settled"][0, 1] == 0
    lab.population.nodes["settled"][1, 2] = 1
    assert lab.improve(1)
    assert lab.population.nodes["settled"][1, 1] == 1


def test_on_open_ground_a_node_gets_within_reach_of_the_straight_line():
    lab = with_paths(laboratory(scene_of(ends=((0, 0), (10, 0))), improvement_radius=8), [(5, 9)])
    assert lab.improve(0)
    assert lab.cost(0) == pytest.approx(10.0)


def test_nodes_stay_on_the_lattice_at_the_border():
    lab = with_paths(laboratory(scene_of(ends=((0, 0), (10, 10)))), [(0, 10)], [(10, 0)])
    for i in (0, 1):
        lab.improve(i)
    check(lab)


@settings(max_examples=counts(60, 8))
@given(st.integers(0, 2**32), st.sampled_from([4, 8, 16]))
def test_of_all_free_neighbours_the_one_that_makes_the_path_shortest_is_taken(seed, resolution):
    lab = laboratory(
        random_scene(np.random.default_rng(seed)),
        seed,
        resolution=resolution,
        population_size=20,
        initial_nodes=2,
    )
    nodes, problem = lab.population.nodes, lab.problem
    for i in range(20):
        size = len(lab.genes(i))
        if not lab.is_feasible(i):
            continue
        for k in range(1, size + 1):
            before, node, after = nodes[i, k - 1].copy(), nodes[i, k].copy(), nodes[i, k + 1].copy()
            lengths = {int(node["gene"]): float(before["length"] + node["length"])}
            for gene in neighbours(lab, int(node["gene"])):
                new = detour(lab, before, gene, after)
                usable = is_usable(gene, problem.arrays, problem.lattice)
                if usable and gene not in lab.genes(i) and (new["depth"] == 0.0).all():
                    lengths[gene] = float(new["length"].sum())
            moved = _move(nodes, i, size, k, 1, lab.scratch, problem, lab.counter)
            assert lengths[int(nodes[i, k]["gene"])] <= min(lengths.values()) + 2e-9
            assert moved == (nodes[i, k]["gene"] != node["gene"])
