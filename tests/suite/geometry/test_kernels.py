"""Kernel and shapely agree on what enters: on the lattice, where nothing rounds, and on floats."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.affinity import rotate
from shapely.geometry import Point, Polygon, box

from suite.geometry.arrangement import Arrangement, arrange
from suite.geometry.kernels import (
    AFTER,
    GROUP,
    _segment_enters_part_exactly,
    first_collision,
    next_entry,
    segment_enters,
    segment_enters_part,
)
from suite.geometry.predicates import orientation
from tests.suite.geometry.lattice import (
    counts,
    enters,
    frame_around,
    is_pinched,
    lines,
    pinches,
    random_segments,
    random_solid,
    star,
)

ROOM = box(0, 0, 10, 10)
NO_PINCH = "T********"


def is_closed(arrangement: Arrangement, *segment: float) -> bool:
    """Whether a segment enters; the same in both directions, and as a path."""
    ax, ay, bx, by = (float(v) for v in segment)
    there = segment_enters(ax, ay, bx, by, arrangement.arrays)
    assert segment_enters(bx, by, ax, ay, arrangement.arrays) == there
    assert (hit(arrangement, (ax, ay), (bx, by)) == 0) == there
    return there


def hit(arrangement: Arrangement, *path: tuple[float, float]) -> int:
    return first_collision(np.array(path, dtype=float), arrangement.arrays)


def judge(arrangement: Arrangement, segments: np.ndarray) -> np.ndarray:
    arrays = arrangement.arrays
    return np.array([segment_enters(*s, arrays) for s in segments.tolist()])


def disagreements(arrangement: Arrangement, oracle, segments: np.ndarray) -> list:
    return segments[judge(arrangement, segments) != enters(oracle, segments)].tolist()


# Against shapely, in bulk: 160 x 500 + 60 x 500 = 110,000 pairs with the JIT on.


def test_kernel_and_shapely_agree_on_80_000_lattice_segments():
    for seed in range(counts(160, 60)):
        rng = np.random.default_rng(seed)
        room, obstacles = random_solid(rng)
        segments = random_segments(rng, room, 500)
        drawn = shapely.union_all([frame_around(room), *obstacles])
        assert disagreements(arrange(room, obstacles), drawn, segments) == [], f"seed {seed}"


def test_kernel_and_shapely_agree_on_30_000_segments_among_random_floats():
    for seed in range(counts(60, 20)):
        rng = np.random.default_rng(seed)
        size = 10.0 ** rng.uniform(0, 4)
        room = box(-size, -size, size, size)
        obstacles = [
            star(rng, rng.uniform(-size, size, 2), size * rng.uniform(0.05, 0.5))
            for _ in range(rng.integers(1, 12))
        ]
        cut = shapely.get_parts(shapely.intersection(obstacles, room))
        arrangement = arrange(room, [p for p in cut if p.area > 0.0])
        solid = arrangement.solid
        vertices = shapely.get_coordinates(solid.intersection(room))
        ends = vertices[rng.integers(0, len(vertices), (500, 2))]
        anywhere = rng.random((500, 2)) < 0.3
        ends[anywhere] = rng.uniform(-size, size, (int(anywhere.sum()), 2))
        segments = ends.reshape(-1, 4)
        wanted = shapely.relate_pattern(solid, lines(segments), NO_PINCH)
        assert segments[judge(arrangement, segments) != wanted].tolist() == [], f"seed {seed}"


@settings(max_examples=counts(60, 20))
@given(st.integers(0, 2**32), st.lists(st.integers(0, 16), min_size=4, max_size=4))
def test_kernel_and_shapely_agree_on_the_half_lattice(seed, halves):
    room, obstacles = random_solid(np.random.default_rng(seed))
    segment = np.array([halves], dtype=float) / 2
    arrangement = arrange(room, obstacles)
    assert disagreements(arrangement, arrangement.solid, segment) == []


# The quick test of one part against the exact one


def convex_part(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Vertices of the convex hull, counter-clockwise by exact signs; none if it has no area."""
    hull: list[tuple[float, float]] = []
    for chain in (sorted(set(points)), sorted(set(points), reverse=True)):
        begin = len(hull)
        for p in chain:
            while len(hull) > begin + 1 and orientation(*hull[-2], *hull[-1], *p) <= 0:
                hull.pop()
            hull.append(p)
        hull.pop()
    return hull if len(hull) > 2 else []


