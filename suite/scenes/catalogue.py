"""The catalogue: scenes found by name, in files that ship with the suite or drawn from a seed.

The files are reconstructions of the environments in Hu and Yang's paper, whose figures are not
available: each file says so, names its figure, and states the exact optimum of its query. The
others are scattered scenes, for studies with more obstacles than the paper's, and moving scenes,
for claims about any dynamic scene.

No corner lies on a crossing of any small lattice, so that no planner owes its results to where we
drew the walls. Scenes that were once drawn on whole metres stay as they were, as controls named
``*_aligned``. Any scene may be turned, shifted and scaled, as in ``zigzag@turn=17,shift=0.37`` or
``my.geojson@twin=3``: see :mod:`suite.scenes.modifiers`.
"""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from suite.errors import SceneError, did_you_mean
from suite.scenes.geojson import read_scene
from suite.scenes.maps.formats import FORMATS, read_map
from suite.scenes.maps.options import OPTIONS, MapOptions
from suite.scenes.modifiers import MARK, PATHS, parse_modifiers, split_modifiers
from suite.scenes.moving import moving, moving_name, parse_moving_name
from suite.scenes.scattered import parse_scattered_name, scattered, scattered_name
from suite.scenes.scene import Query, Scene, make_scene, scene_fingerprint
from suite.scenes.similarity import modified

_FOLDER = Path(__file__).parent / "files"
_PAPER_ORDER = (
    "unstructured",
    "maze",
    "zigzag",
    "double_u",
    "clustered",
    "obstacles_20",
    "obstacles_30",
    "obstacles_40",
)
_DYNAMIC = ("door", "unknown_obstacles")
_ALIGNED = (
    "maze_aligned",
    "zigzag_aligned",
    "double_u_aligned",
    "door_aligned",
    "unknown_obstacles_aligned",
)
_FILES = _PAPER_ORDER + _DYNAMIC + _ALIGNED
_SCATTERED = (100, 300, 1000, 3000)
"""Obstacles of the scattered scenes that are listed; other numbers and seeds need no list."""


def scene_names() -> list[str]:
    """Names of the scenes of the catalogue that ship as files.

    Returns
    -------
    list of str
        In the order in which the paper shows their environments.

    Examples
    --------
    >>> scene_names()[:3]
    ['unstructured', 'maze', 'zigzag']
    """
    return list(_PAPER_ORDER)


def dynamic_names() -> list[str]:
    """Names of the dynamic scenes of the catalogue, whose obstacles move, hide and vanish.

    Returns
    -------
    list of str
        In the order in which the paper shows their environments.

    Examples
    --------
    >>> dynamic_names()
    ['door', 'unknown_obstacles']
    """
    return list(_DYNAMIC)


def aligned_names() -> list[str]:
    """Names of the controls: scenes as they were first drawn, with corners on whole metres.

    The lattice of a planner may have nodes on all of their corners, by which it would look better
    than it is. They are for showing that, and for nothing else.

    Returns
    -------
    list of str
        In the order of the scenes that replaced them, whose names they hold.

    Examples
    --------
    >>> aligned_names()[0]
    'maze_aligned'
    """
    return list(_ALIGNED)


def generated_names() -> list[str]:
    """Names of the generated scenes that studies use, and of one whose obstacles move.

    There are more: ``scattered_N-S`` has N obstacles and the seed S, ``scattered_N`` the seed 0,
    see :func:`suite.scenes.scattered.scattered`; ``moving-S`` is dynamic and has the seed S, see
    :func:`suite.scenes.moving.moving`.

    Returns
    -------
    list of str
        By number of obstacles; the dynamic one last.

    Examples
    --------
    >>> generated_names()[0]
    'scattered_100'
    """
    return [*(scattered_name(obstacles, 0) for obstacles in _SCATTERED), moving_name(0)]


def has_scene(name: str) -> bool:
    """Whether the catalogue has a scene of that name, in a file or generated, modified or not.

    Examples
    --------
    >>> has_scene("maze@turn=3"), has_scene("scattered_50-7"), has_scene("maze.geojson")
    (True, True, False)
    """
    base, _ = split_modifiers(name)
    return base in _FILES or _is_generated(base)


def scene_file(name: str) -> Path:
    """Return the file of a scene of the catalogue.

    Parameters
    ----------
    name : str
        One of :func:`scene_names`, :func:`dynamic_names` or :func:`aligned_names`.

    Returns
    -------
    Path

    Raises
    ------
    SceneError
        If the catalogue has no file of that name.
    """
    if _is_generated(name):
        raise SceneError(
            f"{name}: is generated and has no file. Write one with `kbga-bench generate`."
        )
    if name not in _FILES:
        raise SceneError(_unknown(name))
    return _FOLDER / f"{name}.geojson"


