"""Outlines of cells are exact, and what touches in a corner is closed."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage

from suite.scenes.exact import shortest_path
from suite.scenes.maps.pixels import drawing_of, outlines
from suite.scenes.scene import Scene, make_scene

GRIDS = arrays(np.bool_, st.tuples(st.integers(1, 7), st.integers(1, 7)))


def squares(occupied: np.ndarray) -> shapely.Geometry:
    """The oracle: the union of the occupied cells, the first row the lowest."""
    y, x = np.nonzero(occupied)
    return shapely.union_all(shapely.box(x, y, x + 1, y + 1))


def cells(picture: str) -> np.ndarray:
    return np.array([[c == "#" for c in row] for row in picture.split()])


def scene_of(picture: str, start, goal, **placed) -> Scene:
    drawing = drawing_of(cells(picture), **placed)
    return make_scene("cells", drawing.workspace, drawing.obstacles, (start, goal))


def optimum(picture: str, start, goal) -> float | None:
    scene = scene_of(picture, start, goal)
    found = shortest_path(scene, scene.query())
    return None if found.path is None else found.length


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


@pytest.mark.parametrize(
    ("picture", "start", "goal"),
    [
        ("...#\n..#.\n.#..\n#...", (0.5, 3.5), (3.5, 0.5)),
        (".###.\n.#.#.\n.##..\n.....", (2.5, 2.5), (3.5, 1.5)),
    ],
    ids=["pieces", "a piece and itself"],
)
def test_cells_that_meet_in_a_corner_let_nothing_through(picture, start, goal):
    assert optimum(picture, start, goal) is None


def test_a_touch_that_is_opened_by_a_cell_lets_a_path_through():
    assert optimum("...#\n....\n.#..\n#...", (0.5, 3.5), (3.5, 0.5)) is not None


# The mistakes that gave wrong optima of real maps.


def test_a_block_whose_corners_lie_on_the_straight_line_is_walked_round():
    room = ".....\n.....\n..#..\n.....\n....."
    assert optimum(room, (0.5, 0.5), (4.5, 4.5)) == pytest.approx(2 * np.hypot(2.5, 1.5))


def test_a_wall_of_which_a_corner_lies_on_the_straight_line_on_either_side_is_closed():
    # The straight line runs from corner to corner through both cells.
    assert optimum("..#.\n.##.\n.#..\n##..", (0.5, 3.5), (3.5, 0.5)) is None


@pytest.mark.parametrize("yaw", [0.0, 0.1, 1.0])
@pytest.mark.parametrize("resolution", [1.0, 0.05, 0.03])
def test_a_route_along_corners_in_a_row_is_as_long_as_it_is(resolution, yaw):
    # Stairs up to the right: their tips lie on a line from (1, 1) on, one to three.
    stairs = np.zeros((13, 36), dtype=bool)
    for y in range(1, 11):
        stairs[y, 3 * y + 1 :] = True
    drawing = drawing_of(stairs[::-1], resolution=resolution, yaw=yaw)
    turn = resolution * np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    ends = np.array([(1.0, 1.0), (34.0, 12.0)]) @ turn
    scene = make_scene("stairs", drawing.workspace, drawing.obstacles, tuple(ends))
    found = shortest_path(scene, scene.query())
    assert found.length == pytest.approx(np.hypot(*(ends[1] - ends[0])), rel=1e-8)


def test_the_frame_of_the_map_is_closed():
    assert optimum(".#.\n.#.\n.#.", (0.5, 0.5), (2.5, 0.5)) is None
    # One way round is left, and it is inside.
    assert optimum("...\n.#.\n.#.", (0.5, 0.5), (2.5, 0.5)) == pytest.approx(
        2 * np.hypot(0.5, 1.5) + 1.0
    )
