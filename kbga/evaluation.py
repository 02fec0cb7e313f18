"""Evaluation of a path, paper II-B: F = sum of d_i + beta_i C, Eq. (1).

beta_i is the depth of collision of segment i: the sum of its escape distances from each obstacle
group that it enters (Eq. (2), Fig. 3). A segment is evaluated once, when it comes into being, and
what was found stays with the chromosome.
"""

import numpy as np

from kbga.counter import COMPUTED, OUT_OF_QUESTIONS, may_ask
from kbga.encoding import MAX_HITS, Population, distance
from kbga.memory import COUNT, FIRST_HIT, ROW, UNMEASURED, Memory, key_of, slot_of
from suite.geometry.arrangement import FRAME_MARGIN
from suite.geometry.kernels import (
    AFTER,
    FIRST_CONTACT,
    FIRST_EDGE,
    GROUP,
    LAST_CONTACT,
    LAST_EDGE,
    XMAX,
    XMIN,
    YMAX,
    YMIN,
    ObstacleArrays,
    next_entry,
    pinch_at,
    segment_slips_through,
)
from suite.jit import inlined_kernel, kernel

HAIR = 1e-8
"""Share of the room's longer side below which a distance is rounding: 1e-6 m in 100 m."""

ROUNDING = 2.0**-44
"""Share of the largest coordinate, 256 spacings of float64: scenes have no coarser grid. Far from
the origin it is more than a small room's share."""

SIDES_OF_FRAME = 1.0 + 2.0 * FRAME_MARGIN
"""Longer side of the frame's box by that of the room."""


@inlined_kernel
def hair(arrays: ObstacleArrays) -> float:
    """Metres below which a distance in this scene is rounding.

    The depth of a collision that no shift measures, such as slipping through a pinch point: a
    segment is feasible if and only if its depth is zero. And the distance from a segment's line
    below which a contact with the border lies on it, not on a side: a slanted border is met only up
    to rounding, and to the grid of the arrangement.
    """
    xmin, ymin = arrays.tree[0, XMIN], arrays.tree[0, YMIN]
    xmax, ymax = arrays.tree[0, XMAX], arrays.tree[0, YMAX]
    share = HAIR * (max(xmax - xmin, ymax - ymin) / SIDES_OF_FRAME)
    return max(share, ROUNDING * max(-xmin, -ymin, xmax, ymax))


@inlined_kernel
def _reach(
    ax: float,
    ay: float,
    ux: float,
    uy: float,
    span: float,
    edges: np.ndarray,
    first: int,
    last: int,
) -> tuple[float, float]:
    """How far edges reach to the left (> 0) and right (< 0) within the strip of a segment.

    The strip holds what a shift square to the segment passes over: 0 <= t <= span along the
    direction u from a. Returns the largest and the smallest signed distance; 0 at the least and
    at the most.
    """
    left = 0.0
    right = 0.0
    for e in range(first, last):
        px, py = edges[e, 0] - ax, edges[e, 1] - ay
        qx, qy = edges[e, 2] - ax, edges[e, 3] - ay
        t, h = px * ux + py * uy, py * ux - px * uy
        w, g = qx * ux + qy * uy, qy * ux - qx * uy
        if (t < 0.0 and w < 0.0) or (t > span and w > span):
            continue
        if t < 0.0 or t > span or w < 0.0 or w > span:
            slope = (g - h) / (w - t)
            start = h - t * slope  # height of the edge's line at t = 0
            h = start + min(max(t, 0.0), span) * slope
            g = start + min(max(w, 0.0), span) * slope
        left = max(left, h, g)
        right = min(right, h, g)
    return left, right


@inlined_kernel
def _dead_ends(
    ax: float,
    ay: float,
    ux: float,
    uy: float,
    span: float,
    contacts: np.ndarray,
    first: int,
    last: int,
    width: float,
) -> tuple[bool, bool, bool]:
    """Where a group is joined to the border: left of a segment's line, right, along the segment.

    A joint that the line crosses lies ahead of the segment or behind it, and in no shift's way. So
    does one on the line that the segment does not run along. (One that the segment itself crosses
    leads into the frame, which has a depth of its own.)

    width : distance below which a contact lies on the line, metres.
    """
    left = False
    right = False
    along = False
    for e in range(first, last):
        px, py = contacts[e, 0] - ax, contacts[e, 1] - ay
        qx, qy = contacts[e, 2] - ax, contacts[e, 3] - ay
        h, g = py * ux - px * uy, qy * ux - qx * uy
        low, high = min(h, g), max(h, g)
        left |= low >= -width and high > width
        right |= high <= width and low < -width
        if low >= -width and high <= width:
            t, w = px * ux + py * uy, qx * ux + qy * uy
            along |= max(t, w) > width and min(t, w) < span - width
    return left, right, along


