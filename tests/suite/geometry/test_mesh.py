"""A navigation mesh is free space, no more and no less, and knows where paths bend."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import box

from suite.geometry import mesh as mesh_file
from suite.geometry.arrangement import arrange
from suite.geometry.coordinates import coordinates_of
from suite.geometry.mesh import BENDS, ORIGIN, WAY, Mesh, mesh_of
from tests.suite.geometry.lattice import counts, random_solid

ROOM = box(0, 0, 10, 10)


def mesh_in(room, obstacles) -> Mesh:
    mesh = mesh_of(arrange(room, obstacles).free, coordinates_of(room.bounds))
    assert mesh is not None
    return mesh


def triangles(mesh: Mesh) -> np.ndarray:
    return shapely.polygons(mesh.vertices[mesh.half_edges[:, ORIGIN]].reshape(-1, 3, 2))


def twins(mesh: Mesh) -> np.ndarray:
    """The twin of each half-edge, -1 if it has none, whether or not it leads into a pocket."""
    way = mesh.half_edges[:, WAY]
    return np.where(way < -1, -2 - way, way)


@settings(max_examples=counts(40, 5))
@given(st.integers(0, 2**32))
def test_triangles_are_free_space_and_half_edges_fit(seed):
    room, obstacles = random_solid(np.random.default_rng(seed))
    made = arrange(room, obstacles)
    if not made.free:
        return
    mesh = mesh_in(room, obstacles)
    shapes = triangles(mesh)
    assert shapely.is_ccw(shapely.get_exterior_ring(shapes)).all()
    assert shapely.area(shapes).sum() == pytest.approx(room.difference(made.solid).area)
    assert not shapely.relate_pattern(made.solid, shapes, "T********").any()
    twin = twins(mesh)
    inner = np.flatnonzero(twin >= 0)
    np.testing.assert_array_equal(twin[twin[inner]], inner)
    end = np.roll(mesh.half_edges[:, ORIGIN].reshape(-1, 3), -1, axis=1).ravel()
    np.testing.assert_array_equal(end[inner], mesh.half_edges[twin[inner], ORIGIN])
    bends = np.unique(mesh.half_edges[mesh.half_edges[:, BENDS] == 1, ORIGIN])
    assert set(map(tuple, mesh.vertices[bends])) == set(map(tuple, made.corners[:, :2]))


def test_a_pocket_is_left_by_one_way_and_a_ring_has_none():
    ring = mesh_in(ROOM, [box(4, 4, 6, 6)])
    assert (ring.outward < 0).all()
    pocket = mesh_in(ROOM, [box(4, 4, 6, 6), box(0, 0, 1, 1)])
    dead_ends = pocket.outward[pocket.outward >= 0]
    # Inside, each goes on to the next; there is a half-edge back in that says so.
    back = pocket.half_edges[twins(pocket)[dead_ends], WAY]
    np.testing.assert_array_equal(back, -2 - dead_ends)
    hall = mesh_in(ROOM, [])
    assert (hall.outward >= 0).sum() == len(hall.outward) - 1


def test_far_away_the_mesh_lies_where_the_arrangement_does():
    room = box(5e6, 5e6, 5e6 + 10, 5e6 + 10)
    obstacle = shapely.affinity.rotate(box(5e6 + 4, 5e6 + 4, 5e6 + 6, 5e6 + 6), 17)
    made = arrange(room, [obstacle])
    places = set(map(tuple, shapely.get_coordinates(made.solid).tolist()))
    assert set(map(tuple, mesh_in(room, [obstacle]).vertices.tolist())) <= places


def test_no_free_space_is_a_mesh_of_nothing():
    assert len(mesh_in(ROOM, [ROOM]).vertices) == 0


def spoilt(faces):
    """A triangulation that leaves one triangle out, as a wrong one would."""
    cut = shapely.get_parts(shapely.constrained_delaunay_triangles(faces))
    return shapely.GeometryCollection(list(cut[:-1]))


def flat(_):
    return shapely.GeometryCollection([shapely.Polygon([(0, 0), (1, 0), (2, 0)])])


@pytest.mark.parametrize("wrong", [spoilt, flat])
def test_triangles_that_do_not_fit_make_no_mesh(wrong, monkeypatch):
    free = np.array(arrange(ROOM, [box(4, 4, 6, 6)]).free)
    made = wrong(free)
    monkeypatch.setattr(mesh_file.shapely, "constrained_delaunay_triangles", lambda _: made)
    assert mesh_of(free, coordinates_of(ROOM.bounds)) is None
