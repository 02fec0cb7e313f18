"""What is known of segments between lattice nodes, so that none is checked twice.

The paper records what evaluation finds "so that later it can be used by some specialized genetic
operators ... without re-calculation" (II-B). Beside the chromosomes, which carry their own
records, this table remembers segments that were tried and left, and serves all chromosomes alike.
It holds for one environment; where that changes, a new one is needed.

A hash table with open addressing (Knuth, vol. 3, 6.4, algorithm L), which grows between
generations, so that nothing is allocated within one.
"""

from typing import NamedTuple

import numpy as np

from kbga.encoding import MAX_HITS, records
from suite.jit import inlined_kernel, kernel

SEGMENT = np.dtype([("key", np.int64), ("depth", np.float64)])
"""A segment and what was found out about it.

key : of its two nodes; NOBODY where nothing is remembered.
depth : beta_i, metres, once it is known. Of an infeasible segment that is not measured to the end,
    minus the part that is known; UNMEASURED if none is.
"""


class Memory(NamedTuple):
    """A table of S slots.

    segments : (S,) of SEGMENT.
    hits : (S, 2 + MAX_HITS) int32. COUNT, how many obstacle groups the segment intersects; ROW, of
        a segment that is not measured to the end, the row of the obstacles' tree from which on
        the search goes on; from FIRST_HIT on the numbers of the groups, as in a NODE. A table of
        its own, because it is seldom read: so more segments fit the processor's cache.
    """

    segments: np.ndarray
    hits: np.ndarray


NOBODY = 0
UNMEASURED = -1e-300  # less than any depth that is measured
COUNT, ROW, FIRST_HIT = range(3)

FIRST_SLOTS = 8192
"""Slots of a new table, a power of two. 400 kB: a run that ends soon pays for no more."""

MOST_SLOTS = 65536
"""Slots of the largest table, a power of two. 3 MB, for four times as many segments as the longest
default run on the catalogue tries. Beyond that, newer segments take older ones' places, and some
are checked again."""

_PROBES = 16


def empty_memory(slots: int = FIRST_SLOTS) -> Memory:
    """A table that remembers nothing yet."""
    return Memory(records(slots, SEGMENT), np.zeros((slots, FIRST_HIT + MAX_HITS), np.int32))


def with_room(memory: Memory, checks: int) -> Memory:
    """The same table, or a larger one with the same contents if ``checks`` may crowd it.

    Parameters
    ----------
    memory : Memory
    checks : int
        Collision checks that it has seen. Each adds one segment at most.
    """
    slots = len(memory.segments)
    if 4 * checks <= slots or slots >= MOST_SLOTS:
        return memory
    while slots < MOST_SLOTS and slots < 4 * checks:
        slots *= 2
    grown = empty_memory(slots)
    _copy_all(memory, grown)
    return grown


@inlined_kernel
def key_of(tail: int, head: int) -> int:
    """Number of the segment from one node to another, by their lattice numbers; not NOBODY."""
    return (int(tail) + 2) * 4294967296 + int(head) + 2  # 2**32: lattice numbers are below


@inlined_kernel
def slot_of(segments: np.ndarray, key: int) -> int:
    """Where a segment is remembered; if it is not, where it is to be written."""
    mask = segments.size - 1
    # Two rounds of multiplying and folding; no product exceeds 63 bits.
    mixed = (key >> 32) * 1640531527 + (key & 4294967295) * 1013904223
    mixed = ((mixed ^ (mixed >> 29)) & 4294967295) * 1103515245
    home = (mixed ^ (mixed >> 16)) & mask
    for probe in range(_PROBES):
        slot = (home + probe) & mask
        if segments[slot].key == key or segments[slot].key == NOBODY:
            return slot
    return home


@kernel
def _copy_all(source: Memory, target: Memory) -> None:
    for s in range(source.segments.size):
        key = source.segments[s].key
        if key != NOBODY:
            slot = slot_of(target.segments, key)
            target.segments[slot].key = key
            target.segments[slot].depth = source.segments[s].depth
            for h in range(source.hits.shape[1]):
                target.hits[slot, h] = source.hits[s, h]
