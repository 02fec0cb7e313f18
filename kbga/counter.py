"""Counting questions: whether a segment is free, asked and computed, and how many may be asked.

A question is asked whenever an operator wants to know of a segment; it is computed only if
:mod:`kbga.memory` does not know. Budgets of checks count what is asked, so that a check means the
same for a planner that remembers and for one that does not.
"""

import numpy as np
from numpy.typing import NDArray

from suite.jit import inlined_kernel

COMPUTED, ASKED, LIMIT = range(3)
"""Places of a counter, (3,) int64."""

NO_LIMIT = np.iinfo(np.int64).max

OUT_OF_QUESTIONS = 1e9
"""Depth of a segment that nobody may ask about any more, metres: none that was measured is as deep,
so what holds it is never taken for the best."""


def make_counter(limit: int | None = None) -> NDArray[np.int64]:
    """A counter of nothing yet; ``limit`` questions may be asked, by default any number."""
    return np.array([0, 0, NO_LIMIT if limit is None else limit], np.int64)


@inlined_kernel
def may_ask(counter: np.ndarray) -> bool:
    """Count a question that is about to be asked; False, and not counted, if none is left."""
    if counter[ASKED] >= counter[LIMIT]:
        return False
    counter[ASKED] += 1
    return True


@inlined_kernel
def is_spent(counter: np.ndarray) -> bool:
    """Whether no question is left."""
    return counter[ASKED] >= counter[LIMIT]
