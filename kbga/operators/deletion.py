"""Deletion (paper II-C): leave out a random node if that is beneficial."""

import numpy as np

from kbga.draws import Draws, draw
from kbga.encoding import NEEDED, NEEDED_IF_FEASIBLE, Population, close_columns, distance, forget
from kbga.evaluation import evaluate_within, is_free_segment, sum_up
from kbga.operators.detour import Scratch
from kbga.problem import Problem
from kbga.tuning import Rates
from suite.jit import kernel


@kernel
def _random_node(nodes: np.ndarray, i: int, size: int, known: int, draws: Draws) -> int:
    """Column of a random intermediate node that is not ``known`` to be needed; 0 if none is."""
    count = 0
    for k in range(1, size + 1):
        count += nodes[i, k].needed < known
    if count == 0:
        return 0
    left = int(draw(draws) * count)
    k = 1
    while nodes[i, k].needed >= known or left > 0:
        left -= nodes[i, k].needed < known
        k += 1
    return k


@kernel
def delete(
    population: Population,
    i: int,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    draws: Draws,
    counter: np.ndarray,
) -> bool:
    """Delete a random node of chromosome i if that is beneficial; whether it was done.

    It is where the new segment is feasible: it is no longer than the two that it replaces. In an
    infeasible path, it also is where the new segment costs less than the two. A feasible path
    must stay feasible, even where a short cut through an obstacle would cost less.
    """
    nodes, arrays, memory = population.nodes, problem.arrays, problem.memory
    penalty = rates.penalty
    feasible = population.chromosomes[i].infeasible == 0
    known = NEEDED_IF_FEASIBLE if feasible else NEEDED
    k = _random_node(nodes, i, population.chromosomes[i].intermediate, known, draws)
    if k == 0:
        return False
    trial = scratch.nodes
    trial[0, 0] = nodes[i, k - 1]
    trial[0, 1] = nodes[i, k + 1]
    if feasible:
        beneficial = is_free_segment(trial, 0, 0, arrays, memory, counter)
    else:
        known_cost = (
            nodes[i, k - 1].length
            + nodes[i, k].length
            + (nodes[i, k - 1].depth + nodes[i, k].depth) * penalty
        )
        length = distance(trial[0, 0].x, trial[0, 0].y, trial[0, 1].x, trial[0, 1].y)
        beneficial = is_free_segment(trial, 0, 0, arrays, memory, counter) or evaluate_within(
            trial, 0, 0, arrays, memory, length, penalty, known_cost, counter
        )
    if not beneficial:
        nodes[i, k].needed = known if rates.remembers else 0
        return False
    nodes[i, k - 1] = trial[0, 0]
    close_columns(population, i, k, 1)
    forget(nodes, i, k - 1, k)
    sum_up(population, i, penalty)
    return True
