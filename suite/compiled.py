"""Where compiled kernels are cached: one folder for each state of the sources.

numba notices when the file of a cached function changes, but not when a function that it calls
changes in another file: after an update, old machine code would go on running inside new. So the
folder's name is a hash of all kernel sources.
"""

import hashlib
import os
import shutil
from importlib.util import find_spec
from pathlib import Path

import numba

_PACKAGES = ("suite", "kbga", "baselines")
_KEPT = 4
"""Folders of older sources that stay, so that two checkouts side by side don't evict each other."""


def use_cache_of_these_sources() -> Path:
    """Point numba's cache at the folder that belongs to the sources as they are now.

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
                digest.update(source.read_bytes())
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
