"""Tournament selection and elitism (paper II-D)."""

import numpy as np

from kbga.draws import Draws, draw
from kbga.encoding import Population, copy_chromosome
from suite.jit import kernel


@kernel
def tournament(chromosomes: np.ndarray, size: int, draws: Draws) -> int:
    """Index of the cheapest of ``size`` chromosomes drawn at random."""
    winner = int(draw(draws) * chromosomes.size)
    for _ in range(size - 1):
        rival = int(draw(draws) * chromosomes.size)
        if chromosomes[rival].cost < chromosomes[winner].cost:
            winner = rival
    return winner


@kernel
def keep_elite(parents: Population, children: Population) -> None:
    """Replace the worst child by the best parent, so that the elite is not lost."""
    best = 0
    worst = 0
    for i in range(parents.chromosomes.size):
        if parents.chromosomes[i].cost < parents.chromosomes[best].cost:
            best = i
        if children.chromosomes[i].cost > children.chromosomes[worst].cost:
            worst = i
    copy_chromosome(parents, best, children, worst)
