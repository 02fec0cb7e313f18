"""What is drawn and not closed is found, however little of it there is."""

import pytest
from shapely import MultiPolygon, Polygon, box
from shapely.affinity import translate

from suite.geometry.coordinates import coordinates_of
from suite.geometry.coverage import left_open

PLACES = [(0.0, 0.0), (691608.2, 5334765.7), (-2e7, 9e6)]


def open_ones(solid: list[Polygon], drawn: list[Polygon], place) -> list[int]:
    room = translate(box(0, 0, 80, 60), *place)
    closed = MultiPolygon([translate(p, *place) for p in solid])
    return left_open(closed, [translate(p, *place) for p in drawn], coordinates_of(room.bounds))


@pytest.mark.parametrize("place", PLACES)
def test_a_lost_obstacle_is_found(place):
    drawn = [box(10, 10, 30, 50), box(60, 10, 60.01, 10.01)]
    assert open_ones([drawn[0]], drawn, place) == [1]
    assert open_ones(drawn, drawn, place) == []


@pytest.mark.parametrize("place", PLACES)
def test_a_wall_of_the_grids_width_that_is_closed_is_no_fault(place):
    grid = coordinates_of(translate(box(0, 0, 80, 60), *place).bounds).grid
    wall = box(10, 10, 10 + 2 * grid, 50)
    assert open_ones([wall], [wall], place) == []


@pytest.mark.parametrize("place", PLACES)
def test_a_gap_within_an_obstacle_is_found(place):
    halves = [box(10, 10, 20, 50), box(20.001, 10, 30, 50)]
    assert open_ones(halves, [box(10, 10, 30, 50)], place) == [0]


@pytest.mark.parametrize("place", PLACES)
def test_a_lost_corner_is_found_and_a_grids_width_is_none(place):
    drawn = [box(10, 10, 30, 50)]
    assert open_ones([drawn[0].difference(box(29.9999, 49.9999, 31, 51))], drawn, place) == [0]
    grid = coordinates_of(translate(box(0, 0, 80, 60), *place).bounds).grid
    assert open_ones([box(10 + grid, 10, 30, 50 - grid)], drawn, place) == []
