"""How long large maps take: to load, to prepare, and a query of the exact solver.

python -m tests.perf.large_maps [--queries 200] [--only NAME ...]

Maps of 1,000 to 50,000 vertices: public ones (see ../shared/maps), copies of them side by side, and
scattered scenes. CPU seconds of one process with warm kernels, so that other work on the machine
counts as little as it can.
"""

import argparse
import sys
import time
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.affinity import translate
from shapely.geometry import Polygon, box

from suite.scenes.catalogue import load_scene
from suite.scenes.exact import prepare, shortest_path
from suite.scenes.scattered import scattered
from suite.scenes.scene import Query, Scene, make_scene
from tests.suite.scenes.real_maps import FOLDER

DENVER, ARENA = "Denver_1_256.map", "arena.map"
IRON_HARVEST = "ironharvest_scene_mp_2p_01.mesh"
STREET = 0.02
"""Width of the streets between copies, as a share of a copy's width."""

Drawn = tuple[Polygon, list[Polygon], tuple[NDArray[np.float64], NDArray[np.float64]]]


def public(name: str) -> Scene:
    """A public map."""
    return load_scene(FOLDER / name)


def copies(scene: Scene, columns: int, rows: int) -> Drawn:
    """What is drawn of a scene, so many times side by side, with streets between the copies."""
    xmin, ymin, xmax, ymax = scene.bounds
    width, street = xmax - xmin, STREET * (xmax - xmin)
    dx, dy = width + street, ymax - ymin + street
    query = scene.query()
    obstacles = [
        translate(polygon, i * dx, j * dy)
        for i in range(columns)
        for j in range(rows)
        for polygon in outlines(scene)
    ]
    room = box(xmin, ymin, xmax + (columns - 1) * dx, ymax + (rows - 1) * dy)
    far = np.add(query.goal, ((columns - 1) * dx, (rows - 1) * dy))
    return room, obstacles, (query.start, far)


def drawn(scene: Scene) -> Drawn:
    """What is drawn of a scene."""
    query = scene.query()
    return scene.workspace, outlines(scene), (query.start, query.goal)


def outlines(scene: Scene) -> list[Polygon]:
    """Its obstacles without the vertices that lie on straight sides, as importers give them."""
    return [o.polygon.simplify(0.0) for o in scene.obstacles]


MAPS: Mapping[str, Callable[[], Drawn]] = {
    "arena": lambda: drawn(public(ARENA)),
    "denver": lambda: drawn(public(DENVER)),
    "iron-harvest": lambda: drawn(public(IRON_HARVEST)),
    "denver-10k": lambda: copies(public(DENVER), 4, 3),
    "iron-harvest-10k": lambda: copies(public(IRON_HARVEST), 3, 1),
    "scattered-10k": lambda: drawn(scattered(2900, 1)),
    "denver-20k": lambda: copies(public(DENVER), 6, 4),
    "iron-harvest-20k": lambda: copies(public(IRON_HARVEST), 3, 2),
    "denver-50k": lambda: copies(public(DENVER), 8, 7),
    "iron-harvest-50k": lambda: copies(public(IRON_HARVEST), 5, 3),
}


def random_queries(scene: Scene, count: int) -> list[Query]:
    """Queries between free places, drawn evenly."""
    rng = np.random.default_rng(1)
    xmin, ymin, xmax, ymax = scene.bounds
    solid = scene.arrangement.solid
    shapely.prepare(solid)
    places: list[NDArray[np.float64]] = []
    while len(places) < 2 * count:
        points = rng.uniform((xmin, ymin), (xmax, ymax), (count, 2))
        places += list(points[~shapely.intersects_xy(solid, points)])
    return [Query(f"{i}", places[2 * i], places[2 * i + 1]) for i in range(count)]


def cpu(work: Callable[[], object]) -> float:
    """CPU seconds of some work."""
    begun = time.process_time()
    work()
    return time.process_time() - begun


def measure(name: str, count: int) -> None:
    """Print a line on one map."""
    room, obstacles, ends = MAPS[name]()
    scenes: list[Scene] = []
    load = cpu(lambda: scenes.append(make_scene(name, room, obstacles, ends)))
    scene = scenes[0]
    ready = cpu(partial(prepare, scene))
    queries = random_queries(scene, count)
    shortest_path(scene, queries[0])
    times, none = [], 0
    for query in queries:
        # The best of three: a processor that others use is no property of the solver.
        times.append(min(cpu(partial(shortest_path, scene, query)) for _ in range(3)))
        none += shortest_path(scene, query).path is None
    ms = 1e3 * np.array(times)
    sys.stdout.write(
        f"{name:18} {scene.vertex_count:6} vertices  load {load:6.2f} s  prepare {ready:6.2f} s  "
        f"query median {np.median(ms):7.3f} ms  90 % {np.quantile(ms, 0.9):7.3f}  "
        f"worst {ms.max():7.3f}  without a path {none}/{count}\n"
    )
    sys.stdout.flush()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--queries", type=int, default=200)
    parser.add_argument("--only", nargs="+", choices=MAPS, default=list(MAPS))
    given = parser.parse_args()
    for one in given.only:
        measure(one, given.queries)
