"""Mutation replaces one node by one that was not in the path, whatever that costs."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.kbga.laboratory import check, laboratory, random_scene, scene_of, with_paths
from tests.suite.geometry.lattice import counts


@settings(max_examples=counts(60, 8))
@given(st.integers(0, 2**32), st.sampled_from([3, 10]))
def test_one_node_is_replaced_by_one_that_was_not_in_the_path(seed, resolution):
    lab = laboratory(random_scene(np.random.default_rng(seed)), seed, resolution=resolution)
    for i in range(10):
        before = lab.genes(i)
        assert lab.mutate(i)
        after = lab.genes(i)
        changed = [k for k in range(len(before)) if before[k] != after[k]]
        assert len(after) == len(before)
        assert len(changed) == 1
        assert after[changed[0]] not in before
    check(lab)


def test_any_node_may_go_and_any_lattice_node_may_come():
    lab = with_paths(laboratory(scene_of(), 0, resolution=2), [(5, 5), (0, 0), (10, 10)])
    gone, come = set(), set()
    for _ in range(300):
        before = set(lab.genes(0))
        lab.mutate(0)
        gone |= before - set(lab.genes(0))
        come |= set(lab.genes(0)) - before
    assert gone == come == set(range(9))


def test_a_path_may_get_dearer_and_even_infeasible():
    seen = []
    for seed in range(20):
        lab = with_paths(laboratory(scene_of(shapely.box(2, 5, 5, 8)), seed), [(5, 5)])
        before = lab.cost(0)
        lab.mutate(0)
        seen.append((lab.cost(0) > before, lab.is_feasible(0)))
    assert (True, True) in seen
    assert (True, False) in seen


def test_a_path_without_intermediate_nodes_can_not_mutate():
    lab = with_paths(laboratory(scene_of(), 0), [])
    assert not lab.mutate(0)


def test_a_path_over_all_lattice_nodes_can_not_mutate():
    everywhere = [(float(x), float(y)) for x in (0, 5, 10) for y in (0, 5, 10)]
    lab = with_paths(laboratory(scene_of(), 0, resolution=2), everywhere)
    assert not lab.mutate(0)
    assert sorted(lab.genes(0)) == list(range(9))
