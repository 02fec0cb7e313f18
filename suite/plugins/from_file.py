"""A planner without packaging: a class in a file, or in a module, that a user names on the spot.

What is named in one process must be found in those that it starts, the fork server and its
children. It is handed on by an environment variable, which they inherit. The version of such a
planner is a hash of its code (:mod:`suite.plugins.code_hash`), so that changed code runs anew. Code
that changes while a matrix runs is refused from then on.
"""

import importlib
import json
import os
import sys
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from suite.errors import PluginError
from suite.planner import Planner
from suite.plugins.code_hash import code_hash, files_beside, files_of_package
from suite.plugins.own_modules import VARIABLE, import_file, in_words
from suite.plugins.validation import flaw
from suite.plugins.version_files import refuse_unread, version_files

HOW = "Give path/to/file.py, path/to/file.py:Class, or module:Class."


@dataclass(frozen=True, slots=True)
class NamedPlugin:
    """A planner that is found by the place of its code.

    name : what the class calls itself.
    reference : "file.py:Class" with the whole path, or "module:Class".
    folder : where a module is looked for, after all other places.
    code : the hash of its code.
    version : "sha256-" and the first digits, of code and data.
    """

    name: str
    reference: str
    folder: str
    code: str
    version: str

    @property
    def distribution(self) -> str:
        """Where it comes from, for lists and rows."""
        place = self.reference.rpartition(":")[0]
        return Path(place).name if place.endswith(".py") else place

    def load(self) -> Any:
        """Import the class.

        Raises
        ------
        PluginError
            If the code is not what it was when the plugin was named.
        """
        place, _, kind = self.reference.rpartition(":")
        code = _code(place, self.folder)
        if (code_hash(code), _version(code)) != (self.code, self.version):
            raise PluginError(f"{place} changed since the command began. Give it again.")
        return getattr(_imported(place, self.code), kind)


def name_plugins(references: Iterable[str]) -> list[NamedPlugin]:
    """Make planners known, here and in all processes started from now on, and forget earlier ones.

    Parameters
    ----------
    references : iterable of str
        ``path/to/file.py``, for all planners that are defined in it; ``path/to/file.py:Class``;
        ``module:Class``, where the current folder counts.

    Returns
    -------
    list of NamedPlugin

    Raises
    ------
    PluginError
        If there is no planner. Nothing has changed then.
    """
    plugins = []
    for reference in references:
        try:
            plugins += _resolved(reference, Path.cwd())
        except PluginError as error:
            raise PluginError(f"--plugin {error}") from error.__cause__
    hand_on(plugins)
    return plugins


def add_plugins(references: Iterable[str], folder: Path) -> list[NamedPlugin]:
    """Make planners known as :func:`name_plugins` does, beside those that are known so already.

    Parameters
    ----------
    references : iterable of str
        As there. One that is known already is known as its code is now.
    folder : Path
        The whole path of the one that files are relative to, and where modules are looked for.

    Returns
    -------
    list of NamedPlugin

    Raises
    ------
    PluginError
        If there is no planner. Nothing has changed then.
    """
    plugins = [plugin for reference in references for plugin in _resolved(reference, folder)]
    places = {_place(plugin) for plugin in plugins}
    hand_on([known for known in named_plugins() if _place(known) not in places] + plugins)
    return plugins


def _place(plugin: NamedPlugin) -> tuple[str, str]:
    """Where a planner's code is, by whatever way it was named: its file, or module, and its class.

    A module is looked for in many places, so its name is enough.
    """
    place, _, kind = plugin.reference.rpartition(":")
    return str(Path(place).resolve()) if place.endswith(".py") else place, kind


def hand_on(plugins: Sequence[NamedPlugin]) -> None:
    """Make planners known that were found, in place of earlier ones. Imports none of them."""
    if plugins:
        os.environ[VARIABLE] = json.dumps([asdict(plugin) for plugin in plugins])
    else:
        os.environ.pop(VARIABLE, None)


