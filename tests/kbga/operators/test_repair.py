"""Repair inserts one node into an infeasible segment, next to an obstacle that it hits."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.kbga.laboratory import (
    Laboratory,
    all_near_nodes,
    check,
    detour,
    laboratory,
    near_nodes,
    random_scene,
    scene_of,
    with_paths,
)
from tests.suite.geometry.lattice import counts

WALL = shapely.box(4, 2, 6, 8)
ENDS = ((0, 5), (10, 5))


@settings(max_examples=counts(60, 8))
@given(st.integers(0, 2**32), st.sampled_from([3, 8, 16]))
def test_one_node_comes_into_an_infeasible_segment_next_to_what_it_hits(seed, resolution):
    lab = laboratory(random_scene(np.random.default_rng(seed)), seed, resolution=resolution)
    for i in range(10):
        before = lab.genes(i)
        known = lab.population.nodes[i].copy()
        cost = lab.cost(i)
        if not lab.repair(i):
            assert (lab.genes(i), lab.cost(i)) == (before, cost)
            continue
        after = lab.genes(i)
        (gene,) = set(after) - set(before)
        k = after.index(gene)  # the segment from column k to k + 1 was cut in two
        assert after[:k] + after[k + 1 :] == before
        assert known["depth"][k] > 0
        hits = known["hits"][k][: known["hit_count"][k]].tolist()
        assert any(gene in near_nodes(lab.problem, g) for g in hits)
    check(lab)


def test_a_feasible_path_needs_no_repair():
    lab = with_paths(laboratory(scene_of(WALL, ends=ENDS)), [(5, 9)])
    assert lab.is_feasible(0)
    assert not lab.repair(0)


def test_the_best_candidate_is_taken():
    lab = with_paths(laboratory(scene_of(WALL, ends=ENDS), repair_candidates=1000), [])
    assert lab.repair(0)
    # The four corners and nothing else bend paths; two of them are equally good on either side.
    assert lab.genes(0)[0] in {2 * 11 + 4, 2 * 11 + 6, 8 * 11 + 4, 8 * 11 + 6}
    assert lab.repair(0)
    assert lab.is_feasible(0)
    assert np.isclose(lab.cost(0), 12.0)


@settings(max_examples=counts(60, 8))
@given(st.integers(0, 2**32), st.sampled_from([0.0, 0.1, 3.0, 100.0]), st.sampled_from([8, 16]))
def test_no_node_next_to_the_obstacle_would_cost_less_than_the_one_taken(seed, penalty, resolution):
    scene = random_scene(np.random.default_rng(seed))
    lab = laboratory(scene, seed, resolution=resolution, penalty=penalty, repair_candidates=10_000)
    for i in range(10):
        before, known = lab.genes(i), lab.population.nodes[i].copy()
        if not lab.repair(i):
            continue
        row = lab.population.nodes[i]
        (gene,) = set(lab.genes(i)) - set(before)
        k = lab.genes(i).index(gene)
        taken = sum(float(n["length"] + n["depth"] * penalty) for n in row[k : k + 2])
        hits = known["hits"][k][: known["hit_count"][k]].tolist()
        cheapest = [
            min(
                (cost_of(lab, known[k], other, known[k + 1]), other)
                for other in near_nodes(lab.problem, group)
                if other not in before
            )
            for group in hits
            if set(near_nodes(lab.problem, group)) - set(before)
        ]
        assert any(abs(taken - cost) <= 1e-9 * (1 + cost) for cost, _ in cheapest)


def cost_of(lab: Laboratory, before: np.void, gene: int, after: np.void) -> float:
    """Of the two segments over a node, evaluated anew."""
    new = detour(lab, before, gene, after)
    return float((new["length"] + new["depth"] * lab.rates.penalty).sum())


def test_no_node_is_inserted_into_a_path_of_the_longest_length():
    for size in (0, 1, 2):
        lab = laboratory(scene_of(WALL, ends=ENDS), max_nodes=size + 2)
        with_paths(lab, [(0, 0), (0, 1)][:size])
        assert not lab.is_feasible(0)
        assert not lab.repair(0)


def test_a_node_of_the_path_is_not_inserted_again():
    lab = laboratory(scene_of(WALL, ends=ENDS), 0, repair_candidates=1000)
    near = all_near_nodes(lab.problem)
    places = [(float(n % 11), float(n // 11)) for n in near]
    with_paths(lab, places)
    assert not lab.is_feasible(0)
    assert not lab.repair(0)


def test_a_repair_may_cost_more_at_first():
    lab = with_paths(laboratory(scene_of(WALL, ends=ENDS), penalty=0.1), [])
    before = lab.cost(0)
    assert lab.repair(0)
    assert lab.cost(0) > before


def test_a_slip_through_a_pinch_point_has_no_obstacle_to_be_repaired_at():
    crossed = scene_of(shapely.box(3, 3, 5, 5), shapely.box(5, 5, 7, 7), ends=((4, 6), (6, 4)))
    lab = with_paths(laboratory(crossed), [])
    assert not lab.is_feasible(0)
    assert not lab.repair(0)


@settings(max_examples=counts(60, 8))
@given(st.integers(0, 2**32), st.sampled_from([0.1, 3.0, 100.0]))
def test_a_repair_that_must_help_never_makes_a_path_dearer(seed, penalty):
    scene = random_scene(np.random.default_rng(seed))
    lab = laboratory(scene, seed, resolution=12, penalty=penalty, repair_must_help=True)
    for i in range(10):
        cost = lab.cost(i)
        if lab.repair(i):
            assert lab.cost(i) < cost
        else:
            assert lab.cost(i) == cost
    check(lab)


@settings(max_examples=counts(40, 6))
@given(st.integers(0, 2**32), st.sampled_from([1, 2, 4]), st.sampled_from([3, 8, 16]))
def test_with_a_reach_it_takes_a_free_node_so_near_to_what_it_hits(seed, reach, resolution):
    scene = random_scene(np.random.default_rng(seed))
    lab = laboratory(scene, seed, resolution=resolution, repair_reach=reach, repair_candidates=0)
    for i in range(10):
        before, known = lab.genes(i), lab.population.nodes[i].copy()
        if lab.repair(i):
            (gene,) = set(lab.genes(i)) - set(before)
            k = lab.genes(i).index(gene)
            hits = known["hits"][k][: known["hit_count"][k]].tolist()
            assert any(gene in near_nodes(lab.problem, g) for g in hits)
    check(lab)
