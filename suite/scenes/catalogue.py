"""The catalogue: the scene files that ship with the suite, found by name.

They are reconstructions of the environments in Hu and Yang's paper, whose figures are not
available: each file says so, names its figure, and states the exact optimum of its query.
"""

import os
from difflib import get_close_matches
from pathlib import Path

from suite.errors import SceneError
from suite.scene import Scene
from suite.scene_file import SUFFIXES, read_scene

_FOLDER = Path(__file__).parent
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


def scene_names() -> list[str]:
    """Names of the scenes of the catalogue.

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


def scene_file(name: str) -> Path:
    """Return the file of a scene of the catalogue.

    Parameters
    ----------
    name : str
        One of :func:`scene_names`.

    Returns
    -------
    Path

    Raises
    ------
    SceneError
        If the catalogue has no scene of that name.
    """
    if name not in _PAPER_ORDER:
        raise SceneError(_unknown(name))
    return _FOLDER / f"{name}.geojson"


def load_scene(name_or_path: str | Path, *, inflate: float = 0.0) -> Scene:
    """Load a scene of the catalogue, or one of your own.

    Parameters
    ----------
    name_or_path : str or Path
        One of :func:`scene_names`, or a scene file. A string with a path separator or with the
        suffix of a scene file (``.geojson``, ``.json``) is a path.
    inflate : float
        Radius of the robot, metres; see :func:`suite.scene.make_scene`.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        If the catalogue has no scene of that name, or the file can't be used.

    Examples
    --------
    >>> load_scene("maze").properties["figure"]
    '7'
    """
    path = Path(name_or_path) if _is_path(name_or_path) else scene_file(str(name_or_path))
    return read_scene(path, inflate=inflate)


def _is_path(name_or_path: str | Path) -> bool:
    if isinstance(name_or_path, Path):
        return True
    separators = (os.sep, os.altsep) if os.altsep else (os.sep,)
    has_separator = any(s in name_or_path for s in separators)
    return has_separator or Path(name_or_path).suffix.lower() in SUFFIXES


def _unknown(name: str) -> str:
    message = f"no scene '{name}'. Catalogue: {', '.join(_PAPER_ORDER)}."
    nearest = get_close_matches(name, _PAPER_ORDER, n=1)
    return message + (f" Did you mean '{nearest[0]}'?" if nearest else "")
