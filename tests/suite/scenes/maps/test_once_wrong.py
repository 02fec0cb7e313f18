"""What once gave wrong optima of real maps: each from a file, to the right optimum."""

from pathlib import Path

import numpy as np
import pytest

from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from tests.suite.scenes.maps.files import grid_text, write_ros


def optimum(folder: Path, rows: str, ends: str) -> float | None:
    """Of a grid whose lower left corner is (0, 0), between any two points; None without a path."""
    (folder / "grid.map").write_text(grid_text(rows.replace("#", "@").split()))
    scene = load_scene(str(folder / "grid.map"))
    query = scene.query(ends)
    assert query.blocked is None
    found = shortest_path(scene, query)
    return None if found.path is None else found.length


# A vertex on the straight line blocks it where what is closed lies on both sides.


def test_a_block_whose_corners_lie_on_the_straight_line_is_walked_round(tmp_path):
    room = ".....  .....  ..#..  .....  ....."
    around = 2 * np.hypot(2.5, 1.5)
    assert optimum(tmp_path, room, "0.5,0.5:4.5,4.5") == pytest.approx(around)


def test_a_wall_of_which_corners_lie_on_the_straight_line_is_closed(tmp_path):
    # The straight line runs from corner to corner of the two middle cells.
    assert optimum(tmp_path, "..#.  .##.  .#..  ##..", "0.5,3.5:3.5,0.5") is None


# Routes along corners in a row are taut, however their coordinates are rounded.


@pytest.mark.parametrize("yaw", [0.0, 0.1, 1.0])
@pytest.mark.parametrize("resolution", [1.0, 0.05, 0.03])
def test_a_route_along_corners_in_a_row_is_as_long_as_it_is(tmp_path, resolution, yaw):
    # Stairs up to the right: their tips lie on a line from (1, 1) on, one to three.
    stairs = np.full((13, 36), 255, dtype=np.uint8)
    for y in range(1, 11):
        stairs[y, 3 * y + 1 :] = 0
    file = write_ros(tmp_path, stairs[::-1], resolution=resolution, origin=[0.0, 0.0, yaw])
    turn = resolution * np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    (x, y), (to_x, to_y) = (np.array([(1.0, 1.0), (34.0, 12.0)]) @ turn).tolist()
    scene = load_scene(str(file))
    found = shortest_path(scene, scene.query(f"{x:.9f},{y:.9f}:{to_x:.9f},{to_y:.9f}"))
    assert found.length == pytest.approx(np.hypot(to_x - x, to_y - y), rel=1e-7)


# The border of the map is closed: no way leads round outside.


def test_a_wall_from_border_to_border_is_not_walked_round(tmp_path):
    assert optimum(tmp_path, ".#.  .#.  .#.", "0.5,0.5:2.5,0.5") is None


def test_a_wall_that_is_open_at_one_end_is_walked_round_there(tmp_path):
    around = 2 * np.hypot(0.5, 1.5) + 1.0
    assert optimum(tmp_path, "...  .#.  .#.", "0.5,0.5:2.5,0.5") == pytest.approx(around)


# What touches in a single point lets nothing through.


@pytest.mark.parametrize(
    ("rows", "ends"),
    [
        ("...#  ..#.  .#..  #...", "0.5,3.5:3.5,0.5"),
        (".###.  .#.#.  .##..  .....", "2.5,2.5:3.5,1.5"),
    ],
    ids=["pieces", "a piece and itself"],
)
def test_cells_that_meet_in_a_corner_let_nothing_through(tmp_path, rows, ends):
    assert optimum(tmp_path, rows, ends) is None


def test_where_a_cell_is_free_a_path_leads_through(tmp_path):
    assert optimum(tmp_path, "...#  ....  .#..  #...", "0.5,3.5:3.5,0.5") is not None
