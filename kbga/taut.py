"""A path pulled taut: as short as it gets without passing an obstacle on another side (ours).

The lattice costs length wherever corners lie between its lines. A path that has been found is
therefore pulled taut as a string: where it bends, the bend moves back until the string lies against
corners of obstacles, or is straight. The triangle of a bend and its two neighbours holds all that
can stop it: as the two sides are free, what juts into the triangle crosses the third side only, and
has a vertex in it. The string then runs along the convex hull of these vertices and the neighbours.
Repeated until nothing moves, this is the shortest path of its kind (homotopy class): the way that
Hershberger and Snoeyink (1994) shorten paths, without a triangulation.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kbga.counter import COMPUTED, may_ask
from kbga.encoding import Population, distance, distance_to_segment
from suite.geometry.kernels import (
    FIRST,
    LAST,
    SKIP,
    XMAX,
    XMIN,
    YMAX,
    YMIN,
    ObstacleArrays,
    first_collision,
    pinch_at,
    segment_enters,
    turn_is_closed,
)
from suite.geometry.predicates import orientation
from suite.jit import kernel

ROOM = 512
"""Most places of a string. One that would need more is not pulled any further."""

LEAST_GAIN = 1e-12
"""Share of a length below which a gain is rounding."""


class Strings(NamedTuple):
    """Where paths are pulled taut, so that nothing is allocated within a generation.

    pulled : (2, ROOM, 2) float64, metres. The string that is pulled, and the best so far.
    seen : (1024,) float64, costs of chromosomes that were pulled; newer ones take older ones'
        places. Two of one cost are one path, or mirror images of one length.
    """

    pulled: NDArray[np.float64]
    seen: NDArray[np.float64]


def make_strings() -> Strings:
    """Room for strings, and nothing seen yet."""
    return Strings(np.empty((2, ROOM, 2)), np.zeros(1024))


def pull_taut(
    path: NDArray[np.float64], arrays: ObstacleArrays, counter: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Pull a feasible path taut.

    Parameters
    ----------
    path : (n, 2) float64, metres
        In free space.
    arrays : ObstacleArrays
    counter : (3,) int64
        Of :mod:`kbga.counter`: each segment that is tried is a question. Where none is left, the
        path stays as far as it came.

    Returns
    -------
    (m, 2) float64, metres, in free space, no longer than ``path``.
    """
    string = np.empty((max(ROOM, 2 * len(path)), 2))
    string[: len(path)] = path
    pulled = string[: _pull(string, len(path), arrays, counter)].copy()
    return pulled if is_feasible(pulled, arrays) else path


def pull_promising(
    population: Population,
    first: int,
    last: int,
    limit: float,
    known: float,
    strings: Strings,
    arrays: ObstacleArrays,
    counter: NDArray[np.int64],
) -> NDArray[np.float64] | None:
    """Pull those of some chromosomes taut that may become the best path, and were not seen before.

    Parameters
    ----------
    population : Population
    first, last : int
        Which of its chromosomes, ``last`` excluded.
    limit : float, metres
        Feasible ones are pulled that cost less.
    known : float, metres
        Length of the best path so far.
    strings : Strings
    arrays : ObstacleArrays
    counter : (3,) int64

    Returns
    -------
    (m, 2) float64, metres, the best of them, if it is shorter than ``known``; else None.
    """
    count = _pull_some(population, first, last, limit, known, strings, arrays, counter)
    if count == 0:
        return None
    path = strings.pulled[1, :count].copy()
    return path if is_feasible(path, arrays) else None


def is_feasible(path: NDArray[np.float64], arrays: ObstacleArrays) -> bool:
    """Whether a path is free as a whole, as the referee judges it, and not bend by bend."""
    return bool(first_collision(path, arrays) < 0)


def rest_of(path: NDArray[np.float64], place: NDArray[np.float64]) -> NDArray[np.float64]:
    """What is left of a path (n, 2) for a robot at a place (2,) on it, (m, 2), metres."""
    x, y = place
    away = [distance_to_segment(x, y, *a, *b) for a, b in pairwise(path)]
    nearest = len(away) - 1 - int(np.argmin(away[::-1]))  # of several, the last
    return np.vstack([place, path[nearest + 1 :]])