def assert_quick_is_exact(part, seams, ends):
    vertices = np.array([(x, y, s) for (x, y), s in zip(part, seams, strict=False)], dtype=float)
    for ax, ay, bx, by in (ends, (*ends[2:], *ends[:2])):
        if (ax, ay) != (bx, by):
            asked = ax, ay, bx, by, vertices, 0, len(part) - 1
            assert segment_enters_part(*asked) == _segment_enters_part_exactly(*asked)


SEAMS = st.lists(st.booleans(), min_size=9, max_size=9)
LATTICE = st.integers(0, 4).map(float)


@settings(max_examples=counts(800, 200))
@given(
    st.lists(st.tuples(LATTICE, LATTICE), min_size=3, max_size=9), SEAMS, st.tuples(*[LATTICE] * 4)
)
def test_the_quick_test_of_a_part_is_exact_on_the_lattice(points, seams, ends):
    part = convex_part(points)
    if part:
        assert_quick_is_exact(part, seams, ends)


def test_the_quick_test_of_a_part_is_exact_where_vertices_lie_on_the_line_up_to_an_ulp():
    rng = np.random.default_rng(0)
    for _ in range(counts(10_000, 1000)):
        a, b = rng.uniform(-1.0, 1.0, (2, 2)) * rng.choice([1e-6, 1.0, 1e9])
        on_line = a + rng.uniform(-1.0, 2.0, (int(rng.integers(2, 5)), 1)) * (b - a)
        on_line += np.spacing(on_line) * rng.integers(-1, 2, on_line.shape)
        apex = a + (b - a)[::-1] * rng.uniform(-1.0, 1.0, 2)
        part = convex_part([tuple(p) for p in [*on_line.tolist(), apex.tolist()]])
        if part:
            assert_quick_is_exact(part, rng.random(len(part)) < 0.5, (*a.tolist(), *b.tolist()))


def test_direction_does_not_matter():
    for seed in range(counts(20, 2)):
        rng = np.random.default_rng(seed)
        room, obstacles = random_solid(rng)
        arrangement = arrange(room, obstacles)
        segments = random_segments(rng, room, 200)
        back = segments[:, [2, 3, 0, 1]]
        assert np.array_equal(judge(arrangement, segments), judge(arrangement, back))


def test_bends_at_pinch_points_agree_with_the_pieces_of_a_small_disc():
    bends = closed = 0
    for seed in range(counts(80, 20)):
        rng = np.random.default_rng(seed)
        room, obstacles = random_solid(rng)
        arrangement = arrange(room, obstacles)
        for centre, free in pinches(arrangement.solid):
            ends = [(centre.x + x, centre.y + y) for x in (-0.5, 0, 0.5) for y in (-0.5, 0, 0.5)]
            ends = [e for e in ends if e != (centre.x, centre.y)]
            ends = [e for e in ends if not is_closed(arrangement, *e, centre.x, centre.y)]
            for a in ends:
                for b in ends:
                    wanted = is_pinched(a, centre, b, free)
                    assert (hit(arrangement, a, (centre.x, centre.y), b) == 0) == wanted
                    bends, closed = bends + 1, closed + wanted
    assert 0 < closed < bends


def test_groups_entered_are_those_whose_own_polygons_are_entered():
    for seed in range(counts(20, 3)):
        rng = np.random.default_rng(seed)
        room, obstacles = random_solid(rng)
        arrangement = arrange(room, obstacles)
        for s in random_segments(rng, room, 50):
            wanted = {
                i
                for i, group in enumerate(arrangement.groups)
                if shapely.relate_pattern(group, lines(s[None])[0], NO_PINCH)
            }
            found = set()
            tree, vertices, groups = arrangement.arrays[:3]
            row = next_entry(*s, tree, vertices, 0)
            while row >= 0:
                group = int(tree[row, GROUP])
                assert group not in found
                found.add(group)
                row = next_entry(*s, tree, vertices, int(groups[group, AFTER]))
            # Beyond its own interior, a group closes the slits that it shares with the frame.
            assert wanted <= found


# Named claims


ONE_BOX = arrange(ROOM, [box(3, 3, 6, 6)])


def test_touching_a_corner_is_not_a_collision():
    assert not is_closed(ONE_BOX, 1, 5, 5, 1)
    assert not is_closed(ONE_BOX, 2, 4, 4, 2)  # through the corner (3, 3)
    assert not is_closed(ONE_BOX, 0, 0, 3, 3)


def test_following_an_edge_is_free():
    assert not is_closed(ONE_BOX, 3, 3, 6, 3)
    assert not is_closed(ONE_BOX, 0, 6, 10, 6)
    assert not is_closed(ONE_BOX, 3.5, 3, 4.5, 3)


