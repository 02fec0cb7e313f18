"""The inside of closed lines: by winding number, which shapely has no word for."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from suite.scenes.maps.fill import filled

corner = st.tuples(st.integers(0, 6), st.integers(0, 6))
rings = st.lists(st.lists(corner, min_size=3, max_size=7), min_size=1, max_size=3)


def angle_around(ring: np.ndarray, point: np.ndarray) -> int:
    """How often a ring goes round a point, by the angles of its edges."""
    to = np.roll(ring, -1, axis=0) - point
    a, b = (ring - point) @ [1, 1j], to @ [1, 1j]
    return round(float(np.angle(b / a).sum() / (2.0 * np.pi)))


@settings(max_examples=40)
@given(rings)
def test_a_point_is_inside_as_often_as_the_rings_go_round_it(drawn):
    given_rings = [np.array(ring, dtype=np.float64) for ring in drawn]
    lines = shapely.union_all([shapely.LinearRing(ring) for ring in given_rings])
    for rule in (False, True):
        area = filled(given_rings, evenodd=rule)
        assert area.is_valid
        for x, y in np.random.default_rng(1).uniform(-0.5, 6.5, (30, 2)):
            if lines.distance(shapely.Point(x, y)) < 1e-6:
                continue
            turns = sum(angle_around(ring, np.array([x, y])) for ring in given_rings)
            assert area.contains(shapely.Point(x, y)) == bool(turns % 2 if rule else turns)


@pytest.mark.parametrize("ring", [[(0, 0), (1, 1)], [(0, 0), (0, 0), (1, 1), (0, 0)]])
def test_two_places_have_no_inside(ring):
    assert filled([np.array(ring, dtype=np.float64)]).is_empty


def test_a_ring_that_does_not_cross_itself_keeps_its_vertices():
    ring = np.array([(0, 0), (5, 0), (5, 5), (2.5, 1), (0, 5)], dtype=np.float64)
    assert shapely.get_coordinates(filled([ring]))[:-1].tolist() == ring.tolist()
