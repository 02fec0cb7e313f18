"""The data files that a planner names as part of its version: weights, tables, roadmaps.

They are read from the text of its code, ``version_files = ("weights.npy",)`` in the body of a
class, so that a version is known where nothing of the planner is imported.
"""

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from suite.errors import PluginError

ATTRIBUTE = "version_files"
HOW = f'Write them out in the class, as a tuple of names: {ATTRIBUTE} = ("weights.npy",).'


def version_files(code: Iterable[Path]) -> set[Path]:
    """The data files that code names; of a folder all that are in it.

    Parameters
    ----------
    code : iterable of Path
        Sources. The names stand for files beside the one in which they are written.

    Raises
    ------
    PluginError
        If there is no such file, or the names can't be read.
    """
    named = [(source, name) for source in code for name in names_in(source)]
    return {file for source, name in named for file in _there(source, name)}


def present_version_files(code: Iterable[Path]) -> set[Path]:
    """The same, without what is missing or can't be read: whoever loads the planner hears of it."""
    found: set[Path] = set()
    for source in code:
        try:
            found |= version_files([source])
        except PluginError:
            continue
    return found


def refuse_unread(planner: Any, code: Iterable[Path]) -> None:
    """Refuse a planner whose names of files are others than those that stand in its code.

    Raises
    ------
    PluginError
    """
    own = vars(planner).get(ATTRIBUTE, ())
    known = {name for source in code for name in names_in(source)}
    if isinstance(own, str) or not set(own) <= known:
        raise PluginError(f"{planner.__name__} has {ATTRIBUTE} {own!r} that can't be read. {HOW}")


def names_in(source: Path) -> Iterator[str]:
    """The names that stand in a source, of all its classes.

    Raises
    ------
    PluginError
        If something else stands there.
    """
    text = source.read_bytes() if source.suffix == ".py" else b""
    if ATTRIBUTE.encode() not in text:  # of most packages nothing need be parsed
        return
    try:
        tree = ast.parse(text)
    except SyntaxError:  # its import says so
        return
    for kind in (node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)):
        for node in kind.body:
            if _is_named(node):
                yield from _literal(source, node)


def _is_named(node: ast.stmt) -> bool:
    targets = node.targets if isinstance(node, ast.Assign) else []
    targets = [node.target] if isinstance(node, ast.AnnAssign) and node.value else targets
    return any(isinstance(target, ast.Name) and target.id == ATTRIBUTE for target in targets)


def _literal(source: Path, node: Any) -> tuple[str, ...]:
    try:
        names = ast.literal_eval(node.value)
    except ValueError:
        names = None
    is_tuple = isinstance(names, tuple | list) and all(isinstance(n, str) and n for n in names)
    if not is_tuple:
        raise PluginError(f"{source.name}, line {node.lineno}: {ATTRIBUTE} can't be read. {HOW}")
    return tuple(names)


def _there(source: Path, name: str) -> set[Path]:
    file = source.parent / name
    if not file.resolve().is_relative_to(source.parent.resolve()):
        raise PluginError(
            f"{source.name} names '{name}' in {ATTRIBUTE}, which lies outside of its folder. Only "
            "what lies beside the code goes where it goes."
        )
    if file.is_dir():
        return {inner for inner in file.rglob("*") if inner.is_file()}
    if not file.is_file():
        raise PluginError(
            f"{source.name} names '{name}' in {ATTRIBUTE}, and there is no file {file}. Put it "
            "there (an installed planner ships it as package data), or leave the name out."
        )
    return {file}
