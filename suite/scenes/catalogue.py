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
from pathlib import Path

from suite.errors import SceneError, did_you_mean
from suite.scenes.families.instance import FAMILIES, instance, parse_family_name
from suite.scenes.frozen import frozen
from suite.scenes.geojson import read_scene, stated_radius
from suite.scenes.kept import SUFFIX, read_kept
from suite.scenes.maps.features import knows_no_roles
from suite.scenes.maps.formats import FORMATS, WITHOUT_ROLES, read_map, understood
from suite.scenes.maps.options import OPTIONS, MapOptions
from suite.scenes.modifiers import (
    MARK,
    PATHS,
    SUFFIXES,
    Modifiers,
    parse_modifiers,
    split_modifiers,
)
from suite.scenes.moving import moving, moving_name, parse_moving_name
from suite.scenes.scattered import parse_scattered_name, scattered, scattered_name
from suite.scenes.scene import (
    Query,
    Scene,
    make_scene,
    renamed,
    scene_fingerprint,
    with_snapped_ends,
)
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
    :func:`suite.scenes.moving.moving`; ``maze-S`` and the other families of
    :mod:`suite.scenes.families.instance`.

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


def main_file(source: str) -> Path | None:
    """The file that a scene is named by; None if it is drawn from a seed, or nothing is known.

    Parameters
    ----------
    source : str
        As :func:`load_scene` takes it.

    Examples
    --------
    >>> main_file("maze@turn=3").name, main_file("scattered_50-7")
    ('maze.geojson', None)
    >>> main_file("maps/berlin.map@radius=0.2").as_posix()
    'maps/berlin.map'
    """
    base, modifiers = split_modifiers(source)
    if modifiers:  # there may be more before them
        return main_file(base)
    if _is_path(base):
        return Path(base)
    return scene_file(base) if base in _FILES else None


