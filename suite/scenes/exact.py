"""The exact shortest path among polygons: interval search over a navigation mesh.

Polyanya (Cui, Harabor and Grastien 2017): what a search pushes forward is not a point but a cone,
all that is seen from a corner through a side of a triangle. A cone is kept by the corners that
bound it and not by the places where it cuts that side, so that what it sees is decided by exact
signs of input coordinates alone; only lengths are rounded. Metres.
"""

import heapq
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from suite.geometry.mesh import Mesh, following, preceding, side_of
from suite.geometry.predicates import orientation
from suite.jit import allocating_kernel, kernel
from suite.scenes.scene import Query, Scene


@dataclass(frozen=True, slots=True, eq=False)
class ExactPath:
    """The shortest path of a query, or the proof that there is none.

    path : (n, 2) float64, metres, start to goal; None if the goal can't be reached.
    length : float, metres; infinite if the goal can't be reached.
    checks : triangles that the search looked into, each as often as it did.
    """

    path: NDArray[np.float64] | None
    length: float
    checks: int


def prepare(scene: Scene) -> Mesh:
    """Make what the solver needs of a scene beside its arrangement; kept with the scene.

    The first query does it by itself. Whoever measures queries calls this before.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Mesh
    """
    return scene.mesh


def shortest_path(scene: Scene, query: Query) -> ExactPath:
    """Shortest feasible path from start to goal.

    Parameters
    ----------
    scene : Scene
    query : Query
        One of the scene's own, or any other. There is no path where an end is not in free space.

    Returns
    -------
    ExactPath

    Examples
    --------
    >>> import shapely
    >>> from suite.scenes.scene import make_scene
    >>> scene = make_scene(
    ...     "one box", shapely.box(0, 0, 10, 10), [shapely.box(4, 0, 6, 7)],
    ...     {"main": ((0, 3), (10, 3))},
    ... )
    >>> found = shortest_path(scene, scene.query())
    >>> found.path.tolist()
    [[0.0, 3.0], [4.0, 7.0], [6.0, 7.0], [10.0, 3.0]]
    """
    order, checks = _search(
        query.start[0], query.start[1], query.goal[0], query.goal[1], prepare(scene)
    )
    if order.size == 0:
        return ExactPath(None, np.inf, int(checks))
    path = np.vstack([query.start, scene.mesh.vertices[order[1:-1]], query.goal])
    path = np.ascontiguousarray(path[bends(path)])
    return ExactPath(path, path_length(path), int(checks))


def bends(path: NDArray[np.float64]) -> list[int]:
    """Rows of a path without those that it passes straight on, or in which it starts or ends."""
    kept = [0]
    for i, j in pairwise(range(1, len(path))):
        if orientation(*path[kept[-1]], *path[i], *path[j]) != 0:
            kept.append(i)
    return [*kept, len(path) - 1]


