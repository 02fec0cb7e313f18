"""Mutation (paper II-C): replace a random node by one that is not in the path."""

import numpy as np

from kbga.draws import Draws, draw
from kbga.encoding import Population, contains, forget, set_node
from kbga.evaluation import evaluate_segment, sum_up
from kbga.problem import Problem, node_at, node_count
from suite.jit import kernel


@kernel
def mutate(
    population: Population,
    i: int,
    problem: Problem,
    penalty: float,
    draws: Draws,
    counter: np.ndarray,
) -> bool:
    """Replace a random node of chromosome i; whether it had one, and the lattice another.

    The result need not be better: mutation keeps the population diverse.
    """
    nodes, arrays, memory = population.nodes, problem.arrays, problem.memory
    size = population.chromosomes[i].intermediate
    count = node_count(problem)
    if size == 0 or size == count:
        return False
    k = 1 + int(draw(draws) * size)
    number = int(draw(draws) * count)
    while contains(nodes, i, size, node_at(number, problem)):
        number = (number + 1) % count
    gene = node_at(number, problem)
    set_node(nodes, i, k, gene, problem.lattice)
    forget(nodes, i, k - 1, k + 1)
    evaluate_segment(nodes, i, k - 1, arrays, memory, counter)
    evaluate_segment(nodes, i, k, arrays, memory, counter)
    sum_up(population, i, penalty)
    return True
