"""Scattered scenes: any number of obstacles of arbitrary shape and size, drawn from a seed.

They go on where the paper's series of 20, 30 and 40 obstacles ends (section IV, Fig. 14): the same
workspace, start and goal, and about the same share of it covered, by obstacles that shrink as their
number grows. As in the paper, a concave obstacle counts as its convex parts. No obstacle touches
another one or the border, and none has a hole, so there is always a path. Metres.
"""

import re
from collections.abc import Callable, Sequence

import numpy as np
import shapely
from shapely.geometry import Polygon

from suite.errors import SceneError
from suite.scenes.outlines import concave_outline, convex_outline
from suite.scenes.placing import moved, scaled, scatter
from suite.scenes.scene import DEFAULT_QUERY, Scene, make_scene

MOST = 10_000
"""Convex parts. With more, coordinates in centimetres would no longer draw their shapes."""

WORKSPACE = shapely.box(0.0, 0.0, 100.0, 100.0)
START = (6.0, 7.0)
GOAL = (93.0, 92.0)

CONCAVE = 0.24
"""Concave obstacles for each convex part: nearly half of all obstacles, as in ``obstacles_40``."""

HULL = 0.51
"""Mean area of an obstacle's convex hull, as a share of the workspace's area for each convex part.
Obstacles then cover about 21 % of the workspace, as in ``obstacles_40``."""

SPREAD = 0.5
SIZES = (0.3, 2.5)
"""The area of a hull is log-normal around its mean, with this spread, cut off at these multiples.
In ``obstacles_40`` the largest obstacle has nine times the area of the smallest."""

GAP = 0.19
"""Least distance between obstacles, as a share of the side of a square for each convex part:
3 m of 15.8 m, as in ``obstacles_40``."""

FEWEST = 20
"""Convex parts that share the workspace. Fewer don't grow to fill it but leave it emptier: a single
one that covers a fifth of it may leave no room for the start."""

_NAME = re.compile(r"scattered_([0-9]{1,20})(?:-([0-9]{1,20}))?")


def scattered(obstacles: int, seed: int) -> Scene:
    """Draw a scene of scattered obstacles.

    Parameters
    ----------
    obstacles : int
        Number of convex parts, 1 to 10,000: ``part_count`` of the scene.
    seed : int
        0 or more. The same numbers give the same scene, another seed gives another one.

    Returns
    -------
    Scene
        100 m x 100 m, vertices in whole centimetres.

    Raises
    ------
    SceneError
        If a number is out of its range.

    References
    ----------
    Hu and Yang, section IV and Fig. 14: "a concave obstacle is considered as two or more convex
    obstacles".

    Examples
    --------
    >>> scene = scattered(50, seed=7)
    >>> scene.name, scene.part_count
    ('scattered_50-7', 50)
    """
    _check(obstacles, seed)
    rng = np.random.default_rng([seed, obstacles])
    side = np.sqrt(WORKSPACE.area / max(obstacles, FEWEST))
    concave = _drawn(concave_outline, round(CONCAVE * obstacles), side, rng)
    placed = scatter(concave, [_blocker(side, rng)], GAP * side, WORKSPACE, (START, GOAL), rng)
    scene = _scene(obstacles, seed, placed)
    # Only its arrangement tells into how many parts an obstacle is cut. Convex ones make up.
    while scene.part_count != obstacles:
        if scene.part_count > obstacles:
            placed = placed[:-1]
        else:
            convex = _drawn(convex_outline, obstacles - scene.part_count, side, rng)
            placed = scatter(convex, placed, GAP * side, WORKSPACE, (START, GOAL), rng)
        scene = _scene(obstacles, seed, placed)
    return scene


def scattered_name(obstacles: int, seed: int) -> str:
    """Name of a scattered scene; seed 0 goes without saying.

    Examples
    --------
    >>> scattered_name(300, 0), scattered_name(300, 7)
    ('scattered_300', 'scattered_300-7')
    """
    return f"scattered_{obstacles}" + (f"-{seed}" if seed else "")


def parse_scattered_name(name: str) -> tuple[int, int] | None:
    """Obstacles and seed in the name of a scattered scene; None if it is another name.

    Examples
    --------
    >>> parse_scattered_name("scattered_300-7"), parse_scattered_name("maze")
    ((300, 7), None)
    """
    found = _NAME.fullmatch(name)
    return (int(found[1]), int(found[2] or 0)) if found else None


def _check(obstacles: int, seed: int) -> None:
    if not 1 <= obstacles <= MOST:
        raise SceneError(f"scattered scene: {obstacles} obstacles. Give 1 to {MOST}.")
    if seed < 0:
        raise SceneError(f"scattered scene: seed is {seed}. Give 0 or more.")


def _scene(obstacles: int, seed: int, polygons: Sequence[Polygon]) -> Scene:
    return make_scene(
        scattered_name(obstacles, seed),
        WORKSPACE,
        polygons,
        {DEFAULT_QUERY: (START, GOAL)},
        properties={
            "description": "Obstacles of arbitrary shape and size, convex and concave, "
            f"{obstacles} convex parts in all, scattered at random.",
            "generated": True,
            "generator": "scattered",
            "obstacles": obstacles,
            "seed": seed,
        },
    )


def _drawn(
    outline: Callable[[np.random.Generator], Polygon],
    number: int,
    side: float,
    rng: np.random.Generator,
) -> list[Polygon]:
    """Obstacles around the origin, the largest first; ``side`` of a part's square, metres."""
    multiples = rng.lognormal(-0.5 * SPREAD**2, SPREAD, number).clip(*SIZES)
    scales = side * np.sqrt(HULL * np.sort(multiples)[::-1])
    return [scaled(outline(rng), scale) for scale in scales.tolist()]


def _blocker(side: float, rng: np.random.Generator) -> Polygon:
    """A convex obstacle whose middle lies on the straight line from start to goal."""
    along = rng.uniform(0.4, 0.6)
    place = (1.0 - along) * np.array(START) + along * np.array(GOAL)
    return moved(_drawn(convex_outline, 1, side, rng)[0], place)