def path_length(path: NDArray[np.float64]) -> float:
    """Length of a path (n, 2), metres."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


ROUNDING = 8.0 * 2.0**-53
"""Bounds the rounding of the numbers below, relative to the magnitude of what is subtracted."""

Cone = tuple[float, int, int, int, int, int, int]
"""What is seen from a node through a side of a triangle: the least length of a path through it; the
half-edge by which it enters a triangle; the node; and two nodes on each of the rays on its left and
right, which are the node and a corner or, where a path goes straight on past its last bend, the
node before and the node. A corner that is to be left has -1 for a half-edge."""


class Search(NamedTuple):
    """What a search knows of the nodes: the vertices of the mesh, then start and goal.

    xy : (n, 2) float64, metres.
    cost : (n,) float64, length of the shortest path known to a node, metres.
    parent : (n,) int64, the node before it on that path, -1 for the start.
    closed : (n,) bool, whether its shortest path is known.
    has_goal : (T,) bool, whether the goal lies in a triangle or on its border.
    leads_on : (T,) bool, whether the goal lies in a pocket and a triangle on the way to it.
    """

    xy: np.ndarray
    cost: np.ndarray
    parent: np.ndarray
    closed: np.ndarray
    has_goal: np.ndarray
    leads_on: np.ndarray


@allocating_kernel
def _search(sx: float, sy: float, gx: float, gy: float, mesh: Mesh) -> tuple[np.ndarray, int]:
    """Nodes of the shortest path, and the number of triangles looked into; empty if none."""
    n, triangles = mesh.vertices.shape[0], mesh.outward.shape[0]
    start, goal = n, n + 1
    xy = np.empty((n + 2, 2))
    xy[:n] = mesh.vertices
    xy[start, 0], xy[start, 1] = sx, sy
    xy[goal, 0], xy[goal, 1] = gx, gy
    search = Search(
        xy,
        np.full(n + 2, np.inf),
        np.full(n + 2, -1, dtype=np.int64),
        np.zeros(n + 2, dtype=np.bool_),
        np.zeros(triangles, dtype=np.bool_),
        np.zeros(triangles, dtype=np.bool_),
    )
    queue = [(0.0, -1, start, start, start, start, start)]
    _mark_goal(mesh, search)
    search.cost[start] = 0.0
    checks = 0
    while len(queue) > 0:
        cone = heapq.heappop(queue)
        node = cone[2]
        if cone[1] >= 0:
            checks += _follow(mesh, search, queue, cone)
        elif not search.closed[node]:
            search.closed[node] = True
            if node == goal:
                return _trace_back(search.parent, goal), checks
            if node == start:
                checks += _leave_start(mesh, search, queue)
            else:
                checks += _turn(mesh, search, queue, cone[0], node)
    return np.empty(0, dtype=np.int64), checks


@allocating_kernel
def _trace_back(parent: np.ndarray, goal: int) -> np.ndarray:
    count = 0
    node = goal
    while node >= 0:
        node = parent[node]
        count += 1
    order = np.empty(count, dtype=np.int64)
    node = goal
    for i in range(count - 1, -1, -1):
        order[i] = node
        node = parent[node]
    return order


@kernel
def _holds(mesh: Mesh, t: int, x: float, y: float) -> bool:
    """Whether a place lies in a triangle or on its border."""
    boxes = mesh.boxes
    if x < boxes[t, 0] or y < boxes[t, 1] or x > boxes[t, 2] or y > boxes[t, 3]:
        return False
    a, b, c = mesh.origin[3 * t], mesh.origin[3 * t + 1], mesh.origin[3 * t + 2]
    xy = mesh.vertices
    return (
        orientation(xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], x, y) >= 0
        and orientation(xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1], x, y) >= 0
        and orientation(xy[c, 0], xy[c, 1], xy[a, 0], xy[a, 1], x, y) >= 0
    )


@kernel
def _mark_goal(mesh: Mesh, search: Search) -> None:
    """Mark the triangles of the goal, and those on the way out of its pocket."""
    goal = search.xy.shape[0] - 1
    for t in range(mesh.outward.shape[0]):
        if _holds(mesh, t, search.xy[goal, 0], search.xy[goal, 1]):
            search.has_goal[t] = True
            search.leads_on[t] = True
            while mesh.outward[t] >= 0:
                t = mesh.twin[mesh.outward[t]] // 3
                search.leads_on[t] = True


@kernel
def _leads(mesh: Mesh, search: Search, entry: int) -> bool:
    """Whether a half-edge leads into a triangle, and not into a pocket without the goal."""
    if entry < 0:
        return False
    t = entry // 3
    return mesh.outward[t] != entry or search.leads_on[t]


@kernel
def _distance(xy: np.ndarray, a: int, b: int) -> float:
    return np.sqrt((xy[a, 0] - xy[b, 0]) ** 2 + (xy[a, 1] - xy[b, 1]) ** 2)


@allocating_kernel
def _reach(search: Search, queue: list[Cone], node: int, root: int) -> None:
    """Come straight from a root to a node that it sees; queue the node if that is shorter."""
    goal = search.xy.shape[0] - 1
    cost = search.cost[root] + _distance(search.xy, root, node)
    if cost < search.cost[node]:
        search.cost[node] = cost
        search.parent[node] = root
        least = cost + _distance(search.xy, node, goal)
        heapq.heappush(queue, (least, -1, node, node, node, node, node))


@allocating_kernel
def _reach_corner(mesh: Mesh, search: Search, queue: list[Cone], h: int, root: int) -> None:
    """Come to the origin of a half-edge that a root sees, if a path may bend there.

    It may if the line from the root leaves the corner's solid on one side.
    """
    v = mesh.origin[h]
    if not mesh.bends[h] or search.closed[v]:
        return
    after, before = _neighbours(mesh, v)
    xy = search.xy
    if (xy[v, 0] == xy[root, 0] and xy[v, 1] == xy[root, 1]) or (
        side_of(xy, root, v, after) * side_of(xy, root, v, before) < 0
    ):
        return
    _reach(search, queue, v, root)


@kernel
def _neighbours(mesh: Mesh, v: int) -> tuple[int, int]:
    """Ends of the sides that bound the free space around a corner, counter-clockwise."""
    return mesh.origin[following(mesh.first[v])], mesh.origin[preceding(mesh.last[v])]


@allocating_kernel
def _leave_start(mesh: Mesh, search: Search, queue: list[Cone]) -> int:
    """Queue all that the start sees; return the number of triangles that it lies in."""
    goal = search.xy.shape[0] - 1
    start = goal - 1
    found = 0
    for t in range(mesh.outward.shape[0]):
        if not _holds(mesh, t, search.xy[start, 0], search.xy[start, 1]):
            continue
        found += 1
        if search.has_goal[t]:
            _reach(search, queue, goal, start)
        for h in range(3 * t, 3 * t + 3):
            _reach_corner(mesh, search, queue, h, start)
            a, b = mesh.origin[h], mesh.origin[following(h)]
            if side_of(search.xy, a, b, start) > 0:
                _queue(mesh, search, queue, (0.0, mesh.twin[h], start, start, b, start, a))
    return found


@allocating_kernel
def _queue(mesh: Mesh, search: Search, queue: list[Cone], cone: Cone) -> None:
    """Queue a cone that leads anywhere, with the least length of a path through it."""
    if _leads(mesh, search, cone[1]):
        heapq.heappush(queue, _bounded(mesh, search, cone))


@kernel
def _bounded(mesh: Mesh, search: Search, cone: Cone) -> Cone:
    """A cone with the least length of a path through it, given a bound of what it comes from."""
    bound, entry, root, left, left_tip, right, right_tip = cone
    a, b = mesh.origin[entry], mesh.origin[following(entry)]
    detour = _detour(search.xy, a, b, root, left, left_tip, right, right_tip)
    return max(bound, search.cost[root] + detour), entry, root, left, left_tip, right, right_tip


@kernel
def _detour(
    xy: np.ndarray, a: int, b: int, root: int, left: int, left_tip: int, right: int, right_tip: int
) -> float:
    """Least length of a way from a root to the goal through what a cone leaves of side a-b, metres.

    It never comes out longer than it is: that alone is what the search relies on.
    """
    rx, ry = xy[root, 0], xy[root, 1]
    ax, ay = xy[a, 0] - rx, xy[a, 1] - ry
    ex, ey = xy[b, 0] - xy[a, 0], xy[b, 1] - xy[a, 1]
    goal = xy.shape[0] - 1
    gx, gy = xy[goal, 0] - rx, xy[goal, 1] - ry
    behind = ey * (gx - ax) - ex * (gy - ay)
    if behind > 0.0:  # a way to the side and back is as long as one to the goal's mirror image
        share = 2.0 * behind / (ex * ex + ey * ey)
        gx -= share * ey
        gy += share * ex
    dx, dy = xy[left_tip, 0] - xy[left, 0], xy[left_tip, 1] - xy[left, 1]
    if dx * gy - dy * gx <= 0.0:
        dx, dy = xy[right_tip, 0] - xy[right, 0], xy[right_tip, 1] - xy[right, 1]
        if dx * gy - dy * gx >= 0.0:
            return np.sqrt(gx * gx + gy * gy)
    # Where the ray in direction d cuts the side, as a share of it.
    divisor = dx * ey - dy * ex
    error = ROUNDING * (abs(ax * dy) + abs(ay * dx) + abs(dx * ey) + abs(dy * ex))
    if abs(divisor) <= error:
        return np.sqrt(gx * gx + gy * gy)
    share = min(1.0, max(0.0, (ax * dy - ay * dx) / divisor))
    x, y = ax + share * ex, ay + share * ey
    way = np.sqrt(x * x + y * y) + np.sqrt((gx - x) ** 2 + (gy - y) ** 2)
    return way - 2.0 * error / abs(divisor) * np.sqrt(ex * ex + ey * ey)


@allocating_kernel
def _follow(mesh: Mesh, search: Search, queue: list[Cone], cone: Cone) -> int:
    """Push a cone forward while it is the best there is; return the number of triangles seen."""
    xy = search.xy
    goal = xy.shape[0] - 1
    seen = 0
    while True:
        seen += 1
        bound, entry, root, left, left_tip, right, right_tip = cone
        if (
            search.has_goal[entry // 3]
            and side_of(xy, left, left_tip, goal) <= 0
            and side_of(xy, right, right_tip, goal) >= 0
        ):
            _reach(search, queue, goal, root)
        # On its left the triangle ends with the side from the apex, on its right with that to it.
        on_left, on_right = preceding(entry), following(entry)
        apex = mesh.origin[on_left]
        of_left, of_right = side_of(xy, left, left_tip, apex), side_of(xy, right, right_tip, apex)
        if of_left <= 0 and of_right >= 0:
            _reach_corner(mesh, search, queue, on_left, root)
        one = two = (np.inf, -1, root, left, left_tip, right, right_tip)
        if of_left < 0 and _leads(mesh, search, mesh.twin[on_left]):
            if of_right > 0:
                one = (bound, mesh.twin[on_left], root, left, left_tip, root, apex)
            else:
                one = (bound, mesh.twin[on_left], root, left, left_tip, right, right_tip)
            one = _bounded(mesh, search, one)
        if of_right > 0 and _leads(mesh, search, mesh.twin[on_right]):
            if of_left < 0:
                two = (bound, mesh.twin[on_right], root, root, apex, right, right_tip)
            else:
                two = (bound, mesh.twin[on_right], root, left, left_tip, right, right_tip)
            two = _bounded(mesh, search, two)
        if two[0] < one[0]:
            one, two = two, one
        if two[1] >= 0:
            heapq.heappush(queue, two)
        if one[1] < 0:
            return seen
        if len(queue) > 0 and queue[0][0] < one[0]:
            heapq.heappush(queue, one)
            return seen
        cone = one


@allocating_kernel
def _turn(mesh: Mesh, search: Search, queue: list[Cone], bound: float, v: int) -> int:
    """Queue what is seen from a corner by paths that turn around its solid, or go straight on.

    Straight on exactly: rounding here would prune collinear routes.
    """
    before = search.parent[v]
    after, behind = _neighbours(mesh, v)
    side = side_of(search.xy, before, v, after)
    if side == 0:
        side = side_of(search.xy, before, v, behind)
    if side < 0:
        return _turn_right(mesh, search, queue, bound, v)
    return _turn_left(mesh, search, queue, bound, v)


@allocating_kernel
def _turn_right(mesh: Mesh, search: Search, queue: list[Cone], bound: float, v: int) -> int:
    """Sweep from the solid on the right of a corner, counter-clockwise, to straight on."""
    xy, goal, p = search.xy, search.xy.shape[0] - 1, search.parent[v]
    h = mesh.first[v]
    _reach_corner(mesh, search, queue, following(h), v)
    seen = 0
    while h >= 0:
        seen += 1
        right, left = mesh.origin[following(h)], mesh.origin[preceding(h)]
        entry = mesh.twin[following(h)]
        if search.has_goal[h // 3] and side_of(xy, p, v, goal) <= 0:
            _reach(search, queue, goal, v)
        if side_of(xy, p, v, right) >= 0:
            break
        of_left = side_of(xy, p, v, left)
        if of_left > 0:
            _queue(mesh, search, queue, (bound, entry, v, p, v, v, right))
            break
        _queue(mesh, search, queue, (bound, entry, v, v, left, v, right))
        _reach_corner(mesh, search, queue, preceding(h), v)
        h = mesh.twin[preceding(h)]
    return seen


@allocating_kernel
def _turn_left(mesh: Mesh, search: Search, queue: list[Cone], bound: float, v: int) -> int:
    """Sweep from the solid on the left of a corner, clockwise, to straight on."""
    xy, goal, p = search.xy, search.xy.shape[0] - 1, search.parent[v]
    h = mesh.last[v]
    _reach_corner(mesh, search, queue, preceding(h), v)
    seen = 0
    while h >= 0:
        seen += 1
        right, left = mesh.origin[following(h)], mesh.origin[preceding(h)]
        entry = mesh.twin[following(h)]
        if search.has_goal[h // 3] and side_of(xy, p, v, goal) >= 0:
            _reach(search, queue, goal, v)
        if side_of(xy, p, v, left) <= 0:
            break
        of_right = side_of(xy, p, v, right)
        if of_right < 0:
            _queue(mesh, search, queue, (bound, entry, v, v, left, p, v))
            break
        _queue(mesh, search, queue, (bound, entry, v, v, left, v, right))
        _reach_corner(mesh, search, queue, following(h), v)
        h = mesh.twin[h]
        if h >= 0:
            h = following(h)
    return seen
