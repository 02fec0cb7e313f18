"""What a run of the algorithm knows of its environment: obstacles, lattice, likely nodes.

Of what follows from the obstacles, only that is found out which a run asks for.
"""

import math
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from kbga.encoding import Lattice, distance_to_segment, make_lattice, node_x, node_y
from kbga.memory import Memory, empty_memory
from suite.geometry.arrangement import Arrangement
from suite.geometry.coordinates import Coordinates
from suite.geometry.kernels import (
    FIRST_EDGE,
    LAST_EDGE,
    ObstacleArrays,
    pinch_at,
    segment_enters,
)
from suite.jit import kernel

UNKNOWN, USABLE, CLOSED = 0, 1, 2
LISTED = 4
"""Added to what is known of a node while it is in the list that is being made."""

MOST_NEAR = 16
"""Lattice nodes next to one corner: those of its cell and of the cells around it."""

NOT_LOOKED_FOR = -1
NO_NODE = -1

TAN_SHARP = math.tan(math.radians(10.0))
"""Of the turn from which on a corner is sharp: a grown corner has an arc of 48 sides a circle."""


class Problem(NamedTuple):
    """The environment, as the compiled operators see it.

    arrays : the obstacles.
    lattice : the lattice of intermediate nodes.
    places : (n,) int64, the lattice nodes in the workspace; empty where that fills its bounds, and
        all are.
    corners : (K, 2) float64, corners of the obstacle groups, group by group, metres.
    corner_nodes : (K,) int64, numbers of those that are nodes themselves: sharp ones, if they are
        to be nodes; else NO_NODE.
    corner_start : (G + 1,) int64, rows of ``corners`` where each group begins.
    reach : int. Nodes near a group are those within so many units of its boundary; 0: those next
        to its corners.
    near : (N,) int64, free nodes near each group, from ``near_start[g]`` on.
    near_start : (G + 1,) int64.
    near_count : (G,) int64, how many nodes there are; NOT_LOOKED_FOR before they are found.
    usable : (nodes,) int8, what is known of each node: UNKNOWN, USABLE or CLOSED.
    memory : what is known of segments, see :mod:`kbga.memory`. It and ``usable`` fill up during a
        run; all else stays as it is.
    """

    arrays: ObstacleArrays
    lattice: Lattice
    places: NDArray[np.int64]
    corners: NDArray[np.float64]
    corner_nodes: NDArray[np.int64]
    corner_start: NDArray[np.int64]
    reach: int
    near: NDArray[np.int64]
    near_start: NDArray[np.int64]
    near_count: NDArray[np.int64]
    usable: NDArray[np.int8]
    memory: Memory


def make_problem(
    arrangement: Arrangement,
    bounds: tuple[float, float, float, float],
    resolution: int,
    *,
    room: shapely.Polygon | None = None,
    reach: int = 0,
    coordinates: Coordinates | None = None,
    corner_nodes: bool = False,
) -> Problem:
    """Lay the lattice over a scene.

    Parameters
    ----------
    arrangement : Arrangement
    bounds : xmin, ymin, xmax, ymax of the workspace, metres.
    resolution : lattice units per side, see :func:`kbga.encoding.make_lattice`.
    room : Polygon
        The workspace; default: its bounds.
    reach : int
        Of the search for nodes near an obstacle, lattice units; 0: next to its corners.
    coordinates : Coordinates
        Of the scene; default: those of a workspace of these bounds.
    corner_nodes : bool
        Whether corners of obstacles are nodes too.
    """
    area = None if room is None else room.area
    groups = len(arrangement.arrays.groups)
    # Always a copy: a view would be read-only where there are no corners, another type to numba.
    corners = np.array(arrangement.corners[:, :2], order="C")
    lattice = make_lattice(bounds, resolution, area, coordinates, corners if corner_nodes else None)
    numbers = np.full(len(corners), NO_NODE)
    if corner_nodes:
        _number_corners(arrangement.corners, lattice, numbers)
    corner_start = np.searchsorted(arrangement.corner_group, np.arange(groups + 1))
    if reach == 0:
        near_start = MOST_NEAR * corner_start
    else:
        near_start = _room_along_boundaries(arrangement.arrays, lattice, reach)
    return Problem(
        arrangement.arrays,
        lattice,
        _places(lattice, bounds, room),
        corners,
        numbers,
        corner_start,
        int(reach),
        np.empty(near_start[-1], np.int64),
        near_start,
        np.full(groups, NOT_LOOKED_FOR),
        np.zeros(lattice.columns * lattice.rows + len(lattice.corners), np.int8),
        empty_memory(),
    )


