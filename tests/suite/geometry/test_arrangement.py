"""The arrangement covers what was drawn, with convex parts whose seams fit together."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.affinity import rotate, scale, translate
from shapely.geometry import MultiPolygon, Polygon, box

from suite.geometry.arrangement import Arrangement, arrange
from suite.geometry.kernels import (
    AFTER,
    FIRST,
    FIRST_CONTACT,
    FIRST_EDGE,
    GROUP,
    LAST,
    LAST_CONTACT,
    LAST_EDGE,
    PARTS,
    SEAM,
)
from suite.geometry.predicates import orientation
from tests.suite.geometry.lattice import counts, frame_around, random_solid, star

ROOM = box(0, 0, 10, 10)
seeds = st.integers(0, 2**32)
on_lattice = settings(max_examples=counts(60, 20))


def leaves(arrangement: Arrangement) -> np.ndarray:
    """Rows of the tree that are parts, in the order of their vertices."""
    tree = arrangement.arrays.tree
    rows = tree[tree[:, FIRST] >= 0]
    return rows[np.argsort(rows[:, FIRST])]


def parts(arrangement: Arrangement) -> list[np.ndarray]:
    rows = leaves(arrangement)[:, [FIRST, LAST]].astype(int)
    return [arrangement.arrays.vertices[first:last, :2] for first, last in rows]


def parts_of_group(arrangement: Arrangement, group: int) -> list[np.ndarray]:
    belongs = leaves(arrangement)[:, GROUP] == group
    return [part for part, its in zip(parts(arrangement), belongs, strict=True) if its]


def edges(arrangement: Arrangement, *, seams: bool) -> set[tuple[float, ...]]:
    arrays = arrangement.arrays
    ends = np.vstack([np.hstack([xy, np.roll(xy, -1, axis=0)]) for xy in parts(arrangement)])
    return set(map(tuple, ends[(arrays.vertices[:, SEAM] == 1) == seams].tolist()))


def reverse(directed: set[tuple[float, ...]]) -> set[tuple[float, ...]]:
    return {(x2, y2, x1, y1) for x1, y1, x2, y2 in directed}


def lattice(seed: int) -> tuple[Polygon, list[Polygon], Arrangement]:
    room, obstacles = random_solid(np.random.default_rng(seed))
    return room, obstacles, arrange(room, obstacles)


def random_floats(seed: int) -> tuple[Polygon, list[Polygon], Arrangement]:
    rng = np.random.default_rng(seed)
    stars = [star(rng, rng.uniform(0, 10, 2), 3.0) for _ in range(rng.integers(1, 8))]
    holed = [p.difference(scale(p, 0.4, 0.4)) for p in stars]
    cut = [p for p in shapely.get_parts(shapely.intersection(holed, ROOM)) if p.area > 0]
    return ROOM, cut, arrange(ROOM, cut)


EACH_KIND = pytest.mark.parametrize("draw", [lattice, random_floats])


@EACH_KIND
@on_lattice
@given(seeds)
def test_parts_are_convex_and_counter_clockwise(draw, seed):
    for xy in parts(draw(seed)[2]):
        before, after = np.roll(xy, 1, axis=0), np.roll(xy, -1, axis=0)
        turns = [orientation(*a, *b, *c) for a, b, c in zip(before, xy, after, strict=True)]
        assert min(turns) >= 0
        assert turns.count(1) >= 3
        assert Polygon(xy).is_valid  # once round, no spike
        assert len(np.unique(xy, axis=0)) == len(xy)


@EACH_KIND
@on_lattice
@given(seeds)
def test_parts_cover_what_was_drawn_once(draw, seed):
    room, obstacles, arrangement = draw(seed)
    polygons = [Polygon(xy) for xy in parts(arrangement)]
    union = shapely.union_all(polygons)
    drawn = shapely.union_all([*obstacles, frame_around(room)])
    near = box(*room.bounds).buffer(1, join_style="mitre")
    missing = union.intersection(near).symmetric_difference(drawn.intersection(near))
    assert missing.area < 1e-6
    assert sum(p.area for p in polygons) == pytest.approx(union.area, rel=1e-12)
    assert arrangement.solid.area == pytest.approx(union.area, rel=1e-12)


@on_lattice
@given(seeds)
def test_parts_cover_lattice_solids_exactly(seed):
    _, obstacles, arrangement = lattice(seed)
    covered = shapely.union_all(
        [
            Polygon(xy)
            for g in range(len(arrangement.groups))
            for xy in parts_of_group(arrangement, g)
        ]
    )
    assert covered.equals(shapely.union_all(obstacles))


@EACH_KIND
@on_lattice
@given(seeds)
def test_a_seam_has_a_part_on_both_sides_and_every_other_edge_bounds_the_solid(draw, seed):
    arrangement = draw(seed)[2]
    inner, outer = edges(arrangement, seams=True), edges(arrangement, seams=False)
    assert reverse(inner) == inner
    assert not reverse(outer) & outer
    length = sum(np.hypot(x2 - x1, y2 - y1) for x1, y1, x2, y2 in outer)
    assert length == pytest.approx(arrangement.solid.length, rel=1e-9)


@on_lattice
@given(seeds)
def test_obstacles_that_touch_are_one_group(seed):
    _, obstacles, arrangement = lattice(seed)
    pending, components = list(obstacles), 0
    while pending:
        cluster = [pending.pop()]
        while near := [p for p in pending if any(p.intersects(q) for q in cluster)]:
            cluster += near
            pending = [p for p in pending if not any(p is q for q in near)]
        components += 1
    assert len(arrangement.groups) == components


@EACH_KIND
@on_lattice
@given(seeds)
def test_boxes_fit_and_the_box_of_a_group_contains_those_of_its_parts(draw, seed):
    arrangement = draw(seed)[2]
    arrays = arrangement.arrays
    boxes = leaves(arrangement)[:, :4]
    for xy, bounds in zip(parts(arrangement), boxes, strict=True):
        assert bounds.tolist() == [*xy.min(axis=0), *xy.max(axis=0)]
    for group, bounds in enumerate(arrays.groups[:, :4]):
        its = boxes[leaves(arrangement)[:, GROUP] == group]
        assert len(its) == arrays.groups[group, PARTS]
        assert bounds.tolist() == [*its[:, :2].min(axis=0), *its[:, 2:].max(axis=0)]
    for group, polygon in enumerate(arrangement.groups):
        assert polygon.bounds == tuple(arrays.groups[group, :4])


@EACH_KIND
@on_lattice
@given(seeds)
def test_the_tree_holds_every_part_once_and_each_box_contains_what_is_below(draw, seed):
    arrays = draw(seed)[2].arrays
    tree = arrays.tree
    assert len(tree) == 2 * (tree[:, FIRST] >= 0).sum() - 1
    for row, (*box_of, skip, group, first, _) in enumerate(tree):
        below = tree[row + 1 : int(skip)]
        assert (first >= 0) == (len(below) == 0)
        assert all(below[:, :2].min(axis=0) >= box_of[:2]) if len(below) else skip == row + 1
        assert all(below[:, 2:4].max(axis=0) <= box_of[2:]) if len(below) else True
        assert set(below[:, GROUP]) <= {group} or group == -1
    for group, after in enumerate(arrays.groups[:, AFTER].astype(int)):
        rows = np.flatnonzero(tree[:, GROUP] == group)
        assert rows.tolist() == list(range(rows[0], after))


@on_lattice
@given(seeds)
def test_corners_are_the_convex_corners_of_the_solid(seed):
    arrangement = lattice(seed)[2]
    solid, step = arrangement.solid, 0.1
    found = {tuple(c) for c in arrangement.corners[:, :2].tolist()}
    expected = set()
    for x, y in np.unique(shapely.get_coordinates(solid), axis=0).tolist():
        if solid.envelope.boundary.distance(shapely.Point(x, y)) > 0:
            disc = shapely.Point(x, y).buffer(step, quad_segs=64)
            widest = max((p.area for p in shapely.get_parts(disc.difference(solid))), default=0.0)
            if widest > 0.51 * disc.area:
                expected.add((x, y))
    assert found == expected


@EACH_KIND
@on_lattice
@given(seeds)
def test_the_ends_of_a_corner_bound_its_free_side(draw, seed):
    arrangement = draw(seed)[2]
    outer = edges(arrangement, seams=False)
    for x, y, mx, my, nx, ny in arrangement.corners.tolist():
        assert (mx, my, x, y) in outer
        assert (x, y, nx, ny) in outer
        assert orientation(x, y, mx, my, nx, ny) < 0


@EACH_KIND
@on_lattice
@given(seeds)
def test_the_boundary_of_a_group_is_that_of_its_polygons(draw, seed):
    arrangement = draw(seed)[2]
    arrays = arrangement.arrays
    for group, polygon in enumerate(arrangement.groups):
        first, last = arrays.groups[group, [FIRST_EDGE, LAST_EDGE]].astype(int)
        a, b = np.hsplit(arrays.boundary[first:last], 2)
        assert np.hypot(*(b - a).T).sum() == pytest.approx(polygon.length, rel=1e-9)


@on_lattice
@given(seeds)
def test_the_border_of_a_group_is_where_it_touches_the_frame(seed):
    room, _, arrangement = lattice(seed)
    arrays = arrangement.arrays
    for group, polygon in enumerate(arrangement.groups):
        first, last = arrays.groups[group, [FIRST_CONTACT, LAST_CONTACT]].astype(int)
        rows = arrays.contacts[first:last]
        contact = polygon.intersection(room.boundary)
        assert np.hypot(*(rows[:, 2:] - rows[:, :2]).T).sum() == pytest.approx(contact.length)
        assert (rows.size > 0) == (not contact.is_empty)
        assert contact.distance(shapely.points(rows[:, :2])).max(initial=0.0) == 0.0


def test_all_arrays_are_read_only():
    arrangement = lattice(3)[2]
    assert not any(a.flags.writeable for a in (*arrangement.arrays, arrangement.corners))


def test_the_last_group_is_the_frame():
    empty = arrange(ROOM, [])
    assert empty.groups == ()
    assert empty.arrays.groups[:, :4].tolist() == [[-2.5, -2.5, 12.5, 12.5]]
    assert empty.solid.area == 15.0 * 15.0 - 100.0


def test_a_convex_obstacle_is_one_part():
    hexagon = shapely.Point(5, 5).buffer(3, quad_segs=16)
    assert len(parts_of_group(arrange(ROOM, [hexagon]), 0)) == 1


def test_a_vertex_inside_a_common_side_leaves_no_spike():
    # Hertel and Mehlhorn remove the two halves of a side one by one: the first removal alone
    # would leave a part that runs to (4, 2) and back.
    room = box(-1, -1, 6, 6)
    stacked = arrange(room, [box(0, 0, 4, 2), box(0, 2, 2, 4), box(2, 2, 4, 4)])
    assert [Polygon(xy).bounds for xy in parts_of_group(stacked, 0)] == [(0.0, 0.0, 4.0, 4.0)]
    assert stacked.groups[0].equals(box(0, 0, 4, 4))


def test_the_same_obstacle_twice_is_there_once():
    once, twice = arrange(ROOM, [box(1, 1, 9, 9)]), arrange(ROOM, [box(1, 1, 9, 9)] * 2)
    assert np.array_equal(once.corners, twice.corners)
    assert once.solid.equals(twice.solid)
    assert len(twice.groups) == 1


def test_holes_that_touch_each_other_and_the_outline_are_cut_out():
    ring = Polygon(
        [(1, 1), (9, 1), (9, 9), (1, 9)],
        [[(1, 5), (4, 3), (4, 7)], [(4, 3), (8, 3), (8, 2)]],
    )
    assert ring.is_valid
    arrangement = arrange(ROOM, [ring])
    assert arrangement.groups == (MultiPolygon([arrangement.groups[0].geoms[0]]),)
    assert arrangement.groups[0].equals(ring)
    assert len(arrangement.arrays.pinches) == 2


@pytest.mark.parametrize("offset", [0.0, 1e3, 1e5, 1e7])
@pytest.mark.parametrize("angle", [0.0, 7.0, 33.3])
def test_touching_boxes_are_one_group_wherever_they_lie(angle, offset):
    row = [box(2, 2, 4, 4), box(4, 1, 6, 3), box(6, 3, 7, 7)]
    moved = [translate(rotate(p, angle, origin=(5, 5)), offset, offset) for p in row]
    room = translate(box(-5, -5, 15, 15), offset, offset)
    assert len(arrange(room, moved).groups) == 1


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3, 1e6])
def test_solids_of_any_size_are_covered(size):
    room, *drawn = (
        scale(p, size, size, origin=(0, 0)) for p in (ROOM, box(2, 2, 4, 4), box(4, 3, 6, 5))
    )
    arrangement = arrange(room, drawn)
    assert arrangement.groups[0].area == pytest.approx(8 * size**2)
    assert len(arrangement.corners) == 6