@kernel
def escape_distance(
    ax: float, ay: float, bx: float, by: float, arrays: ObstacleArrays, group: int
) -> float:
    """Shortest shift, square to segment a-b, that frees it from an obstacle group, metres.

    Paper Fig. 3: (a) the smaller of the two sides; (b) the whole group must be left behind, so
    each side counts with the farthest reach of the group within the strip that the segment passes
    over; (c) a side on which the group is joined to the border is a dead end. Where both sides are
    dead ends no shift helps, and both together are taken (ours: deeper than either). A segment
    that runs along the border itself, in the slit below the group, has the dead end under it: only
    the farther side leads out. The frame lies on both sides of every segment.
    """
    least = hair(arrays)
    span = distance(ax, ay, bx, by)
    if span == 0.0:
        # No direction to be square to: the way out of the group's box.
        xmin, ymin = arrays.groups[group, XMIN], arrays.groups[group, YMIN]
        xmax, ymax = arrays.groups[group, XMAX], arrays.groups[group, YMAX]
        return max(least, min(ax - xmin, xmax - ax, ay - ymin, ymax - ay))
    ux, uy = (bx - ax) / span, (by - ay) / span
    first = int(arrays.groups[group, FIRST_EDGE])
    last = int(arrays.groups[group, LAST_EDGE])
    left, right = _reach(ax, ay, ux, uy, span, arrays.boundary, first, last)
    first = int(arrays.groups[group, FIRST_CONTACT])
    last = int(arrays.groups[group, LAST_CONTACT])
    dead_left, dead_right, slit = _dead_ends(
        ax, ay, ux, uy, span, arrays.contacts, first, last, least
    )
    is_frame = group == arrays.groups.shape[0] - 1
    if is_frame or (dead_left and dead_right):
        return max(least, left - right)
    if dead_left:
        return max(least, -right)
    if dead_right:
        return max(least, left)
    if slit:
        return max(least, left, -right)
    return max(least, min(left, -right))


@kernel
def _is_closed_bend(nodes: np.ndarray, i: int, k: int, pinches: np.ndarray) -> bool:
    """Whether column k is a lattice node on a pinch point.

    There two feasible segments need not make a feasible bend. Closing those few nodes (ours)
    keeps evaluation a sum over segments, as Eq. (1) has it.
    """
    return nodes[i, k].gene >= 0 and pinch_at(nodes[i, k].x, nodes[i, k].y, pinches) >= 0


@kernel
def _is_closed_by_pinch(
    nodes: np.ndarray, i: int, k: int, pinches: np.ndarray, ways: np.ndarray
) -> bool:
    """Whether segment k, which enters no obstacle, is closed by a pinch point."""
    ax, ay = nodes[i, k].x, nodes[i, k].y
    bx, by = nodes[i, k + 1].x, nodes[i, k + 1].y
    return (
        segment_slips_through(ax, ay, bx, by, pinches, ways)
        or _is_closed_bend(nodes, i, k, pinches)
        or _is_closed_bend(nodes, i, k + 1, pinches)
    )


@kernel
def is_free_segment(
    nodes: np.ndarray,
    i: int,
    k: int,
    arrays: ObstacleArrays,
    memory: Memory,
    counter: np.ndarray,
) -> bool:
    """Whether segment k of chromosome i is feasible; if so, that is written into its node.

    For those operators that want nothing but feasible segments: it ends at the first obstacle.
    """
    if not may_ask(counter):
        return False
    key = key_of(nodes[i, k].gene, nodes[i, k + 1].gene)
    slot = slot_of(memory.segments, key)
    ax, ay = nodes[i, k].x, nodes[i, k].y
    bx, by = nodes[i, k + 1].x, nodes[i, k + 1].y
    if memory.segments[slot].key != key:
        counter[COMPUTED] += 1
        row = next_entry(ax, ay, bx, by, arrays.tree, arrays.vertices, 0)
        memory.segments[slot].key = key
        memory.hits[slot, COUNT] = 0
        memory.hits[slot, ROW] = row
        memory.segments[slot].depth = (
            UNMEASURED if row >= 0 else _depth_at_pinches(nodes, i, k, arrays)
        )
    if memory.segments[slot].depth != 0.0:
        return False
    nodes[i, k].length = distance(ax, ay, bx, by)
    nodes[i, k].depth = 0.0
    nodes[i, k].hit_count = 0
    return True


