"""A child is the head of one parent and the tail of the other, without loops."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.kbga.laboratory import (
    Laboratory,
    check,
    check_chromosome,
    genes_of,
    laboratory,
    random_scene,
    scene_of,
    with_paths,
)
from tests.suite.geometry.lattice import counts

SEEDS = st.integers(0, 2**32)


def lab_of(seed: int, **others: float) -> Laboratory:
    return laboratory(random_scene(np.random.default_rng(seed)), seed, **others)


def children(lab: Laboratory) -> tuple[list[int], list[int]]:
    return genes_of(lab.children, 0), genes_of(lab.children, 1)


def possible(first: list[int], second: list[int]) -> list[tuple[list[int], list[int]]]:
    """All pairs of children that the paper's words allow."""

    def joined(head: list[int], tail: list[int]) -> list[int]:
        for k, gene in enumerate(head):
            if gene in tail:
                return head[:k] + tail[tail.index(gene) :]
        return head + tail

    return [
        (joined(first[:c], second[o:]), joined(second[:o], first[c:]))
        for c in range(1, len(first) + 1)
        for o in range(1, len(second) + 1)
    ]


@settings(max_examples=counts(60, 8))
@given(SEEDS, st.sampled_from([2, 3, 10]))
def test_children_are_heads_and_tails_of_their_parents_without_loops(seed, resolution):
    lab = lab_of(seed, resolution=resolution)
    for i in range(0, 10, 2):
        first, second = lab.genes(i), lab.genes(i + 1)
        assert lab.cross(i, i + 1, 0, 1)
        assert children(lab) in possible(first, second)
        assert (lab.genes(i), lab.genes(i + 1)) == (first, second)
        for child in (0, 1):
            check_chromosome(lab, lab.children, child)


def test_the_part_between_two_equal_nodes_is_deleted():
    a, b, c, d = (2.0, 2.0), (3.0, 3.0), (4.0, 4.0), (5.0, 5.0)
    cut = 0
    for seed in range(40):
        lab = with_paths(laboratory(scene_of(), seed), [a, b, c], [d, b, a])
        first, second = lab.genes(0), lab.genes(1)
        assert lab.cross(0, 1, 0, 1)
        for child in children(lab):
            assert len(set(child)) == len(child)
            cut += len(child) == 1
        assert sum(map(len, children(lab))) <= len(first) + len(second)
    assert cut > 0


def test_the_children_of_two_parents_with_one_node_in_common_worked_out_by_hand():
    a, b, c, d, e = ((float(k), float(k)) for k in (2, 3, 4, 5, 6))
    # a | b-e, a | e, a |; a-b | b-e, a-b | e, a-b |; a-b-c | b-e, a-b-c | e, a-b-c |:
    # from b to b goes, so that the first, fourth, fifth and seventh are one.
    expected = {"abe", "ae", "a", "ab", "abce", "abc"}
    lab = with_paths(laboratory(scene_of()), [a, b, c], [d, b, e])
    letters = dict(zip(lab.genes(0) + lab.genes(1), "abcdbe", strict=True))
    found = set()
    for _ in range(100):
        assert lab.cross(0, 1, 0, 1)
        found.add("".join(letters[gene] for gene in children(lab)[0]))
    assert found == expected


def test_a_parent_crossed_with_itself_gives_parts_of_itself():
    lab = laboratory(scene_of(), 3)
    for i in range(10):
        genes = lab.genes(i)
        assert lab.cross(i, i, 0, 1)
        for child in children(lab):
            assert child in [genes[:k] + genes[m:] for k in range(10) for m in range(k, 10)]


def test_lengths_vary():
    lab = with_paths(laboratory(scene_of(), 0), [(2, 2), (3, 3), (4, 4)], [(5, 5), (6, 6), (7, 7)])
    lengths = set()
    for _ in range(60):
        assert lab.cross(0, 1, 0, 1)
        lengths |= set(map(len, children(lab)))
    assert lengths == {1, 2, 3, 4, 5}


def test_every_pair_of_nodes_is_chosen_alike():
    lab = with_paths(laboratory(scene_of(), 0), [(2, 2), (3, 3)], [(5, 5), (6, 6)])
    pairs = possible(lab.genes(0), lab.genes(1))
    seen = np.zeros(len(pairs))
    rounds = counts(2000, 400)
    for _ in range(rounds):
        lab.cross(0, 1, 0, 1)
        seen[pairs.index(children(lab))] += 1
    assert (np.abs(seen / rounds - 0.25) < 0.07).all()


def test_it_is_not_done_where_a_child_would_exceed_the_longest_chromosome():
    done = 0
    for _ in range(30):
        lab = with_paths(laboratory(scene_of(), _, max_nodes=4), [(2, 2), (3, 3)], [(5, 5), (6, 6)])
        lab.children.chromosomes["intermediate"] = -7
        if lab.cross(0, 1, 0, 1):
            assert [len(c) for c in children(lab)] == [2, 2]
            done += 1
        else:  # and then nothing is written
            assert (lab.children.chromosomes["intermediate"] == -7).all()
    assert 0 < done < 30


def test_it_is_not_done_with_a_parent_without_intermediate_nodes():
    lab = with_paths(laboratory(scene_of(), 0), [], [(2, 2)])
    assert not lab.cross(0, 1, 0, 1)
    assert not lab.cross(1, 0, 0, 1)
    assert not lab.cross(0, 0, 0, 1)


def test_at_most_one_new_segment_is_evaluated_per_child():
    lab = lab_of(5)
    before = int(lab.counter[0])
    assert lab.cross(0, 1, 0, 1)
    assert int(lab.counter[0]) - before <= 2


def test_the_only_child_of_an_odd_population_is_a_child_like_any():
    lab = laboratory(scene_of(), 0, population_size=3)
    assert lab.cross(0, 1, 2, 2)
    check_chromosome(lab, lab.children, 2)
    check(lab)
