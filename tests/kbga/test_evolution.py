"""Whatever happens to a population, what it records of itself stays true."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from kbga.encoding import GOAL, START, Population
from kbga.evolution import _transform, best_feasible
from tests.kbga.laboratory import (
    Laboratory,
    check,
    laboratory,
    near_nodes,
    random_scene,
    scene_of,
    with_paths,
)
from tests.suite.geometry.lattice import counts

SEEDS = st.integers(0, 2**32)


def apply(lab: Laboratory, name: str) -> None:
    i, j = (int(k) for k in lab.rng.integers(0, lab.settings.population_size, 2))
    if name == "cross":
        if lab.cross(i, j, 0, 1):
            lab.population.nodes[i] = lab.children.nodes[0]
            lab.population.chromosomes[i] = lab.children.chromosomes[0]
    elif name == "next_generation":
        lab.next_generation()
    else:
        getattr(lab, name)(i)


@settings(max_examples=counts(250, 12))
@given(
    SEEDS,
    st.fixed_dictionaries(
        {
            "population_size": st.sampled_from([2, 3, 8]),
            "max_nodes": st.sampled_from([2, 3, 4, 6, 12]),
            "initial_nodes": st.sampled_from([1, 3, 30]),
            "resolution": st.sampled_from([2, 3, 7, 10]),
            "penalty": st.sampled_from([0.0, 0.5, 20.0]),
        }
    ),
)
def test_records_stay_true_after_any_sequence_of_operators(seed, chosen):
    rng = np.random.default_rng(seed)
    lab = laboratory(random_scene(rng), seed, **chosen)
    check(lab)
    names = ["mutate", "repair", "delete", "improve", "cross", "next_generation"]
    for step in range(counts(60, 30)):
        apply(lab, str(rng.choice(names, p=[0.1, 0.2, 0.2, 0.25, 0.2, 0.05])))
        if step % 4 == 0:
            check(lab)
    check(lab)


def surroundings(population: Population, i: int) -> list[tuple]:
    """Of each intermediate node: the one before, itself, the one after; settled and needed."""
    rows = population.nodes[i, : population.chromosomes["intermediate"][i] + 2]
    genes = rows["gene"].tolist()
    flags = zip(rows["settled"].tolist(), rows["needed"].tolist(), strict=True)
    return list(zip(genes, genes[1:], genes[2:], list(flags)[1:-1], strict=False))


@pytest.mark.parametrize("name", ["mutate", "repair", "delete", "improve", "cross"])
def test_what_is_known_of_a_node_is_forgotten_when_a_neighbour_changes(name):
    done = 0
    for seed in range(counts(60, 30)):
        # A small lattice, so that parents have nodes in common.
        lab = laboratory(random_scene(np.random.default_rng(seed)), seed, resolution=4)
        for field, unless in (("settled", "improve"), ("needed", "delete")):
            lab.population.nodes[field] = 0 if name == unless else 1
        for i in range(9):
            before = surroundings(lab.population, i) + surroundings(lab.population, i + 1)
            triples = [b[:3] for b in before]
            if name == "cross":
                done += lab.cross(i, i + 1, 0, 1)
                after = surroundings(lab.children, 0) + surroundings(lab.children, 1)
            else:
                done += getattr(lab, name)(i)
                after = surroundings(lab.population, i)
            for *triple, flags in after:
                is_new = tuple(triple) not in triples
                known = flags[1] if name == "improve" else flags[0]
                assert not (is_new and known)
    assert done > 0


@settings(max_examples=counts(40, 4))
@given(SEEDS, st.sampled_from([2, 3, 5, 20]), st.sampled_from([2, 4, 8]))
def test_the_lowest_cost_never_rises(seed, population_size, tournament_size):
    lab = laboratory(
        random_scene(np.random.default_rng(seed)),
        seed,
        population_size=population_size,
        tournament_size=tournament_size,
        mutation_probability=1.0,
    )
    lowest = np.inf
    for _ in range(12):
        now = lab.population.chromosomes["cost"].min()
        assert now <= lowest
        lowest = now
        lab.next_generation()
    check(lab)


def test_the_first_population_is_random_within_its_bounds():
    lab = laboratory(scene_of(), 1, population_size=counts(400, 100), initial_nodes=5)
    lengths = lab.population.chromosomes["intermediate"]
    assert set(lengths.tolist()) == {1, 2, 3, 4, 5}
    genes = [g for i in range(len(lengths)) for g in lab.genes(i)]
    assert len(set(genes)) > 0.9 * 121
    assert {min(genes), max(genes)} <= {*range(11), *range(110, 121)}
    chains = [[START, *lab.genes(i), GOAL] for i in range(len(lengths))]
    segments = {pair for chain in chains for pair in pairwise(chain)}
    # A segment that two paths share is checked once, unless another took its place in memory.
    assert len(segments) <= lab.counter[0] <= (lengths + 1).sum()


@pytest.mark.parametrize(("max_nodes", "most"), [(2, 0), (3, 1), (4, 2), (100, 9)])
def test_first_chromosomes_fit_into_the_longest_and_into_the_lattice(max_nodes, most):
    lab = laboratory(scene_of(), 0, max_nodes=max_nodes, initial_nodes=50, resolution=2)
    assert lab.population.chromosomes["intermediate"].max() <= most
    for _ in range(5):
        lab.next_generation()
    check(lab)


def test_without_any_operator_the_children_are_copies_of_parents():
    off = ("crossover", "mutation", "repair", "deletion", "improvement")
    lab = laboratory(scene_of(shapely.box(3, 3, 6, 6)), **{f"{o}_probability": 0.0 for o in off})
    before = [tuple(lab.genes(i)) for i in range(10)]
    checks = int(lab.counter[0])
    lab.next_generation()
    assert {tuple(lab.genes(i)) for i in range(10)} <= set(before)
    assert lab.counter[0] == checks, "what is known of a copy is not evaluated again"


def test_parents_stay_as_they_are():
    lab = laboratory(scene_of(shapely.box(3, 3, 6, 6)))
    parents = lab.population
    before = parents.nodes.tobytes(), parents.chromosomes.tobytes()
    lab.next_generation()
    assert lab.children is parents
    assert (parents.nodes.tobytes(), parents.chromosomes.tobytes()) == before


def test_the_best_feasible_chromosome_need_not_be_the_cheapest():
    wall = scene_of(shapely.box(4, 2, 6, 8), ends=((0, 5), (10, 5)))
    lab = with_paths(laboratory(wall, penalty=0.1, population_size=3), [(5, 9)], [], [(5, 10)])
    assert lab.cost(1) < lab.cost(0) < lab.cost(2)
    assert best_feasible(lab.population, 0, 3) == 0


def test_without_a_feasible_chromosome_there_is_no_best_one():
    wall = scene_of(shapely.box(4, 0, 6, 10), ends=((0, 5), (10, 5)))
    assert best_feasible(laboratory(wall).population, 0, 10) == -1


# Better paths within a generation


@settings(max_examples=counts(60, 6))
@given(SEEDS, st.sampled_from([2, 3, 8, 9]))
def test_children_that_are_made_in_parts_are_those_that_are_made_in_one_go(seed, population_size):
    scene = random_scene(np.random.default_rng(seed))
    parts, whole = (
        laboratory(scene, seed, population_size=population_size, repair_limit=np.inf)
        for _ in range(2)
    )
    made = 0
    while made < population_size:
        # So high a best never pauses it but for a feasible child: then after each.
        before, made = made, parts.make_children(made, 1e300)
        assert made > before
        last = parts.best_feasible_cost(parts.children, before, made) < np.inf
        earlier = parts.best_feasible_cost(parts.children, before, max(before, made - 2)) < np.inf
        assert not earlier, "it pauses at once"
        assert last or made == population_size, "it pauses for nothing else"
    assert whole.make_children(0, 1e-300) == population_size, "nothing costs less: no pause"
    for one, other in zip(parts.children, whole.children, strict=True):
        assert one.tobytes() == other.tobytes()
    assert parts.counter[0] == whole.counter[0]


def test_a_path_that_is_longer_than_the_best_is_not_repaired_unless_that_is_wanted():
    wall = scene_of(shapely.box(4, 2, 6, 8), ends=((0, 5), (10, 5)))
    only_repair = {
        f"{operator}_probability": float(operator == "repair")
        for operator in ("crossover", "mutation", "repair", "deletion", "improvement")
    }
    repaired = {}
    for limit in (0.5, 1.0, 1.5, np.inf):
        for best in (9.0, 10.5, np.inf):
            lab = laboratory(wall, repair_limit=limit, **only_repair)
            with_paths(lab, [])  # straight on: 10 m, through the wall
            before = lab.genes(0)
            args = lab.scratch, lab.problem, lab.rates, lab.fresh_draws(), lab.counter, lab.tally
            _transform(lab.population, 0, best, *args)
            repaired[limit, best] = lab.genes(0) != before
    assert repaired == {
        (limit, best): limit * best > 10.0
        for limit in (0.5, 1.0, 1.5, np.inf)
        for best in (9.0, 10.5, np.inf)
    }


# A first population that knows of the obstacles


@settings(max_examples=counts(40, 5))
@given(SEEDS, st.sampled_from([0.0, 0.3, 1.0]), st.sampled_from([2, 3, 12]))
def test_the_records_of_an_informed_population_are_true(seed, share, max_nodes):
    scene = random_scene(np.random.default_rng(seed))
    lab = laboratory(scene, seed, informed_share=share, max_nodes=max_nodes)
    check(lab)
    lab.next_generation()
    check(lab)


HALVES = (range(20), range(20, 40))


def test_informed_chromosomes_have_nodes_next_to_obstacles_and_the_others_any():
    scene = scene_of(shapely.box(4, 2, 6, 8))
    near = set(near_nodes(laboratory(scene).problem, 0))
    lab = laboratory(scene, population_size=40, informed_share=0.5)
    informed, others = ([g in near for i in half for g in lab.genes(i)] for half in HALVES)
    assert np.mean(informed) == 1.0 > 0.2 > np.mean(others)
    feasible = [sum(lab.is_feasible(i) for i in half) for half in HALVES]
    assert feasible[0] > feasible[1], "they are repaired at once"


def test_without_obstacles_informed_chromosomes_are_random_ones():
    lab = laboratory(scene_of(), informed_share=1.0)
    check(lab)
    assert len({tuple(lab.genes(i)) for i in range(10)}) > 5
