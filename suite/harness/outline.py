"""The matrices that ship with the suite: their names, their files, and how large each is.

Their size is read from the files alone. :func:`suite.harness.matrix.load_matrix` checks a matrix:
it draws all of its scenes and imports all of its planners, which takes seconds.
"""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from suite.errors import MatrixError
from suite.scenes.modifiers import expand_twins

FOLDER = Path(__file__).parent / "matrices"


def matrix_names() -> list[str]:
    """Names of the matrices that ship with the suite.

    Examples
    --------
    >>> "paper-static" in matrix_names()
    True
    """
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def matrix_file(name_or_path: str | Path) -> Path:
    """The file of a matrix of the catalogue, or a file of one's own.

    Raises
    ------
    MatrixError
        If there is none.
    """
    path = Path(name_or_path)
    if str(name_or_path) in matrix_names():
        return FOLDER / f"{name_or_path}.toml"
    if path.exists():
        return path
    raise MatrixError(
        f"no matrix '{name_or_path}'. Give a file, or one of: {', '.join(matrix_names())}."
    )


def outline(name: str) -> dict[str, Any]:
    """What a matrix of the catalogue is for, and its numbers of scenes, planners, seeds and runs.

    Each of its scenes has one query.

    Examples
    --------
    >>> outline("paper-static")["runs"]
    1440
    """
    matrix = tomllib.loads(matrix_file(name).read_text(encoding="utf-8"))
    tables = [entry if isinstance(entry, dict) else {"scene": entry} for entry in matrix["scenes"]]
    scenes = {
        twin: _count({**matrix, **table})
        for table in tables
        for twin in expand_twins(table["scene"])
    }
    rounds = sum(own * _worlds(matrix, scene) for scene, own in scenes.items())
    return {
        "description": matrix["description"],
        "scenes": len(scenes),
        "planners": len(matrix["planner"]),
        "seeds": _count(matrix),
        "runs": rounds * len(matrix["planner"]),
    }


def _count(table: Mapping[str, Any]) -> int:
    seeds: int | list[int] = table["seeds"]
    return seeds if isinstance(seeds, int) else len(seeds)


def _worlds(matrix: Mapping[str, Any], scene: str) -> int:
    """How often a scene is run with one seed: once, or once in each of its worlds."""
    worlds = matrix.get("world")
    return 1 if worlds is None else sum(scene in w.get("scenes", [scene]) for w in worlds)
