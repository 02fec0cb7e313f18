"""The generations of KBGA (paper II-D, Fig. 5): select, reproduce, replace with elitism."""

import numpy as np

from kbga.counter import is_spent
from kbga.draws import Draws, draw, left_of
from kbga.encoding import (
    GOAL,
    START,
    Population,
    contains,
    copy_chromosome,
    forget,
    length_of,
    set_node,
)
from kbga.evaluation import evaluate_segment, sum_up
from kbga.operators.crossover import crossover
from kbga.operators.deletion import delete
from kbga.operators.detour import Scratch
from kbga.operators.improvement import improve
from kbga.operators.mutation import mutate
from kbga.operators.repair import repair
from kbga.problem import Problem, near_count, near_node, node_at, node_count
from kbga.selection import tournament
from kbga.tuning import CROSSOVER, DELETION, IMPROVEMENT, MUTATION, REPAIR, Rates, note
from suite.jit import kernel


@kernel
def first_population(
    population: Population,
    start: np.ndarray,
    goal: np.ndarray,
    initial_nodes: int,
    informed: int,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    draws: Draws,
    counter: np.ndarray,
) -> None:
    """Fill a population with random chromosomes and evaluate them.

    Each has 1 to ``initial_nodes`` different nodes, drawn from the whole lattice. The first
    ``informed`` of them know of the obstacles (future work in paper V): their nodes are drawn from
    those next to obstacles, where shortest paths bend, and they are repaired at once.
    """
    nodes = population.nodes
    count = node_count(problem)
    most = min(initial_nodes, nodes.shape[1] - 2, count)
    for i in range(nodes.shape[0]):
        size = 1 + int(draw(draws) * most) if most > 0 else 0
        nodes[i, 0].gene, nodes[i, 0].x, nodes[i, 0].y = START, start[0], start[1]
        for k in range(1, size + 1):
            gene = _new_gene(nodes, i, k - 1, i < informed, problem, draws)
            set_node(nodes, i, k, gene, problem.lattice)
        nodes[i, size + 1].gene = GOAL
        nodes[i, size + 1].x, nodes[i, size + 1].y = goal[0], goal[1]
        population.chromosomes[i].intermediate = size
        forget(nodes, i, 0, size + 1)
        for k in range(size + 1):
            evaluate_segment(nodes, i, k, problem.arrays, problem.memory, counter)
        sum_up(population, i, rates.penalty)
        for _ in range(rates.rounds if i < informed else 0):
            repair(population, i, scratch, problem, rates, draws, counter)


@kernel
def _new_gene(
    nodes: np.ndarray,
    i: int,
    size: int,
    is_informed: bool,
    problem: Problem,
    draws: Draws,
) -> int:
    """A lattice number that is none of the first ``size`` nodes of chromosome i.

    Of a node next to a random obstacle, if that is wanted and there is one left.
    """
    if is_informed:
        groups = problem.near_count.size
        drawn = int(draw(draws) * groups)
        where = draw(draws)
        for g in range(groups):  # the next one where the frame is drawn and has no corner
            group = (drawn + g) % groups
            around = near_count(group, problem)
            offset = int(where * around)
            for n in range(around):
                gene = near_node(group, (offset + n) % around, problem)
                if not contains(nodes, i, size, gene):
                    return gene
    count = node_count(problem)
    number = int(draw(draws) * count)
    while contains(nodes, i, size, node_at(number, problem)):
        number = (number + 1) % count
    return node_at(number, problem)