def test_following_the_border_of_the_workspace_is_free():
    assert not is_closed(ONE_BOX, 0, 0, 10, 0)
    assert not is_closed(ONE_BOX, 10, 2, 10, 9)


def test_crossing_entering_or_leaving_a_box_is_a_collision():
    assert is_closed(ONE_BOX, 0, 5, 10, 5)
    assert is_closed(ONE_BOX, 0, 5, 4, 5)
    assert is_closed(ONE_BOX, 3, 3, 6, 6)  # the diagonal
    assert is_closed(ONE_BOX, 3, 3, 4, 4)
    assert is_closed(ONE_BOX, 3, 4, 6, 5)  # from edge to edge


def test_both_ends_inside_one_obstacle_is_a_collision():
    assert is_closed(ONE_BOX, 4, 4, 5, 5)


def test_leaving_the_workspace_is_a_collision():
    assert is_closed(ONE_BOX, 9, 9, 11, 9)
    assert is_closed(ONE_BOX, 10.5, 1, 10.5, 2)
    assert is_closed(ONE_BOX, 10, 5, 11, 5)


def test_a_point_is_closed_inside_and_free_on_the_outline():
    assert is_closed(ONE_BOX, 4, 4, 4, 4)
    assert is_closed(ONE_BOX, 11, 4, 11, 4)
    for x, y in [(3, 3), (3, 4), (6, 6), (1, 1), (0, 0), (0, 5)]:
        assert not is_closed(ONE_BOX, x, y, x, y)


def test_the_seam_between_two_boxes_that_share_an_edge_is_closed():
    pair = arrange(ROOM, [box(2, 2, 5, 5), box(5, 2, 8, 5)])
    assert is_closed(pair, 5, 0, 5, 10)
    assert is_closed(pair, 5, 2, 5, 5)
    assert is_closed(pair, 5, 3, 5, 4)
    assert is_closed(pair, 5, 3, 5, 3)  # a point in the seam
    assert not is_closed(pair, 5, 2, 5, 2)  # its mouth
    assert not is_closed(pair, 5, 0, 5, 2)  # up to its mouth
    assert not is_closed(pair, 2, 2, 8, 2)  # past its mouth


def test_the_seam_of_a_partly_shared_edge_is_closed_where_it_is_shared():
    pair = arrange(ROOM, [box(2, 2, 5, 6), box(5, 4, 8, 8)])
    assert is_closed(pair, 5, 0, 5, 10)
    assert is_closed(pair, 5, 4, 5, 6)
    assert is_closed(pair, 5, 3, 5, 4.5)
    assert not is_closed(pair, 5, 2, 5, 4)
    assert not is_closed(pair, 5, 6, 5, 8)


def test_seams_that_meet_in_a_t_are_closed_and_so_is_the_point_where_they_meet():
    three = arrange(ROOM, [box(2, 2, 8, 4), box(2, 4, 5, 7), box(5, 4, 8, 7)])
    assert is_closed(three, 0, 4, 10, 4)
    assert is_closed(three, 5, 4, 5, 10)
    assert is_closed(three, 5, 4, 5, 4)
    assert is_closed(three, 3, 4, 5, 4)


def test_a_vertex_amid_overlapping_obstacles_is_closed():
    crossed = arrange(ROOM, [box(2, 2, 6, 6), box(4, 4, 8, 8)])
    assert is_closed(crossed, 4, 4, 4, 4)
    assert is_closed(crossed, 6, 6, 6, 6)
    assert not is_closed(crossed, 4, 6, 4, 6)


@pytest.mark.parametrize("angle", [1.0, 17.0, 30.0, 33.3, 45.0, 81.7])
def test_seams_on_slanted_edges_that_touch_only_up_to_rounding_are_closed(angle):
    left, right = box(2, 3, 5, 7), box(5, 1, 8, 6)
    turned = [rotate(p, angle, origin=(5, 5)) for p in (left, right)]
    pair = arrange(box(-5, -5, 15, 15), turned)
    assert len(pair.groups) == 1
    ways = [((5, -2), (5, 12)), ((5, 2), (5, 6.5)), ((5, 4), (5, 5)), ((5, 3), (5, 6))]
    for a, b in ways:
        a, b = (rotate(Point(p), angle, origin=(5, 5)).coords[0] for p in (a, b))
        assert is_closed(pair, *a, *b)


