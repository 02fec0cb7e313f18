"""Throwing obstacles into a room, so that each lies apart from all others. Metres."""

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Point, Polygon

DECIMALS = 2

BATCH = 0.25
"""Of the obstacles that wait for a place, the share that is thrown at a time, the largest first.
Thrown all at a time, small ones would take the room of large ones."""

SHRINK = 0.997
"""Factor on an obstacle at each throw that finds no place, so that one finds a place in the end."""


def scaled(obstacle: Polygon, factor: float) -> Polygon:
    """The obstacle, scaled about the origin."""
    return shapely.transform(obstacle, lambda xy: factor * xy)


def moved(obstacle: Polygon, place: NDArray[np.float64]) -> Polygon:
    """The obstacle around another point (2,), in centimetres, its ring in canonical order."""
    there = shapely.transform(obstacle, lambda xy: np.round(xy + place, DECIMALS))
    return shapely.normalize(there)


def scatter(
    obstacles: Sequence[Polygon],
    placed: Sequence[Polygon],
    gap: float,
    room: Polygon,
    ends: Sequence[tuple[float, float]],
    rng: np.random.Generator,
) -> list[Polygon]:
    """Throw obstacles until each lies ``gap`` metres from all others, the border, start and goal.

    Parameters
    ----------
    obstacles : sequence of Polygon
        Around the origin, the largest first.
    placed : sequence of Polygon
        Those that stay where they are.
    gap : float, metres
    room : Polygon
        Into which they are thrown.
    ends : sequence of (x, y), metres
        Starts and goals.
    rng : numpy.random.Generator

    Returns
    -------
    list of Polygon
        ``placed``, then the others where they have come to lie.
    """
    low, high = np.reshape(room.bounds, (2, 2))
    fixed = [room.exterior, *map(Point, ends)]
    placed = list(placed)
    waiting = list(obstacles)
    while waiting:
        thrown = waiting[: int(np.ceil(BATCH * len(waiting)))]
        places = rng.uniform(low, high, (len(thrown), 2))
        tries = [moved(obstacle, place) for obstacle, place in zip(thrown, places, strict=True)]
        fits = _fits(tries, [*fixed, *placed], gap)
        placed += [tries[i] for i in np.flatnonzero(fits)]
        again = [scaled(thrown[i], SHRINK) for i in np.flatnonzero(~fits)]
        waiting = again + waiting[len(thrown) :]
    return placed


def _fits(
    tries: Sequence[Polygon], standing: Sequence[shapely.Geometry], gap: float
) -> NDArray[np.bool_]:
    """Which tries are ``gap`` metres from all that stands and from all earlier tries, (n,) bool."""
    everything = np.array([*standing, *tries], dtype=np.object_)
    tree = shapely.STRtree(everything)
    tried, near = tree.query(everything[len(standing) :], predicate="dwithin", distance=gap)
    crowded = tried[near < tried + len(standing)]
    return ~np.isin(np.arange(len(tries)), crowded)
