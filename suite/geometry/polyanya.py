"""The shortest path over a navigation mesh, after Polyanya (Cui, Harabor and Grastien 2017).

What the search pushes forward is not a point but a cone: all that is seen from a corner through a
side of a triangle. A cone is kept by the corners that bound it and not, as there, by the places
where it cuts that side: so what it sees is decided by exact signs of input coordinates alone, and
only lengths are rounded. Where a cone has one way on it goes on, without a look at the others.
Kernels: no validation. Metres.
"""

import numpy as np

from suite.geometry.mesh import BENDS, FIRST, LAST, ORIGIN, WAY, Mesh, following, preceding, side_of
from suite.jit import allocating_kernel, inlined_kernel, kernel

ROUNDING = 8.0 * 2.0**-53
"""Bounds the rounding of the numbers below, relative to the magnitude of what is subtracted."""

# Columns of nodes: the vertices of the mesh, then the start, then the goal. COST is the length of
# the shortest path known to a node, PARENT the node before it on that path, CLOSED whether there
# can be no shorter one.
X, Y, COST, PARENT, CLOSED = range(5)

# Columns of the queue, a binary heap of cones. LEAST is the least length of a path through a cone,
# ENTRY the half-edge by which it enters a triangle, ROOT the node that it is seen from, LEFT and
# RIGHT the corners on the rays that bound it; where a path goes straight on past the root, that ray
# is the root's own, from its parent on. A negative ENTRY is a node, ROOT, that is to be left.
LEAST, ENTRY, ROOT, LEFT, RIGHT = range(5)
NOWHERE = -1

HAS_GOAL, LEADS_ON = 1, 2
"""Marks of triangles: the goal lies there; it lies in a pocket, and this is the way to it."""

IN_A_ROW = 64
"""Triangles that a cone is pushed through at a time."""


@allocating_kernel
def nodes_of_shortest_path(
    sx: float, sy: float, gx: float, gy: float, mesh: Mesh
) -> tuple[np.ndarray, int]:
    """Nodes of the shortest path between two places, and how many triangles were looked into.

    Node i is vertex i of the mesh, the next one the start, the last one the goal; no nodes if there
    is no path.
    """
    half_edges, fans = mesh.half_edges, mesh.fans
    n = mesh.vertices.shape[0]
    start, goal = n, n + 1
    nodes = np.empty((n + 2, 5))
    for i in range(n):
        _set_node(nodes, i, mesh.vertices[i, 0], mesh.vertices[i, 1])
    _set_node(nodes, start, sx, sy)
    _set_node(nodes, goal, gx, gy)
    nodes[start, COST] = 0.0
    marks = np.zeros(mesh.outward.shape[0], dtype=np.uint8)
    _mark_goal(mesh.boxes, half_edges, mesh.outward, nodes, marks)
    # A triangle adds seven rows at most: three corners, three cones and the goal, to the start's.
    most = 8 * (mesh.most + IN_A_ROW)
    queue = np.empty((4 * most, 5))
    queue[0, LEAST], queue[0, ENTRY], queue[0, ROOT] = 0.0, NOWHERE - start, start
    checks = 0
    size = int(np.int64(1))  # a literal has a type of its own: all would be compiled twice
    while size > 0:
        if size + most > queue.shape[0]:
            queue = _larger(queue, size)
        if queue[0, ENTRY] >= 0.0:
            seen, size = _follow(half_edges, fans, nodes, marks, queue, size)
            checks += seen
            continue
        bound, node = queue[0, LEAST], int(queue[0, ROOT])
        size = _pop(queue, size)
        if nodes[node, CLOSED] != 0.0:
            continue
        nodes[node, CLOSED] = 1.0
        if node == goal:
            return _trace_back(nodes), checks
        if node == start:
            seen, size = _leave_start(mesh.boxes, half_edges, fans, nodes, marks, queue, size)
        else:
            seen, size = _turn(half_edges, fans, nodes, marks, queue, size, bound, node)
        checks += seen
    return np.empty(0, dtype=np.int64), checks


@inlined_kernel
def _set_node(nodes: np.ndarray, i: int, x: float, y: float) -> None:
    nodes[i, X], nodes[i, Y] = x, y
    nodes[i, COST], nodes[i, PARENT], nodes[i, CLOSED] = np.inf, -1.0, 0.0


@allocating_kernel
def _larger(queue: np.ndarray, size: int) -> np.ndarray:
    larger = np.empty((2 * queue.shape[0], queue.shape[1]))
    for row in range(size):
        for column in range(queue.shape[1]):
            larger[row, column] = queue[row, column]
    return larger


