"""Random numbers come in blocks, in the generator's order, and never run out."""

import sys

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from kbga.algorithm import KBGA
from kbga.draws import draw, left_of, make_draws, refill
from kbga.evolution import most_draws_of_a_pair
from kbga.settings import KBGASettings
from tests.kbga.laboratory import random_scene
from tests.suite.geometry.lattice import counts


@given(st.integers(0, 2**32), st.lists(st.integers(0, 10), max_size=20))
def test_numbers_are_those_that_the_generator_gives_one_by_one_whenever_a_block_is_refilled(
    seed, takes
):
    draws, rng = make_draws(np.random.default_rng(seed), 10), np.random.default_rng(seed)
    source = np.random.default_rng(seed)
    source.random(10)
    for take in takes:
        if left_of(draws) < take:
            refill(draws, source)
            assert left_of(draws) == 10
        assert [draw(draws) for _ in range(take)] == [rng.random() for _ in range(take)]


@settings(max_examples=counts(60, 12))
@given(
    st.integers(0, 2**32),
    st.fixed_dictionaries(
        {
            "population_size": st.sampled_from([2, 3, 30]),
            "tournament_size": st.sampled_from([1, 2, 40]),
            "initial_nodes": st.sampled_from([1, 4, 40]),
            "informed_share": st.sampled_from([0.0, 0.5, 1.0]),
            "rounds": st.sampled_from([1, 8, 30]),
            "mutation_probability": st.sampled_from([0.0, 1.0]),
            "repair_limit": st.sampled_from([1.0, float("inf")]),
        }
    ),
)
def test_a_block_always_holds_what_a_pair_of_children_takes(seed, chosen):
    scene = random_scene(np.random.default_rng(seed))
    ga = KBGA(scene, settings=KBGASettings(resolution=8, max_nodes=12, **chosen), rng=seed)
    assert left_of(ga._draws) >= 0  # without the compiler, one too many is an IndexError
    for _ in range(counts(10, 3)):
        ga.step()
        assert left_of(ga._draws) >= 0
        assert len(ga._draws.values) >= most_draws_of_a_pair(ga._rates)


def test_the_generator_is_given_back():
    rng = np.random.default_rng(0)
    ga = KBGA(random_scene(np.random.default_rng(1)), rng=rng)
    ga.step()
    known = sys.getrefcount(rng)
    for _ in range(20):
        ga.step()
    assert sys.getrefcount(rng) == known
