"""The obstacle arrays as two flat arrays, for callers that cross from Python for every segment.

A named tuple of thirteen arrays costs 1.5 us to hand to a kernel, two arrays 0.25 us. Planners
whose loop is compiled take :class:`ObstacleArrays` as it is; callbacks from C++ take these.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from suite.geometry.kernels import ObstacleArrays, segment_enters

_FIELDS = ObstacleArrays._fields
_WHOLE = ("part_start", "seam", "group_start", "boundary_start", "border_start", "pinch_start")
_FLOAT = tuple(f for f in _FIELDS if f not in _WHOLE)


class PackedArrays(NamedTuple):
    """:class:`ObstacleArrays` in two flat arrays.

    floats : (F,) float64, the float fields, one after the other.
    whole : (I,) int64, where each field begins and ends, then the integer fields.
    """

    floats: np.ndarray
    whole: np.ndarray


def pack(arrays: ObstacleArrays) -> PackedArrays:
    """Flatten obstacle arrays for :func:`packed_segment_enters`."""
    header = 2 * len(_FIELDS)
    spans: dict[str, tuple[int, int]] = {}
    at = {True: 0, False: header}
    for name in (*_FLOAT, *_WHOLE):
        is_float = name in _FLOAT
        size = getattr(arrays, name).size
        spans[name] = (at[is_float], at[is_float] + size)
        at[is_float] += size
    floats = np.concatenate([getattr(arrays, f).ravel() for f in _FLOAT])
    whole = np.concatenate(
        [
            np.array([spans[f] for f in _FIELDS], dtype=np.int64).ravel(),
            *(getattr(arrays, f).astype(np.int64) for f in _WHOLE),
        ]
    )
    return PackedArrays(floats, whole)


@njit(cache=True)
def _rows(packed: np.ndarray, whole: np.ndarray, number: int, width: int) -> np.ndarray:
    return packed[whole[2 * number] : whole[2 * number + 1]].reshape(-1, width)


@njit(cache=True)
def _span(whole: np.ndarray, number: int) -> np.ndarray:
    return whole[whole[2 * number] : whole[2 * number + 1]]


@njit(cache=True)
def unpack(floats: np.ndarray, whole: np.ndarray) -> ObstacleArrays:
    """Views of the packed arrays, in the order of the fields of :class:`ObstacleArrays`."""
    return ObstacleArrays(
        _rows(floats, whole, 0, 2),
        _span(whole, 1),
        _rows(floats, whole, 2, 4),
        _span(whole, 3),
        _span(whole, 4),
        _rows(floats, whole, 5, 4),
        _rows(floats, whole, 6, 4),
        _span(whole, 7),
        _rows(floats, whole, 8, 4),
        _span(whole, 9),
        _rows(floats, whole, 10, 2),
        _span(whole, 11),
        _rows(floats, whole, 12, 2),
    )


@njit(cache=True)
def packed_segment_enters(
    ax: float, ay: float, bx: float, by: float, floats: np.ndarray, whole: np.ndarray
) -> bool:
    """Whether segment a-b leaves free space; see :func:`suite.geometry.kernels.segment_enters`."""
    return segment_enters(ax, ay, bx, by, unpack(floats, whole))