@allocating_kernel
def _trace_back(nodes: np.ndarray) -> np.ndarray:
    count = 0
    node = nodes.shape[0] - 1
    while node >= 0:
        node = int(nodes[node, PARENT])
        count += 1
    order = np.empty(count, dtype=np.int64)
    node = nodes.shape[0] - 1
    for i in range(count - 1, -1, -1):
        order[i] = node
        node = int(nodes[node, PARENT])
    return order


@inlined_kernel
def _copy(queue: np.ndarray, row: int, to: int) -> None:
    for column in range(queue.shape[1]):
        queue[to, column] = queue[row, column]


@kernel
def _push(
    queue: np.ndarray, size: int, least: float, entry: int, root: int, left: int, right: int
) -> int:
    """Add a row to a heap; return the new number of rows."""
    at = size
    while at > 0 and queue[(at - 1) >> 1, LEAST] > least:
        _copy(queue, (at - 1) >> 1, at)
        at = (at - 1) >> 1
    queue[at, LEAST] = least
    queue[at, ENTRY], queue[at, ROOT] = entry, root
    queue[at, LEFT], queue[at, RIGHT] = left, right
    return size + 1


@kernel
def _pop(queue: np.ndarray, size: int) -> int:
    """Take the first row from a heap; return the new number of rows."""
    size -= 1
    at, child = 0, 1
    while child < size:  # what was the last row is still there, and sinks from the top
        if child + 1 < size and queue[child + 1, LEAST] < queue[child, LEAST]:
            child += 1
        if queue[child, LEAST] >= queue[size, LEAST]:
            break
        _copy(queue, child, at)
        at, child = child, 2 * child + 1
    _copy(queue, size, at)
    return size


@inlined_kernel
def _holds(boxes: np.ndarray, half_edges: np.ndarray, nodes: np.ndarray, t: int, node: int) -> bool:
    """Whether a node lies in a triangle or on its border."""
    x, y = nodes[node, X], nodes[node, Y]
    if (x < boxes[t, 0]) | (y < boxes[t, 1]) | (x > boxes[t, 2]) | (y > boxes[t, 3]):
        return False
    for h in range(3 * t, 3 * t + 3):
        if side_of(nodes, half_edges[h, ORIGIN], half_edges[following(h), ORIGIN], node) < 0:
            return False
    return True


@kernel
def _mark_goal(
    boxes: np.ndarray,
    half_edges: np.ndarray,
    outward: np.ndarray,
    nodes: np.ndarray,
    marks: np.ndarray,
) -> None:
    """Mark the triangles of the goal, and those on the way out of its pocket."""
    goal = nodes.shape[0] - 1
    for t in range(outward.shape[0]):
        if not _holds(boxes, half_edges, nodes, t, goal):
            continue
        marks[t] |= HAS_GOAL | LEADS_ON
        way = t
        while outward[way] >= 0:
            way = half_edges[outward[way], WAY] // 3
            marks[way] |= LEADS_ON


