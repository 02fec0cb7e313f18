"""A planner without packaging: a class in a file, or in a module, that a user names on the spot.

What is named in one process must be found in those that it starts, the fork server and its
children. It is handed on by an environment variable, which they inherit. The version of such a
planner is a hash of its code (:mod:`suite.plugins.code_hash`), so that changed code runs anew. Code
that changes while a matrix runs is refused from then on.
"""

import hashlib
import importlib
import importlib.util
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
from suite.plugins.validation import flaw

VARIABLE = "KBGA_BENCH_PLUGINS"
HOW = "Give path/to/file.py, path/to/file.py:Class, or module:Class."


@dataclass(frozen=True, slots=True)
class NamedPlugin:
    """A planner that is found by the place of its code.

    name : what the class calls itself.
    reference : "file.py:Class" with the whole path, or "module:Class".
    folder : where the modules beside it are looked for, after all other places.
    version : of the code, "sha256-" and the first digits.
    """

    name: str
    reference: str
    folder: str
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
        module = _imported(place, self.folder)
        if _version(module) != self.version:
            raise PluginError(f"{place} changed since the command began. Give it again.")
        return getattr(module, kind)


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
    plugins = [plugin for reference in references for plugin in _resolved(reference)]
    hand_on(plugins)
    return plugins


def hand_on(plugins: Sequence[NamedPlugin]) -> None:
    """Make planners known that were found, in place of earlier ones. Imports none of them."""
    if plugins:
        os.environ[VARIABLE] = json.dumps([asdict(plugin) for plugin in plugins])
    else:
        os.environ.pop(VARIABLE, None)


def named_plugins() -> list[NamedPlugin]:
    """The planners that were made known so. Imports none of them."""
    return [NamedPlugin(**fields) for fields in json.loads(os.environ.get(VARIABLE, "[]"))]


def _resolved(reference: str) -> list[NamedPlugin]:
    place, kind = _parsed(reference)
    folder = Path(place).parent if place.endswith(".py") else Path.cwd()
    try:
        module = _imported(place, str(folder))
        version = _version(module)
    except (Exception, SystemExit) as error:  # other people's code: its import may raise anything
        raise PluginError(f"--plugin {reference}: {type(error).__name__}: {error}") from error
    classes = _planners_of(module) if kind is None else [kind]
    if not classes:
        raise PluginError(f"--plugin {reference}: no subclass of suite.planner.Planner in it.")
    return [
        NamedPlugin(_checked_name(reference, module, each), f"{place}:{each}", str(folder), version)
        for each in classes
    ]


def _parsed(reference: str) -> tuple[str, str | None]:
    """Whole path of the file, or the module, and the class, if one is named."""
    if reference.endswith(".py"):
        place, kind = reference, None
    else:
        place, colon, kind = reference.rpartition(":")
        if not (colon and place and kind.isidentifier()):
            raise PluginError(f"--plugin {reference}: neither a .py file nor a class. {HOW}")
    if not place.endswith(".py"):
        return place, kind
    path = Path(place).expanduser().absolute()
    if not path.is_file():
        raise PluginError(f"--plugin {reference}: there is no file {path}. {HOW}")
    return str(path), kind


def _imported(place: str, folder: str) -> ModuleType:
    """Import a module or a file; a file as it is now is imported once."""
    if folder not in sys.path:
        sys.path.append(folder)
    if not place.endswith(".py"):
        return importlib.import_module(place)
    # Not its bare name: the file of a user may be called like anybody's module.
    content = place.encode() + Path(place).read_bytes()
    name = f"{Path(place).stem}_{hashlib.sha256(content).hexdigest()[:8]}"
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, place)
    if spec is None or spec.loader is None:
        raise PluginError(f"{place} is no Python file.")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses and pickles look it up there
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def _version(module: ModuleType) -> str:
    """Hash of a module with what it imports from beside it, or of the package that it is in."""
    if module.__file__ is None:
        raise PluginError(f"{module.__name__} is a folder without code. {HOW}")
    if module.__package__:
        return code_hash(files_of_package(module.__package__))
    return code_hash(files_beside(Path(module.__file__)))


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


def _checked_name(reference: str, module: ModuleType, kind: str) -> str:
    found = getattr(module, kind, None)
    if found is None:
        raise PluginError(f"--plugin {reference}: there is no class {kind} in {module.__file__}.")
    wrong = flaw(found)
    if wrong is not None:
        raise PluginError(f"--plugin {reference}: {kind} {wrong}")
    name = getattr(found, "name", None)
    if not isinstance(name, str):
        raise PluginError(f"--plugin {reference}: {kind} has no `name`. Give it one, a string.")
    return name
