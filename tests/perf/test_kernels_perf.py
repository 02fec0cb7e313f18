"""How long the kernels take, compiled: `make perf`. Skipped in the ordinary test run."""

import math

import numpy as np
import pytest
import shapely
from numba import njit

from suite.geometry.arrangement import arrange
from suite.geometry.kernels import segment_enters, segment_enters_tables
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from tests.perf.series import SCENES

SEGMENTS = 1000


@njit
def _count_free(segments: np.ndarray, arrays) -> int:
    free = 0
    for i in range(segments.shape[0]):
        if not segment_enters(
            segments[i, 0], segments[i, 1], segments[i, 2], segments[i, 3], arrays
        ):
            free += 1
    return free


def _segments() -> np.ndarray:
    """Segments between lattice points, up to 20 m apart along each axis."""
    rng = np.random.default_rng(0)
    start = rng.integers(0, 101, (SEGMENTS, 2))
    goal = np.clip(start + rng.integers(-20, 21, (SEGMENTS, 2)), 0, 100)
    return np.hstack([start, goal]).astype(np.float64)


@pytest.mark.parametrize("name", SCENES)
def test_thousand_collision_checks_in_compiled_code(benchmark, name):
    benchmark.group = "1000 collision checks, compiled"
    benchmark(_count_free, _segments(), load_scene(name).arrays)


@pytest.mark.parametrize("obstacles", [20, 300, 3000])
def test_thousand_collision_checks_among_many_obstacles(benchmark, obstacles):
    """Segments about as long as the obstacles are apart, among irregular hexagons on a grid."""
    benchmark.group = "1000 collision checks among 20, 300, 3000 obstacles, compiled"
    rng = np.random.default_rng(0)
    side = math.ceil(math.sqrt(obstacles))
    cell = 100.0 / side
    polygons = []
    for i in range(obstacles):
        centre = (np.array([i % side, i // side]) + 0.5) * cell
        angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, 6))
        polygons.append(
            shapely.Polygon(centre + 0.35 * cell * np.c_[np.cos(angles), np.sin(angles)])
        )
    arrays = arrange(shapely.box(0, 0, 100, 100), polygons).arrays
    start = rng.uniform(0.0, 100.0, (SEGMENTS, 2))
    goal = np.clip(start + rng.uniform(-1.5 * cell, 1.5 * cell, (SEGMENTS, 2)), 0.0, 100.0)
    benchmark(_count_free, np.hstack([start, goal]), arrays)
    benchmark.extra_info.update(measure="1000 checks", obstacles=obstacles)


def test_one_collision_check_from_python(benchmark):
    benchmark.group = "one collision check, from Python"
    arrays = load_scene("zigzag").arrays
    tables = (arrays.tree, arrays.vertices, arrays.pinches, arrays.ways)
    benchmark(segment_enters_tables, 1.0, 2.0, 30.0, 40.0, *tables)


@pytest.mark.parametrize("name", SCENES)
def test_exact_shortest_path(benchmark, name):
    benchmark.group = "exact shortest path"
    scene = load_scene(name)
    benchmark(shortest_path, scene, scene.query())
    benchmark.extra_info.update(measure="exact solver", scene=name)
