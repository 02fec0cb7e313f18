"""The coordinates that OMPL plans in: the scene scaled into the unit square, without rounding.

The unit is a power of two, so that scaling changes exponents only: a segment in OMPL's coordinates
is, to the last bit, the segment in metres that the referee judges, and the kernel's verdicts are
the same. OMPL needs it: AORRTC 2.0.1 keeps distances in single precision and adds 1e-5 for their
rounding (``AOXRRTConnect::findNeighbour``). From 256 m on, a distance is rounded by more than that;
the search then reads beyond the end of a list of neighbours, and the process dies.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from suite.geometry.kernels import YMAX
from suite.scenes.scene import Scene

Tables = tuple[NDArray[np.float64], ...]


def tables_in(unit: float, scene: Scene) -> Tables:
    """Make the tables that the collision kernel reads, in units instead of metres."""
    arrays = scene.arrays
    tree, vertices, pinches = arrays.tree.copy(), arrays.vertices.copy(), arrays.pinches.copy()
    tree[:, : YMAX + 1] /= unit
    for table in (vertices, pinches):
        table[:, :2] /= unit
    return tree, vertices, pinches, arrays.ways


def metres(states: list[Any], unit: float) -> NDArray[np.float64]:
    """Read a path of OMPL's, (n, 2) in metres."""
    return unit * np.array([(state[0], state[1]) for state in states], dtype=np.float64)