@kernel
def next_children(
    parents: Population,
    children: Population,
    first: int,
    last: int,
    best: float,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    draws: Draws,
    counter: np.ndarray,
    tally: np.ndarray,
) -> int:
    """Fill places ``first`` to ``last`` of ``children`` with offspring, two at a time.

    It pauses after a feasible child that costs less than ``best``, so that a better path is known
    when it is found, to the caller and to the repairs that follow; and where too few random numbers
    are left, or no question may be asked any more. Called again with the new best, it goes on.
    Returns the place to go on from. Only at the end of the generation may ``last`` be odd.
    """
    count = parents.chromosomes.size
    c = first
    while c < last and left_of(draws) >= most_draws_of_a_pair(rates) and not is_spent(counter):
        i = tournament(parents.chromosomes, rates.tournament_size, draws)
        j = tournament(parents.chromosomes, rates.tournament_size, draws)
        d = min(c + 1, count - 1)  # an odd population has a last child without a twin
        crossed = draw(draws) < rates.crossover and crossover(
            parents, i, j, children, c, d, problem, rates.penalty, draws, counter
        )
        if crossed:
            known = min(parents.chromosomes[i].cost, parents.chromosomes[j].cost)
            new = min(children.chromosomes[c].cost, children.chromosomes[d].cost)
            note(tally, CROSSOVER, known, new)
        else:
            copy_chromosome(parents, j, children, d)
            copy_chromosome(parents, i, children, c)
        for child in range(c, d + 1):
            _transform(children, child, best, scratch, problem, rates, draws, counter, tally)
        found = best_feasible(children, c, d + 1)
        c = d + 1
        if found >= 0 and children.chromosomes[found].cost < best:
            break
    return c


@kernel
def most_draws_of_a_pair(rates: Rates) -> int:
    """Random numbers that two children take at most."""
    parents = 2 * rates.tournament_size + 3  # whether they are crossed, and where
    child = 3 + rates.rounds * 9  # mutation: whether, where, what; a round: 1; repair: 4; others: 2
    return parents + 2 * child


def most_draws_of_first_population(
    population_size: int, initial_nodes: int, informed: int, rates: Rates
) -> int:
    """Random numbers that the first population takes at most."""
    each = 1 + initial_nodes
    return population_size * each + informed * (2 * initial_nodes + 3 * rates.rounds)


@kernel
def _transform(
    children: Population,
    i: int,
    best: float,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    draws: Draws,
    counter: np.ndarray,
    tally: np.ndarray,
) -> None:
    """Apply mutation, then rounds of the specialised operators, to a child."""
    if draw(draws) < rates.mutation:
        known = children.chromosomes[i].cost
        mutate(children, i, problem, rates.penalty, draws, counter)
        note(tally, MUTATION, known, children.chromosomes[i].cost)
    for _ in range(rates.rounds):
        if not _do_round(children, i, best, scratch, problem, rates, draws, counter, tally):
            break


@kernel
def _do_round(
    children: Population,
    i: int,
    best: float,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    draws: Draws,
    counter: np.ndarray,
    tally: np.ndarray,
) -> bool:
    """Repair, deletion and improvement, by probability and heuristic; whether any had an effect.

    best : length of the best feasible path so far, metres; infinite before there is one. A repair
        makes a path longer, so it is lost on one that is too long already.

    All in turn, or one of the two that suit the child: repair or deletion while it is infeasible,
    improvement or deletion then.
    """
    child = children.chromosomes[i]
    changed = False
    deletes = True
    others = True
    if rates.one_operator:
        deletes = draw(draws) < 0.5
        others = not deletes
    if (
        others
        and child.infeasible > 0
        and length_of(children, i) < rates.repair_limit * best
        and draw(draws) < rates.repair
    ):
        known = child.cost
        changed |= repair(children, i, scratch, problem, rates, draws, counter)
        note(tally, REPAIR, known, child.cost)
        if rates.one_operator:
            return changed
    if deletes and draw(draws) < rates.deletion:
        known = child.cost
        changed |= delete(children, i, scratch, problem, rates, draws, counter)
        note(tally, DELETION, known, child.cost)
    if others and child.infeasible == 0 and draw(draws) < rates.improvement:
        known = child.cost
        changed |= improve(children, i, scratch, problem, rates, draws, counter)
        note(tally, IMPROVEMENT, known, child.cost)
    return changed


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
