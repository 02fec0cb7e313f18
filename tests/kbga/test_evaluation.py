"""Eq. (1) by hand, Fig. 3 case by case, and shapely on what is feasible."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box
from shapely.geometry import LineString, Polygon

from kbga.counter import make_counter
from kbga.encoding import GOAL, MAX_HITS, START, empty_population
from kbga.evaluation import escape_distance, evaluate_segment, hair, is_free_segment
from kbga.memory import empty_memory
from suite.geometry.arrangement import Arrangement, arrange
from suite.geometry.kernels import FIRST, GROUP, LAST
from tests.kbga.laboratory import ROOM, laboratory, random_scene, scene_of, with_paths
from tests.suite.geometry.lattice import (
    counts,
    enters,
    frame_around,
    lines,
    random_segments,
    random_solid,
)

Ends = tuple[float, float, float, float]


def record(arrangement: Arrangement, ends: Ends, genes: tuple[int, int] = (START, GOAL)) -> np.void:
    """What evaluation writes of one segment."""
    nodes = empty_population(1, 2).nodes
    nodes["gene"][0] = genes
    nodes["x"][0], nodes["y"][0] = ends[::2], ends[1::2]
    evaluate_segment(nodes, 0, 0, arrangement.arrays, empty_memory(), make_counter())
    return nodes[0, 0]


def depth(ends: Ends, *obstacles: Polygon) -> float:
    """Depth of a segment; the same backwards, and with the whole scene turned or mirrored."""
    found = []
    for turn in (
        lambda x, y: (x, y),
        lambda x, y: (y, x),
        lambda x, y: (10 - x, y),
        lambda x, y: (x, 10 - y),
    ):
        turned = [shapely.transform(o, lambda xy, t=turn: np.c_[t(*xy.T)]) for o in obstacles]
        arrangement = arrange(ROOM, turned)
        a, b = turn(*ends[:2]), turn(*ends[2:])
        found += [record(arrangement, (*a, *b))["depth"], record(arrangement, (*b, *a))["depth"]]
    assert found == pytest.approx([found[0]] * len(found), rel=1e-12)
    return float(found[0])


# Fig. 3


def test_a_the_shortest_shift_out_of_an_obstacle_counts():
    assert depth((0, 4, 10, 4), box(4, 2, 6, 5)) == 1.0
    assert depth((0, 2.5, 10, 2.5), box(4, 2, 6, 5)) == 0.5


def test_a_a_slanted_segment_is_shifted_square_to_itself():
    assert depth((0, 0, 10, 10), box(3, 3, 5, 5)) == pytest.approx(np.sqrt(2))


def test_b_a_shorter_shift_that_meets_another_part_entered_does_not_count():
    # Up 1 frees it from the left part, but only 5 from the right one; down 3 frees it from both.
    assert depth((0, 4, 10, 4), box(2, 2, 4, 5), box(4, 1, 6, 9)) == 3.0


def test_b_a_shorter_shift_into_another_part_of_the_group_does_not_count():
    assert depth((0, 4, 10, 4), box(2, 2, 4, 5), box(3, 5, 5, 9)) == 2.0


def test_c_a_side_joined_to_the_border_is_a_dead_end():
    assert depth((0, 1, 10, 1), box(4, 0, 6, 5)) == 4.0
    assert depth((0, 1, 10, 1), box(4, 0.5, 6, 5)) == 0.5  # the same, not joined


def test_c_a_group_is_joined_where_any_of_its_parts_is():
    assert depth((0, 3, 10, 3), box(4, 2, 6, 8), box(5, 0, 5.5, 2)) == 5.0


def test_c_joined_on_both_sides_there_is_no_way_out_and_the_whole_width_counts():
    assert depth((0, 4, 10, 4), box(4, 0, 6, 10)) == 10.0


def test_c_under_a_wall_along_the_border_the_way_out_is_over_the_wall():
    arrangement = arrange(ROOM, [box(4, 0, 6, 8)])
    assert escape_distance(1.0, 0.0, 9.0, 0.0, arrangement.arrays, 0) == 8.0
    assert depth((1, 0, 9, 0), box(4, 0, 6, 8)) >= 8.0


def test_c_through_a_bite_of_the_workspace_along_its_border_is_no_short_cut():
    bitten = arrange(ROOM.difference(box(4, 0, 6, 8)), [])
    assert record(bitten, (1, 0, 9, 0))["depth"] >= 8.0
    assert record(bitten, (1, 1, 9, 1))["depth"] >= 7.0


def test_c_a_bent_wall_from_border_to_border_is_closed_on_both_sides():
    # From the floor up to 6, and on to the right border: joined below the segment and above it.
    bent = Polygon([(4, 0), (6, 0), (6, 4), (10, 4), (10, 6), (4, 6)])
    assert depth((0, 2, 10, 2), bent) == (6 - 2) + (2 - 0)
    # Across the bend both joints lie on one side, and the corner (4, 6) is all there is on the
    # other, 1 / sqrt(2) from the line y = x + 1.
    assert depth((3, 4, 6, 7), bent) == pytest.approx(1 / np.sqrt(2))


def test_c_a_joint_that_lies_ahead_of_the_segment_is_a_dead_end_on_neither_side():
    assert depth((0, 5.5, 8, 5.5), box(4, 4, 10, 6)) == 0.5
    assert depth((5, 3, 5, 7), box(4, 0, 6, 10)) == 1.0  # one ahead and one behind
    assert depth((4.5, 3, 4.5, 7), box(4, 0, 6, 10)) == 0.5


def test_c_a_joint_is_one_joint_however_the_obstacle_is_cut_up():
    whole = box(4, 4, 10, 6)
    for y in (4.5, 5.0, 5.5):
        cut = box(4, 4, 10, y), box(4, y, 10, 6)
        for height in (4.25, 4.75, 5.25, 5.75):
            assert depth((0, height, 8, height), *cut) == depth((0, height, 8, height), whole)
            assert depth((0, height, 8, height), *cut) == min(height - 4, 6 - height)


def test_c_a_joint_with_a_slanted_border_is_one_joint_too():
    # The border from (10, 0) to (7, 10): vertices on it are on the line only up to the grid.
    room = Polygon([(0, 0), (10, 0), (7, 10), (0, 10)])
    on_border = [(10 - 0.3 * y, y) for y in (4.0, 4.3, 4.9, 6.0)]
    slabs = [
        Polygon([(4, lower[1]), lower, upper, (4, upper[1])])
        for lower, upper in pairwise(on_border)
    ]
    found = record(arrange(room, slabs), (0.0, 4.5, 8.0, 4.5))
    assert found["depth"] == pytest.approx(0.5, rel=1e-9)


def test_c_a_joint_in_a_point_ahead_is_a_dead_end_on_neither_side():
    spike = Polygon([(4, 8), (7, 8), (5, 10)])
    assert depth((5, 7, 5, 9), spike) == 1.0
    assert depth((5.5, 7, 5.5, 9), spike) == 1.5  # the point is on the other side: no way there
    assert depth((4.5, 7, 4.5, 9), spike) == 0.5


def test_c_of_a_joint_in_a_corner_of_the_room_only_the_border_above_is_a_dead_end():
    assert depth((0, 9.5, 9, 9.5), box(8, 8, 10, 10)) == 1.5


def test_c_only_the_group_that_is_joined_has_a_dead_end():
    joined, loose = box(2, 0, 3, 5), box(6, 0.5, 7, 5)
    assert depth((0, 1, 10, 1), joined) == 4.0
    assert depth((0, 1, 10, 1), loose) == 0.5
    assert depth((0, 1, 10, 1), joined, loose) == 4.0 + 0.5


def test_d_two_groups_add_up():
    assert depth((0, 4, 10, 4), box(2, 2, 3, 5), box(6, 1, 7, 6)) == 1.0 + 2.0


def test_d_each_group_is_left_on_its_own_side():
    # Up 1 from the first, down 1 from the second: no one shift does both, and yet 1 + 1 counts.
    assert depth((0, 4, 10, 4), box(2, 1, 3, 5), box(6, 3, 7, 8)) == 1.0 + 1.0


# Concave obstacles: groups of convex parts

CUP = Polygon([(2, 2), (8, 2), (8, 8), (6, 8), (6, 4), (4, 4), (4, 8), (2, 8)])
RING = box(2, 2, 8, 8).difference(box(4, 4, 6, 6))


def boxes(arrangement: Arrangement) -> tuple[list, list]:
    """MMG and MMO of the obstacles: xmin, ymin, xmax, ymax of groups and of convex parts."""
    tree, groups = arrangement.arrays.tree, arrangement.arrays.groups
    frame = len(groups) - 1
    parts = tree[(tree[:, FIRST] >= 0) & (tree[:, GROUP] != frame)]
    return groups[:frame, :4].tolist(), parts[:, :4].tolist()


@pytest.mark.parametrize(("obstacle", "count"), [(CUP, 3), (RING, 4)])
def test_a_concave_obstacle_is_one_group_whose_convex_parts_cover_it_exactly(obstacle, count):
    arrangement = arrange(ROOM, [obstacle])
    groups, _ = boxes(arrangement)
    tree, vertices = arrangement.arrays.tree, arrangement.arrays.vertices
    rows = tree[(tree[:, FIRST] >= 0) & (tree[:, GROUP] == 0)].astype(int)
    parts = [Polygon(vertices[row[FIRST] : row[LAST], :2]) for row in rows]
    assert groups == [[2.0, 2.0, 8.0, 8.0]]
    assert len(parts) == count
    assert all(part.equals(part.convex_hull) for part in parts)
    assert shapely.union_all(parts).equals(obstacle)
    assert sum(part.area for part in parts) == obstacle.area
    assert [tuple(p.bounds) for p in parts] == [tuple(b) for b in boxes(arrangement)[1]]


def test_through_both_walls_of_a_cup_the_way_out_leads_past_the_whole_of_it():
    assert depth((0, 7, 10, 7), CUP) == 1.0  # over the rims
    assert depth((0, 3.5, 10, 3.5), CUP) == 1.5  # under the floor
    assert depth((0, 5, 10, 5), CUP) == 3.0  # past the floor at 2, or the rims at 8


def test_from_inside_a_cup_only_the_part_within_the_strip_counts():
    # From between the walls to the right: the left wall is not in the way of any shift.
    assert depth((5, 7, 10, 7), CUP) == 1.0
    assert depth((5, 5, 5, 0), CUP) == 3.0  # left past x = 2 or right past x = 8, both 3 away
    assert depth((4.5, 5, 5.5, 5), CUP) == 0.0  # in the cup, and free


def test_out_of_a_hole_the_whole_ring_is_in_the_way():
    assert depth((5, 5, 10, 5), RING) == 3.0
    assert depth((5, 5.5, 10, 5.5), RING) == 2.5
    assert depth((4.5, 5, 5.5, 5), RING) == 0.0  # in the hole, and free


def test_with_both_ends_inside_it_must_get_out_all_the_same():
    assert depth((4, 3, 6, 3), box(2, 2, 8, 8)) == 1.0


def test_with_an_end_in_each_wall_of_a_cup_it_must_leave_both():
    assert depth((3, 7, 7, 7), CUP) == 1.0


def test_with_both_ends_inside_a_wall_from_border_to_border_its_whole_width_counts():
    assert depth((4.5, 4, 5.5, 4), box(4, 0, 6, 10)) == 10.0


def test_a_segment_without_length_takes_the_nearest_side():
    assert depth((5, 3, 5, 3), box(4, 2, 7, 8)) == 1.0
    assert depth((5, 1, 5, 1), box(4, 2, 7, 8)) == 0.0
    assert depth((4, 5, 4, 5), box(4, 2, 7, 8)) == 0.0  # on an edge, free


def test_touching_costs_nothing():
    obstacle = box(4, 2, 6, 5)
    assert depth((0, 5, 10, 5), obstacle) == 0.0  # along an edge
    assert depth((3, 4, 5, 6), obstacle) == 0.0  # through the corner (4, 5)
    assert depth((4, 3, 0, 3), obstacle) == 0.0  # from an edge


# Closed, though no obstacle is entered


PINCH = arrange(ROOM, [box(3, 3, 5, 5), box(5, 5, 7, 7)])


def test_slipping_through_a_pinch_point_is_infeasible_but_hits_nothing():
    found = record(PINCH, (4, 6, 6, 4))
    assert (found["depth"], found["hit_count"]) == (hair(PINCH.arrays), 0)


def test_a_lattice_node_on_a_pinch_point_is_closed_a_start_there_is_not():
    assert record(PINCH, (4, 6, 5, 5), (START, 60))["depth"] == hair(PINCH.arrays)
    assert record(PINCH, (5, 5, 4, 6), (60, GOAL))["depth"] == hair(PINCH.arrays)
    assert record(PINCH, (5, 5, 4, 6), (START, 60))["depth"] == 0.0
    assert record(PINCH, (4, 6, 5, 5), (60, GOAL))["depth"] == 0.0


# What is recorded


def test_more_obstacles_than_there_is_room_to_note_still_all_count():
    slabs = [box(x, 3, x + 0.5, 5) for x in np.arange(0.25, 9, 0.8)]
    found = record(arrange(ROOM, slabs), (0.0, 4.5, 10.0, 4.5))
    assert len(slabs) > MAX_HITS
    assert found["hit_count"] == MAX_HITS
    assert len(set(found["hits"].tolist())) == MAX_HITS
    assert found["depth"] == 0.5 * len(slabs)


def test_cost_is_length_plus_penalty_times_depth_summed_over_segments():
    scene = scene_of(box(4, 2, 6, 5), ends=((0, 4), (10, 4)))
    lab = with_paths(laboratory(scene, penalty=3.0), [(5, 9), (8, 9)], [])
    straight, over = lab.cost(1), lab.cost(0)
    assert straight == 10.0 + 1.0 * 3.0
    assert over == pytest.approx(5 * np.sqrt(2) + 3 + np.hypot(2, 5))


@settings(max_examples=counts(30, 4))
@given(st.integers(0, 2**32), st.floats(0, 100))
def test_cost_of_random_paths_adds_up(seed, penalty):
    lab = laboratory(random_scene(np.random.default_rng(seed)), seed, penalty=penalty)
    for nodes, chromosome in zip(*lab.population, strict=True):
        segments = nodes[: chromosome["intermediate"] + 1]
        xy = np.c_[nodes["x"], nodes["y"]][: len(segments) + 1]
        length = np.hypot(*np.diff(xy, axis=0).T).sum()
        wanted = length + penalty * segments["depth"].sum()
        assert chromosome["cost"] == pytest.approx(wanted, rel=1e-12)
        assert chromosome["infeasible"] == (segments["depth"] > 0).sum()


# Against shapely


def test_depth_is_zero_if_and_only_if_shapely_lets_the_segment_pass():
    for seed in range(counts(60, 6)):
        rng = np.random.default_rng(seed)
        room, obstacles = random_solid(rng)
        arrangement = arrange(room, obstacles)
        solid = shapely.union_all([frame_around(room), *obstacles])
        segments = random_segments(rng, room, 100)
        found = np.array([record(arrangement, tuple(s))["depth"] > 0 for s in segments.tolist()])
        assert segments[found != enters(solid, segments)].tolist() == [], f"seed {seed}"


def test_the_quick_test_agrees_with_evaluation_and_writes_the_same():
    for seed in range(counts(30, 4)):
        rng = np.random.default_rng(seed)
        room, obstacles = random_solid(rng)
        arrangement = arrange(room, obstacles)
        for ends in random_segments(rng, room, 50).tolist():
            genes = tuple(int(g) for g in rng.choice([START, 5], 2))
            full = record(arrangement, ends, genes)
            nodes = empty_population(1, 2).nodes
            nodes["gene"][0] = genes
            nodes["x"][0], nodes["y"][0] = ends[::2], ends[1::2]
            free = is_free_segment(nodes, 0, 0, arrangement.arrays, empty_memory(), make_counter())
            assert free == (full["depth"] == 0.0)
            if free:
                assert nodes[0, 0].tolist()[:6] == full.tolist()[:6]


def groups_hit(arrangement: Arrangement, room: Polygon, line: LineString) -> set[int]:
    """By shapely: groups whose interior is entered, and pairs whose common seam is run along."""
    polygons = [*arrangement.groups, frame_around(room)]
    hit = {g for g, p in enumerate(polygons) if shapely.relate_pattern(p, line, "T********")}
    frame = len(polygons) - 1
    for g in range(frame):
        seam = polygons[g].boundary.intersection(polygons[frame].boundary)
        if line.intersection(seam).length > 0:
            hit |= {g, frame}
    return hit


def test_noted_hits_are_the_groups_that_shapely_says_are_entered():
    hits = 0
    for seed in range(counts(60, 6)):
        rng = np.random.default_rng(seed)
        room, obstacles = random_solid(rng)
        arrangement = arrange(room, obstacles)
        segments = random_segments(rng, room, 40)
        segments = segments[(segments[:, :2] != segments[:, 2:]).any(axis=1)]
        # An end inside the frame's far side is nobody's business: lattice nodes lie in the room.
        for ends, line in zip(segments.tolist(), lines(segments), strict=True):
            if not box(*room.bounds).covers(line):
                continue
            found = record(arrangement, ends)
            noted = found["hits"][: found["hit_count"]].tolist()
            assert sorted(noted) == sorted(groups_hit(arrangement, room, line)), (seed, ends)
            hits += len(noted)
    assert hits > 0
