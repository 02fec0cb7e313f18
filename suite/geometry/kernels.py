"""Collision of segments and paths with obstacles cut into convex parts.

Numba kernels over :class:`ObstacleArrays`: no validation, no allocation. Free space has the one
meaning that the whole suite shares: touching an obstacle is free, entering its interior is not,
and a passage of zero width (a seam, a pinch point, a slit along the border) is closed.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from suite.geometry.predicates import orientation


class ObstacleArrays(NamedTuple):
    """Obstacles and the frame around the workspace, as flat arrays. Metres.

    An obstacle group is a set of convex parts that touch; the last group is the frame. Vertices
    run counter-clockwise, so that a part lies on the left of each of its edges.

    part_xy : (V, 2) float64, vertices of all parts, one part after the other.
    part_start : (P + 1,) int64, rows of ``part_xy`` where each part begins.
    part_box : (P, 4) float64, xmin, ymin, xmax, ymax of each part (the paper's MMO).
    seam : (V,) uint8, 1 where the edge from vertex i to the next has solid on both sides.
    group_start : (G + 1,) int64, parts where each group begins.
    group_box : (G, 4) float64, xmin, ymin, xmax, ymax of each group (the paper's MMG).
    boundary : (E, 4) float64, x, y, x, y of the edges between a group and anything else.
    boundary_start : (G + 1,) int64, rows of ``boundary`` where each group begins.
    border : (B, 4) float64, the stretches (or points) in which a group touches the frame.
    border_start : (G + 1,) int64, rows of ``border`` where each group begins.
    pinch_xy : (K, 2) float64, points where free space is cut by parts that meet in a point only.
    pinch_start : (K + 1,) int64, rows of ``pinch_way`` where each pinch point begins.
    pinch_way : (W, 2) float64, a direction into each part that meets the pinch point.
    """

    part_xy: np.ndarray
    part_start: np.ndarray
    part_box: np.ndarray
    seam: np.ndarray
    group_start: np.ndarray
    group_box: np.ndarray
    boundary: np.ndarray
    boundary_start: np.ndarray
    border: np.ndarray
    border_start: np.ndarray
    pinch_xy: np.ndarray
    pinch_start: np.ndarray
    pinch_way: np.ndarray


@njit(cache=True)
def _between(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> bool:
    """Whether p, known to lie on the line a-b, lies strictly between a and b."""
    if ax != bx:
        return min(ax, bx) < px < max(ax, bx)
    return min(ay, by) < py < max(ay, by)


@njit(cache=True)
def _shares_seam(
    ax: float, ay: float, bx: float, by: float, px: float, py: float, qx: float, qy: float
) -> bool:
    """Whether segment a-b, on the line of seam p-q, has more than an end of the seam in common."""
    if ax == bx and ay == by:
        return _between(px, py, qx, qy, ax, ay)
    if px != qx:
        return max(min(ax, bx), min(px, qx)) < min(max(ax, bx), max(px, qx))
    return max(min(ay, by), min(py, qy)) < min(max(ay, by), max(py, qy))


@njit(cache=True)
def _point_enters_part(
    x: float, y: float, part_xy: np.ndarray, seam: np.ndarray, first: int, last: int
) -> bool:
    """Whether a point lies in the interior of a convex part, or between the ends of its seams."""
    inside = True
    px, py = part_xy[last, 0], part_xy[last, 1]
    edge = last
    for i in range(first, last + 1):
        qx, qy = part_xy[i, 0], part_xy[i, 1]
        side = orientation(px, py, qx, qy, x, y)
        if side < 0:
            return False
        if side == 0:
            if seam[edge] and _between(px, py, qx, qy, x, y):
                return True
            inside = False
        px, py, edge = qx, qy, i
    return inside


@njit(cache=True)
def _runs_along_seam(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    part_xy: np.ndarray,
    seam: np.ndarray,
    first: int,
    last: int,
) -> bool:
    """Whether segment a-b lies on the line of a seam of a part and overlaps it."""
    px, py = part_xy[last, 0], part_xy[last, 1]
    edge = last
    for i in range(first, last + 1):
        qx, qy = part_xy[i, 0], part_xy[i, 1]
        if (
            seam[edge]
            and orientation(bx, by, px, py, ax, ay) == 0
            and orientation(bx, by, qx, qy, ax, ay) == 0
            and _shares_seam(ax, ay, bx, by, px, py, qx, qy)
        ):
            return True
        px, py, edge = qx, qy, i
    return False


@njit(cache=True, forceinline=True)
def segment_enters_part(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    part_xy: np.ndarray,
    seam: np.ndarray,
    first: int,
    last: int,
) -> bool:
    """Whether segment a-b meets the interior of a convex part, or runs along one of its seams.

    The part has the vertices ``first`` to ``last`` of ``part_xy``. Separating axes: two convex
    sets in the plane are apart if and only if the line of one of their edges separates them
    (Gottschalk 1996). Touching is allowed, entering is not.
    """
    if ax == bx and ay == by:
        return _point_enters_part(ax, ay, part_xy, seam, first, last)
    # The line of the segment first: it separates most parts whose box was met.
    left = False
    right = False
    on_line = 0
    for i in range(first, last + 1):
        side = orientation(bx, by, part_xy[i, 0], part_xy[i, 1], ax, ay)
        left = left or side > 0
        right = right or side < 0
        on_line += side == 0
    if not (left and right):
        return on_line > 1 and _runs_along_seam(ax, ay, bx, by, part_xy, seam, first, last)
    px, py = part_xy[last, 0], part_xy[last, 1]
    for i in range(first, last + 1):
        qx, qy = part_xy[i, 0], part_xy[i, 1]
        if (
            orientation(qx, qy, ax, ay, px, py) <= 0
            and orientation(qx, qy, bx, by, px, py) <= 0
        ):
            return False
        px, py = qx, qy
    return True


@njit(cache=True, forceinline=True)
def _boxes_apart(
    xmin: float, xmax: float, ymin: float, ymax: float, boxes: np.ndarray, i: int
) -> bool:
    """Whether a box and box i of ``boxes`` have no point in common."""
    return (
        xmin > boxes[i, 2] or xmax < boxes[i, 0] or ymin > boxes[i, 3] or ymax < boxes[i, 1]
    )


@njit(cache=True, forceinline=True)
def next_group_entered(
    ax: float, ay: float, bx: float, by: float, arrays: ObstacleArrays, group: int
) -> int:
    """First obstacle group, from number ``group`` on, that segment a-b enters; -1 if none.

    Boxes first: those of the groups, then those of their parts (paper II-B).
    """
    # Each access to a field of the tuple counts references, which costs more than a box test.
    group_box, group_start = arrays.group_box, arrays.group_start
    part_box, part_start = arrays.part_box, arrays.part_start
    part_xy, seam = arrays.part_xy, arrays.seam
    xmin, xmax = min(ax, bx), max(ax, bx)
    ymin, ymax = min(ay, by), max(ay, by)
    for g in range(group, group_box.shape[0]):
        if _boxes_apart(xmin, xmax, ymin, ymax, group_box, g):
            continue
        for part in range(group_start[g], group_start[g + 1]):
            if _boxes_apart(xmin, xmax, ymin, ymax, part_box, part):
                continue
            first, last = part_start[part], part_start[part + 1] - 1
            if segment_enters_part(ax, ay, bx, by, part_xy, seam, first, last):
                return g
        if ax == bx and ay == by and _is_inner_vertex(ax, ay, arrays, g):
            return g
    return -1


@njit(cache=True)
def _is_inner_vertex(x: float, y: float, arrays: ObstacleArrays, group: int) -> bool:
    """Whether point (x, y) is a vertex of the group with solid, parts and seams, all around it."""
    part_xy, part_start, seam = arrays.part_xy, arrays.part_start, arrays.seam
    found = False
    for part in range(part_start.size - 1):
        last = part_start[part + 1] - 1
        before = last
        for i in range(part_start[part], last + 1):
            if part_xy[i, 0] == x and part_xy[i, 1] == y:
                if not (seam[before] and seam[i]):
                    return False
                if arrays.group_start[group] <= part < arrays.group_start[group + 1]:
                    found = True
            before = i
    return found


@njit(cache=True)
def _cross(ux: float, uy: float, vx: float, vy: float) -> float:
    return ux * vy - uy * vx


@njit(cache=True)
def _way_is_left(ux: float, uy: float, wx: float, wy: float, mx: float, my: float) -> bool:
    """Whether direction m lies strictly inside the counter-clockwise turn from u to w."""
    turn = _cross(ux, uy, wx, wy)
    if turn < 0.0:
        return not (_cross(wx, wy, mx, my) >= 0.0 and _cross(mx, my, ux, uy) >= 0.0)
    return _cross(ux, uy, mx, my) > 0.0 and (turn == 0.0 or _cross(mx, my, wx, wy) > 0.0)


@njit(cache=True)
def turn_is_closed(
    ax: float, ay: float, bx: float, by: float, arrays: ObstacleArrays, pinch: int
) -> bool:
    """Whether a path a -> pinch point -> b slips between two parts that meet in that point.

    It does if there is solid on both of its sides: then no path with clearance comes near it.
    """
    x = arrays.pinch_xy[pinch, 0]
    y = arrays.pinch_xy[pinch, 1]
    ux, uy = ax - x, ay - y
    wx, wy = bx - x, by - y
    if _cross(ux, uy, wx, wy) == 0.0 and ux * wx + uy * wy > 0.0:
        return False  # back the way it came
    left = False
    right = False
    for i in range(arrays.pinch_start[pinch], arrays.pinch_start[pinch + 1]):
        if _way_is_left(ux, uy, wx, wy, arrays.pinch_way[i, 0], arrays.pinch_way[i, 1]):
            left = True
        else:
            right = True
    return left and right


@njit(cache=True)
def segment_slips_through(
    ax: float, ay: float, bx: float, by: float, arrays: ObstacleArrays
) -> bool:
    """Whether segment a-b passes between two parts through the point in which they meet."""
    for k in range(arrays.pinch_xy.shape[0]):
        x = arrays.pinch_xy[k, 0]
        y = arrays.pinch_xy[k, 1]
        if (
            orientation(ax, ay, bx, by, x, y) == 0
            and _between(ax, ay, bx, by, x, y)
            and turn_is_closed(ax, ay, bx, by, arrays, k)
        ):
            return True
    return False


@njit(cache=True)
def segment_enters(ax: float, ay: float, bx: float, by: float, arrays: ObstacleArrays) -> bool:
    """Whether segment a-b leaves free space: enters an obstacle, the frame, or a closed passage."""
    if next_group_entered(ax, ay, bx, by, arrays, 0) >= 0:
        return True
    return arrays.pinch_xy.shape[0] > 0 and segment_slips_through(ax, ay, bx, by, arrays)


@njit(cache=True)
def pinch_at(x: float, y: float, arrays: ObstacleArrays) -> int:
    """Index of the pinch point at (x, y), or -1."""
    for k in range(arrays.pinch_xy.shape[0]):
        if arrays.pinch_xy[k, 0] == x and arrays.pinch_xy[k, 1] == y:
            return k
    return -1


@njit(cache=True)
def first_collision(path: np.ndarray, arrays: ObstacleArrays) -> int:
    """Index of the first segment of a path (n, 2) that leaves free space, or -1.

    A bend at a pinch point that slips between its parts counts for the segment that arrives.
    """
    for i in range(path.shape[0] - 1):
        ax, ay = path[i, 0], path[i, 1]
        bx, by = path[i + 1, 0], path[i + 1, 1]
        if segment_enters(ax, ay, bx, by, arrays):
            return i
        k = pinch_at(bx, by, arrays)
        j = i + 2
        while k >= 0 and j < path.shape[0] and path[j, 0] == bx and path[j, 1] == by:
            j += 1  # a path that waits in the pinch point bends there all the same
        arrives = k >= 0 and not (ax == bx and ay == by)
        if (
            arrives
            and j < path.shape[0]
            and turn_is_closed(ax, ay, path[j, 0], path[j, 1], arrays, k)
        ):
            return i
    return -1
