"""The generations of KBGA (paper II-D, Fig. 5): select, reproduce, replace with elitism."""

from typing import NamedTuple

import numpy as np

from kbga.encoding import GOAL, START, Population, contains, copy_chromosome, forget, length_of, set_node
from kbga.evaluation import evaluate_segment, sum_up
from kbga.operators.crossover import crossover
from kbga.operators.deletion import delete
from kbga.operators.detour import Scratch
from kbga.operators.improvement import improve
from kbga.operators.mutation import mutate
from kbga.operators.repair import repair
from kbga.problem import Problem
from kbga.selection import keep_elite, tournament
from suite.compiled import kernel


class Rates(NamedTuple):
    """The settings that the compiled code reads; see :class:`kbga.settings.KBGASettings`."""

    crossover: float
    mutation: float
    repair: float
    deletion: float
    improvement: float
    tournament_size: int
    penalty: float
    repair_candidates: int
    improvement_radius: int
    rounds: int
    repair_limit: float


@kernel
def first_population(
    population: Population,
    start: np.ndarray,
    goal: np.ndarray,
    initial_nodes: int,
    problem: Problem,
    penalty: float,
    rng: np.random.Generator,
    counter: np.ndarray,
) -> None:
    """Fill a population with random chromosomes and evaluate them.

    Each has 1 to ``initial_nodes`` different nodes, drawn from the whole lattice.
    """
    nodes = population.nodes
    count = problem.lattice.side * problem.lattice.side
    most = min(initial_nodes, nodes.shape[1] - 2, count)
    for i in range(nodes.shape[0]):
        size = 1 + int(rng.random() * most) if most > 0 else 0
        nodes[i, 0].gene, nodes[i, 0].x, nodes[i, 0].y = START, start[0], start[1]
        for k in range(1, size + 1):
            gene = int(rng.random() * count)
            while contains(nodes, i, k - 1, gene):
                gene = (gene + 1) % count
            set_node(nodes, i, k, gene, problem.lattice)
        nodes[i, size + 1].gene = GOAL
        nodes[i, size + 1].x, nodes[i, size + 1].y = goal[0], goal[1]
        population.chromosomes[i].intermediate = size
        forget(nodes, i, 0, size + 1)
        for k in range(size + 1):
            evaluate_segment(nodes, i, k, problem.arrays, problem.memory, counter)
        sum_up(population, i, penalty)


@kernel
def next_children(
    parents: Population,
    children: Population,
    first: int,
    best: float,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    rng: np.random.Generator,
    counter: np.ndarray,
) -> int:
    """Fill ``children`` with the offspring of ``parents``, two at a time, from place ``first`` on.

    It pauses after a feasible child that costs less than ``best``, so that a better path is known
    when it is found; whoever calls it again for the rest gets the same children. The last of them
    make room for the elite. Returns the place to go on from: the number of parents, at the end.
    """
    count = parents.chromosomes.size
    c = first
    while c < count:
        i = tournament(parents.chromosomes, rates.tournament_size, rng)
        j = tournament(parents.chromosomes, rates.tournament_size, rng)
        d = min(c + 1, count - 1)  # an odd population has a last child without a twin
        crossed = rng.random() < rates.crossover and crossover(
            parents, i, j, children, c, d, problem, rates.penalty, rng, counter
        )
        if not crossed:
            copy_chromosome(parents, j, children, d)
            copy_chromosome(parents, i, children, c)
        for child in range(c, d + 1):
            _transform(children, child, best, scratch, problem, rates, rng, counter)
        found = best_feasible(children, c, d + 1)
        c = d + 1
        if found >= 0 and children.chromosomes[found].cost < best:
            break
    if c == count:
        keep_elite(parents, children)
    return c


@kernel
def _transform(
    children: Population,
    i: int,
    best: float,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    rng: np.random.Generator,
    counter: np.ndarray,
) -> None:
    """Apply mutation and the specialised operators to a child, by probability and heuristic.

    best : length of the best feasible path so far, metres; infinite before there is one. A repair
        makes a path longer, so it is lost on one that is too long already.
    """
    if rng.random() < rates.mutation:
        mutate(children, i, problem, rates.penalty, rng, counter)
    for _ in range(rates.rounds):
        changed = False
        if (
            children.chromosomes[i].infeasible > 0
            and length_of(children, i) < rates.repair_limit * best
            and rng.random() < rates.repair
        ):
            changed |= repair(
                children, i, scratch, problem, rates.penalty, rates.repair_candidates, rng, counter
            )
        if rng.random() < rates.deletion:
            changed |= delete(children, i, scratch, problem, rates.penalty, rng, counter)
        if children.chromosomes[i].infeasible == 0 and rng.random() < rates.improvement:
            changed |= improve(
                children, i, scratch, problem, rates.penalty, rates.improvement_radius, rng, counter
            )
        if not changed:
            break


@kernel
def best_feasible(population: Population, first: int, last: int) -> int:
    """Index of the cheapest feasible chromosome from ``first`` to ``last`` (exclusive), or -1."""
    best = -1
    for i in range(first, last):
        if population.chromosomes[i].infeasible == 0 and (
            best < 0 or population.chromosomes[i].cost < population.chromosomes[best].cost
        ):
            best = i
    return best
