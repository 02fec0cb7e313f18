"""The lattice and the chromosomes (paper II-A): a node is one integer, its lattice number.

Start and goal keep their natural coordinates; only the nodes between them lie on the lattice. A
population is a set of flat arrays; what evaluation found out about a segment is stored beside the
chromosome, and edits keep both in step.
"""

import math
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from suite.geometry.coordinates import Coordinates, coordinates_of
from suite.jit import kernel

FINEST = 20_000
"""Finest resolution. Lattice numbers are 32 bits wide, and a byte is kept for each: 400 MB."""

ROUNDING = 1e-9
"""Share of a unit by which a side may miss a whole number of them."""


class Lattice(NamedTuple):
    """A grid over the workspace whose crossings are numbered row by row from its lower left.

    x0, y0 : float, the crossing number 0, metres.
    unit : float, spacing of the lines, metres.
    columns, rows : int, crossings in a row, and in a column.
    xs, ys : (columns,), (rows,) float64, where the lines lie, on the grid of the obstacles, metres:
        a node on a wall or on the border stays there. 0.1 * 3 lies 5e-17 beyond 0.3, which would
        be inside an obstacle that begins there.
    corners : (K, 2) float64, metres: corners of obstacles that are nodes too (ours), numbered on
        from the last crossing. None, in the paper's algorithm.
    """

    x0: float
    y0: float
    unit: float
    columns: int
    rows: int
    xs: NDArray[np.float64]
    ys: NDArray[np.float64]
    corners: NDArray[np.float64]


def make_lattice(
    bounds: tuple[float, float, float, float],
    resolution: int,
    area: float | None = None,
    coordinates: Coordinates | None = None,
    corners: NDArray[np.float64] | None = None,
) -> Lattice:
    """Lay a lattice over a workspace.

    A unit is a square of 1 / resolution ** 2 of the area of the workspace. In a square room, as
    the paper's are, ``resolution`` units make a side. In any other (ours), a room that is turned
    keeps its unit, and only where the lines lie is another matter.

    Parameters
    ----------
    bounds : xmin, ymin, xmax, ymax of the workspace, metres.
    resolution : units per side of a square of that area.
    area : float, of the workspace, square metres; default: it fills its bounds.
    coordinates : of the scene, whose grid the lines keep to; default: those of these bounds.
    corners : (K, 2) float64, metres, of obstacles, which are to be nodes too; default: none.
    """
    xmin, ymin, xmax, ymax = bounds
    width, height = xmax - xmin, ymax - ymin
    unit = math.sqrt(width * height if area is None else area) / resolution
    # A thin room that lies across its box would have more crossings than numbers.
    unit = max(unit, math.sqrt(width * height) / FINEST)
    # What rounding leaves off the last line is no reason to leave off the line.
    columns, rows = (int(side / unit + ROUNDING) + 1 for side in (width, height))
    lines = unit * np.arange(max(columns, rows))
    grid = coordinates_of(bounds) if coordinates is None else coordinates
    places = grid.snapped(np.column_stack([xmin + lines, ymin + lines]))
    xs, ys = np.array(places[:columns, 0]), np.array(places[:rows, 1])
    xs.setflags(write=False)
    ys.setflags(write=False)
    corners = np.empty((0, 2)) if corners is None else corners
    return Lattice(xmin, ymin, unit, columns, rows, xs, ys, corners)


@kernel
def node_x(lattice: Lattice, node: int) -> float:
    """Coordinate x of a lattice number, metres."""
    corner = node - lattice.columns * lattice.rows
    return lattice.xs[node % lattice.columns] if corner < 0 else lattice.corners[corner, 0]


