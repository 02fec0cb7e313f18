"""The scratch rows in which repair and improvement try a node between two others.

Row 0 holds the node before, the node that is tried, and the node after; row 1 the best so far.
"""

import numpy as np

from kbga.encoding import NODE, distance
from suite.compiled import kernel


def make_scratch() -> np.ndarray:
    """Room for one trial and the best so far: (2, 3) of NODE."""
    return np.zeros((2, 3), NODE).view(np.recarray)


@kernel
def detour_length(scratch: np.ndarray) -> float:
    """Length of the way over the node that is tried, metres."""
    x, y = scratch[0, 1].x, scratch[0, 1].y
    return distance(scratch[0, 0].x, scratch[0, 0].y, x, y) + distance(
        x, y, scratch[0, 2].x, scratch[0, 2].y
    )
