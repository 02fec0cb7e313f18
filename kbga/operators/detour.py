"""Detours: what repair and improvement share when they try nodes between two others.

Lengths cost nothing to compare, collisions do. So all candidates are measured first and tested in
the order of their lengths: the first feasible detour is then the best one.
"""

from typing import NamedTuple

import numpy as np

from kbga.encoding import NODE, Lattice, distance, node_x, node_y, records
from suite.jit import kernel

CANDIDATE = np.dtype([("gene", np.int64), ("length", np.float64)], align=True)
"""A node that may be tried: its lattice number, and the length of the way over it, metres."""


NEIGHBOURS = 8
"""Lattice nodes around one."""


class Scratch(NamedTuple):
    """Where the operators try things, so that nothing is allocated within a generation.

    nodes : (2, 3) of NODE. Row 0 holds the node before, the node that is tried, and the node
        after; row 1 the best so far.
    candidates : (K,) of CANDIDATE.
    """

    nodes: np.ndarray
    candidates: np.ndarray


def make_scratch(candidates: int) -> Scratch:
    """Room to try one detour and to list that many candidates."""
    return Scratch(records((2, 3), NODE), records(candidates, CANDIDATE))


@kernel
def list_candidate(scratch: Scratch, count: int, gene: int, lattice: Lattice) -> int:
    """Put a node on the list of ``count`` candidates, with its length; the new count."""
    x, y = node_x(lattice, gene), node_y(lattice, gene)
    tail, head = scratch.nodes[0, 0], scratch.nodes[0, 2]
    scratch.candidates[count].gene = gene
    scratch.candidates[count].length = distance(tail.x, tail.y, x, y) + distance(
        x, y, head.x, head.y
    )
    return count + 1


@kernel
def bring_shortest_forward(candidates: np.ndarray, first: int, count: int) -> None:
    """Swap the shortest of the candidates from ``first`` on to that place."""
    shortest = first
    for c in range(first + 1, count):
        if candidates[c].length < candidates[shortest].length:
            shortest = c
    gene, length = candidates[first].gene, candidates[first].length
    candidates[first].gene = candidates[shortest].gene
    candidates[first].length = candidates[shortest].length
    candidates[shortest].gene = gene
    candidates[shortest].length = length
