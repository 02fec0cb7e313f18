"""No segment is checked twice, and what is remembered is what a check would find."""

import numpy as np
import shapely

from kbga.encoding import empty_population
from kbga.evaluation import evaluate_segment, is_free_segment
from kbga.memory import SLOTS, UNMEASURED, empty_memory, slot_of
from suite.geometry.arrangement import arrange

WALL = arrange(shapely.box(0, 0, 10, 10), [shapely.box(4, 0, 6, 7)]).arrays
FREE = ((1.0, 9.0), (9.0, 9.0))
BLOCKED = ((1.0, 1.0), (9.0, 1.0))


class Bench:
    """A path of one segment, a memory and a counter."""

    def __init__(self) -> None:
        self.memory = empty_memory()
        self.counter = np.zeros(1, np.int64)
        self.nodes = empty_population(1, 2).nodes

    def put(self, ends, tail=7, head=8) -> None:
        self.nodes["gene"][0] = tail, head
        self.nodes["x"][0], self.nodes["y"][0] = np.transpose(ends)

    def evaluate(self) -> float:
        evaluate_segment(self.nodes, 0, 0, WALL, self.memory, self.counter)
        return float(self.nodes["depth"][0, 0])

    def is_free(self) -> bool:
        return bool(is_free_segment(self.nodes, 0, 0, WALL, self.memory, self.counter))


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


def test_an_infeasible_segment_is_measured_when_its_depth_is_wanted():
    bench = Bench()
    bench.put(BLOCKED)
    assert not bench.is_free()
    assert bench.memory["depth"][slot_of(7, 8)] == UNMEASURED
    assert not bench.is_free()
    assert bench.counter[0] == 1
    assert bench.evaluate() == 6.0
    assert bench.nodes["hits"][0, 0, 0] == 0
    assert bench.counter[0] == 2


def test_the_two_directions_of_a_segment_are_two_segments():
    bench = Bench()
    bench.put(FREE, 7, 8)
    bench.evaluate()
    bench.put(BLOCKED, 8, 7)
    assert bench.evaluate() == 6.0


def test_segments_of_one_slot_do_not_answer_for_each_other():
    other = next(n for n in range(9, 10**6) if slot_of(7, n) == slot_of(7, 8))
    bench = Bench()
    for _ in range(3):
        bench.put(FREE, 7, 8)
        assert bench.evaluate() == 0.0
        bench.put(BLOCKED, 7, other)
        assert bench.evaluate() == 6.0
    assert bench.counter[0] == 6


def test_slots_are_in_range_and_used_evenly():
    rng = np.random.default_rng(0)
    pairs = rng.integers(-2, 401 * 401, (20_000, 2)).tolist()
    slots = np.array([slot_of(tail, head) for tail, head in pairs])
    assert 0 <= slots.min() <= slots.max() < SLOTS
    assert np.bincount(slots, minlength=SLOTS).max() < 25