@inlined_kernel
def _entry(half_edges: np.ndarray, marks: np.ndarray, h: int) -> int:
    """Half-edge by which one enters the next triangle; NOWHERE if it leads to no goal."""
    way = half_edges[h, WAY]
    if way >= NOWHERE:
        return way
    return -way - 2 if marks[(-way - 2) // 3] & LEADS_ON else NOWHERE


@kernel
def _distance(nodes: np.ndarray, a: int, b: int) -> float:
    return np.sqrt((nodes[a, X] - nodes[b, X]) ** 2 + (nodes[a, Y] - nodes[b, Y]) ** 2)


@kernel
def _reach(nodes: np.ndarray, queue: np.ndarray, size: int, node: int, root: int) -> int:
    """Come straight from a root to a node that it sees; queue the node if that is shorter."""
    cost = nodes[root, COST] + _distance(nodes, root, node)
    if cost >= nodes[node, COST]:
        return size
    nodes[node, COST] = cost
    nodes[node, PARENT] = root
    least = cost + _distance(nodes, node, nodes.shape[0] - 1)
    return _push(queue, size, least, NOWHERE - node, node, node, node)


@kernel
def _reach_corner(
    half_edges: np.ndarray,
    fans: np.ndarray,
    nodes: np.ndarray,
    queue: np.ndarray,
    size: int,
    v: int,
    root: int,
) -> int:
    """Come to a corner that a root sees, if the line there leaves its solid on one side."""
    if nodes[v, CLOSED] != 0.0 or (nodes[v, X] == nodes[root, X] and nodes[v, Y] == nodes[root, Y]):
        return size
    after, before = (
        half_edges[following(fans[v, FIRST]), ORIGIN],
        half_edges[preceding(fans[v, LAST]), ORIGIN],
    )
    if side_of(nodes, root, v, after) * side_of(nodes, root, v, before) < 0:
        return size
    return _reach(nodes, queue, size, v, root)


@kernel
def _leave_start(
    boxes: np.ndarray,
    half_edges: np.ndarray,
    fans: np.ndarray,
    nodes: np.ndarray,
    marks: np.ndarray,
    queue: np.ndarray,
    size: int,
) -> tuple[int, int]:
    """Queue all that the start sees; the number of triangles that it lies in, and of rows."""
    goal = nodes.shape[0] - 1
    start = goal - 1
    found = 0
    for t in range(boxes.shape[0]):
        if not _holds(boxes, half_edges, nodes, t, start):
            continue
        found += 1
        if marks[t] & HAS_GOAL:
            size = _reach(nodes, queue, size, goal, start)
        for h in range(3 * t, 3 * t + 3):
            a, b = half_edges[h, ORIGIN], half_edges[following(h), ORIGIN]
            if half_edges[h, BENDS]:
                size = _reach_corner(half_edges, fans, nodes, queue, size, a, start)
            if side_of(nodes, a, b, start) > 0:
                size = _queue(half_edges, nodes, marks, queue, size, 0.0, h, start, b, a)
    return found, size


@kernel
def _queue(
    half_edges: np.ndarray,
    nodes: np.ndarray,
    marks: np.ndarray,
    queue: np.ndarray,
    size: int,
    bound: float,
    h: int,
    root: int,
    left: int,
    right: int,
) -> int:
    """Queue the cone that leaves a triangle by a half-edge, if it leads anywhere."""
    entry = _entry(half_edges, marks, h)
    if entry == NOWHERE:
        return size
    least = max(bound, _least(half_edges, nodes, h, root, left, right))
    return _push(queue, size, least, entry, root, left, right)


@kernel
def _least(
    half_edges: np.ndarray, nodes: np.ndarray, h: int, root: int, left: int, right: int
) -> float:
    """Least length of a path through a root and what a cone leaves of a side, to the goal, metres.

    The side is that of half-edge h, by which the cone leaves a triangle. It never comes out longer
    than it is: that alone is what the search relies on.
    """
    a, b = half_edges[following(h), ORIGIN], half_edges[h, ORIGIN]  # as seen: on the left, right
    goal = nodes.shape[0] - 1
    rx, ry = nodes[root, X], nodes[root, Y]
    ax, ay = nodes[a, X] - rx, nodes[a, Y] - ry
    ex, ey = nodes[b, X] - nodes[a, X], nodes[b, Y] - nodes[a, Y]
    gx, gy = nodes[goal, X] - rx, nodes[goal, Y] - ry
    behind = ey * (gx - ax) - ex * (gy - ay)
    if behind > 0.0:  # a way to the side and back is as long as one to the goal's mirror image
        share = 2.0 * behind / (ex * ex + ey * ey)
        gx -= share * ey
        gy += share * ex
    origin = int(nodes[root, PARENT]) if left == root else root
    dx, dy = nodes[left, X] - nodes[origin, X], nodes[left, Y] - nodes[origin, Y]
    if dx * gy - dy * gx <= 0.0:
        origin = int(nodes[root, PARENT]) if right == root else root
        dx, dy = nodes[right, X] - nodes[origin, X], nodes[right, Y] - nodes[origin, Y]
        if dx * gy - dy * gx >= 0.0:
            return nodes[root, COST] + np.sqrt(gx * gx + gy * gy)
    # Where the ray in direction d cuts the side, as a share of it.
    divisor = dx * ey - dy * ex
    error = ROUNDING * (abs(ax * dy) + abs(ay * dx) + abs(dx * ey) + abs(dy * ex))
    if abs(divisor) <= error:
        return nodes[root, COST] + np.sqrt(gx * gx + gy * gy)
    share = min(1.0, max(0.0, (ax * dy - ay * dx) / divisor))
    x, y = ax + share * ex, ay + share * ey
    way = np.sqrt(x * x + y * y) + np.sqrt((gx - x) ** 2 + (gy - y) ** 2)
    slack = 2.0 * error / abs(divisor) * np.sqrt(ex * ex + ey * ey)
    return nodes[root, COST] + way - slack


@inlined_kernel
def _side_of_ray(nodes: np.ndarray, root: int, tip: int, c: int) -> int:
    """Side of a cone's ray on which a node lies."""
    if tip == root:
        return side_of(nodes, int(nodes[root, PARENT]), root, c)
    return side_of(nodes, root, tip, c)


@kernel
def _follow(
    half_edges: np.ndarray,
    fans: np.ndarray,
    nodes: np.ndarray,
    marks: np.ndarray,
    queue: np.ndarray,
    size: int,
) -> tuple[int, int]:
    """Push the first cone forward while it is the best; the number of triangles, and of rows."""
    goal = nodes.shape[0] - 1
    bound, entry, root = queue[0, LEAST], int(queue[0, ENTRY]), int(queue[0, ROOT])
    left, right = int(queue[0, LEFT]), int(queue[0, RIGHT])
    size = _pop(queue, size)
    for seen in range(1, IN_A_ROW + 1):
        if (
            marks[entry // 3] & HAS_GOAL
            and _side_of_ray(nodes, root, left, goal) <= 0
            and _side_of_ray(nodes, root, right, goal) >= 0
        ):
            size = _reach(nodes, queue, size, goal, root)
        # On its left the triangle ends with the side from the apex, on its right with that to it.
        on_left, on_right = preceding(entry), following(entry)
        apex = half_edges[on_left, ORIGIN]
        of_left = _side_of_ray(nodes, root, left, apex)
        of_right = _side_of_ray(nodes, root, right, apex)
        if of_left <= 0 and of_right >= 0 and half_edges[on_left, BENDS]:
            size = _reach_corner(half_edges, fans, nodes, queue, size, apex, root)
        entry, other = NOWHERE, NOWHERE
        if of_left < 0:
            entry = _entry(half_edges, marks, on_left)
        if of_right > 0:
            other = _entry(half_edges, marks, on_right)
        one_right = apex if of_right > 0 else right
        two_left = apex if of_left < 0 else left
        if entry == NOWHERE and other == NOWHERE:
            return seen, size
        if other == NOWHERE:  # the only way on: nothing to choose
            right = one_right
        elif entry == NOWHERE:
            entry, left = other, two_left
        else:
            one = max(bound, _least(half_edges, nodes, on_left, root, left, one_right))
            two = max(bound, _least(half_edges, nodes, on_right, root, two_left, right))
            if two < one:
                size = _push(queue, size, one, entry, root, left, one_right)
                bound, entry, left = two, other, two_left
            else:
                size = _push(queue, size, two, other, root, two_left, right)
                bound, right = one, one_right
            if queue[0, LEAST] < bound:
                break
    return seen, _push(queue, size, bound, entry, root, left, right)


@kernel
def _turn(
    half_edges: np.ndarray,
    fans: np.ndarray,
    nodes: np.ndarray,
    marks: np.ndarray,
    queue: np.ndarray,
    size: int,
    bound: float,
    v: int,
) -> tuple[int, int]:
    """Queue what is seen from a corner by paths that turn around its solid, or go straight on.

    From the solid, which lies on one side of the way to the corner, triangle by triangle to the
    prolongation of that way. Exactly: rounding here would prune collinear routes. Returns the
    number of triangles, and of rows.
    """
    goal = nodes.shape[0] - 1
    p = int(nodes[v, PARENT])
    side = side_of(nodes, p, v, half_edges[following(fans[v, FIRST]), ORIGIN])
    if side == 0:
        side = side_of(nodes, p, v, half_edges[preceding(fans[v, LAST]), ORIGIN])
    h = fans[v, FIRST] if side < 0 else fans[v, LAST]
    near = following(h) if side < 0 else preceding(h)
    if half_edges[near, BENDS]:
        size = _reach_corner(half_edges, fans, nodes, queue, size, half_edges[near, ORIGIN], v)
    seen = 0
    while h >= 0:
        seen += 1
        near = following(h) if side < 0 else preceding(h)
        far = preceding(h) if side < 0 else following(h)
        a, b = half_edges[near, ORIGIN], half_edges[far, ORIGIN]
        if marks[h // 3] & HAS_GOAL and side * side_of(nodes, p, v, goal) >= 0:
            size = _reach(nodes, queue, size, goal, v)
        if side * side_of(nodes, p, v, a) <= 0:
            break
        of_far = side * side_of(nodes, p, v, b)
        if of_far < 0:
            b = v  # the cone ends with the prolongation
        left, right = (b, a) if side < 0 else (a, b)
        size = _queue(half_edges, nodes, marks, queue, size, bound, following(h), v, left, right)
        if of_far < 0:
            break
        if half_edges[far, BENDS]:
            size = _reach_corner(half_edges, fans, nodes, queue, size, b, v)
        h = _beside(half_edges, h, side)
    return seen, size


@kernel
def _beside(half_edges: np.ndarray, h: int, side: int) -> int:
    """The half-edge from the same origin in the next triangle: counter-clockwise if side < 0."""
    way = half_edges[preceding(h) if side < 0 else h, WAY]
    if way == NOWHERE:
        return NOWHERE
    other = way if way >= 0 else -way - 2
    return other if side < 0 else following(other)
