"""Repair (paper II-C): insert a node into an infeasible segment, near the obstacle it hits."""

import math

import numpy as np

from kbga.draws import Draws, draw
from kbga.encoding import Population, contains, forget, open_column, set_node
from kbga.evaluation import evaluate_within, sum_up
from kbga.operators.detour import (
    NEIGHBOURS,
    Scratch,
    bring_shortest_forward,
    list_candidate,
    make_scratch,
)
from kbga.problem import Problem, near_count, near_node
from kbga.settings import KBGASettings
from kbga.tuning import Rates
from suite.jit import kernel


def scratch_for(problem: Problem, settings: KBGASettings) -> Scratch:
    """Room for all candidates of one repair, or of one step of an improvement."""
    most = int(settings.repair_candidates) or int(np.diff(problem.near_start).max(initial=0))
    return make_scratch(max(NEIGHBOURS, most))


@kernel
def _random_infeasible_segment(nodes: np.ndarray, i: int, infeasible: int, draws: Draws) -> int:
    """Column of one of the ``infeasible`` infeasible segments of chromosome i."""
    wanted = int(draw(draws) * infeasible)
    k = 0
    while True:
        if nodes[i, k].depth > 0.0:
            if wanted == 0:
                return k
            wanted -= 1
        k += 1


@kernel
def _list_candidates(
    nodes: np.ndarray,
    i: int,
    size: int,
    scratch: Scratch,
    problem: Problem,
    group: int,
    most: int,
    draws: Draws,
) -> int:
    """List up to ``most`` lattice nodes near an obstacle group, 0: all; how many there are.

    Evenly spread over all of them, from a random one on, when there are more than are tried.
    """
    around = near_count(group, problem)
    tries = min(most, around) if most > 0 else around
    if tries == 0:
        return 0
    offset = int(draw(draws) * around)
    count = 0
    for attempt in range(tries):
        gene = near_node(group, (offset + attempt * around // tries) % around, problem)
        if not contains(nodes, i, size, gene):
            count = list_candidate(scratch, count, gene, problem.lattice)
    return count


@kernel
def _try_candidates(
    scratch: Scratch,
    count: int,
    problem: Problem,
    penalty: float,
    limit: float,
    counter: np.ndarray,
) -> bool:
    """Put the detour that costs least into row 1 of the scratch nodes; whether there is one.

    limit : what it must cost less than, metres; may be infinite.
    """
    trial, candidates = scratch.nodes, scratch.candidates
    arrays, memory = problem.arrays, problem.memory
    best = limit
    for c in range(count):
        bring_shortest_forward(candidates, c, count)
        length = candidates[c].length
        if length >= best:  # so are all that follow
            break
        set_node(trial, 0, 1, candidates[c].gene, problem.lattice)
        if not evaluate_within(trial, 0, 0, arrays, memory, length, penalty, best, counter):
            continue
        cost = length + trial[0, 0].depth * penalty
        if not evaluate_within(trial, 0, 1, arrays, memory, cost, penalty, best, counter):
            continue
        best = cost + trial[0, 1].depth * penalty
        trial[1, 0] = trial[0, 0]
        trial[1, 1] = trial[0, 1]
    return best < limit


@kernel
def repair(
    population: Population,
    i: int,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    draws: Draws,
    counter: np.ndarray,
) -> bool:
    """Repair one random infeasible segment of chromosome i; whether a node was inserted.

    Evaluation has recorded which segments are infeasible and what they hit. The local search
    tries lattice nodes near one of the obstacles hit, and takes the one whose two segments cost
    least: be it more than before, as another repair may follow, or only if it is less.
    """
    nodes = population.nodes
    size, infeasible = population.chromosomes[i].intermediate, population.chromosomes[i].infeasible
    if infeasible == 0 or size + 2 >= nodes.shape[1]:
        return False
    k = _random_infeasible_segment(nodes, i, infeasible, draws)
    if nodes[i, k].hit_count == 0:
        return False
    group = nodes[i, k].hits[int(draw(draws) * nodes[i, k].hit_count)]
    scratch.nodes[0, 0] = nodes[i, k]
    scratch.nodes[0, 2] = nodes[i, k + 1]
    count = _list_candidates(
        nodes, i, size, scratch, problem, group, rates.repair_candidates, draws
    )
    limit = math.inf
    if rates.repair_must_help:
        limit = nodes[i, k].length + nodes[i, k].depth * rates.penalty
    if not _try_candidates(scratch, count, problem, rates.penalty, limit, counter):
        return False
    open_column(population, i, k + 1)
    nodes[i, k] = scratch.nodes[1, 0]
    nodes[i, k + 1] = scratch.nodes[1, 1]
    forget(nodes, i, k, k + 2)
    sum_up(population, i, rates.penalty)
    return True
