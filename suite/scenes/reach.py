"""What a query can reach: the part of free space that it lies in, and whether there is a way."""

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from suite.geometry.coordinates import printed
from suite.scenes.scene import Query, Scene


def reachable_bounds(scene: Scene, query: Query) -> tuple[float, float, float, float]:
    """Bounds of the part of free space that a query lies in.

    Most of a map that a robot has drawn is unknown: a room of 19 m may be free on 5 m. The faces of
    the arrangement stand for the parts, as they are at hand: asking which ones a query touches
    takes some 0.1 ms (``scene.regions`` takes up to 6 ms on the same maps). Only where a sliver was
    rounded away are two faces one part.

    Parameters
    ----------
    scene : Scene
    query : Query
        Its ends are in free space, or on the border of it.

    Returns
    -------
    xmin, ymin, xmax, ymax, metres; those of the room, if the query touches no part.

    Examples
    --------
    >>> from suite.scenes.scene import make_scene
    >>> wall = shapely.box(4, 0, 5, 9)
    >>> room = make_scene("room", shapely.box(0, 0, 30, 9), [wall], {})
    >>> reachable_bounds(room, room.query("6,1:9,9"))
    (5.0, 0.0, 30.0, 9.0)
    """
    touched = _touched(scene, scene.arrangement.free, query.start, query.goal)
    if not touched:
        return scene.bounds
    xmin, ymin, xmax, ymax = shapely.total_bounds(touched).tolist()
    return xmin, ymin, xmax, ymax


def no_way(scene: Scene, query: Query) -> str | None:
    """Why no path leads from start to goal.

    There is one if and only if a part of free space holds both: two parts have single points in
    common at the most, and no path leads through these.

    Parameters
    ----------
    scene : Scene
    query : Query

    Returns
    -------
    str, a sentence with the proof; None if there is a way. That takes some 0.2 ms; where there is
    none, ``scene.regions`` is made.

    Examples
    --------
    >>> from suite.scenes.scene import make_scene
    >>> wall = shapely.box(4, 0, 6, 10)
    >>> scene = make_scene("two rooms", shapely.box(0, 0, 10, 10), [wall], ((1, 1), (9, 9)))
    >>> no_way(scene, scene.query())
    'no way: the start lies in a part of free space of 40 m2, which does not hold the goal.'
    """
    start = _touched(scene, scene.arrangement.free, query.start)
    goal = _touched(scene, scene.arrangement.free, query.goal)
    if not _have_one_in_common(start, goal):
        regions = list(scene.regions.geoms)
        start, goal = _touched(scene, regions, query.start), _touched(scene, regions, query.goal)
    if _have_one_in_common(start, goal):
        return None
    for what, end, parts in (("start", query.start, start), ("goal", query.goal, goal)):
        if not parts:
            return f"no way: the {what} {printed(*end)} lies in no free space."
    area = sum(part.area for part in start)
    return (
        f"no way: the start lies in a part of free space of {area:.6g} m2, which does not hold the "
        "goal."
    )


def _touched(scene: Scene, parts: Sequence[Polygon], *places: NDArray[np.float64]) -> list[Polygon]:
    """Those of some parts of free space that hold one of some places, borders included."""
    known = np.array(parts, dtype=np.object_)
    near = shapely.dwithin(known, shapely.multipoints(np.array(places)), scene.coordinates.grid)
    return list(known[near])


def _have_one_in_common(some: list[Polygon], others: list[Polygon]) -> bool:
    return any(part is other for part in some for other in others)
