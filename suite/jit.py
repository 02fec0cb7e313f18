"""How kernels are compiled, and where the machine code is kept.

numba notices when the file of a cached function changes, but not when a function that it calls
changes in another file: after an update, old machine code would go on running inside new. So there
is one folder for each state of the files that kernels are made from, and a hash of them is its
name. Whoever decorates a kernel imports this file, which points numba there first.
"""

import contextlib
import hashlib
import os
import shutil
from importlib.util import find_spec
from pathlib import Path

import numba
from numba import njit
from numba.core import event
from platformdirs import user_cache_path

# _nrt is numba's own name for the switch, which its type hints leave out.
kernel = njit(cache=True, _nrt=False)  # type: ignore[call-overload]
"""Compile a function that owns nothing: scalars, and arrays that its caller holds, go in; scalars
come out; nothing is allocated. So numba need not count references, which it does whenever an array
is taken from a tuple or a record: that was more than half of the time of KBGA's generations."""

inlined_kernel = njit(  # type: ignore[call-overload]
    cache=True, _nrt=False, forceinline=True
)
"""The same, pasted into each caller: for the few that are called for every segment."""

allocating_kernel = njit(cache=True)
"""Compile a function that makes arrays of its own, for which numba counts references."""

SOURCES = (
    "suite/jit.py",
    "suite/geometry/*.py",
    "suite/scenes/exact.py",
    "suite/scenes/homotopy.py",
    "kbga/**/*.py",
    "baselines/cma_es.py",
    "baselines/grid_astar.py",
)
"""The files that hold kernels, and those beside them that hold what kernels read: tolerances,
sizes, settings. All of the packages need not be read to know them; a test does."""

_KEPT = 4
"""Folders of older sources that stay, so that two checkouts side by side don't evict each other."""


def cache_folder() -> Path:
    """The folder that belongs to the kernels' sources as they are now.

    Returns
    -------
    Path
        Below ``NUMBA_CACHE_DIR`` if that is set, else below the user's cache folder.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sources():
        digest.update(source.read_bytes())
    base = os.environ.get("NUMBA_CACHE_DIR")
    top = Path(base, "kbga-bench") if base else user_cache_path("kbga-bench")
    return top / digest.hexdigest()[:16]


def sources() -> list[Path]:
    """The files that :data:`SOURCES` names, of those of our packages that are installed."""
    found: list[Path] = []
    for pattern in SOURCES:
        package, _, files = pattern.partition("/")
        spec = find_spec(package)
        for root in (spec.submodule_search_locations or []) if spec else []:
            found += sorted(Path(root).glob(files))
    return found


class _MakesRoom(event.Listener):
    """Deletes the folders of older sources when something is compiled.

    Not before: an import that compiles nothing leaves them alone.
    """

    def on_start(self, _: event.Event) -> None:
        own = Path(numba.config.CACHE_DIR)  # type: ignore[attr-defined]
        # Another process may be doing the same.
        with contextlib.suppress(OSError):
            others = [folder for folder in own.parent.iterdir() if folder != own]
            others.sort(key=lambda folder: folder.stat().st_mtime, reverse=True)
            for folder in others[_KEPT:]:
                shutil.rmtree(folder, ignore_errors=True)

    def on_end(self, _: event.Event) -> None:
        pass


numba.config.CACHE_DIR = str(cache_folder())  # type: ignore[attr-defined]
event.register("numba:compile", _MakesRoom())  # type: ignore[no-untyped-call]
