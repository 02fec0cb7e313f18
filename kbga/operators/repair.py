"""Repair (paper II-C): insert a node into an infeasible segment, near the obstacle it hits."""

import math

import numpy as np

from kbga.draws import Draws, draw
from kbga.encoding import Population, contains, forget, open_column, set_node
from kbga.evaluation import evaluate_within, sum_up
from kbga.operators.detour import Scratch, bring_shortest_forward, list_candidate
from kbga.problem import Problem, near_count, near_node
from suite.compiled import kernel


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
    """List up to ``most`` lattice nodes next to an obstacle group; how many there are.

    Evenly spread over all of them, from a random one on, when there are more than are tried.
    """
    around = near_count(group, problem)
    tries = min(most, around)
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
    scratch: Scratch, count: int, problem: Problem, penalty: float, counter: np.ndarray
) -> bool:
    """Put the detour that costs least into row 1 of the scratch nodes; whether there is one."""
    trial, candidates = scratch.nodes, scratch.candidates
    arrays, memory = problem.arrays, problem.memory
    best = math.inf
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
    return best < math.inf


@kernel
def repair(
    population: Population,
    i: int,
    scratch: Scratch,
    problem: Problem,
    penalty: float,
    candidates: int,
    draws: Draws,
    counter: np.ndarray,
) -> bool:
    """Repair one random infeasible segment of chromosome i; whether a node was inserted.

    Evaluation has recorded which segments are infeasible and what they hit. The local search
    tries lattice nodes next to one of the obstacles hit, and takes the one whose two segments
    cost least, be it more than before: another repair may follow.
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
    count = _list_candidates(nodes, i, size, scratch, problem, group, candidates, draws)
    if not _try_candidates(scratch, count, problem, penalty, counter):
        return False
    open_column(population, i, k + 1)
    nodes[i, k] = scratch.nodes[1, 0]
    nodes[i, k + 1] = scratch.nodes[1, 1]
    forget(nodes, i, k, k + 2)
    sum_up(population, i, penalty)
    return True
