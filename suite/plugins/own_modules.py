"""Planners from files, each with modules of its own: what one imports is nobody else's.

A file ``lucky.py`` is the package ``suite.plugins.own_modules.lucky_1a2b3c4d``, and the modules
that lie beside it are inside that package. Where the file, or one of them, says ``import utils``,
it gets the ``utils`` beside it, whatever else has that name: another planner's, an installed
package. The whole names are those that pickles have. Any process can import them that inherits the
environment, by an ordinary import, so that pools and their workers find what they are sent.
"""

import builtins
import hashlib
import importlib
import importlib.util
import json
import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

from suite.plugins.code_hash import code_hash, files_beside, module_beside

VARIABLE = "KBGA_BENCH_PLUGINS"
"""What tells other processes of the planners that were named: JSON, a list of NamedPlugin."""

__path__: list[str] = []  # what makes this module a package: others can be imported from it

_files: dict[str, Path] = {}
"""The files that were imported here, by the names of their packages."""


def import_file(file: Path, version: str) -> ModuleType:
    """Import a planner's file as it is now; once for each version of its code.

    Parameters
    ----------
    file : Path
        The whole path.
    version : str
        The hash of its code.
    """
    name = _package_of(file, version)
    _files[name] = file
    importlib.invalidate_caches()  # files may be younger than what Python knows of their folder
    return importlib.import_module(name)


def package_of(module: str) -> str:
    """What belongs together: the package of a planner's file, or else the first part of a name.

    Examples
    --------
    >>> package_of("numpy.linalg"), package_of("suite.plugins.own_modules.lucky_1a.utils")
    ('numpy', 'suite.plugins.own_modules.lucky_1a')
    """
    return _split(module)[0] if module.startswith(f"{__name__}.") else module.partition(".")[0]


def in_words(error: BaseException) -> str:
    """What an import raised, with the names of modules as their author writes them."""
    return re.sub(rf"{re.escape(__name__)}\.\w+\.", "", f"{type(error).__name__}: {error}")


def _package_of(file: Path, version: str) -> str:
    """The package that a file in a version is."""
    digest = hashlib.sha256(f"{file} {version}".encode()).hexdigest()[:8]
    return f"{__name__}.{re.sub(r'[^0-9A-Za-z_]', '_', file.stem)}_{digest}"


def _file_of(package: str) -> Path | None:
    """The file of a package; one that was not imported here is looked for in the environment."""
    if package not in _files:
        for plugin in json.loads(os.environ.get(VARIABLE, "[]")):
            file = Path(plugin["reference"].rpartition(":")[0])
            if package == _package_of(file, plugin["code"]):
                if code_hash(files_beside(file)) != plugin["code"]:
                    raise ImportError(f"{file} changed since the command began. Give it again.")
                _files[package] = file
    return _files.get(package)


class _Finder(MetaPathFinder):
    """Finds the packages of planners' files, and what is in them."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if not fullname.startswith(f"{__name__}."):
            return None
        package, inner = _split(fullname)
        file = _file_of(package)
        if file is None:
            return None
        if not inner:
            folder = [str(file.parent)]
            loader = _Loader(fullname, str(file))
            return importlib.util.spec_from_file_location(
                fullname, file, loader=loader, submodule_search_locations=folder
            )
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is None or spec.origin is None:
            return spec
        if Path(spec.origin) not in _code_of(package):
            raise ImportError(
                f"{spec.origin} is imported by a name that is made as the planner runs, so that "
                f"its version does not know it. Write `import {inner}` in {file}."
            )
        if isinstance(spec.loader, SourceFileLoader):
            spec.loader = _Loader(fullname, spec.origin)
        return spec


class _Loader(SourceFileLoader):
    """Runs the text as it stands in the file, with imports that look beside the planner's file."""

    def get_code(self, _: str) -> CodeType:
        # Compiled code is kept by the second of a change: it may be older than what is hashed.
        return self.source_to_code(self.get_data(self.path), self.path)

    def exec_module(self, module: ModuleType) -> None:
        package, _ = _split(module.__name__)
        own = {**vars(builtins), "__import__": _Importer(package)}
        module.__dict__["__builtins__"] = own
        super().exec_module(module)


class _Importer:
    """Stands for ``__import__`` in the modules of one planner's file.

    Parameters
    ----------
    package : str
    """

    def __init__(self, package: str) -> None:
        self._package = package
        self._known: dict[str, str | None] = {}

    def __call__(
        self,
        name: str,
        globals: Mapping[str, object] | None = None,  # noqa: A002  as Python's own has it
        locals: Mapping[str, object] | None = None,  # noqa: A002
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        own = self._own(name) if level == 0 else None
        if own is not None:
            module = importlib.import_module(own)
            if not fromlist:  # `import a.b` binds a
                return sys.modules[self._own(name.partition(".")[0]) or own]
            return builtins.__import__(module.__name__, globals, locals, fromlist)
        found = builtins.__import__(name, globals, locals, fromlist or (), level)
        return _Importlib(self.import_module) if found is importlib else found

    def import_module(self, name: str, package: str | None = None) -> ModuleType:
        """What ``importlib.import_module`` is in these modules."""
        own = None if name.startswith(".") else self._own(name)
        return importlib.import_module(name if own is None else own, package)

    def _own(self, name: str) -> str | None:
        """The whole name of a module that lies beside the file; None if none does."""
        top, dot, rest = name.partition(".")
        if top not in self._known:
            file = _files[self._package]
            inside = f"{self._package}.{top}"
            lies_there = bool(module_beside(file.parent, top))
            self._known[top] = inside if lies_there else None
            if top == file.stem:  # a helper that imports the planner's own file
                self._known[top] = self._package
        own = self._known[top]
        return None if own is None else f"{own}{dot}{rest}"


class _Importlib(ModuleType):
    """``importlib`` as a planner's modules see it: it imports what they would import."""

    def __init__(self, import_module: Callable[..., ModuleType]) -> None:
        super().__init__(importlib.__name__)
        self.import_module = import_module

    def __getattr__(self, name: str) -> Any:
        return getattr(importlib, name)


def _split(name: str) -> tuple[str, str]:
    """The package of a planner's file, and what is inside it."""
    first, _, inner = name.removeprefix(f"{__name__}.").partition(".")
    return f"{__name__}.{first}", inner


@cache
def _code_of(package: str) -> set[Path]:
    """The files that are in the hash of a package's code."""
    return files_beside(_files[package])


sys.meta_path.insert(0, _Finder())
