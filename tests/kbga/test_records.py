"""What evaluation found is kept and used, never found again; and no path outgrows N_max."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from kbga import KBGA, KBGAPlusSettings, KBGASettings, evaluation, make_scene
from kbga.encoding import Population
from kbga.evaluation import sum_up
from kbga.memory import NOBODY
from suite.scenes.catalogue import load_scene, scene_names
from tests.kbga.laboratory import Laboratory, laboratory, random_scene
from tests.suite.geometry.lattice import COMPILED, counts

SEEDS = st.integers(0, 2**32)


# The records of a chromosome

MARK = 1e-13
"""Metres: far below what moves an operator, and far above the rounding of a length."""


def segments(population: Population, i: int) -> dict[tuple[int, int], float]:
    """Length on record of each segment of a chromosome, by the genes at its ends."""
    row = population.nodes[i, : population.chromosomes["intermediate"][i] + 2]
    return dict(zip(pairwise(row["gene"].tolist()), row["length"].tolist(), strict=False))


def mark(lab: Laboratory) -> None:
    """Give each segment on record a length of its own, which no evaluation would find."""
    count, columns = lab.population.nodes.shape
    marks = MARK * (1 + np.arange(count * columns).reshape(count, columns))
    lab.population.nodes["length"] += marks
    for i in range(count):
        sum_up(lab.population, i, lab.rates.penalty)


@settings(max_examples=counts(40, 5))
@given(SEEDS, st.sampled_from(["mutate", "repair", "delete", "improve"]))
def test_an_operator_leaves_the_records_of_segments_that_stay_as_they_are(seed, name):
    lab = laboratory(random_scene(np.random.default_rng(seed)), seed, resolution=8)
    mark(lab)
    for i in range(10):
        before = segments(lab.population, i)
        getattr(lab, name)(i)
        after = segments(lab.population, i)
        stayed = before.keys() & after.keys()
        assert len(after.keys() - stayed) <= 2, "more segments are new than touch one node"
        assert {s: after[s] for s in stayed} == {s: before[s] for s in stayed}


@settings(max_examples=counts(40, 5))
@given(SEEDS)
def test_a_child_has_the_records_of_its_parents_and_one_new_segment_at_most(seed):
    lab = laboratory(random_scene(np.random.default_rng(seed)), seed)
    mark(lab)
    for i in range(9):
        known = {
            *segments(lab.population, i).items(),
            *segments(lab.population, i + 1).items(),
        }
        if lab.cross(i, i + 1, 0, 1):
            for child in (0, 1):
                assert len(segments(lab.children, child).items() - known) <= 1


# Checks


@pytest.mark.parametrize("scene_name", scene_names())
def test_no_check_is_made_twice_in_a_run(scene_name):
    scene = load_scene(scene_name)
    for seed in range(counts(5, 1)):
        # What pulling taut asks is no segment between two nodes.
        chosen = KBGAPlusSettings(max_generations=counts(500, 2), taut=0.0)
        ga = KBGA(scene, settings=chosen, rng=seed)
        ga.run()
        # Each check is remembered: were one made twice, there would be more of them than segments.
        assert ga.computed_checks == (ga._problem.memory.segments["key"] != NOBODY).sum()


class Listener:
    """Hears of each check: from where to where, and from which row of the obstacles' tree on."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.rows: dict[tuple[float, ...], list[int]] = {}
        ask = evaluation.next_entry

        def listen(ax, ay, bx, by, tree, vertices, row):
            self.rows.setdefault((ax, ay, bx, by), []).append(row)
            return ask(ax, ay, bx, by, tree, vertices, row)

        monkeypatch.setattr(evaluation, "next_entry", listen)


@pytest.mark.skipif(COMPILED, reason="compiled kernels can't be listened to")
@pytest.mark.parametrize("seed", range(3))
def test_the_counter_counts_every_check_and_what_is_interrupted_goes_on(monkeypatch, seed):
    listener = Listener(monkeypatch)
    walls = [shapely.box(3, 0, 4, 8), shapely.box(6, 2, 7, 10)]
    # Start and goal off the lattice, so that a place is a gene.
    scene = make_scene("walls", shapely.box(0, 0, 10, 10), walls, ((1.01, 1.03), (9.07, 9.01)))
    ga = KBGA(scene, None, KBGASettings(population_size=12, resolution=20, max_generations=8), seed)
    ga.run()
    assert ga.computed_checks == len(listener.rows)
    for rows in listener.rows.values():
        assert rows[0] == 0
        # Another look begins where the last one ended, at the part that it met, or after its group.
        assert all(before < after for before, after in pairwise(rows))


# N_max


@settings(max_examples=counts(60, 6))
@given(
    SEEDS,
    st.sampled_from([2, 3, 4, 5, 9]),
    st.sampled_from([2, 3, 11]),
    st.sampled_from([1, 40]),
    st.sampled_from([0.0, 0.2, 1.0]),
)
def test_no_chromosome_is_longer_than_n_max_in_any_generation(
    seed, max_nodes, population_size, initial_nodes, mutation_probability
):
    ga = KBGA(
        random_scene(np.random.default_rng(seed)),
        settings=KBGASettings(
            population_size=population_size,
            resolution=8,
            max_nodes=max_nodes,
            initial_nodes=initial_nodes,
            mutation_probability=mutation_probability,
        ),
        rng=seed,
    )
    for _ in range(counts(20, 6)):
        lengths = [len(path) for path in ga.paths()]
        assert 2 <= min(lengths) <= max(lengths) <= max_nodes
        ga.step()
