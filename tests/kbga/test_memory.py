"""No segment is checked twice, and what is remembered is what a check would find."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from kbga.counter import make_counter
from kbga.encoding import empty_population
from kbga.evaluation import evaluate_segment, evaluate_within, hair, is_free_segment
from kbga.memory import (
    FIRST_SLOTS,
    MOST_SLOTS,
    NOBODY,
    UNMEASURED,
    empty_memory,
    key_of,
    slot_of,
    with_room,
)
from suite.geometry.arrangement import arrange
from tests.suite.geometry.lattice import counts, random_segments, random_solid

WALL = arrange(shapely.box(0, 0, 10, 10), [shapely.box(4, 0, 6, 7)]).arrays
FREE = ((1.0, 9.0), (9.0, 9.0))
BLOCKED = ((1.0, 1.0), (9.0, 1.0))


class Bench:
    """A path of one segment, a memory and a counter."""

    def __init__(self, arrays=WALL) -> None:
        self.arrays = arrays
        self.memory = empty_memory()
        self.counter = make_counter()
        self.nodes = empty_population(1, 2).nodes

    def put(self, ends, tail=7, head=8) -> None:
        self.nodes["gene"][0] = tail, head
        self.nodes["x"][0], self.nodes["y"][0] = np.transpose(ends)

    def evaluate(self) -> float:
        evaluate_segment(self.nodes, 0, 0, self.arrays, self.memory, self.counter)
        return float(self.nodes["depth"][0, 0])

    def stays_below(self, limit: float) -> bool:
        """With a penalty of 1, so that costs are length and depth."""
        args = self.arrays, self.memory, 8.0, 1.0, limit, self.counter
        return bool(evaluate_within(self.nodes, 0, 0, *args))

    def known_depth(self) -> float:
        segments = self.memory.segments
        return float(segments["depth"][slot_of(segments, key_of(7, 8))])

    def is_free(self) -> bool:
        return bool(is_free_segment(self.nodes, 0, 0, self.arrays, self.memory, self.counter))


def test_a_segment_is_checked_once():
    bench = Bench()
    for ends, genes in ((FREE, (7, 8)), (BLOCKED, (8, 9))):
        bench.put(ends, *genes)
        depths = {bench.evaluate() for _ in range(3)}
        assert depths == {0.0 if ends is FREE else 6.0}
        assert bench.is_free() == (ends is FREE)
    assert bench.counter[0] == 2


def test_a_free_segment_needs_no_measuring_after_the_quick_test():
    bench = Bench()
    bench.put(FREE)
    assert bench.is_free()
    assert bench.evaluate() == 0.0
    assert bench.counter[0] == 1


def test_an_infeasible_segment_is_measured_when_its_depth_is_wanted_from_where_the_check_ended():
    bench = Bench()
    bench.put(BLOCKED)
    assert not bench.is_free()
    assert bench.known_depth() == UNMEASURED
    assert not bench.is_free()
    assert bench.evaluate() == 6.0
    assert bench.nodes["hits"][0, 0, 0] == 0
    assert bench.counter[0] == 1


def test_measuring_ends_with_the_obstacle_that_costs_too_much_and_goes_on_from_there():
    slabs = [
        shapely.box(x, 0, x + 1, 9) for x in (2, 4, 6)
    ]  # each 8 m deep, as they stand on the border
    arrays = arrange(shapely.box(0, 0, 10, 10), slabs).arrays
    bench = Bench(arrays)
    bench.put(BLOCKED)
    assert not bench.stays_below(8.0 + 8.0)
    assert -bench.known_depth() == 8.0
    assert not bench.stays_below(8.0 + 9.0)
    assert -bench.known_depth() == 16.0
    assert bench.stays_below(8.0 + 24.5)
    assert (bench.nodes["depth"][0, 0], bench.nodes["hit_count"][0, 0]) == (24.0, 3)
    assert sorted(bench.nodes["hits"][0, 0, :3].tolist()) == [0, 1, 2]
    assert not bench.stays_below(8.0 + 24.0)
    assert bench.counter[0] == 1


def test_the_two_directions_of_a_segment_are_two_segments():
    bench = Bench()
    bench.put(FREE, 7, 8)
    bench.evaluate()
    bench.put(BLOCKED, 8, 7)
    assert bench.evaluate() == 6.0


def test_segments_of_one_slot_do_not_answer_for_each_other():
    nobody = empty_memory().segments
    home = slot_of(nobody, key_of(7, 8))
    others = [n for n in range(9, 400_000) if slot_of(nobody, key_of(7, n)) == home]
    bench = Bench()
    for _ in range(2):
        for k, other in enumerate([8, *others[:30]]):
            bench.put(BLOCKED if k % 2 else FREE, 7, other)
            assert bench.evaluate() == (6.0 if k % 2 else 0.0)
    assert bench.counter[0] > 31, "so many have no room side by side"


def test_a_crowded_table_grows_and_forgets_nothing():
    bench = Bench()
    for n in range(FIRST_SLOTS // 4 + 1):
        bench.put(BLOCKED if n % 2 else FREE, 7, n)
        bench.evaluate()
    assert with_room(bench.memory, FIRST_SLOTS // 4) is bench.memory
    bench.memory = with_room(bench.memory, int(bench.counter[0]))
    assert len(bench.memory.segments) == 2 * FIRST_SLOTS
    known = int((bench.memory.segments["key"] != NOBODY).sum())
    checks = int(bench.counter[0])
    for n in range(FIRST_SLOTS // 4 + 1):
        bench.put(BLOCKED if n % 2 else FREE, 7, n)
        assert bench.evaluate() == (6.0 if n % 2 else 0.0)
    assert bench.counter[0] == checks == known, "nothing was checked again"


def test_what_is_measured_in_part_goes_on_in_the_larger_table():
    slabs = [shapely.box(x, 0, x + 1, 9) for x in (2, 4, 6)]
    bench = Bench(arrange(shapely.box(0, 0, 10, 10), slabs).arrays)
    bench.put(BLOCKED)
    assert not bench.stays_below(8.0 + 9.0)
    bench.memory = with_room(bench.memory, FIRST_SLOTS)
    assert -bench.known_depth() == 16.0
    assert bench.evaluate() == 24.0
    assert sorted(bench.nodes["hits"][0, 0, :3].tolist()) == [0, 1, 2]
    assert bench.counter[0] == 1


def test_the_largest_table_stays_as_it_is():
    largest = empty_memory(MOST_SLOTS)
    assert with_room(largest, 10**9) is largest


def test_slots_are_in_range_and_used_evenly():
    rng = np.random.default_rng(0)
    pairs = rng.integers(-2, 401 * 401, (20_000, 2)).tolist()
    nobody = empty_memory().segments
    slots = np.array([slot_of(nobody, key_of(tail, head)) for tail, head in pairs])
    assert 0 <= slots.min() <= slots.max() < FIRST_SLOTS
    assert np.bincount(slots, minlength=FIRST_SLOTS).max() < 25


def test_keys_tell_all_segments_apart():
    ends = [-2, -1, 0, 1, 2**31 - 1]
    keys = {key_of(tail, head) for tail in ends[1:] for head in ends}
    assert len(keys) == 4 * 5
    assert NOBODY not in keys


ASKED = st.lists(
    st.tuples(
        st.sampled_from(["is_free", "evaluate", "stays_below"]),
        st.sampled_from([0.0, 0.5, 2.0, 20.0]),  # all else costs
        st.sampled_from([0.0, 0.25, 1.0, 30.0]),  # penalty
        st.sampled_from([0.0, 0.5, 1.0, 2.5, 4.0, 9.0, 21.0, 1e6, np.inf]),  # limit
    ),
    min_size=1,
    max_size=8,
)


@settings(max_examples=counts(300, 40))
@given(st.integers(0, 2**32), ASKED)
def test_whatever_was_asked_before_the_answer_is_that_of_a_fresh_evaluation_bit_for_bit(
    seed, asked
):
    rng = np.random.default_rng(seed)
    room, obstacles = random_solid(rng)
    arrays = arrange(room, obstacles).arrays
    for ax, ay, bx, by in random_segments(rng, room, 10).tolist():
        genes = [(7, 8), (-1, 8), (-1, -2)][int(rng.integers(0, 3))]
        fresh, bench = Bench(arrays), Bench(arrays)
        for one in (fresh, bench):
            one.put(((ax, ay), (bx, by)), *genes)
        depth = fresh.evaluate()
        for question, cost, penalty, limit in [*asked, ("evaluate", 0.0, 0.0, np.inf)]:
            bench.put(((ax, ay), (bx, by)), *genes)
            if question == "evaluate":
                wanted, answer = True, bench.evaluate() == depth
            elif question == "is_free":
                wanted, answer = depth == 0.0, bench.is_free()
            else:
                wanted = cost + depth * penalty < limit
                args = arrays, bench.memory, cost, penalty, limit, bench.counter
                answer = bool(evaluate_within(bench.nodes, 0, 0, *args))
            assert answer == wanted, question
            if answer:
                count = int(fresh.nodes["hit_count"][0, 0])
                for name in ("length", "depth", "hit_count"):
                    assert bench.nodes[name][0, 0] == fresh.nodes[name][0, 0], name
                found, known = (b.nodes["hits"][0, 0, :count].tolist() for b in (fresh, bench))
                assert found == known
        assert bench.counter[0] == 1


def test_a_segment_that_only_a_pinch_point_closes_is_measured_in_full_at_once():
    corners = shapely.box(3, 3, 5, 5), shapely.box(5, 5, 7, 7)
    arrays = arrange(shapely.box(0, 0, 10, 10), list(corners)).arrays
    bench = Bench(arrays)
    bench.put(((4.0, 6.0), (6.0, 4.0)))
    assert not bench.stays_below(8.0)
    assert bench.known_depth() == hair(arrays)
    assert not bench.is_free()
    assert bench.evaluate() == hair(arrays)
