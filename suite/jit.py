"""How kernels are compiled, and where the machine code is kept.

numba notices when the file of a cached function changes, but not when a function that it calls
changes in another file: after an update, old machine code would go on running inside new. So there
is one folder for each state of the files that kernels are made from, and a hash of them is its
name.
"""

import hashlib
import os
import shutil
from importlib.util import find_spec
from pathlib import Path

import numba
from numba import njit

# _nrt is numba's own name for the switch, which its type hints leave out.
kernel = njit(cache=True, _nrt=False)  # type: ignore[call-overload]
"""Compile a function that owns nothing: scalars, and arrays that its caller holds, go in; scalars
come out; nothing is allocated. So numba need not count references, which it does whenever an array
is taken from a tuple or a record: that was more than half of the time of KBGA's generations."""

inlined_kernel = njit(  # type: ignore[call-overload]
    cache=True, _nrt=False, forceinline=True
)
"""The same, pasted into each caller: for the few that are called for every segment."""

_PACKAGES = ("suite", "kbga", "baselines")
_MARKS = (b"suite.jit", b"njit")
"""What stands in each file that holds kernels."""
_CONSTANTS = ("suite/geometry", "kbga")
"""Folders whose other files hold what kernels read: tolerances, sizes, settings."""

_KEPT = 4
"""Folders of older sources that stay, so that two checkouts side by side don't evict each other."""


def use_cache_of_these_sources() -> Path:
    """Point numba's cache at the folder that belongs to the kernels' sources as they are now.

    Returns
    -------
    Path
        The folder, below ``NUMBA_CACHE_DIR`` if that is set, else below the user's cache folder.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for name in _PACKAGES:
        spec = find_spec(name)
        for root in (spec.submodule_search_locations or []) if spec else []:
            for source in sorted(Path(root).rglob("*.py")):
                content = source.read_bytes()
                place = source.relative_to(Path(root).parent).as_posix()
                if place.startswith(_CONSTANTS) or any(mark in content for mark in _MARKS):
                    digest.update(content)
    base = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME")
    top = (Path(base) if base else Path.home() / ".cache") / "kbga-bench"
    folder = top / digest.hexdigest()[:16]
    if not folder.is_dir():
        _make_room(top)
    numba.config.CACHE_DIR = str(folder)  # type: ignore[attr-defined]
    return folder


def _make_room(top: Path) -> None:
    if top.is_dir():
        old = sorted(top.iterdir(), key=lambda f: f.stat().st_mtime, reverse=True)
        for folder in old[_KEPT:]:
            shutil.rmtree(folder, ignore_errors=True)