def load_scene(name_or_path: str | Path, *, inflate: float | None = None) -> Scene:
    """Load a scene of the catalogue, or one of your own.

    Parameters
    ----------
    name_or_path : str or Path
        One of :func:`scene_names`, :func:`dynamic_names`, :func:`aligned_names` or
        :func:`generated_names`, or a scene file; with or without modifiers behind an ``@``, see
        :mod:`suite.scenes.modifiers`. A string with a path separator or with the suffix of a scene
        file (``.geojson``, ``.json``) is a path. A Path has no modifiers.
    inflate : float, optional
        Radius of the robot, metres; see :func:`suite.scenes.scene.make_scene`. Default: that of
        the modifier, or the one that the file states, or none.

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
            return _modified(base, parse_modifiers(text, name_or_path), inflate)
    return _unmodified(name_or_path, MapOptions(), inflate)


def _modified(base: str, modifiers: Modifiers, inflate: float | None) -> Scene:
    """A scene read, stopped, moved, grown and its ends put right, in this order."""
    said = modifiers.radius if inflate is None else inflate
    radius = _stated_radius(base) if said is None else said
    # Of an end, at a time or moved, is said in the end whether it is free.
    keep = modifiers.snap or modifiers.at is not None
    grown_last = modifiers.moves or modifiers.at is not None
    scene = _unmodified(base, modifiers.options, 0.0 if grown_last else radius, keep)
    name = f"{scene.name}{MARK}{modifiers.text}"
    if modifiers.at is not None:
        scene = frozen(scene, modifiers.at, inflate=0.0 if modifiers.moves else radius)
    if modifiers.moves:
        scene = modified(scene, modifiers, inflate=radius)
    return with_snapped_ends(scene, name) if modifiers.snap else renamed(scene, name)


def _stated_radius(name_or_path: str) -> float:
    if split_modifiers(name_or_path)[1]:
        return 0.0  # by which it has grown already
    suffix = Path(name_or_path).suffix.lower()
    is_scene_file = suffix not in (SUFFIX, *FORMATS) and _is_path(name_or_path)
    return stated_radius(Path(name_or_path)) if is_scene_file else 0.0


def _unmodified(
    name_or_path: str | Path,
    options: MapOptions,
    inflate: float | None,
    keep_blocked: bool = False,
) -> Scene:
    """A scene as it is drawn. inflate : metres; None, as its file says; 0, not at all."""
    if isinstance(name_or_path, str) and split_modifiers(name_or_path)[1]:
        _refuse(options, name_or_path)
        return _inflated(load_scene(name_or_path), inflate or 0.0)
    if _is_path(name_or_path):
        path = Path(name_or_path)
        if path.suffix == SUFFIX:
            _refuse(options, path.name)
            return _inflated(read_kept(path), inflate or 0.0)
        if path.suffix.lower() in FORMATS:
            return read_map(path, options, inflate=inflate or 0.0)
        if knows_no_roles(path):
            return read_map(path, options, inflate=inflate or 0.0, form=WITHOUT_ROLES)
        if path.suffix and path.suffix.lower() not in SUFFIXES and not _looks_like_json(path):
            raise SceneError(f"{path}: {_no_format(path)}")
        _refuse(options, path.name)
        return read_scene(path, inflate=inflate, keep_blocked=keep_blocked)
    name = str(name_or_path)
    _refuse(options, name)
    if _is_generated(name):
        return _inflated(_generated(name), inflate or 0.0)
    return read_scene(scene_file(name), inflate=inflate)


def _looks_like_json(path: Path) -> bool:
    """Whether a file of any suffix is to be read as a scene file: one that is missing is, too."""
    try:
        with path.open("rb") as file:
            return file.read(1000).removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{")
    except OSError:
        return True


def _no_format(path: Path) -> str:
    return f"no format of maps has the suffix '{path.suffix[:20]}'. {understood()}"


def _refuse(options: MapOptions, where: str) -> None:
    for option in OPTIONS:
        if getattr(options, option) is not None:
            raise SceneError(f"{where}: is no map, of which {option} could be said. Leave it out.")


def scene_as_it_was(
    source: str, query: str, fingerprint: str, load: Callable[[str], Scene] = load_scene
) -> tuple[Scene, Query]:
    """The scene and the query of a run, unless they have changed since it was wanted.

    A store keeps the scenes of its rows, and reads them by :mod:`suite.store.scenes`.

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
            f"{source}: the scene has changed since its rows were made, or wanted. Give `run` "
            "again: it runs them on the scene as it is now. Or put the scene back."
        )
    return scene, asked


def _is_path(name_or_path: str | Path) -> bool:
    if isinstance(name_or_path, Path):
        return True
    separators = (os.sep, os.altsep) if os.altsep else (os.sep,)
    has_separator = any(s in name_or_path for s in separators)
    return has_separator or Path(name_or_path).suffix.lower() in PATHS


def _is_generated(name: str) -> bool:
    parsers = (parse_scattered_name, parse_moving_name, parse_family_name)
    return any(parse(name) is not None for parse in parsers)


def _generated(name: str) -> Scene:
    member = parse_family_name(name)
    if member is not None:
        return instance(*member)
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
        path=scene.path,
        inflate=inflate,
        strata={q.name: q.stratum for q in scene.queries if q.stratum is not None},
        grown_by=scene.radius,
    )


def _unknown(name: str) -> str:
    if Path(name).suffix:
        return f"no scene '{name}', and {_no_format(Path(name))}"
    message = (
        f"no scene '{name}'. Catalogue: {', '.join(_PAPER_ORDER)}. Dynamic: {', '.join(_DYNAMIC)}. "
        f"Generated: {', '.join(generated_names())}, or scattered_N-S for N obstacles and seed S, "
        f"moving-S for seed S, or a family's name and -S: {', '.join(FAMILIES)}. "
        f"Controls: {', '.join(_ALIGNED)}."
    )
    return message + did_you_mean(name, [*_FILES, *generated_names()])