@kernel
def _number_corners(
    corners: NDArray[np.float64], lattice: Lattice, numbers: NDArray[np.int64]
) -> None:
    """Note in ``numbers`` which nodes the sharp ones of corners (K, 6) are.

    Where a corner lies on a crossing of the lattice, the two are one node.
    """
    for corner in range(len(corners)):
        if not _is_sharp(corners[corner]):
            continue
        x, y = corners[corner, 0], corners[corner, 1]
        column = _nearest(lattice.xs, (x - lattice.x0) / lattice.unit)
        row = _nearest(lattice.ys, (y - lattice.y0) / lattice.unit)
        if lattice.xs[column] == x and lattice.ys[row] == y:
            numbers[corner] = row * lattice.columns + column
        else:
            numbers[corner] = lattice.columns * lattice.rows + corner


@kernel
def _nearest(lines: NDArray[np.float64], place: float) -> int:
    """Number of the line nearest to a place, which is given in units from the first one."""
    return min(max(int(np.rint(place)), 0), lines.size - 1)


@kernel
def _is_sharp(corner: NDArray[np.float64]) -> bool:
    """Whether a corner (6,), with the ends of its edges, turns by 10 degrees or more."""
    before_x, before_y = corner[0] - corner[2], corner[1] - corner[3]
    after_x, after_y = corner[4] - corner[0], corner[5] - corner[1]
    cross = before_x * after_y - before_y * after_x
    dot = before_x * after_x + before_y * after_y
    return dot <= 0.0 or abs(cross) >= TAN_SHARP * dot


def _places(
    lattice: Lattice, bounds: tuple[float, float, float, float], room: shapely.Polygon | None
) -> NDArray[np.int64]:
    """Lattice numbers in a room that does not fill its bounds: the grid lies over the workspace."""
    if room is None or room.equals(shapely.box(*bounds)):
        return np.empty(0, np.int64)
    shapely.prepare(room)
    inside = shapely.intersects_xy(room, *np.meshgrid(lattice.xs, lattice.ys))
    return np.flatnonzero(inside.ravel())


def _room_along_boundaries(
    arrays: ObstacleArrays, lattice: Lattice, reach: int
) -> NDArray[np.int64]:
    """Where the near nodes of each group begin, with room for all that can be: (G + 1,) int64."""
    edges = arrays.boundary
    # Rows that an edge's surroundings can meet, by the most nodes that they cut out of one row.
    spans = np.abs(edges[:, 2:] - edges[:, :2]) / lattice.unit
    most = (np.ceil(spans.max(axis=1, initial=0.0)) + 2 * reach + 2) * (3 * reach + 4)
    total = np.concatenate([[0], np.cumsum(most.astype(np.int64))])
    sizes = total[arrays.groups[:, LAST_EDGE].astype(int)]
    sizes -= total[arrays.groups[:, FIRST_EDGE].astype(int)]
    # No group has more near nodes than there are nodes.
    sizes = np.minimum(sizes, lattice.columns * lattice.rows)
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)


@kernel
def node_count(problem: Problem) -> int:
    """How many lattice nodes there are in the workspace."""
    if problem.places.size > 0:
        return problem.places.size
    return problem.lattice.columns * problem.lattice.rows


@kernel
def node_at(number: int, problem: Problem) -> int:
    """Return the lattice number of one of the nodes in the workspace."""
    return problem.places[number] if problem.places.size > 0 else number


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
    return (usable[node] & USABLE) != 0


@kernel
def near_count(group: int, problem: Problem) -> int:
    """How many free nodes lie near an obstacle group; finds them if need be.

    The paper's "neighboring grids of the intersected obstacle" (II-C); or its corners themselves,
    where these are nodes and sharp (ours).
    """
    if problem.near_count[group] == NOT_LOOKED_FOR:
        if problem.reach > 0:
            problem.near_count[group] = _find_along_boundary(group, problem)
        else:
            problem.near_count[group] = _find_at_corners(group, problem)
    return problem.near_count[group]


