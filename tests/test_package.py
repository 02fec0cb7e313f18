"""What is built to be installed: the archive of sources, and from it the wheel; no network."""

import shutil
import subprocess
import sys
import tarfile
import zipfile
from email import message_from_bytes
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("suite", "kbga", "baselines")
BESIDE = (
    "CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "LICENSE", "MANIFEST.in", "Makefile",
    "README.md", "pyproject.toml", ".pre-commit-config.yaml", ".ci/run",
)  # fmt: skip


def files_of(*folders: str) -> set[str]:
    paths = [path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file()]
    return {p.relative_to(ROOT).as_posix() for p in paths if "__pycache__" not in p.parts}


def build(what: str, source: Path, target: Path) -> Path:
    """Build by our build backend in the environment as it is."""
    code = f"from setuptools import build_meta; build_meta.build_{what}({str(target)!r})"
    done = subprocess.run([sys.executable, "-c", code], cwd=source, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (built,) = target.iterdir()
    return built


@pytest.fixture(scope="module")
def sdist(tmp_path_factory):
    """The archive of sources, built from a copy: building leaves files where it is done."""
    copy = tmp_path_factory.mktemp("copy")
    for name in files_of(*PACKAGES, "tests", "results") | set(BESIDE):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, copy / name)
    return build("sdist", copy, tmp_path_factory.mktemp("sdist"))


@pytest.fixture(scope="module")
def wheel(sdist, tmp_path_factory):
    """The wheel, built from the archive of sources as an installer would."""
    unpacked = tmp_path_factory.mktemp("unpacked")
    with tarfile.open(sdist) as archive:
        archive.extractall(unpacked, filter="data")
    (source,) = unpacked.iterdir()
    return build("wheel", source, tmp_path_factory.mktemp("wheel"))


def made_by_building(name: str) -> bool:
    return ".egg-info/" in name or ".dist-info/" in name or name in ("PKG-INFO", "setup.cfg")


def test_the_archive_of_sources_holds_packages_tests_and_what_stands_beside_but_no_results(sdist):
    with tarfile.open(sdist) as archive:
        paths = [member.name.partition("/")[2] for member in archive if member.isfile()]
    wanted = files_of(*PACKAGES, "tests") | set(BESIDE)
    assert {path for path in paths if not made_by_building(path)} == wanted


def test_the_wheel_holds_every_file_of_the_three_packages_and_nothing_else(wheel):
    names = {name for name in zipfile.ZipFile(wheel).namelist() if not made_by_building(name)}
    assert names == files_of(*PACKAGES)


def test_no_user_installs_what_the_project_is_developed_with(wheel):
    archive = zipfile.ZipFile(wheel)
    (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
    required = message_from_bytes(archive.read(name)).get_all("Requires-Dist") or []
    assert [line for line in required if line.startswith("ompl")] == [
        'ompl>=2.0.1; python_version < "3.14"'
    ]
    tools = ("pytest", "mypy", "ruff", "hypothesis", "pdoc", "import-linter", "setuptools")
    assert [line for line in required if line.startswith(tools)] == []
