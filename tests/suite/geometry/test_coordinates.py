"""Local coordinates are exact, the grid is one that float64 can tell, and places are read back."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suite.geometry.coordinates import coordinates_of, printed
from suite.geometry.tolerances import GRID, LARGEST

places = st.floats(-0.9 * LARGEST, 0.9 * LARGEST)
sides = st.floats(1.0, 1e6)
shares = st.floats(-0.25, 1.25)


def exactly(x: float, origin: float) -> Fraction:
    return Fraction(x) - Fraction(origin)


@given(places, places, sides, sides, shares, shares)
def test_a_place_within_reach_of_the_room_is_moved_there_and_back_exactly(x, y, w, h, u, v):
    room = (x, y, x + w, y + h)
    point = np.array([x + u * max(w, h), y + v * max(w, h)])
    coordinates = coordinates_of(room)
    local = coordinates.local(point)
    assert [Fraction(value) for value in local.tolist()] == [
        exactly(p, o) for p, o in zip(point.tolist(), coordinates.origin, strict=True)
    ]
    assert np.array_equal(coordinates.world(local), point)


@given(places, places, sides, sides, shares, shares)
def test_snapping_twice_is_snapping_once_and_moves_by_half_a_grid(x, y, w, h, u, v):
    coordinates = coordinates_of((x, y, x + w, y + h))
    point = np.array([x + u * w, y + v * h])
    snapped = coordinates.snapped(point)
    assert np.array_equal(coordinates.snapped(snapped), snapped)
    assert np.abs(snapped - point).max() <= 0.54 * coordinates.grid


@given(places, sides)
def test_the_grid_is_sixteen_spacings_of_float64_at_least(x, side):
    room = (x, 0.0, x + side, side)
    grid = coordinates_of(room).grid
    spacing = math.ulp(max(abs(value) for value in room))
    assert grid >= GRID
    assert grid >= 15.99 * spacing
    assert grid == GRID or grid < 160.1 * spacing


@pytest.mark.parametrize(
    ("side", "grid"), [(1e-3, 1e-12), (0.5, 1e-10), (1.0, 1e-9), (1e4, 1e-9), (1e6, 1e-8)]
)
def test_near_the_origin_the_grid_is_a_nanometre_or_finer_in_small_rooms(side, grid):
    coordinates = coordinates_of((0.0, 0.0, side, side))
    assert coordinates.grid == grid
    assert coordinates.origin == (0.0, 0.0)


@given(places, places)
def test_a_printed_place_is_read_back_to_the_nanometre(x, y):
    read = [float(word) for word in printed(x, y).strip("()").split(", ")]
    assert np.abs(np.array(read) - (x, y)).max() <= 0.51e-9 + np.spacing(max(abs(x), abs(y)))


def test_coordinates_of_a_map_are_printed_as_they_are():
    assert printed(461523.25, 5638012.125) == "(461523.25, 5638012.125)"
    assert printed(691608.2, 5334765.7) == "(691608.2, 5334765.7)"
    assert printed(-0.0, 1e300) == "(0, 1e+300)"
