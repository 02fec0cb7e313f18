"""The shortest path among polygons by lazy A* over the tangent visibility graph: a second opinion.

It asks nothing but whether segments are free, as planners do. That makes it the planner
``visibility-graph``, the oracle of the tests, and what stands in where no mesh can be made.

A shortest path bends only at corners where solid is convex, and only around them; so the search
generates edges that are tangent at both ends and turn tautly around their tail, and tests whether
an edge is free only when it comes off the queue (Lozano-Perez and Wesley 1979 for the graph,
Dellin and Srinivasa 2016 for lazy edge evaluation). Metres.
"""

import heapq
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from suite.geometry.kernels import ObstacleArrays, segment_enters
from suite.geometry.predicates import orientation
from suite.jit import allocating_kernel
from suite.scenes.scene import Query, Scene


def tangent_path(scene: Scene, query: Query) -> tuple[NDArray[np.float64] | None, int]:
    """Shortest feasible path from start to goal, and how many segments the search asked about.

    Parameters
    ----------
    scene : Scene
    query : Query
        One of the scene's own, or any other. There is no path where an end is not in free space.

    Returns
    -------
    path : (n, 2) float64, metres, or None if there is none
    checks : int

    Examples
    --------
    >>> import shapely
    >>> from suite.scenes.scene import make_scene
    >>> scene = make_scene(
    ...     "one box", shapely.box(0, 0, 10, 10), [shapely.box(4, 0, 6, 7)],
    ...     {"main": ((0, 3), (10, 3))},
    ... )
    >>> path, checks = tangent_path(scene, scene.query())
    >>> path.tolist(), checks
    ([[0.0, 3.0], [4.0, 7.0], [6.0, 7.0], [10.0, 3.0]], 4)
    """
    arrangement = scene.arrangement
    order, checks = _search(
        query.start[0],
        query.start[1],
        query.goal[0],
        query.goal[1],
        arrangement.corners,
        arrangement.arrays,
    )
    if order.size == 0:
        return None, int(checks)
    nodes = np.vstack([arrangement.corners[:, :2], query.start, query.goal])
    return without_straight_bends(nodes[order]), int(checks)


def without_straight_bends(path: NDArray[np.float64]) -> NDArray[np.float64]:
    """A path (n, 2) without the points that it passes straight on, or in which it starts or ends.

    Examples
    --------
    >>> without_straight_bends(np.array([(0, 0), (1, 0), (2, 0), (2, 5.0)])).tolist()
    [[0.0, 0.0], [2.0, 0.0], [2.0, 5.0]]
    """
    kept = [0]
    for i, j in pairwise(range(1, len(path))):
        if orientation(*path[kept[-1]], *path[i], *path[j]) != 0:
            kept.append(i)
    return np.ascontiguousarray(path[[*kept, len(path) - 1]])


@allocating_kernel
def _is_tangent(px: float, py: float, corners: np.ndarray, i: int) -> bool:
    """Whether the line from p to corner i leaves the corner's solid on one side."""
    x, y = corners[i, 0], corners[i, 1]
    first = orientation(px, py, x, y, corners[i, 2], corners[i, 3])
    second = orientation(px, py, x, y, corners[i, 4], corners[i, 5])
    return first * second >= 0


@allocating_kernel
def _solid_side(px: float, py: float, corners: np.ndarray, i: int) -> int:
    """Side of a tangent line p -> corner i on which the corner's solid lies: 1 left, -1 right."""
    x, y = corners[i, 0], corners[i, 1]
    side = orientation(px, py, x, y, corners[i, 2], corners[i, 3])
    return side if side != 0 else orientation(px, py, x, y, corners[i, 4], corners[i, 5])


@allocating_kernel
def _turns_around(
    px: float, py: float, side: int, corners: np.ndarray, i: int, qx: float, qy: float
) -> bool:
    """Whether the path p -> corner i -> q, tangent at its bend, is taut: bends around solid.

    Straight on is allowed, exactly: rounding here would prune collinear routes.
    """
    x, y = corners[i, 0], corners[i, 1]
    turn = orientation(px, py, x, y, qx, qy)
    if turn == -side:
        return False
    if turn == 0:
        return (x - px) * (qx - x) + (y - py) * (qy - y) > 0.0
    return (
        orientation(x, y, qx, qy, corners[i, 2], corners[i, 3]) != -side
        and orientation(x, y, qx, qy, corners[i, 4], corners[i, 5]) != -side
    )


@allocating_kernel
def _search(
    sx: float, sy: float, gx: float, gy: float, corners: np.ndarray, arrays: ObstacleArrays
) -> tuple[np.ndarray, int]:
    """Node numbers of the shortest path, and the number of visibility tests; empty if none.

    Node i is corner i; the start is number n, the goal n + 1.
    """
    n = corners.shape[0]
    start, goal = n, n + 1
    xy = np.empty((n + 2, 2))
    xy[:n] = corners[:, :2]
    xy[start, 0], xy[start, 1] = sx, sy
    xy[goal, 0], xy[goal, 1] = gx, gy
    to_goal = np.sqrt((xy[:, 0] - gx) ** 2 + (xy[:, 1] - gy) ** 2)
    parent = np.full(n + 2, -1, dtype=np.int64)
    closed = np.zeros(n + 2, dtype=np.bool_)
    # Several edges into a node may be queued, for the cheapest of them need not be free; a node
    # closes when its first free edge comes off.
    queue = [(to_goal[start], 0.0, start, start)]
    checks = 0
    while len(queue) > 0:
        _, cost, tail, node = heapq.heappop(queue)
        if closed[node]:
            continue
        x, y = xy[node, 0], xy[node, 1]
        px, py = xy[tail, 0], xy[tail, 1]
        side = 0
        if node != start:
            checks += 1
            if segment_enters(px, py, x, y, arrays):
                continue
        closed[node] = True
        parent[node] = tail
        if node == goal:
            return _trace_back(parent, start, goal), checks
        if node != start:
            side = _solid_side(px, py, corners, node)
        for other in range(n + 2):
            if closed[other]:
                continue
            qx, qy = xy[other, 0], xy[other, 1]
            if node != start and not _turns_around(px, py, side, corners, node, qx, qy):
                continue
            if other != goal and ((x == qx and y == qy) or not _is_tangent(x, y, corners, other)):
                continue
            g = cost + np.sqrt((qx - x) ** 2 + (qy - y) ** 2)
            heapq.heappush(queue, (g + to_goal[other], g, node, other))
    return np.empty(0, dtype=np.int64), checks


@allocating_kernel
def _trace_back(parent: np.ndarray, start: int, goal: int) -> np.ndarray:
    count = 1
    node = goal
    while node != start:
        node = parent[node]
        count += 1
    order = np.empty(count, dtype=np.int64)
    node = goal
    for i in range(count - 1, -1, -1):
        order[i] = node
        node = parent[node]
    return order
