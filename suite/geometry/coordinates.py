"""Coordinates relative to a workspace, and the grid on which its scene is snapped.

Real maps lie at 5,000,000 m from their origin, where neighbouring float64 are 1e-9 m apart: there
a grid of 1e-9 is none, and the points in which lines cross are rounded as coarsely as that. So
whatever is computed of a scene is computed near zero, and the grid is never finer than what the
coordinates of the place can tell apart. Metres.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from suite.geometry.tolerances import GRID_DECIMALS, HIT_DEPTH

Bounds = tuple[float, float, float, float]

FAR = 4.0
"""A workspace that lies further from an axis than this many times its larger side is shifted. From
there on the difference of two of its coordinates, and of what lies beside it, is exact: neither is
more than twice the other (Sterbenz 1974, theorem 4.3.1)."""

SPACINGS = 16.0
"""The grid is at least as wide as this many spacings of float64 where the workspace lies: what is
rounded to the nearest float64 then moves by a 32nd of the grid at most, and by far too little to
come upon an edge, from which snap rounding keeps it half of the grid away (Hobby 1999)."""


@dataclass(frozen=True, slots=True)
class Coordinates:
    """Where the coordinates of a scene lie, and how finely they are told apart.

    origin : x, y of the local origin, metres; 0 along an axis to which the workspace lies near.
    decimals : the grid is 10 to the power of minus this, metres.
    """

    origin: tuple[float, float]
    decimals: int

    @property
    def grid(self) -> float:
        """Width of the grid, metres."""
        return float(f"1e{-self.decimals}")

    @property
    def hit_depth(self) -> float:
        """How deep a robot must be in an obstacle to be hit by it, metres."""
        return HIT_DEPTH * self.grid

    def local(self, xy: ArrayLike) -> NDArray[np.float64]:
        """Coordinates (..., 2) relative to the origin; exact within reach of the workspace."""
        return np.asarray(xy, dtype=np.float64) - self.origin

    def world(self, xy: ArrayLike) -> NDArray[np.float64]:
        """Local coordinates (..., 2) as those of the scene, rounded to the nearest float64."""
        return np.asarray(xy, dtype=np.float64) + self.origin

    def snapped(self, xy: ArrayLike) -> NDArray[np.float64]:
        """Coordinates (..., 2) of the scene, moved to the nearest place of its grid."""
        # -0.0 and 0.0 are one place; hashes of scenes must agree.
        return self.world(np.round(self.local(xy), self.decimals) + 0.0)


def coordinates_of(bounds: Bounds) -> Coordinates:
    """The local coordinates of what lies within bounds.

    Parameters
    ----------
    bounds : xmin, ymin, xmax, ymax
        Of a workspace, metres.

    Returns
    -------
    Coordinates
        Of nanometres, for rooms of a metre or more near the origin; finer for smaller ones, and
        coarser where float64 is.

    Examples
    --------
    >>> coordinates_of((0.0, 0.0, 80.0, 60.0))
    Coordinates(origin=(0.0, 0.0), decimals=9)
    >>> coordinates_of((691608.0, 5334765.0, 691688.0, 5334825.0))
    Coordinates(origin=(691600.0, 5334760.0), decimals=7)
    """
    xmin, ymin, xmax, ymax = bounds
    side = max(xmax - xmin, ymax - ymin)
    spacing = math.ulp(max(abs(value) for value in bounds))
    finest = GRID_DECIMALS + max(0, -_magnitude(side))
    coarsest = math.floor(-math.log10(SPACINGS * spacing))
    origin = (_origin(xmin, xmax, side), _origin(ymin, ymax, side))
    return Coordinates(origin, min(finest, coarsest))


def _magnitude(length: float) -> int:
    """The power of ten of a positive length."""
    return math.floor(math.log10(length))


def _origin(low: float, high: float, side: float) -> float:
    if max(low, -high) < FAR * side:
        return 0.0
    unit = float(f"1e{_magnitude(side)}")
    return math.floor(low / unit) * unit


def printed(x: float, y: float) -> str:
    """A place in words, to the nanometre: never rounded so that it could not be read back.

    Examples
    --------
    >>> printed(461523.25, 5638012.125), printed(10.0, 1.0 / 3.0)
    ('(461523.25, 5638012.125)', '(10, 0.333333333)')
    """
    return f"({_digits(x)}, {_digits(y)})"


def _digits(value: float) -> str:
    if not abs(value) < 1e15:
        return repr(float(value))
    return np.format_float_positional(np.round(value, GRID_DECIMALS) + 0.0, trim="-")
