"""What is known of segments between lattice nodes, so that none is checked twice.

The paper records what evaluation finds "so that later it can be used by some specialized genetic
operators ... without re-calculation" (II-B). Beside the chromosomes, which carry their own
records, this table remembers segments that were tried and left, and serves all chromosomes alike.
It holds for one environment; where that changes, a new one is needed.
"""

import numpy as np
from numpy.typing import NDArray

from kbga.encoding import MAX_HITS
from suite.compiled import kernel

SEGMENT = np.dtype(
    [
        ("tail", np.int64),
        ("head", np.int64),
        ("depth", np.float64),
        ("hit_count", np.int64),
        ("hits", np.int64, (MAX_HITS,)),
    ],
    align=True,
)
"""A segment and what was found out about it.

tail, head : lattice numbers of its nodes (START and GOAL for the ends of the path).
depth : beta_i, metres; UNMEASURED if it is only known to be infeasible.
hits, hit_count : as in a NODE.
"""

UNMEASURED = -1.0

SLOTS = 4096
"""Segments that are remembered at once, a power of two: a newer one takes the place of an older
one of the same slot. 400 kB, which fits the cache of a core beside everything else."""

_NOTHING = -3


def empty_memory() -> NDArray[np.void]:
    """A table that remembers nothing yet: (SLOTS,) of SEGMENT."""
    memory = np.zeros(SLOTS, SEGMENT)
    memory["tail"] = _NOTHING
    return memory.view(np.recarray)


@kernel
def slot_of(tail: int, head: int) -> int:
    """Where a segment is remembered, if it is."""
    mixed = tail * 73856093 ^ head * 19349663
    return (mixed ^ (mixed >> 13)) & (SLOTS - 1)
