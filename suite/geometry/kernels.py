"""Collision of segments and paths with obstacles cut into convex parts.

Numba kernels over :class:`ObstacleArrays`: no validation, no allocation. Free space has the one
meaning that the whole suite shares: touching an obstacle is free, entering its interior is not,
and a passage of zero width (a seam, a pinch point, a slit along the border) is closed.
"""

from typing import NamedTuple

import numpy as np

from suite.geometry.predicates import ERROR_BOUND, orientation
from suite.jit import inlined_kernel, kernel


class ObstacleArrays(NamedTuple):
    """Obstacles and the frame around the workspace, as tables: (rows, columns) float64. Metres.

    An obstacle group is a set of convex parts that touch; the last group is the frame. Vertices
    run counter-clockwise, so that a part lies on the left of each of its edges. All tables have
    one type and there are few of them: handing an array to a kernel costs more than a box test.
    Numbers of rows are whole, "from" and "to" (exclusive).

    tree : boxes in preorder, of sets of groups, of groups (the paper's MMG), of sets of parts, and
        of convex parts (its MMO): XMIN, YMIN, XMAX, YMAX; SKIP, the row after the last descendant;
        GROUP, the group that it belongs to, or -1; FIRST to LAST, rows of the vertices of a part,
        or -1.
    vertices : x, y, and SEAM: 1 where the edge to the part's next vertex has solid on both sides.
    groups : XMIN, YMIN, XMAX, YMAX of a group; PARTS, their number; AFTER, the row of ``tree``
        after the group; FIRST_EDGE to LAST_EDGE, rows of ``boundary``; FIRST_CONTACT to
        LAST_CONTACT, rows of ``contacts``.
    boundary : x, y, x, y of the edges between a group and anything else.
    contacts : x, y, x, y of the stretches in which a group touches the frame, each in one piece,
        and of the points in which it does no more than that.
    pinches : x, y of a point where free space is cut by parts that meet in a point only; rows
        FIRST_WAY to LAST_WAY in ``ways``.
    ways : x, y, a direction into each part that meets a pinch point.
    """

    tree: np.ndarray
    vertices: np.ndarray
    groups: np.ndarray
    boundary: np.ndarray
    contacts: np.ndarray
    pinches: np.ndarray
    ways: np.ndarray


XMIN, YMIN, XMAX, YMAX = range(4)
SKIP, GROUP, FIRST, LAST = range(4, 8)
PARTS, AFTER, FIRST_EDGE, LAST_EDGE, FIRST_CONTACT, LAST_CONTACT = range(4, 10)
SEAM = 2
FIRST_WAY, LAST_WAY = 2, 3