@kernel
def _pull_some(
    population: Population,
    first: int,
    last: int,
    limit: float,
    known: float,
    strings: Strings,
    arrays: ObstacleArrays,
    counter: np.ndarray,
) -> int:
    """Put the best string of some chromosomes into row 1; how many places it has, 0 if none."""
    pulled, seen = strings.pulled, strings.seen
    found = 0
    for i in range(first, last):
        cost = population.chromosomes[i].cost
        if population.chromosomes[i].infeasible > 0 or cost >= limit:
            continue
        slot = _slot(cost, seen.size)
        if seen[slot] == cost:
            continue
        seen[slot] = cost
        count = population.chromosomes[i].intermediate + 2
        if count > pulled.shape[1]:
            continue
        for k in range(count):
            pulled[0, k, 0] = population.nodes[i, k].x
            pulled[0, k, 1] = population.nodes[i, k].y
        count = _pull(pulled[0], count, arrays, counter)
        length = 0.0
        for k in range(count - 1):
            length += distance(
                pulled[0, k, 0], pulled[0, k, 1], pulled[0, k + 1, 0], pulled[0, k + 1, 1]
            )
        if length < known * (1.0 - LEAST_GAIN):
            known = length
            found = count
            for k in range(count):
                pulled[1, k, 0], pulled[1, k, 1] = pulled[0, k, 0], pulled[0, k, 1]
    return found


@kernel
def _slot(cost: float, size: int) -> int:
    """Where a cost is noted: digits of it that differ from path to path."""
    scattered = cost * 7919.7919
    return int((scattered - np.floor(scattered)) * size)


@kernel
def _pull(string: np.ndarray, count: int, arrays: ObstacleArrays, counter: np.ndarray) -> int:
    """Pull the first ``count`` places of a string taut, in place; how many there are then."""
    k = 1
    while k < count - 1:
        new = _pull_bend(string, count, k, arrays, counter)
        if new < 0:
            k += 1
            continue
        count = new
        k = max(1, k - 1)
    return count


@kernel
def _pull_bend(
    string: np.ndarray, count: int, k: int, arrays: ObstacleArrays, counter: np.ndarray
) -> int:
    """Pull the bend k of a string taut; how many places it has then, or -1 if nothing moved.

    The new places are written behind the string, before they replace the bend.
    """
    ax, ay = string[k - 1, 0], string[k - 1, 1]
    bx, by = string[k, 0], string[k, 1]
    cx, cy = string[k + 1, 0], string[k + 1, 1]
    if (bx == ax and by == ay) or (bx == cx and by == cy):  # twice: a node lies on the goal
        _replace(string, count, k, 0)
        return count - 1
    side = orientation(ax, ay, cx, cy, bx, by)
    x, y = ax, ay
    added = 0
    length = 0.0
    while True:
        nx, ny = _next_of_hull(x, y, ax, ay, bx, by, cx, cy, side, arrays)
        if (nx == bx and ny == by) or not _is_free(x, y, nx, ny, arrays, counter):
            return -1
        length += distance(x, y, nx, ny)
        if nx == cx and ny == cy:
            break
        if count + added >= string.shape[0]:
            return -1
        string[count + added, 0], string[count + added, 1] = nx, ny
        added += 1
        x, y = nx, ny
    known = distance(ax, ay, bx, by) + distance(bx, by, cx, cy)
    if length >= known * (1.0 - LEAST_GAIN) and added > 0:
        return -1
    if arrays.pinches.shape[0] > 0 and _slips(string, count, k, added, arrays):
        return -1
    _replace(string, count, k, added)
    return count + added - 1


@kernel
def _is_free(
    ax: float, ay: float, bx: float, by: float, arrays: ObstacleArrays, counter: np.ndarray
) -> bool:
    if not may_ask(counter):
        return False
    counter[COMPUTED] += 1
    return not segment_enters(ax, ay, bx, by, arrays)