@kernel
def near_node(group: int, number: int, problem: Problem) -> int:
    """One of the free nodes near an obstacle group, which has been asked for their count."""
    return problem.near[problem.near_start[group] + number]


@kernel
def _find_along_boundary(group: int, problem: Problem) -> int:
    """List the free nodes within reach of the boundary of a group; how many there are.

    Row by row along each edge: the part of the edge that is within reach of the row bounds the
    columns that can be.
    """
    lattice, arrays, near = problem.lattice, problem.arrays, problem.near
    first = problem.near_start[group]
    reach = problem.reach * lattice.unit
    count = 0
    for e in range(int(arrays.groups[group, FIRST_EDGE]), int(arrays.groups[group, LAST_EDGE])):
        ax, ay = arrays.boundary[e, 0], arrays.boundary[e, 1]
        bx, by = arrays.boundary[e, 2], arrays.boundary[e, 3]
        low = int(np.ceil((min(ay, by) - reach - lattice.y0) / lattice.unit))
        high = int(np.floor((max(ay, by) + reach - lattice.y0) / lattice.unit))
        for row in range(max(low, 0), min(high, lattice.rows - 1) + 1):
            y = lattice.y0 + row * lattice.unit
            left, right = min(ax, bx), max(ax, bx)
            if abs(by - ay) > reach:  # else all of the edge may be within reach of the row
                near_x = ax + (bx - ax) * min(max((y - reach - ay) / (by - ay), 0.0), 1.0)
                far_x = ax + (bx - ax) * min(max((y + reach - ay) / (by - ay), 0.0), 1.0)
                left, right = min(near_x, far_x), max(near_x, far_x)
            begin = int(np.ceil((left - reach - lattice.x0) / lattice.unit))
            end = int(np.floor((right + reach - lattice.x0) / lattice.unit))
            for column in range(max(begin, 0), min(end, lattice.columns - 1) + 1):
                node = row * lattice.columns + column
                x = lattice.x0 + column * lattice.unit
                if (
                    problem.usable[node] < LISTED
                    and distance_to_segment(x, y, ax, ay, bx, by) <= reach
                    and is_known_usable(node, problem)
                ):
                    problem.usable[node] += LISTED
                    near[first + count] = node
                    count += 1
    for n in range(first, first + count):
        problem.usable[near[n]] -= LISTED
    return count


@kernel
def _find_at_corners(group: int, problem: Problem) -> int:
    """List the free nodes next to the corners of a group; how many there are.

    Of each corner, those are the crossings of the lattice cell that holds it; where they are closed
    or those of another corner already, of the cells around it too. Shortest paths bend at corners
    only.

    A sharp corner that is a node itself needs none beside it. Of a round one, a few crossings stand
    for many corners.
    """
    first, near = problem.near_start[group], problem.near
    count = 0
    for corner in range(problem.corner_start[group], problem.corner_start[group + 1]):
        own = problem.corner_nodes[corner]
        if own >= 0:
            if problem.usable[own] < LISTED and is_known_usable(own, problem):
                problem.usable[own] += LISTED
                near[first + count] = own
                count += 1
            continue
        found = _add_near_corner(problem, corner, 0, first, count)
        if found == count:
            found = _add_near_corner(problem, corner, 1, first, count)
        count = found
    for n in range(first, first + count):
        problem.usable[problem.near[n]] -= LISTED
    return count


@kernel
def _add_near_corner(problem: Problem, corner: int, margin: int, first: int, count: int) -> int:
    """Add the free nodes of the cell of a corner, and ``margin`` cells around, to the near ones."""
    lattice, near = problem.lattice, problem.near
    column = (problem.corners[corner, 0] - lattice.x0) / lattice.unit
    row = (problem.corners[corner, 1] - lattice.y0) / lattice.unit
    for j in range(int(np.floor(row)) - margin, int(np.ceil(row)) + margin + 1):
        for i in range(int(np.floor(column)) - margin, int(np.ceil(column)) + margin + 1):
            if not (0 <= i < lattice.columns and 0 <= j < lattice.rows):
                continue
            node = j * lattice.columns + i
            if problem.usable[node] < LISTED and is_known_usable(node, problem):
                problem.usable[node] += LISTED
                near[first + count] = node
                count += 1
    return count
