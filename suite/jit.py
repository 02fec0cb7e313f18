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
import time
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
    "suite/scenes/homotopy.py",
    "suite/scenes/visibility.py",
    "kbga/**/*.py",
    "baselines/cma_es.py",
    "baselines/grid_astar.py",
)
"""The files that hold kernels, and those beside them that hold what kernels read: tolerances,
sizes, settings. All of the packages need not be read to know them; a test does."""

_OURS = ("suite", "kbga", "baselines")

TELL_S = 1.0
"""Compiling for so long is told of, seconds."""

TOLD = "KBGA_BENCH_TOLD_OF_COMPILING"
"""The variable by which a command and its processes say it once."""

TOLD_WORDS = (
    "kbga-bench: compiling the kernels, once after an install or an update: half a minute to two "
    "minutes, and longer on a busy machine."
)

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


class _Tells(event.Listener):
    """Says on standard error, once for a command, that kernels of ours are being compiled.

    Only when that has taken a while: a single small kernel is done before anybody has wondered.
    Where it goes is settled when this file is imported: a fork server may be silenced later.
    """

    def __init__(self) -> None:
        self._spent_s = 0.0
        self._begun: list[float] = []
        self._told = TOLD in os.environ
        with contextlib.suppress(OSError):
            self._terminal = os.dup(2)

    def on_start(self, begun: event.Event) -> None:
        module = begun.data["dispatcher"].py_func.__module__
        if self._begun or module.partition(".")[0] in _OURS:
            self._begun.append(time.monotonic())
            self._tell(self._spent_s + self._begun[-1] - self._begun[0])

    def on_end(self, _: event.Event) -> None:
        if self._begun:
            began = self._begun.pop()
            self._spent_s += 0.0 if self._begun else time.monotonic() - began

    def _tell(self, spent_s: float) -> None:
        if self._told or spent_s < TELL_S:
            return
        self._told = True
        # Past os.environ: who watches that for what planners do to it sees nothing of ours.
        os.putenv(TOLD, "1")
        with contextlib.suppress(AttributeError, OSError):
            os.write(self._terminal, f"{TOLD_WORDS}\n".encode())


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
event.register("numba:compile", _Tells())  # type: ignore[no-untyped-call]
event.register("numba:compile", _MakesRoom())  # type: ignore[no-untyped-call]
