"""An outline with fewer vertices covers the exact one, and reaches no further than was said."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage
from shapely.affinity import rotate, translate
from shapely.geometry import Polygon

from suite.scenes.maps.pixels import outlines
from suite.scenes.maps.simplify import simplified
from tests.strategies import lattice_polygons

GRIDS = arrays(np.bool_, st.tuples(st.integers(2, 9), st.integers(2, 9)))
TOLERANCES = st.sampled_from([0.3, 0.71, 1.0, 1.5, 3.0])


def check(exact: Polygon, tolerance: float, slack: float = 1e-9) -> Polygon:
    found = simplified(exact, tolerance)
    assert found.is_valid
    assert shapely.get_num_coordinates(found) <= shapely.get_num_coordinates(exact)
    assert exact.difference(found.buffer(slack)).is_empty
    added = shapely.segmentize(found, 0.05)
    assert shapely.distance(shapely.points(shapely.get_coordinates(added)), exact).max() <= (
        tolerance + slack
    )
    # What lies between is no further: the farthest points of a pocket lie on its chord.
    inside = shapely.get_parts(found.difference(exact))
    middles = [part.representative_point() for part in inside if part.area > 0.0]
    assert all(middle.distance(exact) <= tolerance + slack for middle in middles)
    return found


@settings(max_examples=60)
@given(GRIDS, TOLERANCES)
def test_outlines_of_cells_only_grow_and_by_no_more_than_the_tolerance(occupied, tolerance):
    for piece in outlines(occupied):
        check(piece, tolerance)


@settings(max_examples=40)
@given(lattice_polygons(), TOLERANCES, st.floats(0.0, 360.0))
def test_so_do_polygons_of_any_kind_at_the_coordinates_of_a_map(polygon, tolerance, angle):
    moved = translate(rotate(polygon, angle, origin=(0, 0)), 691608.2, 5334765.7)
    check(moved, tolerance, slack=1e-6)


def test_a_convex_polygon_stays_what_it_is():
    box = shapely.box(0, 0, 3, 2)
    assert simplified(box, 10.0).equals(box)


def test_an_outline_never_crosses_another_of_the_same_polygon():
    # A C whose mouth is closed but for a finger that lies in it.
    room = shapely.box(0, 0, 10, 10).difference(shapely.box(2, 4, 10, 6))
    finger = shapely.box(1, 4.9, 8, 5.1)
    found = check(room.union(finger), 20.0)
    assert found.is_valid


def test_stairs_become_a_slope():
    steps = np.tril(np.ones((40, 40), dtype=bool))
    (piece,) = outlines(steps)
    assert shapely.get_num_coordinates(piece) - 1 > 80
    # A tip at each end of the slope, and the corner below.
    assert shapely.get_num_coordinates(check(piece, 0.8).simplify(0.0)) - 1 <= 5


def test_blots_lose_most_of_its_vertices():
    noise = np.random.default_rng(1).random((120, 120))
    pieces = outlines(ndimage.gaussian_filter(noise, 4) < 0.49)
    before, after = (
        sum(map(shapely.get_num_coordinates, found))
        for found in (pieces, [check(piece, 1.0) for piece in pieces])
    )
    assert after < 0.5 * before
