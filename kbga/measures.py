"""What there is to say about a population, generation by generation."""

from dataclasses import dataclass

import numpy as np

from kbga.encoding import Population
from suite.jit import kernel


@dataclass(frozen=True, slots=True)
class GenerationReport:
    """What there is to say about one generation.

    generation : int, 0 for the first population.
    best, mean : float, cost of the best chromosome and of all, Eq. (1), metres.
    feasible_share : float, share of feasible chromosomes.
    diversity : float, share of chromosomes that differ from all before them in the population.
    checks : int, collision checks of a segment so far.
    """

    generation: int
    best: float
    mean: float
    feasible_share: float
    diversity: float
    checks: int


@kernel
def _are_equal(nodes: np.ndarray, i: int, j: int, intermediate: int) -> bool:
    """Whether chromosomes i and j, of one length, have the same nodes."""
    for k in range(1, intermediate + 1):  # noqa: SIM110 (any() of a generator does not compile)
        if nodes[i, k].gene != nodes[j, k].gene:
            return False
    return True


@kernel
def measure(population: Population) -> tuple[float, float, float, float]:
    """Best and mean cost, feasible share and diversity; see :class:`GenerationReport`."""
    nodes, chromosomes = population.nodes, population.chromosomes
    count = nodes.shape[0]
    best = np.inf
    total = 0.0
    feasible = 0
    distinct = 0
    for i in range(count):
        cost = chromosomes[i].cost
        best = min(best, cost)
        total += cost
        feasible += chromosomes[i].infeasible == 0
        is_new = True
        for j in range(i):
            # Equal nodes make equal costs: few pairs are compared node by node.
            if (
                chromosomes[j].cost == cost
                and chromosomes[j].intermediate == chromosomes[i].intermediate
                and _are_equal(nodes, i, j, chromosomes[i].intermediate)
            ):
                is_new = False
                break
        distinct += is_new
    return best, total / count, feasible / count, distinct / count
