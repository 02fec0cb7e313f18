"""What runs need and processes keep: scenes, their optima and referees, planners, the stream.

What is made before any clock starts is told: each thing keeps the CPU seconds that it took, in the
process that made it, and forks of that process know them.
"""

import time
import warnings
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any, Generic, TypeVar

import numpy as np
import shapely

from suite.geometry.tolerances import OPTIMUM_RELATIVE
from suite.planner import Planner
from suite.plugins.discovery import load_planner
from suite.plugins.settings import make_settings
from suite.processes.output import show_warning
from suite.referee.path import Referee
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import prepare, shortest_path
from suite.scenes.scene import Scene, SceneWarning, make_scene
from suite.store.record import Cell

T = TypeVar("T")

MOST_OPTIMA = 2**17
"""Kept in a process: of all queries of a matrix of maps, for each run leaves from a process that
has computed them. Each takes a few hundred bytes."""


@dataclass(frozen=True, slots=True, eq=False)
class Prepared(Generic[T]):
    """What was made before any clock, and the CPU seconds that it took."""

    value: T
    cpu_s: float


def stream(cell: Cell) -> np.random.Generator:
    """The random stream of a cell: another one for each seed, scene, query and variant."""
    return named_stream(cell.scene, cell.query, cell.variant, cell.seed)


def named_stream(scene: str, query: str, variant: str, seed: int) -> np.random.Generator:
    """The random stream of a run of these names."""
    return np.random.default_rng([seed, zlib.crc32(f"{scene}/{query}/{variant}".encode())])


def prepared_scene(source: str) -> Scene:
    """A scene with its arrangement and its mesh; kept, so that a warmed process hands it on."""
    return _scene(source).value


def scene_cpu_s(source: str) -> float:
    """CPU seconds that loading, arranging and meshing a scene took, once for all runs of it."""
    return _scene(source).cpu_s


@lru_cache(maxsize=64)
def _scene(source: str) -> Prepared[Scene]:
    def load() -> Scene:
        scene = load_scene(source)
        prepare(scene)
        return scene

    return _timed(load)


def _timed(make: Callable[[], T]) -> Prepared[T]:
    """Make something, and say what it took; kernels are loaded, or compiled, before."""
    _have_kernels()
    start = time.process_time()
    value = make()
    return Prepared(value, time.process_time() - start)


@cache
def _have_kernels() -> None:
    """Load what scenes and optima are made by, once in a process: it is no scene's own."""
    wall = shapely.box(4, 0, 6, 7)
    scene = make_scene("one wall", shapely.box(0, 0, 10, 10), [wall], ((1, 3), (9, 3)))
    shortest_path(scene, scene.query())


@lru_cache(maxsize=64)
def referee(source: str) -> Referee:
    """The referee of a scene."""
    return Referee(prepared_scene(source))


def exact_optimum(source: str, query: str) -> float | None:
    """Length of the exact shortest path of a query, metres; None if there is none.

    Always computed: what a scene file states holds for the geometry that it once had. If it is
    another length, a :class:`SceneWarning` says so.
    """
    return _optimum(source, query).value


def optimum_cpu_s(source: str, query: str) -> float:
    """CPU seconds that the exact optimum of a query took, once for all runs of the query."""
    return _optimum(source, query).cpu_s


@lru_cache(maxsize=MOST_OPTIMA)
def _optimum(source: str, query: str) -> Prepared[float | None]:
    scene = prepared_scene(source)
    wanted = scene.query(query)
    if wanted.blocked is not None:
        return Prepared(None, 0.0)
    found = _timed(lambda: shortest_path(scene, wanted).length)
    length = found.value
    stated = scene.stored_optimum(wanted)
    if stated is not None and not abs(stated - length) <= OPTIMUM_RELATIVE * stated:
        warnings.warn(
            f"{source}, query '{query}': the file states an optimum of {stated:.9g} m; it is "
            f"{f'{length:.9g} m' if np.isfinite(length) else 'none, there is no path'}, which "
            "counts. Take properties.optimum out, or put it right.",
            SceneWarning,
            stacklevel=3,
        )
    return Prepared(length if np.isfinite(length) else None, found.cpu_s)


def make_ready(source: str, query: str) -> None:
    """Prepare a scene, the optimum of a query and the referee, in a process that others leave from.

    What loading warns of, the harness has said when it read the matrix; what is new is one line.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SceneWarning)
        prepared_scene(source)
    with warnings.catch_warnings():
        warnings.showwarning = show_warning
        exact_optimum(source, query)
    referee(source)


@lru_cache(maxsize=256)
def planner_class(name: str) -> type[Planner]:
    """The class of a plugin; kept, because finding it reads the metadata of every package."""
    return load_planner(name)


def build_planner(name: str, settings: Mapping[str, Any]) -> Planner:
    """A planner of that plugin name with those settings."""
    found = planner_class(name)
    return found(make_settings(found, settings))