@kernel
def _between(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> bool:
    """Whether p, known to lie on the line a-b, lies strictly between a and b."""
    if ax != bx:
        return min(ax, bx) < px < max(ax, bx)
    return min(ay, by) < py < max(ay, by)


@kernel
def _shares_seam(
    ax: float, ay: float, bx: float, by: float, px: float, py: float, qx: float, qy: float
) -> bool:
    """Whether segment a-b, on the line of seam p-q, has more than an end of the seam in common."""
    if ax == bx and ay == by:
        return _between(px, py, qx, qy, ax, ay)
    if px != qx:
        return max(min(ax, bx), min(px, qx)) < min(max(ax, bx), max(px, qx))
    return max(min(ay, by), min(py, qy)) < min(max(ay, by), max(py, qy))


@kernel
def _point_enters_part(x: float, y: float, vertices: np.ndarray, first: int, last: int) -> bool:
    """Whether a point lies in the interior of a convex part, or between the ends of its seams."""
    inside = True
    px, py = vertices[last, 0], vertices[last, 1]
    edge = last
    for i in range(first, last + 1):
        qx, qy = vertices[i, 0], vertices[i, 1]
        side = orientation(px, py, qx, qy, x, y)
        if side < 0:
            return False
        if side == 0:
            if vertices[edge, SEAM] != 0.0 and _between(px, py, qx, qy, x, y):
                return True
            inside = False
        px, py, edge = qx, qy, i
    return inside


@kernel
def _runs_along_seam(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    vertices: np.ndarray,
    first: int,
    last: int,
) -> bool:
    """Whether segment a-b lies on the line of a seam of a part and overlaps it."""
    px, py = vertices[last, 0], vertices[last, 1]
    edge = last
    for i in range(first, last + 1):
        qx, qy = vertices[i, 0], vertices[i, 1]
        if (
            vertices[edge, SEAM] != 0.0
            and orientation(bx, by, px, py, ax, ay) == 0
            and orientation(bx, by, qx, qy, ax, ay) == 0
            and _shares_seam(ax, ay, bx, by, px, py, qx, qy)
        ):
            return True
        px, py, edge = qx, qy, i
    return False


@kernel
def _segment_enters_part_exactly(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    vertices: np.ndarray,
    first: int,
    last: int,
) -> bool:
    """As :func:`segment_enters_part`, for two different ends, with exact signs throughout."""
    left = False
    right = False
    on_line = 0
    for i in range(first, last + 1):
        side = orientation(bx, by, vertices[i, 0], vertices[i, 1], ax, ay)
        left = left or side > 0
        right = right or side < 0
        on_line += side == 0
    if not (left and right):
        return on_line > 1 and _runs_along_seam(ax, ay, bx, by, vertices, first, last)
    px, py = vertices[last, 0], vertices[last, 1]
    for i in range(first, last + 1):
        qx, qy = vertices[i, 0], vertices[i, 1]
        if orientation(qx, qy, ax, ay, px, py) <= 0 and orientation(qx, qy, bx, by, px, py) <= 0:
            return False
        px, py = qx, qy
    return True


@inlined_kernel
def segment_enters_part(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    vertices: np.ndarray,
    first: int,
    last: int,
) -> bool:
    """Whether segment a-b meets the interior of a convex part, or runs along one of its seams.

    The part has the vertices ``first`` to ``last`` of ``vertices``. Separating axes: two convex
    sets in the plane are apart if and only if the line of one of their edges separates them
    (Gottschalk 1996). Touching is allowed, entering is not.

    The line of the segment comes first: it separates most parts whose box was met. Its signs are
    gathered without a branch, for no processor foresees them; where one of them is in doubt and
    matters, all is decided again, exactly.
    """
    if ax == bx and ay == by:
        return _point_enters_part(ax, ay, vertices, first, last)
    dx, dy = bx - ax, by - ay
    left = False
    right = False
    doubt = False
    for i in range(first, last + 1):
        ahead = dx * (vertices[i, 1] - ay)
        back = dy * (vertices[i, 0] - ax)
        side = ahead - back
        bound = ERROR_BOUND * (abs(ahead) + abs(back))
        left |= side > bound
        right |= side < -bound
        doubt |= abs(side) <= bound
    if not (left & right):
        return doubt and _segment_enters_part_exactly(ax, ay, bx, by, vertices, first, last)
    px, py = vertices[last, 0], vertices[last, 1]
    for i in range(first, last + 1):
        qx, qy = vertices[i, 0], vertices[i, 1]
        if orientation(qx, qy, ax, ay, px, py) <= 0 and orientation(qx, qy, bx, by, px, py) <= 0:
            return False
        px, py = qx, qy
    return True


@inlined_kernel
def next_entry(
    ax: float, ay: float, bx: float, by: float, tree: np.ndarray, vertices: np.ndarray, row: int
) -> int:
    """First row of ``tree``, from ``row`` on, whose part the segment a-b enters; -1 if none.

    Boxes first (paper II-B): a box that lies beside the segment's own box, or on one side of its
    line, is skipped with all that is in it.
    """
    if ax == bx and ay == by:
        return _next_entry_of_point(ax, ay, tree, vertices, row)
    xmin, xmax = min(ax, bx), max(ax, bx)
    ymin, ymax = min(ay, by), max(ay, by)
    nx, ny = by - ay, ax - bx
    wide, high = 0.5 * abs(nx), 0.5 * abs(ny)
    # Far more than the rounding of the test below, so that it never skips what is touched.
    largest = max(-tree[0, XMIN], -tree[0, YMIN], tree[0, XMAX], tree[0, YMAX])
    slack = 1e-14 * largest * (abs(nx) + abs(ny))
    while row < tree.shape[0]:
        x0, y0, x1, y1 = tree[row, XMIN], tree[row, YMIN], tree[row, XMAX], tree[row, YMAX]
        # | and not or: five tests in one branch, for no processor foresees them.
        if (
            (xmin > x1)
            | (xmax < x0)
            | (ymin > y1)
            | (ymax < y0)
            | (
                abs(nx * (0.5 * (x0 + x1) - ax) + ny * (0.5 * (y0 + y1) - ay))
                > wide * (x1 - x0) + high * (y1 - y0) + slack
            )
        ):
            row = int(tree[row, SKIP])
            continue
        first = int(tree[row, FIRST])
        if first >= 0 and segment_enters_part(
            ax, ay, bx, by, vertices, first, int(tree[row, LAST]) - 1
        ):
            return row
        row += 1
    return -1


@kernel
def _next_entry_of_point(
    x: float, y: float, tree: np.ndarray, vertices: np.ndarray, start: int
) -> int:
    """First row of ``tree``, from ``start`` on, whose part holds the point in closed space.

    That is its interior, a seam, or a vertex around which there is nothing but parts and seams.
    """
    inner = -1
    is_open = False
    row = 0
    while row < tree.shape[0]:
        if x > tree[row, XMAX] or x < tree[row, XMIN] or y > tree[row, YMAX] or y < tree[row, YMIN]:
            row = int(tree[row, SKIP])
            continue
        first, last = int(tree[row, FIRST]), int(tree[row, LAST]) - 1
        if first >= 0:
            if row >= start and _point_enters_part(x, y, vertices, first, last):
                return row
            before = last
            for i in range(first, last + 1):
                if vertices[i, 0] == x and vertices[i, 1] == y:
                    if vertices[before, SEAM] == 0.0 or vertices[i, SEAM] == 0.0:
                        is_open = True
                    elif inner < 0 and row >= start:
                        inner = row
                before = i
        row += 1
    return -1 if is_open else inner


@kernel
def _cross(ux: float, uy: float, vx: float, vy: float) -> float:
    return ux * vy - uy * vx


@kernel
def _way_is_left(ux: float, uy: float, wx: float, wy: float, mx: float, my: float) -> bool:
    """Whether direction m lies strictly inside the counter-clockwise turn from u to w."""
    turn = _cross(ux, uy, wx, wy)
    if turn < 0.0:
        return not (_cross(wx, wy, mx, my) >= 0.0 and _cross(mx, my, ux, uy) >= 0.0)
    return _cross(ux, uy, mx, my) > 0.0 and (turn == 0.0 or _cross(mx, my, wx, wy) > 0.0)


@kernel
def turn_is_closed(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    pinches: np.ndarray,
    ways: np.ndarray,
    pinch: int,
) -> bool:
    """Whether a path a -> pinch point -> b slips between two parts that meet in that point.

    It does if there is solid on both of its sides: then no path with clearance comes near it.
    """
    x, y = pinches[pinch, 0], pinches[pinch, 1]
    ux, uy = ax - x, ay - y
    wx, wy = bx - x, by - y
    if _cross(ux, uy, wx, wy) == 0.0 and ux * wx + uy * wy > 0.0:
        return False  # back the way it came
    left = False
    right = False
    for i in range(int(pinches[pinch, FIRST_WAY]), int(pinches[pinch, LAST_WAY])):
        if _way_is_left(ux, uy, wx, wy, ways[i, 0], ways[i, 1]):
            left = True
        else:
            right = True
    return left and right


@kernel
def segment_slips_through(
    ax: float, ay: float, bx: float, by: float, pinches: np.ndarray, ways: np.ndarray
) -> bool:
    """Whether segment a-b passes between two parts through the point in which they meet."""
    for k in range(pinches.shape[0]):
        x, y = pinches[k, 0], pinches[k, 1]
        if (
            orientation(ax, ay, bx, by, x, y) == 0
            and _between(ax, ay, bx, by, x, y)
            and turn_is_closed(ax, ay, bx, by, pinches, ways, k)
        ):
            return True
    return False


@kernel
def segment_enters_tables(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    tree: np.ndarray,
    vertices: np.ndarray,
    pinches: np.ndarray,
    ways: np.ndarray,
) -> bool:
    """Whether segment a-b leaves free space: enters an obstacle, the frame, or a closed passage.

    With only the tables that it reads, for callers that come from Python for every segment.
    """
    if next_entry(ax, ay, bx, by, tree, vertices, 0) >= 0:
        return True
    return segment_slips_through(ax, ay, bx, by, pinches, ways)


@kernel
def segment_enters(ax: float, ay: float, bx: float, by: float, arrays: ObstacleArrays) -> bool:
    """Whether segment a-b leaves free space: enters an obstacle, the frame, or a closed passage."""
    return segment_enters_tables(
        ax, ay, bx, by, arrays.tree, arrays.vertices, arrays.pinches, arrays.ways
    )


@kernel
def pinch_at(x: float, y: float, pinches: np.ndarray) -> int:
    """Row of the pinch point at (x, y), or -1."""
    for k in range(pinches.shape[0]):
        if pinches[k, 0] == x and pinches[k, 1] == y:
            return k
    return -1


@kernel
def first_collision(path: np.ndarray, arrays: ObstacleArrays) -> int:
    """Index of the first segment of a path (n, 2) that leaves free space, or -1.

    A bend at a pinch point that slips between its parts counts for the segment that arrives: only
    a path that is checked as a whole, and not segment by segment, shows it.

    Parameters
    ----------
    path : (n, 2) array of numbers, metres
    arrays : ObstacleArrays
        ``scene.arrays``.
    """
    for i in range(path.shape[0] - 1):
        # Plugins give whole numbers, and float32, too.
        ax, ay = np.float64(path[i, 0]), np.float64(path[i, 1])
        bx, by = np.float64(path[i + 1, 0]), np.float64(path[i + 1, 1])
        if segment_enters(ax, ay, bx, by, arrays):
            return i
        k = pinch_at(bx, by, arrays.pinches)
        j = i + 2
        while k >= 0 and j < path.shape[0] and path[j, 0] == bx and path[j, 1] == by:
            j += 1  # a path that waits in the pinch point bends there all the same
        arrives = k >= 0 and not (ax == bx and ay == by)
        if arrives and j < path.shape[0]:
            cx, cy = np.float64(path[j, 0]), np.float64(path[j, 1])
            if turn_is_closed(ax, ay, cx, cy, arrays.pinches, arrays.ways, k):
                return i
    return -1
