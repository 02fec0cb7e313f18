"""The code of a planner as a hash: rows of a planner that was changed are not rows of this one.

The version of an installed plugin often stays while its author works on it. Its own source counts,
and nothing that it depends on: that has versions of its own.
"""

import ast
import hashlib
from collections.abc import Iterable
from importlib.metadata import EntryPoint
from importlib.util import find_spec
from pathlib import Path

CODE = (".py", ".so", ".pyd")

OURS = ("suite", "kbga", "baselines")
"""Packages that have the version of kbga-bench, wherever they are imported from."""


def code_hash(files: Iterable[Path]) -> str:
    """Hash of the names and contents of files, the same wherever they lie.

    Parameters
    ----------
    files : iterable of Path

    Returns
    -------
    str
        "sha256-" and twelve digits.
    """
    parts = sorted((f.name, hashlib.sha256(f.read_bytes()).hexdigest()) for f in set(files))
    return f"sha256-{hashlib.sha256(repr(parts).encode()).hexdigest()[:12]}"


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
        for name in _imported_names(here):
            waiting |= _modules(file.parent, name) - found
    return found


def _imported_names(file: Path) -> set[str]:
    """First parts of the names of all modules that a source imports, wherever in it."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {node.module} if node.module else {alias.name for alias in node.names}
    return {name.split(".")[0] for name in names} - {*OURS}


def _modules(folder: Path, name: str) -> set[Path]:
    """The sources of a module or a package of a folder, if there is one of that name."""
    module, package = folder / f"{name}.py", folder / name
    return {module} if module.is_file() else {p for p in package.rglob("*.py") if p.is_file()}
