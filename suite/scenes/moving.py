"""Moving scenes: rooms whose obstacles move, hide, appear and vanish, drawn from a seed.

They are for claims about every dynamic scene: unlike the paper's two, nobody arranged them.
At time 0 what the robot knows leaves it a way: what is closed from the start is drawn anew. Later
obstacles may overlap, leave the room, stop on the goal or come upon the robot, and a wall across
the room may appear or be found: not every goal can be reached, not every hit be avoided. Metres,
seconds.
"""

import re
from zlib import crc32

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.affinity import translate
from shapely.geometry import MultiPoint, Polygon

from suite.errors import SceneError
from suite.scenes.dynamics import Detection, Dynamics, Motion, Removal, make_motion
from suite.scenes.exact import shortest_path
from suite.scenes.outlines import concave_outline, convex_outline
from suite.scenes.scene import DEFAULT_QUERY, Obstacle, Scene, make_scene, scene_at

WORKSPACE = shapely.box(0.0, 0.0, 100.0, 100.0)
LOW, HIGH = 0.0, 100.0
DECIMALS = 2

STATIC = (2, 8)
CHANGING = (2, 8)
"""Of the obstacles that stay and of those that change, the least number and the first too large."""

SIZE = (6.0, 24.0)
"""Side of a square as large as an obstacle's convex hull."""

SHRINK = 0.97
"""Factor on an obstacle at each throw that finds no place, so that one finds a place in the end."""

CLEAR = 1.0
"""Least distance from start and goal of an obstacle as it is drawn: there it is at time 0."""

WALLED = 0.35
WALL_STAYS = 0.25
"""Share of the scenes with a wall between start and goal, and of those in which it is static."""

SPEEDS = (0.3, 8.0)
STOPS = 0.5
"""Speed of an obstacle on its way from one place to the next, and how often it stops there."""

MOVES, HIDES, VANISHES, APPEARS = range(4)
SHARES = (0.4, 0.3, 0.2, 0.1)
"""How often an obstacle that changes anyway moves, hides, vanishes and appears besides."""

TIME_LIMIT = 60.0

_NAME = re.compile(r"moving-([0-9]{1,20})")


def moving(seed: int) -> Scene:
    """Draw a dynamic scene.

    Parameters
    ----------
    seed : int
        0 or more. The same seed gives the same scene, another seed gives another one.

    Returns
    -------
    Scene
        100 m x 100 m, all numbers in hundredths. Its property ``world`` holds the speed of the
        robot, the interval of its updates, its sensing range and the time limit.

    Raises
    ------
    SceneError
        If the seed is negative.

    Examples
    --------
    >>> scene = moving(7)
    >>> scene.name, scene.is_dynamic, scene.properties["world"]["time_limit"]
    ('moving-7', True, 60.0)
    """
    if seed < 0:
        raise SceneError(f"moving scene: seed is {seed}. Give 0 or more.")
    rng = np.random.default_rng([seed, crc32(b"moving")])
    while not _can_start(scene := _drawn(seed, rng)):
        pass
    return scene


def _can_start(scene: Scene) -> bool:
    """Whether there is a way in what the robot knows when it looks around for the first time."""
    start = shapely.Point(scene.query().start)
    senses = scene.properties["world"]["sensing_range"]
    unknown = {o.name for o in scene.obstacles if not _is_known_at_first(o, start, senses)}
    return shortest_path(scene_at(scene, 0.0, without=unknown), scene.query()).path is not None


def _is_known_at_first(obstacle: Obstacle, start: shapely.Point, senses: float) -> bool:
    dynamics = obstacle.dynamics
    if dynamics is None or dynamics.detection is None:
        return True
    within = dynamics.detection.range
    distance = translate(obstacle.polygon, *dynamics.offset(0.0)).distance(start)
    return bool(distance <= (senses if within is None else within))


def _drawn(seed: int, rng: np.random.Generator) -> Scene:
    """One draw, whatever it is worth."""
    start, goal = ((_number(rng, x, x + 17.0), _number(rng, 3.0, 97.0)) for x in (3.0, 80.0))
    ends = MultiPoint([start, goal])
    statics, changing = rng.integers(*STATIC), rng.integers(*CHANGING)
    obstacles = [_static(f"static {i}", ends, rng) for i in range(1, statics + 1)]
    obstacles += [_changing(f"changing {i}", ends, rng) for i in range(1, changing + 1)]
    if rng.random() < WALLED:
        obstacles.append(_wall(rng))
    return make_scene(
        moving_name(seed),
        WORKSPACE,
        obstacles,
        {DEFAULT_QUERY: (start, goal)},
        properties={
            "description": "Obstacles that stay, move, hide, appear and vanish at random.",
            "generated": True,
            "generator": "moving",
            "seed": seed,
            "world": {
                "speed": _number(rng, 1.5, 6.0),
                "interval": float(rng.choice([1.0, 1.5, 2.0, 3.0])),
                "sensing_range": _number(rng, 3.0, 25.0),
                "time_limit": TIME_LIMIT,
            },
        },
    )


