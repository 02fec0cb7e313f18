"""Deletion leaves out a node only where that is beneficial, in feasible and infeasible paths."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from kbga.encoding import NEEDED, NEEDED_IF_FEASIBLE
from tests.kbga.laboratory import check, laboratory, random_scene, scene_of, with_paths
from tests.suite.geometry.lattice import counts

WALL = shapely.box(4, 2, 6, 8)
ENDS = ((0, 5), (10, 5))


@settings(max_examples=counts(80, 8))
@given(st.integers(0, 2**32), st.sampled_from([0.0, 0.3, 20.0]))
def test_a_path_never_gets_dearer_and_a_feasible_one_stays_feasible(seed, penalty):
    rng = np.random.default_rng(seed)
    lab = laboratory(random_scene(rng), seed, penalty=penalty, initial_nodes=4)
    for _ in range(4):
        for i in range(10):
            before, cost, feasible = lab.genes(i), lab.cost(i), lab.is_feasible(i)
            done = lab.delete(i)
            after = lab.genes(i)
            assert len(before) - len(after) == int(done)
            assert after in (
                [before[:k] + before[k + 1 :] for k in range(len(before))] if done else [before]
            )
            assert lab.cost(i) <= cost + 1e-9
            assert lab.is_feasible(i) or not feasible
    check(lab)


def test_a_detour_of_a_feasible_path_is_cut():
    lab = with_paths(laboratory(scene_of()), [(2, 8)])
    assert lab.delete(0)
    assert lab.genes(0) == []
    assert lab.cost(0) == pytest.approx(8 * np.sqrt(2))


def test_a_node_that_makes_a_path_infeasible_is_deleted():
    lab = with_paths(laboratory(scene_of(WALL, ends=((0, 1), (10, 1)))), [(5, 4)])
    assert not lab.is_feasible(0)
    assert lab.delete(0)
    assert lab.is_feasible(0)


def test_a_node_that_leads_around_an_obstacle_stays_and_is_known_to_be_needed():
    lab = with_paths(laboratory(scene_of(WALL, ends=ENDS), penalty=0.1), [(5, 9)])
    assert lab.is_feasible(0)
    assert not lab.delete(0)
    assert lab.population.nodes["needed"][0, 1] == NEEDED_IF_FEASIBLE
    checks = int(lab.counter[0])
    assert not lab.delete(0)
    assert lab.counter[0] == checks, "what is known is not asked again"


def test_what_a_feasible_path_needs_an_infeasible_one_may_cut():
    # At this penalty the way through the wall costs less than the way around it.
    lab = with_paths(laboratory(scene_of(WALL, ends=ENDS), penalty=0.1), [(5, 9)])
    lab.population.nodes["needed"][0, 1] = NEEDED_IF_FEASIBLE
    lab.population.chromosomes["infeasible"][0] = 1  # as after a mutation elsewhere
    assert lab.delete(0)
    assert lab.genes(0) == []


def test_what_no_path_can_spare_is_known_in_all_of_them():
    lab = with_paths(laboratory(scene_of(WALL, ends=ENDS), penalty=20.0), [(5, 9)])
    lab.population.chromosomes["infeasible"][0] = 1  # as if there were an obstacle elsewhere
    assert not lab.delete(0)
    assert lab.population.nodes["needed"][0, 1] == NEEDED
    lab.population.chromosomes["infeasible"][0] = 0
    checks = int(lab.counter[0])
    assert not lab.delete(0)
    assert lab.counter[0] == checks


def test_without_a_penalty_a_node_in_the_way_still_goes_when_that_frees_the_path():
    # (5, 5) is a pinch point, closed to lattice nodes; past it the straight line is free.
    boxes = (shapely.box(3, 3, 5, 5), shapely.box(5, 5, 7, 7), shapely.box(5, 3, 7, 5))
    lab = with_paths(laboratory(scene_of(*boxes, ends=((1, 5), (3, 7))), penalty=0.0), [(2, 6)])
    assert lab.delete(0)
    assert lab.is_feasible(0)


def test_a_path_without_intermediate_nodes_has_none_to_delete():
    lab = with_paths(laboratory(scene_of()), [])
    assert not lab.delete(0)
