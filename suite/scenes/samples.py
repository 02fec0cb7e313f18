"""Samples of queries: pairs of places drawn in free space, and some of each stratum of a map.

A query that is drawn is called by its own two places, ``x,y:x,y``, so that a row says by itself
where it went. If n are wanted, they are the first n of any larger number.
"""

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from zlib import crc32

import numpy as np
import shapely
from numpy.typing import NDArray

from suite.errors import SceneError
from suite.scenes.scene import Query, Scene

AT_A_TIME = 1024
MOST_PLACES = 200_000
"""Places that are drawn in vain, one after the other, before it is said that there are no more."""

DECIMALS = 3
"""Of the coordinates of a place: millimetres, which people can read and no robot can tell apart."""
MAGNITUDES = 4
"""Powers of ten that lie at least between a room's larger side and the last decimal."""


@dataclass(frozen=True, slots=True)
class _Place:
    """A free place. text : its coordinates as a name has them. region : number of its part."""

    x: float
    y: float
    text: str
    region: int


def random_queries(
    scene: Scene,
    count: int,
    *,
    seed: int = 0,
    min_distance: float = 0.0,
    connected: bool = True,
) -> tuple[Query, ...]:
    """Draw pairs of places uniformly from the free space of a scene.

    Parameters
    ----------
    scene : Scene
        Of a dynamic one, what is free at time 0.
    count : int
    seed : int
        Of the stream, which is another one for each name of a scene.
    min_distance : float
        Between start and goal, straight, metres.
    connected : bool
        Only pairs between which there is a path.

    Returns
    -------
    tuple of Query
        Each is what ``scene.query`` gives for its name; none is blocked.

    Raises
    ------
    SceneError
        If so many can't be found. The message says why, and what to change.

    Examples
    --------
    >>> from suite.scenes.catalogue import load_scene
    >>> drawn = random_queries(load_scene("maze"), 2, min_distance=50.0)
    >>> [float(np.hypot(*(query.goal - query.start))) > 50.0 for query in drawn]
    [True, True]
    """
    rng = np.random.default_rng([seed, crc32(f"{scene.name}/queries".encode())])
    _check_room(scene, min_distance)
    queries: dict[str, Query] = {}
    flaws: Counter[str] = Counter()
    in_vain = 0
    for pairs in _pairs(scene, rng):
        in_vain += AT_A_TIME
        for start, goal in pairs:
            name = f"{start.text}:{goal.text}"
            flaw = _flaw(start, goal, min_distance, connected)
            if flaw is None and name not in queries:
                queries[name] = scene.query(name)
                in_vain, flaws = 0, Counter()
            flaws[flaw or "drawn before"] += 1
            if len(queries) == count:
                return tuple(queries.values())
        if in_vain > MOST_PLACES:
            break
    raise SceneError(
        f"{scene.name}: only {len(queries)} of {count} queries can be drawn: of the last "
        f"{MOST_PLACES} places hardly any were free"
        + "".join(f", {number} pairs were {flaw}" for flaw, number in flaws.items())
        + ". Ask for fewer, or for a smaller min_distance, or for connected = false."
    )


def _check_room(scene: Scene, min_distance: float) -> None:
    """Refuse what no number of draws would find."""
    regions = scene.at_first.regions
    if regions.is_empty:
        raise SceneError(f"{scene.name}: no place is free, to draw queries from.")
    xmin, ymin, xmax, ymax = regions.bounds
    across = math.hypot(xmax - xmin, ymax - ymin)
    if not min_distance < across:  # so written, NaN is refused too
        raise SceneError(
            f"{scene.name}: min_distance is {min_distance:g} m, and free space is {across:.6g} m "
            "across. Give less."
        )


def _flaw(start: _Place, goal: _Place, min_distance: float, connected: bool) -> str | None:
    """Why two places are no query that is wanted; None if they are."""
    if connected and start.region != goal.region:
        return "without a path"
    distance = math.hypot(goal.x - start.x, goal.y - start.y)
    return "too near" if distance < min_distance or distance == 0.0 else None


def _pairs(scene: Scene, rng: np.random.Generator) -> Iterator[list[tuple[_Place, _Place]]]:
    """Free places, two by two, as they are drawn; after each lot of draws those that are there."""
    regions = np.array(shapely.get_parts(scene.at_first.regions))
    tree = shapely.STRtree(regions)
    shapely.prepare(regions)
    decimals = _decimals(scene)
    left: list[_Place] = []
    while True:
        left += _free_places(regions, tree, decimals, rng)
        even = len(left) // 2 * 2
        yield list(zip(left[:even:2], left[1:even:2], strict=True))
        left = left[even:]


def _free_places(
    regions: NDArray[np.object_], tree: shapely.STRtree, decimals: int, rng: np.random.Generator
) -> list[_Place]:
    """Those of a lot of places, drawn uniformly in their bounds, that lie within regions."""
    bounds = shapely.total_bounds(regions)
    drawn = np.round(rng.uniform(bounds[:2], bounds[2:], (AT_A_TIME, 2)), decimals) + 0.0
    points = np.asarray(shapely.points(drawn))
    place, region = tree.query(points)
    within = shapely.contains_properly(regions[region], points[place])
    by_place = sorted(zip(place[within].tolist(), region[within].tolist(), strict=True))
    return [
        _Place(x, y, f"{_text(x, decimals)},{_text(y, decimals)}", number)
        for (i, number) in by_place
        for x, y in [drawn[i].tolist()]
    ]


def _decimals(scene: Scene) -> int:
    """Decimals of drawn coordinates: of millimetres, or more in a small room."""
    xmin, ymin, xmax, ymax = scene.bounds
    small = MAGNITUDES - math.floor(math.log10(max(xmax - xmin, ymax - ymin)))
    return min(max(DECIMALS, small), scene.coordinates.decimals)


def _text(value: float, decimals: int) -> str:
    return np.format_float_positional(value, precision=max(decimals, 0), trim="-")


def stratified_queries(scene: Scene, per_stratum: int, *, seed: int = 0) -> tuple[Query, ...]:
    """Some of a scene's own queries, at random: so many of each stratum.

    Parameters
    ----------
    scene : Scene
        With strata: the buckets of a ``.scen`` file, say.
    per_stratum : int
        All, of a stratum that has no more.
    seed : int
        Of the stream, which is another one for each name of a scene and stratum.

    Returns
    -------
    tuple of Query
        In the order of the scene.

    Raises
    ------
    SceneError
        If the scene's queries have no strata.
    """
    by_stratum: dict[str, list[Query]] = {}
    for query in scene.queries:
        if query.stratum is not None:
            by_stratum.setdefault(query.stratum, []).append(query)
    if not by_stratum:
        raise SceneError(
            f"{scene.name}: its queries have no strata. Draw some with random = 100, or name them."
        )
    chosen = {
        queries[i].name
        for stratum, queries in by_stratum.items()
        for i in _shuffled(f"{scene.name}/{stratum}", len(queries), seed)[:per_stratum]
    }
    return tuple(query for query in scene.queries if query.name in chosen)


def _shuffled(name: str, count: int, seed: int) -> list[int]:
    rng = np.random.default_rng([seed, crc32(name.encode())])
    order: list[int] = rng.permutation(count).tolist()
    return order
