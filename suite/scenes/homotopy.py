"""The shortest path of each route: locally shortest paths, one to a homotopy class, best first.

Two paths are on the same route if one can be deformed into the other without passing through an
obstacle. A ray goes up from a point inside each obstacle group that stands free of the frame; the
rays that a path crosses, each with its direction, spell a word, and its free reduction names the
route exactly (Hershberger and Snoeyink 1994; Bhattacharya, Likhachev and Kumar 2012). The search
is A* over the tangent visibility graph, with the word so far as part of the state. Metres.
"""

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon

from suite.geometry.kernels import (
    FIRST_CONTACT,
    LAST_CONTACT,
    ObstacleArrays,
    segment_enters,
)
from suite.geometry.predicates import orientation
from suite.jit import allocating_kernel
from suite.scenes.scene import Query, Scene

Word = tuple[int, ...]
"""A reduced word: +k where the ray of group k - 1 is crossed from left to right, else -k."""


@dataclass(frozen=True, slots=True, eq=False)
class RouteOptimum:
    """The shortest path of one route.

    word : tuple of int, the route: +k or -k for each crossing of the ray of obstacle group k - 1
        from left to right or from right to left, reduced. Empty for the route below everything.
    path : (n, 2) float64, metres, start to goal.
    length : float, metres.
    """

    word: Word
    path: NDArray[np.float64]
    length: float


@dataclass(frozen=True, slots=True, eq=False)
class _Roadmap:
    """The tangent visibility graph of a query. Nodes: free sectors at corners, start, goal.

    xy : (N + 2, 2) float64, metres; the start is row N, the goal row N + 1.
    neighbours : for each node the numbers of the nodes that it sees.
    weights : for each node the lengths of its edges, in the same order.
    words : for each node the words of its edges, in the same order.
    to_goal : (N + 2,) float64, shortest distance to the goal over the graph.
    """

    xy: NDArray[np.float64]
    neighbours: list[list[int]]
    weights: list[list[float]]
    words: list[list[Word]]
    to_goal: NDArray[np.float64]


def route_optima(
    scene: Scene, query: Query, *, limit_ratio: float = 1.07, most: int | None = None
) -> list[RouteOptimum]:
    """Shortest paths of the routes that are hardly longer than the best one.

    Parameters
    ----------
    scene : Scene
    query : Query
    limit_ratio : float
        Routes are listed if their optimum is at most this many times the best one's. The number
        of routes grows exponentially with it, since paths may also wind around obstacles.
    most : int, optional
        Stop after this many routes.

    Returns
    -------
    list of RouteOptimum
        Shortest first; empty if the goal can't be reached.

    Raises
    ------
    ValueError
        If `limit_ratio` is below 1 or not finite.

    References
    ----------
    Hershberger, Snoeyink: Computing minimum length paths of a given homotopy class, 1994.
    Bhattacharya, Likhachev, Kumar: Topological constraints in search-based robot path planning,
    2012.

    Examples
    --------
    >>> from suite.scenes.scene import make_scene
    >>> scene = make_scene(
    ...     "one box", shapely.box(0, 0, 10, 10), [shapely.box(4, 2, 6, 7)],
    ...     {"main": ((1, 4), (9, 4))},
    ... )
    >>> [(r.word, round(r.length, 3)) for r in route_optima(scene, scene.query(), limit_ratio=1.2)]
    [((), 9.211), ((1,), 10.485)]
    """
    if not 1.0 <= limit_ratio < np.inf:
        raise ValueError(f"limit_ratio is {limit_ratio}. Give a finite number of 1 or more.")
    roadmap = _roadmap(scene, query)
    start = len(roadmap.xy) - 2
    limit = limit_ratio * roadmap.to_goal[start]
    if not np.isfinite(limit):
        return []
    found: list[RouteOptimum] = []
    for route in _routes(roadmap, limit):
        if most is not None and len(found) >= most:
            break
        found.append(route)
    return found


def routes_of(scene: Scene, paths: Sequence[NDArray[np.float64]]) -> list[Word]:
    """The routes of some paths: two with the same ends are on one if their words are the same.

    Parameters
    ----------
    scene : Scene
    paths : sequence of (n, 2) float64, metres

    Returns
    -------
    list of tuple of int
        A word for each path; comparable among these paths only.
    """
    rays = _ray_sources(scene, np.concatenate(paths))
    words: list[Word] = []
    for path in paths:
        word: Word = ()
        for a, b in pairwise(path):
            word = reduced(word, _letters(a, b, rays))
        words.append(word)
    return words


