"""What a run of the algorithm knows of its environment: obstacles, lattice, likely nodes.

Of what follows from the obstacles, only that is found out which a run asks for.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kbga.encoding import Lattice, make_lattice, node_x, node_y
from kbga.memory import Memory, empty_memory
from suite.compiled import kernel
from suite.geometry.arrangement import Arrangement
from suite.geometry.kernels import ObstacleArrays, pinch_at, segment_enters

UNKNOWN, USABLE, CLOSED = 0, 1, 2


class Problem(NamedTuple):
    """The environment, as the compiled operators see it.

    arrays : the obstacles.
    lattice : the lattice of intermediate nodes.
    corners : (K, 2) float64, corners of the obstacle groups, group by group, metres.
    near : (MOST_NEAR * K,) int64, free lattice nodes next to the corners of each group. Those of
        group g begin at ``MOST_NEAR * near_start[g]``.
    near_start : (G + 1,) int64, rows of ``corners`` where each group begins.
    near_count : (G,) int64, how many nodes there are; NOT_LOOKED_FOR before they are found.
    usable : (side ** 2,) int8, what is known of each lattice node: UNKNOWN, USABLE or CLOSED.
    memory : what is known of segments, see :mod:`kbga.memory`. It and ``usable`` fill up during a
        run; all else stays as it is.
    """

    arrays: ObstacleArrays
    lattice: Lattice
    corners: NDArray[np.float64]
    near: NDArray[np.int64]
    near_start: NDArray[np.int64]
    near_count: NDArray[np.int64]
    usable: NDArray[np.int8]
    memory: Memory


MOST_NEAR = 16
"""Lattice nodes next to one corner: those of its cell and of the cells around it."""

NOT_LOOKED_FOR = -1


def make_problem(
    arrangement: Arrangement, bounds: tuple[float, float, float, float], resolution: int
) -> Problem:
    """Lay the lattice over a scene.

    Parameters
    ----------
    arrangement : Arrangement
    bounds : xmin, ymin, xmax, ymax of the workspace, metres.
    resolution : lattice units per side.
    """
    lattice = make_lattice(bounds, resolution)
    groups = len(arrangement.arrays.groups)
    # Always a copy: a view would be read-only where there are no corners, another type to numba.
    corners = np.array(arrangement.corners[:, :2], order="C")
    return Problem(
        arrangement.arrays,
        lattice,
        corners,
        np.empty(MOST_NEAR * len(corners), np.int64),
        np.searchsorted(arrangement.corner_group, np.arange(groups + 1)),
        np.full(groups, NOT_LOOKED_FOR),
        np.zeros(lattice.side**2, np.int8),
        empty_memory(),
    )


@kernel
def is_usable(node: int, arrays: ObstacleArrays, lattice: Lattice) -> bool:
    """Whether a path may bend at a lattice node: it is free, and no pinch point.

    At a pinch point two feasible segments need not make a feasible bend; leaving those few nodes
    out keeps the evaluation a sum over segments.
    """
    x, y = node_x(lattice, node), node_y(lattice, node)
    return not segment_enters(x, y, x, y, arrays) and pinch_at(x, y, arrays.pinches) < 0


@kernel
def is_known_usable(node: int, problem: Problem) -> bool:
    """As :func:`is_usable`, which is asked once for each node."""
    usable = problem.usable
    if usable[node] == UNKNOWN:
        usable[node] = USABLE if is_usable(node, problem.arrays, problem.lattice) else CLOSED
    return usable[node] == USABLE


@kernel
def near_count(group: int, problem: Problem) -> int:
    """How many free nodes lie next to the corners of an obstacle group; finds them if need be.

    The paper's grids neighbouring an obstacle (II-C). Of each corner, those are the crossings of
    the lattice cell that holds it; where they are closed or those of another corner already, of the
    cells around it too. Shortest paths bend at corners only.
    """
    if problem.near_count[group] == NOT_LOOKED_FOR:
        first = MOST_NEAR * problem.near_start[group]
        count = 0
        for corner in range(problem.near_start[group], problem.near_start[group + 1]):
            found = _add_near_corner(problem, corner, 0, first, count)
            if found == count:
                found = _add_near_corner(problem, corner, 1, first, count)
            count = found
        problem.near_count[group] = count
    return problem.near_count[group]


@kernel
def near_node(group: int, number: int, problem: Problem) -> int:
    """One of the free nodes next to an obstacle group, which has been asked for their count."""
    return problem.near[MOST_NEAR * problem.near_start[group] + number]


@kernel
def _add_near_corner(problem: Problem, corner: int, margin: int, first: int, count: int) -> int:
    """Add the free nodes of the cell of a corner, and ``margin`` cells around, to the near ones."""
    lattice, near = problem.lattice, problem.near
    column = (problem.corners[corner, 0] - lattice.x0) / lattice.dx
    row = (problem.corners[corner, 1] - lattice.y0) / lattice.dy
    for j in range(int(np.floor(row)) - margin, int(np.ceil(row)) + margin + 1):
        for i in range(int(np.floor(column)) - margin, int(np.ceil(column)) + margin + 1):
            if not (0 <= i < lattice.side and 0 <= j < lattice.side):
                continue
            node = j * lattice.side + i
            known = False
            for k in range(first, first + count):
                known |= near[k] == node
            if not known and is_known_usable(node, problem):
                near[first + count] = node
                count += 1
    return count
