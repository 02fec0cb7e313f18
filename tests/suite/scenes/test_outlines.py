import numpy as np
import pytest
import shapely

from suite.scenes.outlines import concave_outline, convex_outline

both = pytest.mark.parametrize("draw", [convex_outline, concave_outline])


def drawn(draw, number=200):
    rng = np.random.default_rng(5)
    return np.array([draw(rng) for _ in range(number)])


@both
def test_an_outline_has_a_hull_of_area_1_around_the_origin(draw):
    hulls = shapely.convex_hull(drawn(draw))
    assert shapely.area(hulls) == pytest.approx(np.ones(hulls.size))
    assert shapely.get_coordinates(shapely.centroid(hulls)) == pytest.approx(
        np.zeros((hulls.size, 2)), abs=1e-12
    )


@both
def test_an_outline_is_one_valid_polygon_without_holes(draw):
    shapes = drawn(draw)
    assert (shapely.get_type_id(shapes) == shapely.GeometryType.POLYGON).all()
    assert shapely.is_valid(shapes).all()
    assert (shapely.get_num_interior_rings(shapes) == 0).all()


def test_convex_outlines_are_convex_and_concave_ones_clearly_are_not():
    assert shapely.area(drawn(convex_outline)) == pytest.approx(np.ones(200))
    assert (shapely.area(drawn(concave_outline)) < 0.95).all()


def test_convex_outlines_have_three_to_eight_vertices():
    counts = shapely.get_num_coordinates(drawn(convex_outline)) - 1
    assert set(counts.tolist()) == set(range(3, 9))


@both
def test_an_outline_has_no_needle_and_no_slip(draw):
    for outline in drawn(draw):
        xy = shapely.get_coordinates(outline)[:-1]
        ahead, behind = np.roll(xy, -1, axis=0) - xy, np.roll(xy, 1, axis=0) - xy
        lengths = np.hypot(*ahead.T)
        cosine = (ahead * behind).sum(axis=1) / (lengths * np.roll(lengths, 1))
        assert np.degrees(np.arccos(cosine)).min() > 15.0
        assert lengths.min() > 0.05
