"""The machine and the versions that results come from."""

import importlib.metadata
import os
import platform
import subprocess
from collections.abc import Iterable
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

import psutil

PACKAGES = ("kbga-bench", "numpy", "numba", "llvmlite", "shapely", "ompl", "pandas", "matplotlib")
VARIABLES = ("OMP_NUM_THREADS", "NUMBA_DISABLE_JIT", "NUMBA_CPU_NAME", "PYTHONHASHSEED")


def provenance(matrix: str, distributions: Iterable[tuple[str, str]] = ()) -> dict[str, Any]:
    """Everything that somebody needs to know who wants to repeat the rows of a session.

    Parameters
    ----------
    matrix : str
        What is run.
    distributions : iterable of (name, version)
        The packages that the planners come from.

    Returns
    -------
    dict
        Plain data.
    """
    return {
        "matrix": matrix,
        "started_at": datetime.now(UTC).isoformat(timespec="seconds"),
        "host": host_name(),
        "os": platform.platform(),
        "cpu": _cpu_model(),
        "cores": os.cpu_count(),
        "memory_bytes": psutil.virtual_memory().total,
        "python": platform.python_version(),
        "versions": {p: v for p in PACKAGES if (v := package_version(p)) is not None},
        "planner_distributions": dict(sorted(set(distributions))),
        "git": _git_state(),
        "environment": {name: os.environ[name] for name in VARIABLES if name in os.environ},
    }


def package_version(name: str) -> str | None:
    """Version of an installed distribution; None if it is not there."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


@cache
def host_name() -> str:
    """Name of this machine in its network."""
    return platform.node()


def load_average() -> float:
    """Mean number of processes that wanted a processor in the last minute."""
    return os.getloadavg()[0]


def _cpu_model() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


_SOURCES = (":/suite", ":/kbga", ":/baselines", ":/pyproject.toml")


def _git_state() -> dict[str, Any] | None:
    """Commit of the checkout that this file lies in; None if it is installed from elsewhere."""
    folder = Path(__file__).parent
    try:
        # A virtual environment may lie inside somebody else's checkout: that commit is not ours.
        _git(folder, "ls-files", "--error-unmatch", Path(__file__).name)
        commit = _git(folder, "rev-parse", "HEAD")
        # Of what runs only: results that are being made, or a text, change no result.
        changed = _git(folder, "status", "--porcelain", "-uno", "--", *_SOURCES)
        return {"commit": commit, "dirty": bool(changed)}
    except (OSError, subprocess.SubprocessError):
        return None


def _git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(
        ["git", *arguments], cwd=folder, capture_output=True, text=True, check=True, timeout=10
    )
    return done.stdout.strip()