@kernel
def node_y(lattice: Lattice, node: int) -> float:
    """Coordinate y of a lattice number, metres."""
    corner = node - lattice.columns * lattice.rows
    return lattice.ys[node // lattice.columns] if corner < 0 else lattice.corners[corner, 1]


def nearest_crossing(lattice: Lattice, x: float, y: float) -> int:
    """Lattice number of the crossing that is nearest to a place, metres."""
    column = min(max(round((x - lattice.x0) / lattice.unit), 0), lattice.columns - 1)
    row = min(max(round((y - lattice.y0) / lattice.unit), 0), lattice.rows - 1)
    return row * lattice.columns + column


@kernel
def is_crossing(lattice: Lattice, node: int) -> bool:
    """Whether a lattice number is that of a crossing, which has neighbours; else of a corner."""
    return node < lattice.columns * lattice.rows


@kernel
def distance(ax: float, ay: float, bx: float, by: float) -> float:
    """Distance of two points, metres. Not ``hypot``: its guard against overflow costs 10 ns."""
    dx, dy = bx - ax, by - ay
    return math.sqrt(dx * dx + dy * dy)


@kernel
def distance_to_segment(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Distance of a point from segment a-b, metres."""
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    share = 0.0 if square == 0.0 else ((x - ax) * dx + (y - ay) * dy) / square
    share = min(max(share, 0.0), 1.0)
    return distance(x, y, ax + share * dx, ay + share * dy)


MAX_HITS = 6
"""Obstacle groups remembered per segment. A repair takes one of them; a segment that hits more is
cut in two soon, and the halves are evaluated anew."""


NODE = np.dtype(
    [
        ("gene", np.int32),
        ("settled", np.int8),
        ("needed", np.int8),
        ("hit_count", np.int16),
        ("x", np.float64),
        ("y", np.float64),
        ("length", np.float64),
        ("depth", np.float64),
        ("hits", np.int32, (MAX_HITS,)),
    ],
    align=True,
)
"""A node of a chromosome, and what is known of the segment that leaves it.

gene : lattice number; START and GOAL for the ends.
x, y : metres.
length : d_i of the segment, metres.
depth : beta_i of the segment, metres; 0 if and only if it is feasible.
hits, hit_count : numbers of the obstacle groups that it intersects, and how many are noted.
settled : 1 if improvement found no better place between the same two neighbours.
needed : what deletion found out between the same two neighbours: 0, nothing yet;
    NEEDED_IF_FEASIBLE, no benefit in a feasible path; NEEDED, none in any path.

A record and not seven arrays: edits move nodes with all that is known of them, in one copy. 64
bytes, a line of the processor's cache.
"""

NEEDED_IF_FEASIBLE, NEEDED = 1, 2

CHROMOSOME = np.dtype(
    [("intermediate", np.int64), ("cost", np.float64), ("infeasible", np.int64)], align=True
)
"""A chromosome as a whole.

intermediate : number of intermediate nodes.
cost : Eq. (1), metres.
infeasible : number of infeasible segments.
"""

START, GOAL = -1, -2


class Population(NamedTuple):
    """P chromosomes of at most M nodes, start and goal included.

    Column 0 holds the start, columns 1 to ``intermediate`` the intermediate nodes, the column after
    them the goal. Segment k runs from column k to column k + 1.

    nodes : (P, M) of NODE.
    chromosomes : (P,) of CHROMOSOME.
    """

    nodes: np.ndarray
    chromosomes: np.ndarray


def records(shape: int | tuple[int, ...], dtype: np.dtype) -> np.ndarray:
    """Records, all zero, whose fields the kernels can read as attributes.

    Compiled, they can anyway. Without the compiler it takes numpy's record arrays, which are slow.
    """
    zeros = np.zeros(shape, dtype)
    return zeros.view(np.recarray) if numba.config.DISABLE_JIT else zeros  # type: ignore[attr-defined]


def empty_population(count: int, max_nodes: int) -> Population:
    """Room for ``count`` chromosomes of at most ``max_nodes`` nodes."""
    return Population(records((count, max_nodes), NODE), records(count, CHROMOSOME))


def path_of(population: Population, i: int) -> NDArray[np.float64]:
    """Chromosome i as a path (n, 2), metres."""
    path = np.empty((population.chromosomes["intermediate"][i] + 2, 2))
    _copy_path(population, i, path)
    return path


@kernel
def _copy_path(population: Population, i: int, path: np.ndarray) -> None:
    for k in range(path.shape[0]):
        path[k, 0] = population.nodes[i, k].x
        path[k, 1] = population.nodes[i, k].y


@kernel
def length_of(population: Population, i: int) -> float:
    """Length of chromosome i, metres, whether it is feasible or not."""
    length = 0.0
    for k in range(population.chromosomes[i].intermediate + 1):
        length += population.nodes[i, k].length
    return length


@kernel
def copy_chromosome(source: Population, i: int, target: Population, j: int) -> None:
    """Copy chromosome i of one population to place j of another, with all that is known of it."""
    nodes, copies = source.nodes, target.nodes
    for k in range(source.chromosomes[i].intermediate + 2):
        copies[j, k] = nodes[i, k]
    target.chromosomes[j] = source.chromosomes[i]


@kernel
def set_node(nodes: np.ndarray, i: int, k: int, gene: int, lattice: Lattice) -> None:
    """Put a lattice node into column k; the segments that touch it are to be evaluated after."""
    nodes[i, k].gene = gene
    nodes[i, k].x = node_x(lattice, gene)
    nodes[i, k].y = node_y(lattice, gene)


@kernel
def forget(nodes: np.ndarray, i: int, first: int, last: int) -> None:
    """Note that columns ``first`` to ``last`` have a new place or neighbour: try them again."""
    for k in range(first, last + 1):
        nodes[i, k].settled = 0
        nodes[i, k].needed = 0


@kernel
def open_column(population: Population, i: int, k: int) -> None:
    """Make room for a new node at column k; the rest moves up by one."""
    nodes = population.nodes
    for m in range(population.chromosomes[i].intermediate + 1, k - 1, -1):
        nodes[i, m + 1] = nodes[i, m]
    population.chromosomes[i].intermediate += 1


@kernel
def close_columns(population: Population, i: int, first: int, count: int) -> None:
    """Remove ``count`` nodes from column ``first`` on; the rest moves down."""
    nodes = population.nodes
    for m in range(first + count, population.chromosomes[i].intermediate + 2):
        nodes[i, m - count] = nodes[i, m]
    population.chromosomes[i].intermediate -= count


@kernel
def contains(nodes: np.ndarray, i: int, size: int, gene: int) -> bool:
    """Whether a lattice node is one of the ``size`` intermediate nodes of chromosome i."""
    for k in range(1, size + 1):  # noqa: SIM110 (any() of a generator does not compile)
        if nodes[i, k].gene == gene:
            return True
    return False
