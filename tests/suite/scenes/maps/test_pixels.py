"""Outlines of cells are exact."""

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage

from suite.scenes.maps.pixels import drawing_of, outlines

GRIDS = arrays(np.bool_, st.tuples(st.integers(1, 7), st.integers(1, 7)))


def squares(occupied: np.ndarray) -> shapely.Geometry:
    """The oracle: the union of the occupied cells, the first row the lowest."""
    y, x = np.nonzero(occupied)
    return shapely.union_all(shapely.box(x, y, x + 1, y + 1))


def cells(picture: str) -> np.ndarray:
    return np.array([[c == "#" for c in row] for row in picture.split()])


@given(GRIDS)
def test_outlines_are_the_union_of_the_cells(occupied):
    pieces = outlines(occupied)
    assert all(piece.is_valid for piece in pieces)
    assert sum(piece.area for piece in pieces) == occupied.sum()
    assert shapely.union_all(pieces).equals(squares(occupied)) or not occupied.any()


@given(GRIDS)
def test_each_piece_of_cells_that_share_sides_is_a_polygon(occupied):
    assert len(outlines(occupied)) == ndimage.label(occupied)[1]


@given(GRIDS)
def test_no_vertex_lies_on_a_straight_line_and_all_are_corners_of_cells(occupied):
    for piece in outlines(occupied):
        for ring in (piece.exterior, *piece.interiors):
            xy = shapely.get_coordinates(ring)[:-1]
            assert (xy == np.rint(xy)).all()
            ahead = np.roll(xy, -1, axis=0) - xy
            back = np.roll(ahead, 1, axis=0)
            assert (ahead[:, 0] * back[:, 1] != ahead[:, 1] * back[:, 0]).all()


def test_a_piece_within_a_hole_of_another_is_a_polygon_of_its_own():
    occupied = cells("#####\n#...#\n#.#.#\n#...#\n#####")
    outer, inner = outlines(occupied)
    assert [len(outer.interiors), len(inner.interiors)] == [1, 0]
    assert (outer.area, inner.area) == (16.0, 1.0)


def test_an_image_without_or_full_of_obstacles_is_one():
    assert outlines(np.zeros((3, 4), dtype=bool)) == []
    assert outlines(np.ones((3, 4), dtype=bool))[0].equals(shapely.box(0, 0, 4, 3))


def test_the_first_row_is_the_top():
    (piece,) = drawing_of(cells("##.\n...")).obstacles
    assert piece.equals(shapely.box(0, 1, 2, 2))


def test_cells_are_scaled_and_turned_about_the_lower_left_corner_which_lies_at_the_origin():
    drawing = drawing_of(cells(".#\n.."), resolution=0.5, origin=(10.0, -3.0), yaw=np.pi / 2)
    # Turned by a quarter to the left, right is up and up is left.
    assert drawing.workspace.equals_exact(shapely.box(9, -3, 10, -2), 1e-12, normalize=True)
    (piece,) = drawing.obstacles
    assert piece.equals_exact(shapely.box(9, -2.5, 9.5, -2), 1e-12, normalize=True)
