"""What a matrix needs of its user's own files: scenes, and planners that are named by their code.

The machines of a cluster need no disk in common. The harness packs these files once, a worker that
lacks them is sent them with a run, and each machine keeps them in folders named after what is in
them: what numba compiles in such a folder is found again by all workers of that machine, now and
later. A scene travels as it was read, whatever files it was read from, and needs no library there
that reads them.
"""

import hashlib
import os
import shutil
import sys
import tempfile
import time
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath

from platformdirs import user_cache_path

from suite.errors import HarnessError
from suite.harness.fork_server import Warmth
from suite.plugins.code_hash import files_beside, files_of_package
from suite.plugins.from_file import NamedPlugin
from suite.plugins.version_files import version_files
from suite.scenes.catalogue import has_scene
from suite.scenes.kept import SUFFIX, pack_scene
from suite.scenes.scene import Scene

KEPT_S = 60 * 24 * 3600.0
"""Folders that no matrix used for so long are deleted. No matrix takes as long."""


@dataclass(frozen=True, slots=True)
class Parcel:
    """Files of one folder, to lie in one folder again.

    files : (path below that folder, with slashes; content, compressed) of each.
    """

    files: tuple[tuple[str, bytes], ...]

    @property
    def digest(self) -> str:
        """Hash of names and contents: 32 hexadecimal digits."""
        parts = [(name, hashlib.sha256(content).hexdigest()) for name, content in self.files]
        return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]


@dataclass(frozen=True, slots=True)
class PackedScene:
    """A scene as a document. source : as cells name it."""

    source: str
    parcel: Parcel


@dataclass(frozen=True, slots=True)
class PackedPlugin:
    """A planner that is named by its code. parcel : all of that code, and the data it names."""

    plugin: NamedPlugin
    parcel: Parcel


@dataclass(frozen=True, slots=True)
class Luggage:
    """All files of a user that the runs of a matrix read."""

    scenes: tuple[PackedScene, ...] = ()
    plugins: tuple[PackedPlugin, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.scenes or self.plugins)


@dataclass(frozen=True, slots=True)
class Unpacked:
    """Where a machine keeps what came to it.

    sources : of scenes here, by their sources in the cells of the harness.
    plugins : as they are named here.
    """

    sources: Mapping[str, str]
    plugins: tuple[NamedPlugin, ...] = ()

    def source(self, there: str) -> str:
        """What is loaded here for a source of the harness; scenes of the catalogue stay."""
        return self.sources.get(there, there)

    def warmth(self, there: Warmth) -> Warmth:
        """What a fork server here has ready for the runs of the harness."""
        queries = tuple((self.source(source), query) for source, query in there.queries)
        return replace(there, queries=queries)


def pack(scenes: Mapping[str, Scene], plugins: Iterable[NamedPlugin]) -> Luggage:
    """Pack what runs will need.

    Parameters
    ----------
    scenes : mapping from source to scene
        Sources as :func:`suite.scenes.catalogue.load_scene` takes them. Those of the catalogue are
        everywhere.
    plugins : iterable of NamedPlugin

    Raises
    ------
    HarnessError
        If a file of a planner can't be read any more.
    """
    packed = [
        _packed_scene(source, scene)
        for source, scene in sorted(scenes.items())
        if not has_scene(source)
    ]
    return Luggage(tuple(packed), tuple(_packed_plugin(plugin) for plugin in plugins))


def unpack(luggage: Luggage) -> Unpacked:
    """Lay what came to this machine where it is kept, unless it is there.

    Raises
    ------
    HarnessError
        If it can't be kept.
    """
    room = user_cache_path("kbga-bench-luggage")
    try:
        room.mkdir(parents=True, exist_ok=True)
        _forget_old(room)
        sources = {packed.source: _scene_here(packed, room) for packed in luggage.scenes}
        return Unpacked(sources, tuple(_plugin_here(packed, room) for packed in luggage.plugins))
    except OSError as error:
        raise HarnessError(
            f"the files of the matrix can't be kept in {room} ({error.strerror or error}). Make "
            "room there, or set XDG_CACHE_HOME in the worker's environment to a folder that it "
            "can write."
        ) from error


def _packed_scene(source: str, scene: Scene) -> PackedScene:
    # Once more, and not smaller: the document is compressed.
    content = zlib.compress(pack_scene(scene), level=0)
    return PackedScene(source, Parcel(((f"scene{SUFFIX}", content),)))


def _packed_plugin(plugin: NamedPlugin) -> PackedPlugin:
    try:
        folder, code = _code(_place(plugin))
        return PackedPlugin(plugin, _parcel(folder, code | version_files(code)))
    except OSError as error:
        raise HarnessError(
            f"{error.filename}: can't be read, to be sent to the workers ({error.strerror}). Put "
            "it back, and give the same command again."
        ) from error


def _code(place: str) -> tuple[Path, set[Path]]:
    """The folder of a planner's code, and its files."""
    if place.endswith(".py"):
        return Path(place).parent, files_beside(Path(place))
    return _folder_of_package(place), files_of_package(place)


def _folder_of_package(module: str) -> Path:
    """The folder in which Python finds the package that a module is in, or a module in none."""
    first = sys.modules[module.partition(".")[0]]  # imported when the plugin was named
    if first.__file__ is None:
        raise HarnessError(
            f"{module}: {first.__name__} has no __init__.py, and can't be sent to the workers. "
            "Make one."
        )
    file = Path(first.__file__)
    return file.parent.parent if file.stem == "__init__" else file.parent


def _parcel(folder: Path, files: Iterable[Path]) -> Parcel:
    return Parcel(
        tuple(
            (file.relative_to(folder).as_posix(), zlib.compress(file.read_bytes()))
            for file in sorted(files)
        )
    )


def _scene_here(packed: PackedScene, room: Path) -> str:
    ((name, _),) = packed.parcel.files
    return str(_kept(packed.parcel, room) / name)


def _plugin_here(packed: PackedPlugin, room: Path) -> NamedPlugin:
    folder = _kept(packed.parcel, room)
    place = _place(packed.plugin)
    kind = packed.plugin.reference.rpartition(":")[2]
    here = str(folder / Path(place).name) if place.endswith(".py") else place
    return replace(packed.plugin, reference=f"{here}:{kind}", folder=str(folder))


def _place(plugin: NamedPlugin) -> str:
    """The file, or the name of the module."""
    return plugin.reference.rpartition(":")[0]


def _kept(parcel: Parcel, room: Path) -> Path:
    """The folder of a parcel. It appears as a whole, for several workers may make it at once."""
    folder = room / parcel.digest
    if not folder.exists():
        made = Path(tempfile.mkdtemp(prefix="new-", dir=room))
        try:
            _write(parcel.files, made)
            made.rename(folder)
        except OSError:
            shutil.rmtree(made, ignore_errors=True)
            if not folder.exists():  # nobody else was quicker
                raise
    os.utime(folder)
    return folder


def _write(files: Sequence[tuple[str, bytes]], folder: Path) -> None:
    for name, content in files:
        file = folder / PurePosixPath(name)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(zlib.decompress(content))


def _forget_old(room: Path) -> None:
    for folder in room.iterdir():
        if time.time() - folder.stat().st_mtime > KEPT_S:
            shutil.rmtree(folder, ignore_errors=True)