def test_a_box_laid_on_a_slanted_edge_is_joined_to_it():
    ramp = Polygon([(0.1, 0.2), (9.7, 3.3), (9.7, 0.2)])
    a, b = (np.array(ramp.exterior.interpolate(d, normalized=True).coords[0]) for d in (0.05, 0.2))
    up = np.array([a[1] - b[1], b[0] - a[0]])
    both = arrange(ROOM, [ramp, Polygon([a, b, b + up, a + up])])
    assert len(both.groups) == 1
    assert is_closed(both, *a, *b)
    assert is_closed(both, *((2 * a + b) / 3), *((a + 2 * b) / 3))


PINCH = arrange(ROOM, [box(2, 2, 5, 5), box(5, 5, 8, 8)])


def test_a_pinch_point_is_closed_straight_on():
    assert is_closed(PINCH, 4, 6, 6, 4)
    assert is_closed(PINCH, 0, 10, 10, 0)


def test_a_pinch_point_is_closed_along_the_edges():
    assert is_closed(PINCH, 5, 4, 5, 6)
    assert is_closed(PINCH, 2, 5, 8, 5)


def test_a_pinch_point_is_closed_for_bends():
    assert hit(PINCH, (4, 6), (5, 5), (6, 4)) == 0
    assert hit(PINCH, (4, 6), (5, 5), (5, 4)) == 0
    assert hit(PINCH, (4, 5), (5, 5), (5, 4)) == 0
    assert hit(PINCH, (1, 9), (4, 6), (5, 5), (6, 4)) == 1


def test_a_pinch_point_is_closed_for_a_path_that_waits_in_it():
    assert hit(PINCH, (4, 6), (5, 5), (5, 5), (5, 5), (6, 4)) == 0
    assert hit(PINCH, (4, 6), (5, 5), (5, 5), (4, 5.5)) == -1
    assert hit(PINCH, (5, 5), (5, 5), (4, 6)) == -1
    assert hit(PINCH, (4, 6), (5, 5), (5, 5)) == -1


def test_a_path_that_stays_in_one_sector_may_touch_a_pinch_point():
    assert hit(PINCH, (4, 6), (5, 5), (5, 6)) == -1
    assert hit(PINCH, (2, 5), (5, 5), (5, 8)) == -1
    assert hit(PINCH, (4, 6), (5, 5), (4, 6)) == -1
    assert not is_closed(PINCH, 4, 6, 5, 5)
    assert not is_closed(PINCH, 5, 5, 5, 5)


def test_a_path_along_an_edge_cannot_pass_the_corner_that_touches_it():
    touched = arrange(ROOM, [box(2, 2, 8, 4), Polygon([(5, 4), (7, 7), (3, 7)])])
    assert is_closed(touched, 2, 4, 8, 4)
    assert hit(touched, (2, 4), (5, 4), (8, 4)) == 0
    assert not is_closed(touched, 2, 4, 5, 4)
    assert hit(touched, (2, 4), (5, 4), (3, 7)) == -1


def test_a_point_in_which_four_corners_meet_lets_nobody_into_another_sector():
    wedge = Polygon([(5, 5), (7, 6), (6, 7)])
    four = arrange(ROOM, [rotate(wedge, angle, origin=(5, 5)) for angle in (0, 90, 180, 270)])
    ways = [(8, 5), (5, 8), (2, 5), (5, 2)]
    for a in ways:
        for b in ways:
            assert hit(four, a, (5, 5), b) == (-1 if a == b else 0)
    assert hit(four, (8, 5), (5, 5), (8, 6)) == -1
    assert is_closed(four, 8, 5, 2, 5)


def test_the_slit_between_an_obstacle_and_the_border_is_closed():
    low = arrange(ROOM, [box(3, 0, 6, 4)])
    assert is_closed(low, 0, 0, 10, 0)
    assert is_closed(low, 3, 0, 6, 0)
    assert is_closed(low, 4, 0, 5, 0)
    assert not is_closed(low, 0, 0, 3, 0)
    assert not is_closed(low, 3, 0, 3, 0)


def test_a_corner_that_touches_the_border_closes_the_way_along_it():
    spike = arrange(ROOM, [Polygon([(5, 0), (7, 4), (3, 4)])])
    assert is_closed(spike, 0, 0, 10, 0)
    assert hit(spike, (0, 0), (5, 0), (10, 0)) == 0
    assert hit(spike, (3, 1), (5, 0), (7, 1)) == 0
    assert not is_closed(spike, 0, 0, 5, 0)
    assert hit(spike, (0, 0), (5, 0), (3, 4)) == -1


