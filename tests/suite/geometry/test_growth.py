"""Growth is nowhere less than the radius, exactly the radius along walls, and hardly more."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon, box

from suite.geometry.growth import SIDES, grown, shrunk
from tests.strategies import float_polygons, lattice_polygons
from tests.suite.geometry.lattice import star

GRID = 1e-9
WIDEST = 1.0 / math.cos(0.25 * math.pi / SIDES)
"""Of a fan's corner from its centre, in radii."""

radii = st.floats(0.05, 3.0)
stars = st.integers(0, 2**32).map(lambda seed: star(np.random.default_rng(seed), (5.0, 5.0), 3.0))
polygons = st.one_of(lattice_polygons(), float_polygons(), stars)


@given(polygons, radii)
@settings(max_examples=100)
def test_all_within_the_radius_is_covered_and_hardly_more(polygon, radius):
    cover = grown(polygon, radius, GRID)
    assert cover.is_valid
    again = shapely.set_precision(cover, GRID)
    for outline in (cover, again):
        assert outline.exterior.distance(polygon) >= radius - 1e-2 * GRID
        assert all(hole.distance(polygon) >= radius - 1e-2 * GRID for hole in outline.interiors)
    reach = shapely.buffer(polygon, radius * WIDEST * 1.0001, quad_segs=500)
    assert cover.difference(reach).area < 1e-6


@given(polygons, st.floats(0.05, 0.5))
@settings(max_examples=100)
def test_what_is_left_of_a_room_keeps_the_radius_from_its_border(polygon, radius):
    left = shrunk(polygon, radius, GRID)
    assume(not left.is_empty)
    assert left.is_valid
    assert polygon.contains_properly(left)
    assert left.distance(polygon.boundary) >= radius - 1e-2 * GRID
    assert polygon.buffer(-radius * WIDEST * 1.0001, quad_segs=500).difference(left).area < 1e-6


def test_walls_move_by_exactly_the_radius():
    middle = shapely.box(4.1, 0, 5.9, 10)
    assert grown(box(4, 4, 6, 6), 0.5, GRID).intersection(middle).bounds == (4.1, 3.5, 5.9, 6.5)
    assert shrunk(box(0, 0, 10, 10), 0.5, GRID).equals(box(0.5, 0.5, 9.5, 9.5))


def test_a_robot_may_stand_exactly_its_radius_from_a_wall_along_an_axis():
    """On a map of cells of a metre with a radius of 0.5 m: in each cell beside a wall."""
    cover = grown(box(4, 4, 6, 6), 0.5, GRID)
    beside = shapely.points([(x, y) for x in (3.5, 4.5, 5.5, 6.5) for y in (3.5, 4.5, 5.5, 6.5)])
    corners = shapely.points([(x, y) for x in (3.5, 6.5) for y in (3.5, 6.5)])
    inside = shapely.points([(x, y) for x in (4.5, 5.5) for y in (4.5, 5.5)])
    assert shapely.relate_pattern(cover, beside, "T********").sum() == 4
    assert shapely.relate_pattern(cover, inside, "T********").all()
    assert not cover.intersects(corners).any()


def test_a_yard_too_narrow_for_the_robot_is_filled_and_a_wider_one_stays():
    with_yard = Polygon(box(0, 0, 10, 10).exterior, [box(4, 4, 6, 6).exterior])
    assert len(grown(with_yard, 1.1, GRID).interiors) == 0
    assert Polygon(grown(with_yard, 0.9, GRID).interiors[0]).equals_exact(
        box(4.9, 4.9, 5.1, 5.1), 1e-8, normalize=True
    )


@pytest.mark.parametrize("turn", np.arange(0.0, 90.0, 7.0))
def test_no_hole_is_left_where_strips_and_fans_meet(turn):
    spike = shapely.affinity.rotate(Polygon([(0, 0), (10, 0.1), (0, 0.2)]), turn, origin=(0, 0))
    assert len(grown(spike, 0.4, GRID).interiors) == 0
