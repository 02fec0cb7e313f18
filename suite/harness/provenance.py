"""The machine and the versions that results come from."""

import importlib.metadata
import os
import platform
import re
import subprocess
from collections.abc import Iterable
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

import psutil
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from suite.processes.cores import honest_cores

ONE_THREAD = dict.fromkeys(
    (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "BLIS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
        "NUMEXPR_NUM_THREADS",
        "NUMBA_NUM_THREADS",
    ),
    "1",
)
"""The environment of every run. A run has one processor: threads of libraries would only disturb
its neighbours' timing."""

VARIABLES = re.compile(
    "(OMP|GOMP|KMP|MKL|OPENBLAS|BLIS|VECLIB|NUMEXPR|NUMBA|NPY|PYTHON|MALLOC|LD|DYLD|GLIBC)_.*"
    "|PYTHON.*|TZ|LANG|LC_ALL"
)
"""Environment variables that can change what numerical code does, or how fast."""

DISTRIBUTION = "kbga-bench"


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
    planners = sorted(set(distributions))
    return {
        "matrix": matrix,
        "started_at": datetime.now(UTC).isoformat(timespec="seconds"),
        "host": host_name(),
        "os": platform.platform(),
        "cpu": _cpu_model(),
        "cores": os.cpu_count(),
        "physical_cores": psutil.cpu_count(logical=False),
        "usable_cores": len(honest_cores()),
        "memory_bytes": psutil.virtual_memory().total,
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "versions": installed_versions([DISTRIBUTION, *(name for name, _ in planners)]),
        "planner_distributions": dict(planners),
        "git": _git_state(),
        "environment": run_environment(),
    }


def run_environment() -> dict[str, str]:
    """The environment variables of a run that can change its outcome or its time."""
    environment = {**os.environ, **ONE_THREAD}
    return {name: environment[name] for name in sorted(environment) if VARIABLES.fullmatch(name)}


def installed_versions(roots: Iterable[str]) -> dict[str, str]:
    """Versions of distributions, and of all that they require, and so on; extras left out.

    Returns
    -------
    dict
        From name, in lower case with hyphens, to version. What is not installed is not in it.
    """
    versions: dict[str, str] = {}
    waiting: list[str] = [canonicalize_name(name) for name in roots]
    while waiting:
        name = waiting.pop()
        if name not in versions and (version := package_version(name)) is not None:
            versions[name] = version
            waiting += _required(name)
    return dict(sorted(versions.items()))


def _required(name: str) -> list[str]:
    wanted = map(Requirement, importlib.metadata.requires(name) or [])
    here = [one for one in wanted if one.marker is None or one.marker.evaluate({"extra": ""})]
    return [canonicalize_name(requirement.name) for requirement in here]


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
