"""The code of a planner as a hash: rows of a planner that was changed are not rows of this one.

The version of an installed plugin often stays while its author works on it. Its own source counts,
and nothing that it depends on: that has versions of its own.
"""

import ast
import hashlib
import os
from collections.abc import Iterable, Iterator
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.metadata import EntryPoint
from importlib.util import find_spec
from pathlib import Path

CODE = (".py", ".so", ".pyd")

OURS = ("suite", "kbga", "baselines")
"""Packages that have the version of kbga-bench, wherever they are imported from."""

BY_NAME = ("import_module", "__import__")
"""Functions that import the module that they are given the name of."""


def code_hash(files: Iterable[Path]) -> str:
    """Hash of the names and contents of files, the same wherever they lie together.

    Parameters
    ----------
    files : iterable of Path
        The name of each begins at the folder that all of them are in.

    Returns
    -------
    str
        "sha256-" and twelve digits.
    """
    own = {file.absolute() for file in files}
    root = os.path.commonpath([file.parent for file in own]) if own else ""
    parts = sorted((Path(os.path.relpath(f, root)).as_posix(), _digest(f)) for f in own)
    return f"sha256-{hashlib.sha256(repr(parts).encode()).hexdigest()[:12]}"


def _digest(file: Path) -> str:
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


def module_of(point: EntryPoint) -> str:
    """The module that an entry point names, whether it is well written or not.

    Examples
    --------
    >>> module_of(EntryPoint("walk", "walkers.far:Walk", "kbga_bench.planners"))
    'walkers.far'
    """
    return point.value.partition(":")[0].strip()


def files_of_entry_point(point: EntryPoint) -> set[Path]:
    """The code of the distribution and of the package that an entry point leads to.

    The first is all there is of an ordinary installation, the second of an editable one. Imports
    nothing. An entry point that leads to nothing has no code.
    """
    files = {
        Path(str(file.locate()))
        for file in (point.dist.files if point.dist is not None else None) or ()
        if file.suffix in CODE
    }
    return {file for file in files | files_of_package(module_of(point)) if file.is_file()}


def files_of_package(module: str) -> set[Path]:
    """The code of the package that a module is in, or of a module in none. Imports nothing."""
    try:
        # Of the first part alone: to find what is inside a package, it would be imported.
        spec = find_spec(module.split(".")[0])
    except (ImportError, ValueError):
        return set()
    if spec is None:
        return set()
    folders = spec.submodule_search_locations
    if folders is not None:
        return {f for place in folders for f in Path(place).rglob("*") if f.suffix in CODE}
    return {Path(spec.origin)} if spec.origin is not None else set()


def files_beside(file: Path) -> set[Path]:
    """A file, and all that it imports from its own folder, directly or not.

    Parameters
    ----------
    file : Path
        Python source. What it imports is read from its text: nothing is run.

    Raises
    ------
    SyntaxError
        If one of them is no Python.
    """
    found: set[Path] = set()
    waiting = {file}
    while waiting:
        here = waiting.pop()
        found.add(here)
        for folder, name in _imported(here, file.parent):
            waiting |= module_beside(folder, name) - found
    return found


def module_beside(folder: Path, name: str) -> set[Path]:
    """The code of a module or a package that lies in a folder; empty if it is to be had elsewhere.

    What lies beside a file comes first, as in a script of Python's, but for our own packages. A
    folder without ``__init__.py`` may hold anything, so it comes last.

    Parameters
    ----------
    folder : Path
    name : str
        Of a module at the top, without dots.
    """
    if not name or name in OURS:
        return set()
    package = folder / name
    if (package / "__init__.py").is_file():
        return _code_in(package)
    files = [folder / f"{name}{suffix}" for suffix in (*EXTENSION_SUFFIXES, ".py")]
    for file in files:  # in the order in which Python looks for them
        if file.is_file():
            return {file}
    return set() if _is_elsewhere(name) else _code_in(package)


def _code_in(package: Path) -> set[Path]:
    return {file for file in package.rglob("*") if file.suffix in CODE and file.is_file()}


def _is_elsewhere(name: str) -> bool:
    """Whether Python finds a module of that name, with code, on its own path."""
    try:
        spec = find_spec(name)
        return spec is not None and spec.origin is not None
    except (ImportError, ValueError):
        return False


def _imported(file: Path, top: Path) -> Iterator[tuple[Path, str]]:
    """(folder, first part of the name) of all modules that a source imports, wherever in it.

    Parameters
    ----------
    file : Path
    top : Path
        The folder in which names without dots before them are looked for.
    """
    if file.suffix != ".py":
        return
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Import):
            names, folder = [alias.name for alias in node.names], top
        elif isinstance(node, ast.ImportFrom):
            names = [node.module] if node.module else [alias.name for alias in node.names]
            folder = [file, *file.parents][node.level] if node.level else top
        elif isinstance(node, ast.Call) and _called(node) in BY_NAME:
            names, folder = _first_text(node), top
        else:
            continue
        for name in names:
            yield folder, name.split(".")[0]


def _called(node: ast.Call) -> str:
    """The last part of the name of what is called."""
    called = node.func
    return called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")


def _first_text(node: ast.Call) -> list[str]:
    """The first argument, if it is a text that stands there, with dots before it or not."""
    match node.args:
        case [ast.Constant(value=str(text)), *_]:
            return [text.lstrip(".")]
    return []
