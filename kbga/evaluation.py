"""Evaluation of a path, paper II-B: F = sum of d_i + beta_i C, Eq. (1).

beta_i is the depth of collision of segment i: the sum of its escape distances from each obstacle
group that it enters (Eq. (2), Fig. 3). A segment is evaluated once, when it comes into being, and
what was found stays with the chromosome.
"""

import math

import numpy as np
from numba import njit

from kbga.encoding import MAX_HITS, Population, distance
from suite.geometry.kernels import (
    ObstacleArrays,
    next_group_entered,
    pinch_at,
    segment_slips_through,
)

LEAST_DEPTH = 1e-6
"""Depth of a collision that no shift measures, such as slipping through a pinch point, metres: a
segment is feasible if and only if its depth is zero."""


@njit(cache=True)
def _reach(
    ax: float, ay: float, ux: float, uy: float, span: float, edges: np.ndarray, first: int, last: int
) -> tuple[float, float]:
    """How far edges reach to the left (h > 0) and right (h < 0) inside the strip of a segment.

    The strip is 0 <= t <= span along the direction u from a. Returns the highest and the lowest h
    of what lies in it; (-inf, inf) if nothing does.
    """
    high = -math.inf
    low = math.inf
    for e in range(first, last):
        px, py = edges[e, 0] - ax, edges[e, 1] - ay
        qx, qy = edges[e, 2] - ax, edges[e, 3] - ay
        h = py * ux - px * uy
        g = qy * ux - qx * uy
        high = max(high, h, g)
        low = min(low, h, g)
    return high, low


@njit(cache=True)
def escape_distance(
    ax: float, ay: float, bx: float, by: float, arrays: ObstacleArrays, group: int
) -> float:
    """Shortest shift, square to segment a-b, that frees it from a whole obstacle group, metres.

    Paper Fig. 3: (a) the smaller of the two sides; (b) the whole group must be left behind, so
    each side counts with the farthest reach of the group in the segment's strip; (c) a side on
    which the group is joined to the border is a dead end. Where both sides are dead ends no shift
    helps, and the sum of both is taken (ours: deeper than either).
    """
    span = distance(ax, ay, bx, by)
    if span == 0.0:
        # No direction to be square to: the way out of the group's box.
        box = arrays.group_box[group]
        return max(LEAST_DEPTH, min(ax - box[0], box[2] - ax, ay - box[1], box[3] - ay))
    ux, uy = (bx - ax) / span, (by - ay) / span
    first, last = arrays.boundary_start[group], arrays.boundary_start[group + 1]
    high, low = _reach(ax, ay, ux, uy, span, arrays.boundary, first, last)
    left, right = max(high, 0.0), max(-low, 0.0)
    first, last = arrays.border_start[group], arrays.border_start[group + 1]
    border_high, border_low = _reach(ax, ay, ux, uy, span, arrays.border, first, last)
    left_is_dead = border_high > 0.0
    right_is_dead = border_low < 0.0
    if left_is_dead and right_is_dead:
        return max(LEAST_DEPTH, left + right)
    if left_is_dead:
        return max(LEAST_DEPTH, right)
    if right_is_dead:
        return max(LEAST_DEPTH, left)
    return max(LEAST_DEPTH, min(left, right))


@njit(cache=True)
def _is_closed_bend(nodes: np.ndarray, i: int, k: int, arrays: ObstacleArrays) -> bool:
    """Whether column k is a lattice node on a pinch point.

    There two feasible segments need not make a feasible bend. Closing those few nodes (ours)
    keeps evaluation a sum over segments, as Eq. (1) has it.
    """
    return nodes[i, k].gene >= 0 and pinch_at(nodes[i, k].x, nodes[i, k].y, arrays) >= 0


@njit(cache=True)
def _is_closed_by_pinch(nodes: np.ndarray, i: int, k: int, arrays: ObstacleArrays) -> bool:
    """Whether segment k, which enters no obstacle, is closed by a pinch point."""
    return (
        segment_slips_through(
            nodes[i, k].x, nodes[i, k].y, nodes[i, k + 1].x, nodes[i, k + 1].y, arrays
        )
        or _is_closed_bend(nodes, i, k, arrays)
        or _is_closed_bend(nodes, i, k + 1, arrays)
    )


@njit(cache=True)
def is_free_segment(
    nodes: np.ndarray, i: int, k: int, arrays: ObstacleArrays, counter: np.ndarray
) -> bool:
    """Whether segment k of chromosome i is feasible; if so, that is written into its node.

    For those operators that want nothing but feasible segments: it ends at the first obstacle.
    """
    ax, ay = nodes[i, k].x, nodes[i, k].y
    bx, by = nodes[i, k + 1].x, nodes[i, k + 1].y
    counter[0] += 1
    if next_group_entered(ax, ay, bx, by, arrays, 0) >= 0:
        return False
    if arrays.pinch_xy.shape[0] > 0 and _is_closed_by_pinch(nodes, i, k, arrays):
        return False
    nodes[i, k].length = distance(ax, ay, bx, by)
    nodes[i, k].depth = 0.0
    nodes[i, k].hit_count = 0
    return True


@njit(cache=True)
def evaluate_segment(
    nodes: np.ndarray, i: int, k: int, arrays: ObstacleArrays, counter: np.ndarray
) -> None:
    """Length, depth and hit obstacles of segment k of chromosome i, written into its node."""
    ax, ay = nodes[i, k].x, nodes[i, k].y
    bx, by = nodes[i, k + 1].x, nodes[i, k + 1].y
    counter[0] += 1
    depth = 0.0
    count = 0
    group = next_group_entered(ax, ay, bx, by, arrays, 0)
    while group >= 0:
        depth += escape_distance(ax, ay, bx, by, arrays, group)
        if count < MAX_HITS:
            nodes[i, k].hits[count] = group
            count += 1
        group = next_group_entered(ax, ay, bx, by, arrays, group + 1)
    if (
        depth == 0.0
        and arrays.pinch_xy.shape[0] > 0
        and _is_closed_by_pinch(nodes, i, k, arrays)
    ):
        depth = LEAST_DEPTH
    nodes[i, k].length = distance(ax, ay, bx, by)
    nodes[i, k].depth = depth
    nodes[i, k].hit_count = count


@njit(cache=True)
def sum_up(population: Population, i: int, penalty: float) -> None:
    """Cost of chromosome i, Eq. (1), and its number of infeasible segments, from its records."""
    nodes = population.nodes
    cost = 0.0
    infeasible = 0
    for k in range(population.chromosomes[i].size + 1):
        cost += nodes[i, k].length + nodes[i, k].depth * penalty
        if nodes[i, k].depth > 0.0:
            infeasible += 1
    population.chromosomes[i].cost = cost
    population.chromosomes[i].infeasible = infeasible