def moving_name(seed: int) -> str:
    """Name of a moving scene.

    Examples
    --------
    >>> moving_name(7)
    'moving-7'
    """
    return f"moving-{seed}"


def parse_moving_name(name: str) -> int | None:
    """Seed in the name of a moving scene; None if it is another name.

    Examples
    --------
    >>> parse_moving_name("moving-7"), parse_moving_name("moving")
    (7, None)
    """
    found = _NAME.fullmatch(name)
    return int(found[1]) if found else None


def _number(rng: np.random.Generator, low: float, high: float) -> float:
    return round(float(rng.uniform(low, high)), DECIMALS)


def _place(rng: np.random.Generator) -> tuple[float, float]:
    return _number(rng, LOW, HIGH), _number(rng, LOW, HIGH)


def _static(name: str, ends: MultiPoint, rng: np.random.Generator) -> Obstacle:
    return Obstacle(name, _polygon(ends, rng))


def _changing(name: str, ends: MultiPoint, rng: np.random.Generator) -> Obstacle:
    polygon = _polygon(ends, rng)
    return Obstacle(name, polygon, _dynamics(shapely.get_coordinates(polygon.centroid)[0], rng))


def _wall(rng: np.random.Generator) -> Obstacle:
    """From one side of the room to the other, between start and goal."""
    left = _number(rng, 30.0, 60.0)
    polygon = shapely.box(left, LOW, left + _number(rng, 2.0, 8.0), HIGH)
    stays = rng.random() < WALL_STAYS
    return Obstacle("wall", polygon, None if stays else _dynamics(np.array([left, 50.0]), rng))


def _polygon(ends: MultiPoint, rng: np.random.Generator) -> Polygon:
    """An obstacle in the room, clear of start and goal."""
    outline = (convex_outline, concave_outline)[int(rng.integers(2))](rng)
    size = rng.uniform(*SIZE)
    while True:
        polygon = _placed(outline, size, rng)
        if WORKSPACE.covers(polygon) and polygon.distance(ends) >= CLEAR:
            return polygon
        size *= SHRINK


def _placed(outline: Polygon, size: float, rng: np.random.Generator) -> Polygon:
    place = np.array(_place(rng))
    return shapely.transform(outline, lambda xy: np.round(size * xy + place, DECIMALS))


def _dynamics(place: NDArray[np.float64], rng: np.random.Generator) -> Dynamics:
    """Changes of an obstacle around a place (2,): one at least, maybe several."""
    wanted = rng.random(len(SHARES)) < SHARES
    wanted[rng.integers(len(SHARES))] = True
    return Dynamics(
        _motion(place, rng) if wanted[MOVES] else None,
        _detection(rng) if wanted[HIDES] else None,
        _removal(rng) if wanted[VANISHES] else None,
        _number(rng, 0.5, 0.5 * TIME_LIMIT) if wanted[APPEARS] else 0.0,
    )


def _motion(place: NDArray[np.float64], rng: np.random.Generator) -> Motion:
    """From a place (2,) over others of the room, each way at a speed of its own."""
    time = float(rng.choice([0.0, _number(rng, 0.0, 10.0)]))
    here = place
    rows = [(time, 0.0, 0.0)]
    for _ in range(rng.integers(1, 5)):
        there = np.array(_place(rng))
        # In half a second at least: its times are rounded, and must rise.
        time += max(0.5, float(np.hypot(*(there - here))) / rng.uniform(*SPEEDS))
        rows.append((time, *(there - place)))
        if rng.random() < STOPS:
            time += rng.uniform(1.0, 8.0)
            rows.append((time, *(there - place)))
        here = there
    return make_motion(np.round(rows, DECIMALS))


def _detection(rng: np.random.Generator) -> Detection:
    """In a range of its own, or in the robot's."""
    return Detection(_number(rng, 1.0, 20.0) if rng.random() < 0.5 else None)


def _removal(rng: np.random.Generator) -> Removal:
    """By time, by the robot's coming, or by either."""
    by_time, by_place = [(True, False), (False, True), (True, True)][int(rng.integers(3))]
    return Removal(
        _number(rng, 1.0, TIME_LIMIT) if by_time else None,
        _place(rng) if by_place else None,
        _number(rng, 2.0, 20.0) if by_place else 0.0,
    )
