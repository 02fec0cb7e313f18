"""Repair (paper II-C): insert a node into an infeasible segment, near the obstacle it hits."""

import math

import numpy as np

from kbga.encoding import Population, contains, forget, open_column, set_node
from kbga.evaluation import evaluate_segment, sum_up
from kbga.operators.detour import detour_length
from kbga.problem import Problem
from suite.compiled import kernel


@kernel
def _random_infeasible_segment(
    nodes: np.ndarray, i: int, infeasible: int, rng: np.random.Generator
) -> int:
    """Column of one of the ``infeasible`` infeasible segments of chromosome i."""
    wanted = int(rng.random() * infeasible)
    k = 0
    while True:
        if nodes[i, k].depth > 0.0:
            if wanted == 0:
                return k
            wanted -= 1
        k += 1


@kernel
def repair(
    population: Population,
    i: int,
    scratch: np.ndarray,
    problem: Problem,
    penalty: float,
    candidates: int,
    rng: np.random.Generator,
    counter: np.ndarray,
) -> bool:
    """Repair one random infeasible segment of chromosome i; whether a node was inserted.

    Evaluation has recorded which segments are infeasible and what they hit. The local search
    tries lattice nodes next to one of the obstacles hit, and takes the one whose two segments
    cost least, be it more than before: another repair may follow.
    """
    nodes, arrays, memory = population.nodes, problem.arrays, problem.memory
    size, infeasible = population.chromosomes[i].intermediate, population.chromosomes[i].infeasible
    if infeasible == 0 or size + 2 >= nodes.shape[1]:
        return False
    k = _random_infeasible_segment(nodes, i, infeasible, rng)
    if nodes[i, k].hit_count == 0:
        return False
    group = nodes[i, k].hits[int(rng.random() * nodes[i, k].hit_count)]
    near = problem.near
    first = problem.near_start[group]
    around = problem.near_start[group + 1] - first
    tries = min(candidates, around)
    if tries == 0:
        return False
    scratch[0, 0] = nodes[i, k]
    scratch[0, 2] = nodes[i, k + 1]
    best = math.inf
    offset = int(rng.random() * around)
    for attempt in range(tries):
        # Evenly spread over all nodes near the obstacle when there are more than are tried.
        gene = near[first + (offset + attempt * around // tries) % around]
        if contains(nodes, i, size, gene):
            continue
        set_node(scratch, 0, 1, gene, problem.lattice)
        length = detour_length(scratch)
        if length >= best:
            continue
        evaluate_segment(scratch, 0, 0, arrays, memory, counter)
        cost = length + scratch[0, 0].depth * penalty
        if cost >= best:
            continue
        evaluate_segment(scratch, 0, 1, arrays, memory, counter)
        cost += scratch[0, 1].depth * penalty
        if cost < best:
            best = cost
            scratch[1, 0] = scratch[0, 0]
            scratch[1, 1] = scratch[0, 1]
    if best == math.inf:
        return False
    open_column(population, i, k + 1)
    nodes[i, k] = scratch[1, 0]
    nodes[i, k + 1] = scratch[1, 1]
    forget(nodes, i, k, k + 2)
    sum_up(population, i, penalty)
    return True