@kernel
def _next_of_hull(
    x: float,
    y: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    cx: float,
    cy: float,
    side: int,
    arrays: ObstacleArrays,
) -> tuple[float, float]:
    """The place after (x, y) on the hull of a, c and all that stops a string in triangle a, b, c.

    Gift wrapping (Jarvis 1973), on b's side of a-c. The bend itself stops the string if a part has
    it as a vertex and juts into the triangle there; a part on the other side does not.
    """
    tree, vertices = arrays.tree, arrays.vertices
    xmin, xmax = min(ax, bx, cx), max(ax, bx, cx)
    ymin, ymax = min(ay, by, cy), max(ay, by, cy)
    nx, ny = cx, cy
    row = 0
    while row < tree.shape[0] and side != 0:
        if (
            (xmin > tree[row, XMAX])
            | (xmax < tree[row, XMIN])
            | (ymin > tree[row, YMAX])
            | (ymax < tree[row, YMIN])
        ):
            row = int(tree[row, SKIP])
            continue
        first, last = int(tree[row, FIRST]), int(tree[row, LAST])
        for v in range(first, last):
            px, py = vertices[v, 0], vertices[v, 1]
            if px == bx and py == by:
                before = v - 1 if v > first else last - 1
                after = v + 1 if v + 1 < last else first
                if not (
                    _is_in_wedge(vertices[before, 0], vertices[before, 1], ax, ay, bx, by, cx, cy)
                    and _is_in_wedge(vertices[after, 0], vertices[after, 1], ax, ay, bx, by, cx, cy)
                ):
                    continue
            if (
                xmin <= px <= xmax
                and ymin <= py <= ymax
                and not (px == x and py == y)
                and orientation(x, y, nx, ny, px, py) == side
                and orientation(ax, ay, cx, cy, px, py) == side
                and orientation(ax, ay, bx, by, px, py) != side
                and orientation(bx, by, cx, cy, px, py) != side
            ):
                nx, ny = px, py
        row += 1
    return nx, ny


@kernel
def _is_in_wedge(
    x: float, y: float, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> bool:
    """Whether a point lies in the closed wedge at b that the triangle a, b, c is cut from."""
    inner = orientation(ax, ay, bx, by, cx, cy)
    return (
        orientation(ax, ay, bx, by, x, y) != -inner and orientation(bx, by, cx, cy, x, y) != -inner
    )


@kernel
def _slips(string: np.ndarray, count: int, k: int, added: int, arrays: ObstacleArrays) -> bool:
    """Whether a string with ``added`` places instead of bend k would slip through a pinch point."""
    for number in range(-1, added + 1):  # the neighbours of the bend, and the new places
        at = _place(count, k, added, number)
        pinch = pinch_at(string[at, 0], string[at, 1], arrays.pinches)
        if pinch < 0 or at == 0 or at == count - 1:
            continue
        before, after = _place(count, k, added, number - 1), _place(count, k, added, number + 1)
        if turn_is_closed(
            string[before, 0],
            string[before, 1],
            string[after, 0],
            string[after, 1],
            arrays.pinches,
            arrays.ways,
            pinch,
        ):
            return True
    return False


@kernel
def _place(count: int, k: int, added: int, number: int) -> int:
    """Where a place of the new string is: those before bend k have numbers below 0."""
    if number < 0:
        return k + number
    return count + number if number < added else k + 1 + number - added


@kernel
def _replace(string: np.ndarray, count: int, k: int, added: int) -> None:
    """Put the ``added`` places behind the string in the place of bend k."""
    # The rest and the places behind it change places, by three reversals.
    _reverse(string, k + 1, count)
    _reverse(string, count, count + added)
    _reverse(string, k + 1, count + added)
    for i in range(k, count + added - 1):
        string[i, 0], string[i, 1] = string[i + 1, 0], string[i + 1, 1]


@kernel
def _reverse(string: np.ndarray, first: int, last: int) -> None:
    last -= 1
    while first < last:
        for j in range(2):
            string[first, j], string[last, j] = string[last, j], string[first, j]
        first += 1
        last -= 1
