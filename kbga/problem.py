"""What a run of the algorithm knows of its environment: obstacles, lattice, likely nodes."""

from typing import NamedTuple

import numpy as np
from numba import njit

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
    near : (K,) int64, free lattice nodes next to the corners of each obstacle group.
    near_start : (G + 1,) int64, entries of ``near`` where each group begins.
    usable : (side ** 2,) int8, what is known of each lattice node: UNKNOWN, USABLE or CLOSED.
    memory : what is known of segments, see :mod:`kbga.memory`. It and ``usable`` fill up during a
        run; all else stays as it is.
    """

    arrays: ObstacleArrays
    lattice: Lattice
    near: np.ndarray
    near_start: np.ndarray
    usable: np.ndarray
    memory: Memory


def make_problem(
    arrangement: Arrangement, bounds: tuple[float, float, float, float], resolution: int
) -> Problem:
    """Lay the lattice over a scene and find the nodes next to its obstacles.

    Parameters
    ----------
    arrangement : Arrangement
    bounds : xmin, ymin, xmax, ymax of the workspace, metres.
    resolution : lattice units per side.
    """
    lattice = make_lattice(bounds, resolution)
    near, near_start = _nodes_near_corners(
        arrangement.corners, arrangement.corner_group, arrangement.arrays, lattice
    )
    usable = np.zeros(lattice.side**2, np.int8)
    return Problem(arrangement.arrays, lattice, near, near_start, usable, empty_memory())


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


@njit(cache=True)
def _nodes_near_corners(
    corners: np.ndarray, corner_group: np.ndarray, arrays: ObstacleArrays, lattice: Lattice
) -> tuple[np.ndarray, np.ndarray]:
    """Free nodes next to the corners of each group (paper: the grids neighbouring the obstacle).

    Those are the crossings of the lattice cell that holds the corner; where all of them are
    closed, the cells around it too. Shortest paths bend at corners only.
    """
    groups = arrays.groups.shape[0]
    order = np.argsort(corner_group, kind="mergesort")
    near = np.empty(16 * max(1, corners.shape[0]), dtype=np.int64)
    start = np.zeros(groups + 1, dtype=np.int64)
    count = 0
    at = 0
    for group in range(groups):
        start[group] = count
        while at < order.size and corner_group[order[at]] == group:
            corner = order[at]
            at += 1
            column = (corners[corner, 0] - lattice.x0) / lattice.dx
            row = (corners[corner, 1] - lattice.y0) / lattice.dy
            for margin in range(2):
                before = count
                for j in range(int(np.floor(row)) - margin, int(np.ceil(row)) + margin + 1):
                    for i in range(
                        int(np.floor(column)) - margin, int(np.ceil(column)) + margin + 1
                    ):
                        if not (0 <= i < lattice.side and 0 <= j < lattice.side):
                            continue
                        node = j * lattice.side + i
                        known = False
                        for k in range(start[group], count):
                            known = known or near[k] == node
                        if not known and is_usable(node, arrays, lattice):
                            near[count] = node
                            count += 1
                if count > before:
                    break
    start[groups] = count
    return near[:count].copy(), start
