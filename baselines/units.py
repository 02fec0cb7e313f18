"""How large rooms are, and rooms scaled into the unit square.

Packages have tolerances of their own, so that they need scaling. The unit is a power of two, so
that scaling changes exponents only: nothing is rounded.
"""

import math

from suite.scenes.reach import reachable_bounds
from suite.scenes.scene import Query, Scene


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


def free_side(scene: Scene, query: Query) -> float:
    """Of the box around the part of free space that a query lies in, metres.

    Parameters
    ----------
    scene : Scene
    query : Query
        Its ends are in free space, or on the border of it.

    Returns
    -------
    float, metres

    Examples
    --------
    >>> import shapely
    >>> from suite.scenes.scene import make_scene
    >>> wall = shapely.box(4, 0, 5, 9)
    >>> room = make_scene("room", shapely.box(0, 0, 30, 9), [wall], {})
    >>> free_side(room, room.query("1,1:2,8")), free_side(room, room.query("6,1:9,9"))
    (9.0, 25.0)
    """
    xmin, ymin, xmax, ymax = reachable_bounds(scene, query)
    return max(xmax - xmin, ymax - ymin)


def unit_above(length: float) -> float:
    """The smallest power of two that is no less than a length above 0.

    Examples
    --------
    >>> unit_above(0.001), unit_above(2.0)
    (0.001953125, 2.0)
    """
    mantissa, exponent = math.frexp(length)
    return math.ldexp(1.0, exponent - 1 if mantissa == 0.5 else exponent)
