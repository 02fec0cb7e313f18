"""From occupied cells to polygons, exactly: each vertex is a corner of a cell.

What is occupied falls into pieces of cells that share sides. A corner of an outline is a point
where its four cells are not alike in pairs; on each line of the lattice the corners pair up to the
outline's edges, so that sorting links them all. Where two cells meet in one corner only, the
outline keeps to its cell if the other is of another piece, which touches it there; if it is of the
same piece, the piece surrounds a hole that touches its outer outline there. x right, y up.
"""

from collections.abc import Iterator, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage
from shapely.geometry import Polygon

from suite.scenes.maps.drawing import Drawing, Point
from suite.scenes.maps.simplify import simplified

SW, SE, NW, NE = 1, 2, 4, 8
"""The cells around a point of the lattice; a sum of them says which are occupied."""

CORNERS = (SW, SE, NW, NE, SE | NW, SW | NE, *(15 - cell for cell in (SW, SE, NW, NE)))
TOUCHES = (SE | NW, SW | NE)
LEAVES_SIDEWAYS = (SW, NE, 15 - NW, 15 - SE, SW | NE)
"""Corners that an outline leaves to the left or right, what is occupied on its left; it leaves the
others upwards or downwards."""


def outlines(occupied: NDArray[np.bool_]) -> list[Polygon]:
    """The pieces of what is occupied, as polygons without collinear vertices.

    Parameters
    ----------
    occupied : (rows, columns) bool
        The first row is the lowest; cell [y, x] is the square from (x, y) to (x + 1, y + 1).

    Returns
    -------
    list of Polygon
        Valid, with whole coordinates; two of them touch in single points at the most.

    Examples
    --------
    >>> touching = np.array([[1, 0], [0, 1]], dtype=bool)
    >>> [piece.bounds for piece in outlines(touching)]
    [(0.0, 0.0, 1.0, 1.0), (1.0, 1.0, 2.0, 2.0)]
    >>> ring = np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]], dtype=bool)
    >>> outlines(ring)[0].area, len(outlines(ring)[0].interiors)
    (8.0, 1)
    """
    pieces = np.pad(ndimage.label(occupied)[0], 1)
    xy, piece, after = _linked_corners(pieces)
    rings = list(_cycles(after.tolist()))
    if not rings:
        return []
    sizes = np.array([len(ring) for ring in rings])
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    order = np.concatenate(rings)
    corners = xy[order]
    outer = _areas(corners, first) > 0.0
    numbers = np.repeat(np.arange(len(rings)), sizes)
    made = np.asarray(shapely.linearrings(corners, indices=numbers))
    of = piece[order[first]]
    rank = np.lexsort((~outer, of))  # of each piece the outer ring, then its holes
    return list(np.asarray(shapely.polygons(made[rank], indices=of[rank] - 1)))


def _linked_corners(
    pieces: NDArray[np.signedinteger],
) -> tuple[NDArray[np.float64], NDArray[np.signedinteger], NDArray[np.int64]]:
    """Corners of outlines, row by row: where, of what piece, and the number of the one after each.

    A point where two cells touch is two corners, of which the first ends an edge from its left.
    """
    cells = (pieces[:-1, :-1], pieces[:-1, 1:], pieces[1:, :-1], pieces[1:, 1:])
    around = np.zeros(cells[0].shape, dtype=np.uint8)
    for bit, cell in zip((SW, SE, NW, NE), cells, strict=True):
        around |= np.where(cell > 0, np.uint8(bit), np.uint8(0))
    kind = np.zeros(16, dtype=np.bool_)
    kind[list(CORNERS)] = True
    places = np.flatnonzero(kind[around])
    places = np.repeat(places, 1 + np.isin(around.ravel()[places], TOUCHES))
    y, x = np.divmod(places, len(around[0]))
    code = around[y, x]
    sw, se, nw, ne = (cell[y, x] for cell in cells)

    numbers = np.arange(len(places))
    starts_edge = numbers % 2 == 0  # each line's corners are the ends of its edges, by turns
    sideways = numbers ^ 1
    # Where cells touch: whether the corner goes on upwards, see the file's docstring.
    joined = np.where(code == SE | NW, se == nw, sw == ne)
    up = ((code == SE | NW) == joined) == starts_edge
    order = np.lexsort((np.isin(code, TOUCHES) & up, y, x))
    upright = np.empty_like(numbers)
    upright[order] = order[numbers ^ 1]
    after = np.where(np.isin(code, LEAVES_SIDEWAYS), sideways, upright)
    piece = np.where(starts_edge, np.maximum(se, ne), np.maximum(sw, nw))
    return np.column_stack([x, y]).astype(np.float64), piece, after


def _cycles(after: Sequence[int]) -> Iterator[list[int]]:
    """The cycles of a permutation.

    A loop over corners, the only one: it takes as long as pointer jumping in numpy would.
    """
    seen = bytearray(len(after))
    for first in range(len(after)):
        if not seen[first]:
            cycle = []
            at = first
            while not seen[at]:
                seen[at] = 1
                cycle.append(at)
                at = after[at]
            yield cycle


def _areas(corners: NDArray[np.float64], first: NDArray[np.int64]) -> NDArray[np.float64]:
    """Twice the signed area of each ring; positive if it goes counter-clockwise."""
    following = np.roll(corners, -1, axis=0)
    last = np.append(first[1:], len(corners)) - 1
    following[last] = corners[first]
    cross = corners[:, 0] * following[:, 1] - corners[:, 1] * following[:, 0]
    return np.asarray(np.add.reduceat(cross, first), dtype=np.float64)


def drawing_of(
    occupied: NDArray[np.bool_],
    *,
    resolution: float = 1.0,
    origin: Point = (0.0, 0.0),
    yaw: float = 0.0,
    simplify: float | None = None,
) -> Drawing:
    """A grid of cells, each free or occupied, as workspace and obstacles.

    Parameters
    ----------
    occupied : (rows, columns) bool
        As an image has them: the first row is the highest.
    resolution : float
        Side of a cell, metres.
    origin : (x, y)
        Where the lower left corner of the lowest row's first cell lies, metres.
    yaw : float
        By what the grid is turned about it, counter-clockwise, radians.
    simplify : float, optional
        Metres by which obstacles may grow to have fewer vertices.

    Returns
    -------
    Drawing
        Without queries or properties.
    """
    height, width = occupied.shape
    pieces = outlines(occupied[::-1])
    if simplify is not None:
        pieces = [simplified(piece, simplify / resolution) for piece in pieces]
    turn = resolution * np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    shapes = np.array([shapely.box(0, 0, width, height), *pieces], dtype=np.object_)
    workspace, *obstacles = shapely.transform(shapes, lambda xy: xy @ turn + origin)
    return Drawing(workspace, tuple(obstacles))
