"""The outlines of SVG shapes as points, curves as chords that are off by no more than a tolerance.

A convex curve loses that much, and a hollow one gains it.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from svgelements import (
    Arc,
    Close,
    CubicBezier,
    Move,
    PathSegment,
    QuadraticBezier,
)

Points = NDArray[np.float64]

MOST_CHORDS = 2000
"""Of one segment of a curve, however large it is drawn."""


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """Points (n, 2) of a subpath in turn; closed, if its end was joined to its start."""

    points: Points
    closed: bool


def lines_of(segments: Iterable[PathSegment], tolerance: float) -> list[Line]:
    """The subpaths of a shape.

    Parameters
    ----------
    segments : of svgelements
    tolerance : float
        In units of the segments, above 0: by how much a chord may be off.
    """
    lines: list[Line] = []
    points: list[Points] = []

    def end(closed: bool) -> None:
        if len(points) > 1:
            lines.append(Line(np.array(points), closed))
        points.clear()

    for segment in segments:
        if segment.end is None:
            continue
        where = np.array([segment.end.x, segment.end.y])
        if isinstance(segment, Move):
            end(False)
            points.append(where)
        elif isinstance(segment, Close):
            end(True)
            points.append(where)  # what is drawn without another move starts there
        else:
            points.extend(_chords(segment, tolerance))
            points.append(where)
    end(False)
    return lines


def _chords(segment: PathSegment, tolerance: float) -> list[Points]:
    """The ends of the chords within a segment, without those of the segment itself."""
    count = min(MOST_CHORDS, max(1, math.ceil(_count(segment, tolerance))))
    places = (segment.point(i / count) for i in range(1, count))
    return [np.array([place.x, place.y]) for place in places]


def _count(segment: PathSegment, tolerance: float) -> float:
    """Into how many chords of equal parameter a segment is cut.

    A curve p on [0, 1] is nowhere further from n chords than max |p''| / (8 n^2).
    """
    if isinstance(segment, Arc):
        radius = max(segment.rx, segment.ry)
        return math.sqrt(radius / (8.0 * tolerance)) * abs(segment.sweep)
    if isinstance(segment, QuadraticBezier):
        bend = 2.0 * _second(segment.start, segment.control, segment.end)
    elif isinstance(segment, CubicBezier):
        bend = 6.0 * max(
            _second(segment.start, segment.control1, segment.control2),
            _second(segment.control1, segment.control2, segment.end),
        )
    else:
        return 1.0
    return math.sqrt(bend / (8.0 * tolerance))


def _second(a: complex, b: complex, c: complex) -> float:
    return abs(complex(a) - 2.0 * complex(b) + complex(c))
