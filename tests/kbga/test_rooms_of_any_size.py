"""KBGA in rooms from 1 mm to 1,000 km, and far from the origin: its tolerances go with the room."""

import numpy as np
import pytest
import shapely

from kbga.algorithm import KBGA
from kbga.encoding import make_lattice, node_x, node_y
from kbga.evaluation import escape_distance, hair
from suite.geometry.arrangement import Arrangement, arrange
from suite.geometry.coordinates import coordinates_of
from suite.referee.path import judge
from suite.scenes.exact import shortest_path
from suite.scenes.scene import make_scene

SIZES = {"1 mm": 1e-5, "100 m": 1.0, "1,000 km": 1e4}
"""Factors on a room of 100 m."""

sizes = pytest.mark.parametrize("factor", SIZES.values(), ids=SIZES)
OFFSETS = pytest.mark.parametrize("corner", [(0.0, 0.0), (691608.2, 5334765.7), (257390.5, 9.9e6)])


def wall(factor: float) -> Arrangement:
    """A wall from border to border."""
    room, across = ((0, 0, 100, 100), (40, 0, 60, 100))
    scaled = [shapely.box(*(factor * x for x in box)) for box in (room, across)]
    return arrange(scaled[0], [scaled[1]])


@sizes
def test_a_wall_from_border_to_border_has_no_way_under_it_in_any_room(factor):
    # Over the border by a two thousandth of the room: not on it.
    low = 0.05 * factor
    depth = escape_distance(0.0, low, 100 * factor, low, wall(factor).arrays, 0)
    assert depth == pytest.approx(100 * factor, rel=1e-3)


def test_what_is_rounding_goes_with_the_room_and_never_below_that_of_its_coordinates():
    assert hair(wall(1.0).arrays) == 1e-6
    assert hair(wall(1e4).arrays) == pytest.approx(1e-2)
    far = (1e7, 1e7, 1e7 + 1.0, 1e7 + 1.0)
    width = hair(arrange(shapely.box(*far), []).arrays)
    assert coordinates_of(far).grid <= width <= 10.0 * coordinates_of(far).grid


@sizes
@pytest.mark.parametrize("seed", range(2))
def test_it_finds_a_short_way_in_a_room_of_any_size(factor, seed):
    boxes = [(20.3, 0, 30.1, 70.7), (50.9, 30.7, 60.3, 100), (70.7, 10.1, 80.9, 60.3)]
    room, *walls = (shapely.box(*(factor * x for x in b)) for b in [(0, 0, 100, 100), *boxes])
    start, goal = factor * np.array([(5.3, 5.7), (93.1, 8.9)])
    scene = make_scene("room", room, walls, (start, goal))
    verdict = judge(scene, scene.query(), KBGA(scene, rng=seed).run())
    assert verdict.valid
    optimum = shortest_path(scene, scene.query()).length
    assert optimum * (1 - 1e-12) <= verdict.length < 1.1 * optimum


@OFFSETS
def test_a_node_on_a_wall_stays_there_wherever_the_room_lies(corner):
    # Decimal numbers of a map, and lines that meet them: x0 + 37 * 0.8 is that of 29.6.
    x0, y0 = corner
    lattice = make_lattice((x0, y0, x0 + 80.0, y0 + 80.0), 100)
    for k in range(101):
        assert node_x(lattice, k) == round(x0 + 0.8 * k, 1)
        assert node_y(lattice, k * lattice.columns) == round(y0 + 0.8 * k, 1)
