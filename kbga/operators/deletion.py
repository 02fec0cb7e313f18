"""Deletion (paper II-C): leave out a random node if that is beneficial."""

import numpy as np
from numba import njit

from kbga.encoding import Population, close_columns, forget
from kbga.evaluation import evaluate_segment, is_free_segment, sum_up
from kbga.problem import Problem


@njit(cache=True)
def _random_node(nodes: np.ndarray, i: int, size: int, rng: np.random.Generator) -> int:
    """Column of a random intermediate node that is not known to be needed; 0 if there is none."""
    chosen = 0
    count = 0
    for k in range(1, size + 1):
        if not nodes[i, k].needed:
            count += 1
            if rng.random() * count < 1.0:
                chosen = k
    return chosen


@njit(cache=True)
def delete(
    population: Population,
    i: int,
    scratch: np.ndarray,
    problem: Problem,
    penalty: float,
    rng: np.random.Generator,
    counter: np.ndarray,
) -> bool:
    """Delete a random node of chromosome i if that is beneficial; whether it was done.

    An infeasible path must get cheaper; where it turns feasible it does, for the new segment is
    no longer than the two that it replaces. A feasible path must stay feasible: then it gets
    shorter.
    """
    nodes, arrays = population.nodes, problem.arrays
    k = _random_node(nodes, i, population.chromosomes[i].size, rng)
    if k == 0:
        return False
    scratch[0, 0] = nodes[i, k - 1]
    scratch[0, 1] = nodes[i, k + 1]
    if population.chromosomes[i].infeasible == 0:
        beneficial = is_free_segment(scratch, 0, 0, arrays, counter)
    else:
        evaluate_segment(scratch, 0, 0, arrays, counter)
        beneficial = scratch[0, 0].length + scratch[0, 0].depth * penalty < (
            nodes[i, k - 1].length
            + nodes[i, k].length
            + (nodes[i, k - 1].depth + nodes[i, k].depth) * penalty
        )
    if not beneficial:
        nodes[i, k].needed = 1
        return False
    nodes[i, k - 1] = scratch[0, 0]
    close_columns(population, i, k, 1)
    forget(nodes, i, k - 1, k)
    sum_up(population, i, penalty)
    return True