def load_scene(name_or_path: str | Path, *, inflate: float = 0.0) -> Scene:
    """Load a scene of the catalogue, or one of your own.

    Parameters
    ----------
    name_or_path : str or Path
        One of :func:`scene_names`, :func:`dynamic_names`, :func:`aligned_names` or
        :func:`generated_names`, or a scene file; with or without modifiers behind an ``@``, see
        :mod:`suite.scenes.modifiers`. A string with a path separator or with the suffix of a scene
        file (``.geojson``, ``.json``) is a path. A Path has no modifiers.
    inflate : float
        Radius of the robot, metres; see :func:`suite.scenes.scene.make_scene`.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        If the catalogue has no scene of that name, or the scene can't be used.

    Examples
    --------
    >>> load_scene("maze").properties["figure"]
    '7'
    >>> load_scene("maze@turn=17").name
    'maze@turn=17'
    """
    if not isinstance(name_or_path, Path):
        base, text = split_modifiers(name_or_path)
        if text:
            modifiers = parse_modifiers(text, name_or_path)
            radius = inflate or modifiers.radius
            if modifiers.moves:
                return modified(_unmodified(base, modifiers.options), modifiers, inflate=radius)
            scene = _unmodified(base, modifiers.options, radius)
            return replace(scene, name=f"{scene.name}{MARK}{modifiers.text}")
    return _unmodified(name_or_path, MapOptions(), inflate)


def _unmodified(name_or_path: str | Path, options: MapOptions, inflate: float = 0.0) -> Scene:
    if _is_path(name_or_path):
        path = Path(name_or_path)
        if path.suffix.lower() in FORMATS:
            return read_map(path, options, inflate=inflate)
        _refuse(options, path.name)
        return read_scene(path, inflate=inflate)
    name = str(name_or_path)
    _refuse(options, name)
    if _is_generated(name):
        return _inflated(_generated(name), inflate)
    return read_scene(scene_file(name), inflate=inflate)


def _refuse(options: MapOptions, where: str) -> None:
    for option in OPTIONS:
        if getattr(options, option) is not None:
            raise SceneError(f"{where}: is no map, of which {option} could be said. Leave it out.")


def scene_as_it_was(
    source: str, query: str, fingerprint: str, load: Callable[[str], Scene] = load_scene
) -> tuple[Scene, Query]:
    """The scene and the query of a row, unless they have changed since it was made.

    Parameters
    ----------
    source : str
        What :func:`load_scene` takes.
    query : str
        Its name.
    fingerprint : str
        As :func:`suite.scenes.scene.scene_fingerprint` gave it then.
    load : callable
        That loads the scene.

    Raises
    ------
    SceneError
        If the scene can't be loaded, or has changed.
    """
    scene = load(source)
    asked = scene.query(query)
    if scene_fingerprint(scene, asked) != fingerprint:
        raise SceneError(
            f"{source}: the scene has changed since its rows were made, or wanted. Run them again "
            "into a new store, or put the scene back."
        )
    return scene, asked


def _is_path(name_or_path: str | Path) -> bool:
    if isinstance(name_or_path, Path):
        return True
    separators = (os.sep, os.altsep) if os.altsep else (os.sep,)
    has_separator = any(s in name_or_path for s in separators)
    return has_separator or Path(name_or_path).suffix.lower() in PATHS


def _is_generated(name: str) -> bool:
    return parse_scattered_name(name) is not None or parse_moving_name(name) is not None


def _generated(name: str) -> Scene:
    numbers = parse_scattered_name(name)
    return scattered(*numbers) if numbers is not None else moving(parse_moving_name(name) or 0)


def _inflated(scene: Scene, inflate: float) -> Scene:
    if inflate == 0.0:
        return scene
    return make_scene(
        scene.name,
        scene.workspace,
        scene.obstacles,
        {query.name: (query.start, query.goal) for query in scene.queries},
        properties=scene.properties,
        inflate=inflate,
    )


def _unknown(name: str) -> str:
    message = (
        f"no scene '{name}'. Catalogue: {', '.join(_PAPER_ORDER)}. Dynamic: {', '.join(_DYNAMIC)}. "
        f"Generated: {', '.join(generated_names())}, or scattered_N-S for N obstacles and seed S, "
        f"moving-S for seed S. Controls: {', '.join(_ALIGNED)}."
    )
    return message + did_you_mean(name, [*_FILES, *generated_names()])
