"""The orientation predicate has the exact sign, whatever the floats: held to rational numbers."""

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from suite.geometry.predicates import orientation
from suite.geometry.tolerances import GRID, LARGEST
from tests.suite.geometry.lattice import counts

EXAMPLES = counts(1000, 200)
small = st.integers(-3, 3).map(float)
scene_coordinate = st.floats(-LARGEST, LARGEST).filter(lambda v: v == 0.0 or abs(v) >= GRID)


def exact(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    ax, ay, bx, by, cx, cy = (Fraction(v) for v in (ax, ay, bx, by, cx, cy))
    determinant = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return (determinant > 0) - (determinant < 0)


@settings(max_examples=EXAMPLES)
@given(st.tuples(*[small] * 6))
def test_sign_is_exact_on_the_lattice(points):
    assert orientation(*points) == exact(*points)


@settings(max_examples=EXAMPLES)
@given(st.tuples(*[scene_coordinate] * 6))
def test_sign_is_exact_for_any_coordinates_of_a_scene(points):
    assert orientation(*points) == exact(*points)


@settings(max_examples=EXAMPLES)
@given(
    st.tuples(*[st.floats(-1e4, 1e4)] * 4),
    st.floats(-1, 2),
    st.tuples(st.integers(-3, 3), st.integers(-3, 3)),
)
def test_sign_is_exact_within_a_few_ulps_of_the_line(ends, share, ulps):
    ax, ay, bx, by = (float(np.round(v, 9)) for v in ends)
    cx, cy = ax + share * (bx - ax), ay + share * (by - ay)
    cx, cy = cx + ulps[0] * np.spacing(cx), cy + ulps[1] * np.spacing(cy)
    cx, cy = (v if abs(v) >= 1e-100 else 0.0 for v in (cx, cy))
    assert orientation(ax, ay, bx, by, cx, cy) == exact(ax, ay, bx, by, cx, cy)


@settings(max_examples=EXAMPLES)
@given(
    st.tuples(*[st.integers(-(2**10), 2**10)] * 6),
    st.integers(-480, 480),
)
def test_sign_is_exact_for_nearly_equal_points_at_every_scale(steps, exponent):
    points = [(1.0 + s * 2.0**-52) * 2.0**exponent for s in steps]
    assert orientation(*points) == exact(*points)


def test_points_that_only_rounding_tells_from_the_line_are_beside_it():
    # The classic of Kettner et al. (2008): naive determinants call most of these collinear.
    rng = np.random.default_rng(1)
    on_line = 0
    for i, j in rng.integers(0, 256, (counts(4000, 500), 2)).tolist():
        c = (0.5 + i * 2.0**-53, 0.5 + j * 2.0**-53)
        sign = orientation(12.0, 12.0, 24.0, 24.0, *c)
        assert sign == (j > i) - (j < i)
        on_line += sign == 0
    assert on_line < 100


@settings(max_examples=EXAMPLES // 2)
@given(st.tuples(*[scene_coordinate] * 6))
def test_swapping_two_points_turns_the_sign(points):
    ax, ay, bx, by, cx, cy = points
    sign = orientation(*points)
    assert orientation(bx, by, ax, ay, cx, cy) == -sign
    assert orientation(bx, by, cx, cy, ax, ay) == sign


def test_two_equal_points_lie_on_every_line():
    assert orientation(0.1, 0.2, 0.1, 0.2, 7.3, 9.1) == 0
    assert orientation(0.1, 0.2, 7.3, 9.1, 0.1, 0.2) == 0
