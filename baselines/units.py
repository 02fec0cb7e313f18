"""Rooms scaled into the unit square, for packages that have tolerances of their own.

The unit is a power of two, so that scaling changes exponents only: nothing is rounded.
"""

import math

from suite.scenes.scene import Scene


def unit_of(scene: Scene) -> float:
    """Metres that are 1 in scaled coordinates: the power of two above the room's longer side.

    Examples
    --------
    >>> import shapely
    >>> from suite.scenes.scene import make_scene
    >>> make = lambda side: make_scene("room", shapely.box(0, 0, side, 9), [], ((1, 1), (2, 2)))
    >>> unit_of(make(100)), unit_of(make(128)), unit_of(make(3000))
    (128.0, 128.0, 4096.0)
    """
    return unit_above(longer_side(scene))


def longer_side(scene: Scene) -> float:
    """Of the box around the room, metres."""
    xmin, ymin, xmax, ymax = scene.bounds
    return float(max(xmax - xmin, ymax - ymin))


def unit_above(length: float) -> float:
    """The smallest power of two that is no less than a length above 0.

    Examples
    --------
    >>> unit_above(0.001), unit_above(2.0)
    (0.001953125, 2.0)
    """
    mantissa, exponent = math.frexp(length)
    return math.ldexp(1.0, exponent - 1 if mantissa == 0.5 else exponent)
