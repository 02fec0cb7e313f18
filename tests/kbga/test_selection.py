"""Bigger tournaments are harder to win, and the elite is never lost."""

import numpy as np
import pytest

from kbga.draws import make_draws
from kbga.encoding import CHROMOSOME, Population, empty_population
from kbga.selection import keep_elite, tournament
from tests.suite.geometry.lattice import counts

DRAWS = counts(4000, 1500)


def with_costs(costs: list[float]) -> Population:
    population = empty_population(len(costs), 3)
    population.chromosomes["cost"] = costs
    population.nodes["gene"] = np.arange(len(costs))[:, None]
    return population


def winners(size: int, count: int = 10) -> np.ndarray:
    chromosomes = np.zeros(count, CHROMOSOME).view(np.recarray)
    chromosomes["cost"] = np.arange(count)
    draws = make_draws(np.random.default_rng(1), size * DRAWS)
    return np.array([tournament(chromosomes, size, draws) for _ in range(DRAWS)])


def test_a_tournament_of_one_draws_anybody_alike():
    shares = np.bincount(winners(1), minlength=10) / DRAWS
    assert shares == pytest.approx(np.full(10, 0.1), abs=0.03)


@pytest.mark.parametrize("size", [2, 3, 5])
def test_the_cheapest_wins_as_often_as_it_is_drawn(size):
    share = (winners(size) == 0).mean()
    assert share == pytest.approx(1 - 0.9**size, abs=0.04)


def test_bigger_tournaments_pick_cheaper_parents():
    means = [winners(size).mean() for size in (1, 2, 4, 8)]
    assert means == sorted(means, reverse=True)
    assert means[0] - means[-1] > 3


def test_the_best_parent_replaces_the_worst_child_and_no_other():
    parents, children = with_costs([3.0, 1.0, 2.0]), with_costs([5.0, 9.0, 4.0])
    keep_elite(parents, children)
    assert children.chromosomes["cost"].tolist() == [5.0, 1.0, 4.0]
    assert parents.chromosomes["cost"].tolist() == [3.0, 1.0, 2.0]


def test_the_elite_comes_with_its_nodes():
    parents, children = with_costs([3.0, 1.0]), with_costs([5.0, 9.0])
    parents.nodes["x"][1] = 7.5
    keep_elite(parents, children)
    assert children.nodes["x"][1, :2].tolist() == [7.5, 7.5]