def named_plugins() -> list[NamedPlugin]:
    """The planners that were made known so. Imports none of them."""
    return [NamedPlugin(**fields) for fields in json.loads(os.environ.get(VARIABLE, "[]"))]


def _resolved(reference: str, base: Path) -> list[NamedPlugin]:
    place, kind = _parsed(reference, base)
    folder = str(base)
    try:
        code = _code(place, folder)
        hashed, version = code_hash(code), _version(code)
        module = _imported(place, hashed)
    except PluginError as error:
        raise PluginError(f"{reference}: {error}") from error
    except (Exception, SystemExit) as error:  # other people's code: its import may raise anything
        raise PluginError(f"{reference}: {in_words(error)}") from error
    classes = _planners_of(module) if kind is None else [kind]
    if not classes:
        raise PluginError(f"{reference}: no subclass of suite.planner.Planner in it.")
    names = [_checked_name(reference, module, each, code) for each in classes]
    return [
        NamedPlugin(name, f"{place}:{each}", folder, hashed, version)
        for name, each in zip(names, classes, strict=True)
    ]


def _parsed(reference: str, base: Path) -> tuple[str, str | None]:
    """Whole path of the file, or the module, and the class, if one is named."""
    if reference.endswith(".py"):
        place, kind = reference, None
    else:
        place, colon, kind = reference.rpartition(":")
        if not (colon and place and kind.isidentifier()):
            raise PluginError(f"{reference}: neither a .py file nor a class. {HOW}")
    if not place.endswith(".py"):
        return place, kind
    path = base / os.path.expanduser(place)  # noqa: PTH111 (that raises where nobody is called so)
    if not os.path.isfile(path):  # noqa: PTH113 (that raises where the name is too long)
        raise PluginError(f"{reference}: there is no file {path}. {HOW}")
    return str(path), kind


def _imported(place: str, hashed: str) -> ModuleType:
    """Import a module, or a file whose code has that hash; each once."""
    if place.endswith(".py"):
        return import_file(Path(place), hashed)
    module = importlib.import_module(place)
    if module.__file__ is None:
        raise PluginError(f"{place} is a folder without code. {HOW}")
    return module


def _version(code: Iterable[Path]) -> str:
    """Hash of code and of the data files that it names."""
    return code_hash({*code, *version_files(code)})


def _code(place: str, folder: str) -> set[Path]:
    """The code of a file with what it imports from beside it, of a module so, or of its package."""
    if place.endswith(".py"):
        return files_beside(Path(place))
    if folder not in sys.path:
        sys.path.append(folder)
    return _files_of_module(place)


def _files_of_module(module: str) -> set[Path]:
    files = files_of_package(module)
    is_package = "." in module or any(file.name == "__init__.py" for file in files)
    if is_package:
        return files
    return {other for file in files if file.is_file() for other in files_beside(file)}


def _planners_of(module: ModuleType) -> list[str]:
    """The classes of planners that the module itself defines and names; a base has no name."""
    return [
        name
        for name, kind in vars(module).items()
        if isinstance(kind, type)
        and issubclass(kind, Planner)
        and kind.__module__ == module.__name__
        and "name" in vars(kind)
    ]


def _checked_name(reference: str, module: ModuleType, kind: str, code: Iterable[Path]) -> str:
    found = getattr(module, kind, None)
    if found is None:
        raise PluginError(f"{reference}: there is no class {kind} in {module.__file__}.")
    wrong = flaw(found)
    if wrong is not None:
        raise PluginError(f"{reference}: {kind} {wrong}")
    try:
        refuse_unread(found, code)
    except PluginError as error:
        raise PluginError(f"{reference}: {error}") from error
    name = getattr(found, "name", None)
    if not isinstance(name, str):
        raise PluginError(f"{reference}: {kind} has no `name`. Give it one, a string.")
    return name