State = tuple[int, Word]
"""A node and the reduced word of the way to it: paths in one state are deformable into another."""


def _routes(roadmap: _Roadmap, limit: float) -> Iterator[RouteOptimum]:
    """Routes in order of their optima, up to a length of `limit`.

    The heuristic is the exact distance to the goal over the graph, hence consistent: a state is
    first expanded at its shortest length, and nothing beyond the limit is ever queued.
    """
    start, goal = len(roadmap.xy) - 2, len(roadmap.xy) - 1
    parent: dict[State, State | None] = {}
    queue: list[tuple[float, float, State, State | None]] = [
        (roadmap.to_goal[start], 0.0, (start, ()), None)
    ]
    while queue:
        _, length, state, origin = heapq.heappop(queue)
        if state in parent:
            continue
        parent[state] = origin
        node, word = state
        if node == goal:
            yield RouteOptimum(word, _trace_back(roadmap.xy, parent, state), length)
            continue
        edges = zip(
            roadmap.neighbours[node], roadmap.weights[node], roadmap.words[node], strict=True
        )
        for other, weight, letters in edges:
            bound = length + weight + roadmap.to_goal[other]
            if bound > limit * (1.0 + _ROUNDING):
                continue
            after = (other, reduced(word, letters))
            if after not in parent:
                heapq.heappush(queue, (bound, length + weight, after, state))


# Sums of the same lengths in another order: the best route must not fall to a limit_ratio of 1.
_ROUNDING = 1e-12


def reduced(word: Word, letters: Word) -> Word:
    """Return the product of two reduced words: a letter and its inverse cancel.

    Parameters
    ----------
    word, letters : tuple of int
        Reduced words.

    Returns
    -------
    tuple of int

    Examples
    --------
    >>> reduced((1, 2), (-2, 3))
    (1, 3)
    """
    common = min(len(word), len(letters))
    n = 0
    while n < common and word[-1 - n] == -letters[n]:
        n += 1
    return word[: len(word) - n] + letters[n:]


def _trace_back(
    xy: NDArray[np.float64], parent: dict[State, State | None], state: State
) -> NDArray[np.float64]:
    nodes: list[int] = []
    at: State | None = state
    while at is not None:
        nodes.append(at[0])
        at = parent[at]
    return np.ascontiguousarray(xy[nodes[::-1]])


def _roadmap(scene: Scene, query: Query) -> _Roadmap:
    corners = scene.arrangement.corners
    xy = np.vstack([corners[:, :2], query.start, query.goal])
    sees = _visible_pairs(xy, corners, scene.arrays)
    lengths = np.hypot(*(xy[:, None, :] - xy[None, :, :]).transpose(2, 0, 1))
    rays = _ray_sources(scene, xy)
    neighbours = [np.flatnonzero(row).tolist() for row in sees]
    return _Roadmap(
        xy=xy,
        neighbours=neighbours,
        weights=[lengths[i, near].tolist() for i, near in enumerate(neighbours)],
        words=[[_letters(xy[i], xy[j], rays) for j in near] for i, near in enumerate(neighbours)],
        to_goal=_distances_to_last(sees, lengths),
    )