def test_a_hole_of_an_obstacle_is_free_and_its_ring_is_not():
    ring = arrange(ROOM, [box(1, 1, 9, 9).difference(box(3, 3, 7, 7))])
    assert not is_closed(ring, 3, 3, 7, 7)
    assert not is_closed(ring, 3, 3, 7, 3)
    assert is_closed(ring, 5, 5, 5, 8)
    assert is_closed(ring, 0, 5, 10, 5)


def test_overlapping_obstacles_are_one_solid():
    cross = arrange(ROOM, [box(2, 4, 8, 6), box(4, 2, 6, 8)])
    assert is_closed(cross, 4, 4, 6, 4)  # an edge of each, inside the other
    assert not is_closed(cross, 4, 2, 4, 4)
    assert not is_closed(cross, 2, 4, 4, 4)


def test_the_outline_of_a_nested_obstacle_is_closed():
    nested = arrange(ROOM, [box(1, 1, 9, 9), box(3, 3, 5, 5)])
    assert is_closed(nested, 3, 3, 5, 3)
    assert is_closed(nested, 3, 3, 3, 3)
    assert is_closed(nested, 3, 4, 3, 4)


def test_an_obstacle_that_fills_the_workspace_leaves_nothing():
    full = arrange(ROOM, [ROOM])
    rng = np.random.default_rng(0)
    assert judge(full, rng.integers(0, 11, (200, 4)).astype(float)).all()
    assert is_closed(full, 0, 0, 0, 0)
    assert is_closed(full, 0, 5, 0, 5)


def test_the_notch_of_a_workspace_that_is_not_convex_is_closed():
    room = arrange(Polygon([(0, 0), (10, 0), (10, 10), (5, 5), (0, 10)]), [])
    assert is_closed(room, 0, 10, 10, 10)
    assert is_closed(room, 2, 7, 8, 7)
    assert not is_closed(room, 0, 5, 10, 5)  # under the notch, touching it
    assert not is_closed(room, 0, 10, 5, 5)


def test_a_pocket_walled_in_by_touching_obstacles_is_free_inside_and_shut():
    walls = [box(1, 1, 9, 2), box(1, 8, 9, 9), box(1, 2, 2, 8), box(8, 2, 9, 8)]
    pocket = arrange(ROOM, walls)
    assert not is_closed(pocket, 2, 2, 8, 8)
    assert not is_closed(pocket, 2, 2, 2, 8)
    for way in [(1, 2), (9, 2), (0.5, 5), (5, 0.5), (0.5, 2), (2, 0.5)]:
        assert is_closed(pocket, 5, 5, *way)
    assert is_closed(pocket, 2, 2, 0, 2)  # along the seam


def test_a_pocket_walled_in_by_corners_that_touch_is_shut():
    walls = [
        Polygon([(5, 0), (10, 5), (10, 0)]),
        Polygon([(10, 5), (5, 10), (10, 10)]),
        Polygon([(5, 10), (0, 5), (0, 10)]),
        Polygon([(0, 5), (5, 0), (0, 0)]),
    ]
    diamond = arrange(box(-5, -5, 15, 15), walls)
    assert is_closed(diamond, 5, 5, 5, -1)
    assert hit(diamond, (4, 4), (5, 0), (6, -1)) == 0
    assert not is_closed(diamond, 5, 0, 5, 10)


def test_nothing_but_the_frame_is_closed_without_obstacles():
    empty = arrange(ROOM, [])
    assert not is_closed(empty, 0, 0, 10, 10)
    assert not is_closed(empty, 0, 0, 0, 10)
    assert is_closed(empty, 0, 0, -1, 5)


def test_the_first_collision_of_a_path_is_the_first_segment_that_enters():
    assert hit(ONE_BOX, (0, 0), (2, 0), (2, 9), (9, 2), (0, 0)) == 2
    assert hit(ONE_BOX, (0, 0), (3, 3), (6, 3), (6, 6)) == -1
    assert hit(ONE_BOX, (4, 4), (4, 4)) == 0
    assert hit(ONE_BOX, (0, 0)) == -1


@pytest.mark.parametrize("kind", [np.int64, np.int32, np.float32])
def test_whole_numbers_are_coordinates_too(kind):
    for path in ([(0, 0), (2, 0), (2, 9), (9, 2)], [(0, 0), (3, 3), (6, 3), (6, 6)]):
        wanted = hit(ONE_BOX, *path)
        assert first_collision(np.array(path, dtype=kind), ONE_BOX.arrays) == wanted
