"""What runs need and processes keep: scenes, their optima and referees, planners, the stream."""

import warnings
import zlib
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from suite.geometry.tolerances import OPTIMUM_RELATIVE
from suite.planner import Planner
from suite.plugins.discovery import load_planner
from suite.plugins.settings import make_settings
from suite.processes.output import show_warning
from suite.referee.path import Referee
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Scene, SceneWarning
from suite.store.record import Cell

MOST_OPTIMA = 2**17
"""Kept in a process: of all queries of a matrix of maps, for each run leaves from a process that
has computed them. Each takes a few hundred bytes."""


def stream(cell: Cell) -> np.random.Generator:
    """The random stream of a cell: another one for each seed, scene, query and variant."""
    return named_stream(cell.scene, cell.query, cell.variant, cell.seed)


def named_stream(scene: str, query: str, variant: str, seed: int) -> np.random.Generator:
    """The random stream of a run of these names."""
    return np.random.default_rng([seed, zlib.crc32(f"{scene}/{query}/{variant}".encode())])


@lru_cache(maxsize=64)
def prepared_scene(source: str) -> Scene:
    """A scene with its arrangement computed; kept, so that a warmed process hands it on."""
    scene = load_scene(source)
    # Touching the cached property builds it.
    _ = scene.arrangement
    return scene


@lru_cache(maxsize=64)
def referee(source: str) -> Referee:
    """The referee of a scene."""
    return Referee(prepared_scene(source))


@lru_cache(maxsize=MOST_OPTIMA)
def exact_optimum(source: str, query: str) -> float | None:
    """Length of the exact shortest path of a query, metres; None if there is none.

    Always computed: what a scene file states holds for the geometry that it once had. If it is
    another length, a :class:`SceneWarning` says so.
    """
    scene = prepared_scene(source)
    wanted = scene.query(query)
    if wanted.blocked is not None:
        return None
    length = shortest_path(scene, wanted).length
    stated = scene.stored_optimum(wanted)
    if stated is not None and not abs(stated - length) <= OPTIMUM_RELATIVE * stated:
        warnings.warn(
            f"{source}, query '{query}': the file states an optimum of {stated:.9g} m; it is "
            f"{f'{length:.9g} m' if np.isfinite(length) else 'none, there is no path'}, which "
            "counts. Take properties.optimum out, or put it right.",
            SceneWarning,
            stacklevel=2,
        )
    return length if np.isfinite(length) else None


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
