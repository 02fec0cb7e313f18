"""Crossover (paper II-C): exchange the parts after a node of each parent, then cut out loops."""

import numpy as np

from kbga.draws import Draws, draw
from kbga.encoding import Population, close_columns, forget
from kbga.evaluation import evaluate_segment, sum_up
from kbga.problem import Problem
from suite.jit import kernel


@kernel
def _splice(
    parents: Population, i: int, cut: int, j: int, resume: int, children: Population, c: int
) -> None:
    """Child c: chromosome i up to column ``cut``, then chromosome j from column ``resume`` on."""
    nodes, copies = parents.nodes, children.nodes
    for k in range(cut + 1):
        copies[c, k] = nodes[i, k]
    end = parents.chromosomes[j].intermediate + 1
    for k in range(resume, end + 1):
        copies[c, cut + 1 + k - resume] = nodes[j, k]
    children.chromosomes[c].intermediate = cut + end - resume


@kernel
def _cut_loop(children: Population, c: int, cut: int) -> bool:
    """Delete the part between two equal nodes, one of each parent; whether there was one.

    The parents have no loops, so equal nodes lie on both sides of the joint. The first node with
    an equal one keeps its place and goes on as its equal did.
    """
    nodes = children.nodes
    for k in range(1, cut + 1):
        for m in range(children.chromosomes[c].intermediate, cut, -1):
            if nodes[c, m].gene == nodes[c, k].gene:
                close_columns(children, c, k, m - k)
                forget(nodes, c, k, k)
                return True
    return False


@kernel
def _offspring(
    parents: Population,
    i: int,
    cut: int,
    j: int,
    resume: int,
    children: Population,
    c: int,
    problem: Problem,
    penalty: float,
    counter: np.ndarray,
) -> None:
    _splice(parents, i, cut, j, resume, children, c)
    if not _cut_loop(children, c, cut):
        # Every other segment comes from a parent and is known; only the joint is new.
        evaluate_segment(children.nodes, c, cut, problem.arrays, problem.memory, counter)
        forget(children.nodes, c, cut, cut + 1)
    sum_up(children, c, penalty)


@kernel
def crossover(
    parents: Population,
    i: int,
    j: int,
    children: Population,
    c: int,
    d: int,
    problem: Problem,
    penalty: float,
    draws: Draws,
    counter: np.ndarray,
) -> bool:
    """Make children c and d of parents i and j; whether it was done.

    The nodes are chosen among the intermediate ones, each parent's on its own, so that lengths
    vary. It is not done where a parent has no intermediate node or a child would exceed N_max.
    """
    size_i, size_j = parents.chromosomes[i].intermediate, parents.chromosomes[j].intermediate
    if size_i == 0 or size_j == 0:
        return False
    cut = 1 + int(draw(draws) * size_i)
    other = 1 + int(draw(draws) * size_j)
    longest = parents.nodes.shape[1] - 2
    if cut + size_j - other > longest or other + size_i - cut > longest:
        return False
    _offspring(parents, i, cut, j, other + 1, children, c, problem, penalty, counter)
    _offspring(parents, j, other, i, cut + 1, children, d, problem, penalty, counter)
    return True