def _distances_to_last(
    sees: NDArray[np.bool_], lengths: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Shortest distance of each node to the last one (Dijkstra 1959)."""
    distance = np.full(len(sees), np.inf)
    distance[-1] = 0.0
    is_open = np.ones(len(sees), dtype=bool)
    while is_open.any():
        node = int(np.where(is_open, distance, np.inf).argmin())
        if not is_open[node] or not np.isfinite(distance[node]):
            break
        is_open[node] = False
        through = np.where(sees[node], distance[node] + lengths[node], np.inf)
        distance = np.minimum(distance, through)
    return distance


@dataclass(frozen=True, slots=True)
class _Ray:
    """The ray from (x, y) upward; `letter` is the number of its obstacle group, from 1."""

    x: float
    y: float
    letter: int


def _ray_sources(scene: Scene, xy: NDArray[np.float64]) -> list[_Ray]:
    """One ray for each obstacle group that paths can go around, ordered from left to right.

    No two share their x, and none starts at the x of a node: a segment crosses a ray or does not.
    """
    table = scene.arrays.groups
    taken = set(xy[:, 0].tolist())
    rays: list[_Ray] = []
    for number, group in enumerate(scene.arrangement.groups, 1):
        if table[number - 1, FIRST_CONTACT] == table[number - 1, LAST_CONTACT]:
            x, y = _point_inside(group, taken)
            taken.add(x)
            rays.append(_Ray(x, y, number))
    return sorted(rays, key=lambda ray: ray.x)


def _point_inside(group: MultiPolygon, taken: set[float]) -> tuple[float, float]:
    """Find a point in the interior of a group whose x is not taken yet."""
    polygon = max(group.geoms, key=lambda p: p.area)
    xmin, _, xmax, _ = polygon.bounds
    xs = np.unique(shapely.get_coordinates(polygon)[:, 0])
    between = sorted(pairwise(xs.tolist()), key=lambda gap: gap[0] - gap[1])
    for left, right in between:
        for share in _SHARES:
            x = left + share * (right - left)
            if x in taken or not xmin < x < xmax:
                continue
            y = _inside_on_vertical(polygon, x)
            if y is not None:
                return x, y
    raise ValueError("an obstacle group is too thin to put a point inside")


# Golden-section multiples: well spread, and never on the lattices that people draw on.
_SHARES = [(0.5 + 0.6180339887498949 * k) % 1.0 for k in range(1, 40)]


def _inside_on_vertical(polygon: shapely.Polygon, x: float) -> float | None:
    """Return the middle y of the longest stretch of the vertical at x inside a polygon."""
    _, ymin, _, ymax = polygon.bounds
    cut = polygon.intersection(shapely.LineString([(x, ymin - 1.0), (x, ymax + 1.0)]))
    stretches = [s for s in shapely.get_parts(cut) if s.length > 0.0]
    if not stretches:
        return None
    longest = max(stretches, key=lambda s: float(s.length))
    return float(shapely.get_coordinates(longest)[:, 1].mean())


def _letters(a: NDArray[np.float64], b: NDArray[np.float64], rays: Sequence[_Ray]) -> Word:
    """List the rays that segment a-b crosses, in order; no two follow that cancel."""
    ax, ay, bx, by = float(a[0]), float(a[1]), float(b[0]), float(b[1])
    if ax < bx:
        crossed = [r for r in rays if ax < r.x < bx and orientation(ax, ay, bx, by, r.x, r.y) < 0]
        return tuple(ray.letter for ray in crossed)
    crossed = [r for r in rays if bx < r.x < ax and orientation(bx, by, ax, ay, r.x, r.y) < 0]
    return tuple(-ray.letter for ray in reversed(crossed))


@allocating_kernel
def _is_tangent(corners: np.ndarray, i: int, qx: float, qy: float) -> bool:
    """Whether the way from corner i to q is tangent to the corner's solid, and not into it."""
    if i >= corners.shape[0]:
        return True  # start or goal
    x, y = corners[i, 0], corners[i, 1]
    first = orientation(x, y, corners[i, 2], corners[i, 3], qx, qy)
    second = orientation(x, y, corners[i, 4], corners[i, 5], qx, qy)
    # Left of one and right of the other is into the solid, or straight away from its tip.
    return first * second >= 0


@allocating_kernel
def _visible_pairs(xy: np.ndarray, corners: np.ndarray, arrays: ObstacleArrays) -> np.ndarray:
    """Which nodes see each other along a line that is tangent at both: (n, n) bool."""
    n = xy.shape[0]
    sees = np.zeros((n, n), dtype=np.bool_)
    for i in range(n):
        for j in range(i + 1, n):
            ax, ay, bx, by = xy[i, 0], xy[i, 1], xy[j, 0], xy[j, 1]
            if ax == bx and ay == by:
                continue
            if not (_is_tangent(corners, i, bx, by) and _is_tangent(corners, j, ax, ay)):
                continue
            if not segment_enters(ax, ay, bx, by, arrays):
                sees[i, j] = True
                sees[j, i] = True
    return sees