@kernel
def evaluate_segment(
    nodes: np.ndarray,
    i: int,
    k: int,
    arrays: ObstacleArrays,
    memory: Memory,
    counter: np.ndarray,
) -> None:
    """Length, depth and hit obstacles of segment k of chromosome i, written into its node.

    Where no question is left, it is as deep as no other is, and hits nothing that is known.
    """
    if not evaluate_within(nodes, i, k, arrays, memory, 0.0, 0.0, np.inf, counter):
        nodes[i, k].length = distance(
            nodes[i, k].x, nodes[i, k].y, nodes[i, k + 1].x, nodes[i, k + 1].y
        )
        nodes[i, k].depth = OUT_OF_QUESTIONS
        nodes[i, k].hit_count = 0


@kernel
def evaluate_within(
    nodes: np.ndarray,
    i: int,
    k: int,
    arrays: ObstacleArrays,
    memory: Memory,
    cost: float,
    penalty: float,
    limit: float,
    counter: np.ndarray,
) -> bool:
    """Whether a path stays below a cost limit with segment k of chromosome i.

    cost : what all else costs, the length of the segment included.

    If so, all of the segment is written into its node. If not, measuring ends with the obstacle
    that is too much; should more be asked another time, it goes on from there. Where no question
    is left, the answer is no.
    """
    if not may_ask(counter):
        return False
    key = key_of(nodes[i, k].gene, nodes[i, k + 1].gene)
    slot = slot_of(memory.segments, key)
    if memory.segments[slot].key != key:
        counter[COMPUTED] += 1
        memory.segments[slot].key = key
        memory.segments[slot].depth = UNMEASURED
        memory.hits[slot, COUNT] = 0
        memory.hits[slot, ROW] = 0
    if memory.segments[slot].depth < 0.0:
        _measure(nodes, i, k, arrays, memory, slot, cost, penalty, limit)
    depth = memory.segments[slot].depth
    if depth < 0.0 or cost + depth * penalty >= limit:
        return False
    nodes[i, k].length = distance(
        nodes[i, k].x, nodes[i, k].y, nodes[i, k + 1].x, nodes[i, k + 1].y
    )
    nodes[i, k].depth = depth
    count = min(memory.hits[slot, COUNT], MAX_HITS)
    nodes[i, k].hit_count = count
    for h in range(count):
        nodes[i, k].hits[h] = memory.hits[slot, FIRST_HIT + h]
    return True


@kernel
def _measure(
    nodes: np.ndarray,
    i: int,
    k: int,
    arrays: ObstacleArrays,
    memory: Memory,
    slot: int,
    cost: float,
    penalty: float,
    limit: float,
) -> None:
    """Go on measuring the segment of a slot, until it is measured or costs too much."""
    ax, ay = nodes[i, k].x, nodes[i, k].y
    bx, by = nodes[i, k + 1].x, nodes[i, k + 1].y
    tree, vertices, groups = arrays.tree, arrays.vertices, arrays.groups
    known = memory.segments[slot].depth
    depth = 0.0 if known == UNMEASURED else -known
    count = memory.hits[slot, COUNT]
    row = memory.hits[slot, ROW]
    while depth == 0.0 or cost + depth * penalty < limit:
        row = next_entry(ax, ay, bx, by, tree, vertices, row)
        if row < 0:
            if count == 0:
                depth = _depth_at_pinches(nodes, i, k, arrays)
            memory.segments[slot].depth = depth
            memory.hits[slot, COUNT] = count
            return
        group = int(tree[row, GROUP])
        depth += escape_distance(ax, ay, bx, by, arrays, group)
        if count < MAX_HITS:
            memory.hits[slot, FIRST_HIT + count] = group
        count += 1
        row = int(groups[group, AFTER])
    memory.segments[slot].depth = -depth
    memory.hits[slot, COUNT] = count
    memory.hits[slot, ROW] = row


@kernel
def _depth_at_pinches(nodes: np.ndarray, i: int, k: int, arrays: ObstacleArrays) -> float:
    """Depth of segment k, which enters no obstacle: 0 but for one that a pinch point closes."""
    if arrays.pinches.shape[0] > 0 and _is_closed_by_pinch(
        nodes, i, k, arrays.pinches, arrays.ways
    ):
        return hair(arrays)
    return 0.0


@kernel
def sum_up(population: Population, i: int, penalty: float) -> None:
    """Cost of chromosome i, Eq. (1), and its number of infeasible segments, from its records."""
    nodes = population.nodes
    cost = 0.0
    infeasible = 0
    for k in range(population.chromosomes[i].intermediate + 1):
        cost += nodes[i, k].length + nodes[i, k].depth * penalty
        if nodes[i, k].depth > 0.0:
            infeasible += 1
    population.chromosomes[i].cost = cost
    population.chromosomes[i].infeasible = infeasible
