"""A stranger's planner, in a distribution of its own, installed beside our wheel as a user would.

The environment is new; numpy and all other packages it borrows from the one that runs the tests,
because there is no network. What suite/plugins/README.md leads to is this distribution.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from suite.conformance.finding import Kind
from suite.conformance.rules import examine
from suite.conformance.subject import Subject
from suite.harness.matrix import load_matrix
from suite.plugins.from_file import VARIABLE, name_plugins
from suite.store.read import read_runs

ROOT = Path(__file__).parents[1]
PLUGIN = ROOT / "tests" / "example_plugin"
README = (ROOT / "suite" / "plugins" / "README.md").read_text(encoding="utf-8")
MATRIX = """
scenes = ["obstacles_20"]
seeds = 2

[[planner]]
planner = "small-prm"
budget = { generations = 4 }

[[planner]]
planner = "visibility-graph"
"""


# Machine code belongs to the place of its source: in a new place all of it would be compiled.
INTERPRETED = {**os.environ, "NUMBA_DISABLE_JIT": "1"}


def done(*command, code=0, cwd=None, env=None):
    ended = subprocess.run(
        [*map(str, command)], capture_output=True, text=True, cwd=cwd, env=env, timeout=600
    )
    assert ended.returncode == code, ended.stdout + ended.stderr
    return ended.stdout


def installed(python, folder):
    """Install a source tree, from a copy: building leaves files in it."""
    pip = [sys.executable, "-m", "pip", "--python", python, "install", "--quiet"]
    alone = ["--no-index", "--no-deps", "--no-build-isolation", "--disable-pip-version-check"]
    done(*pip, *alone, folder)


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """A virtual environment with our wheel and the stranger's, made without a network."""
    folder = tmp_path_factory.mktemp("fresh")
    source = folder / "source"
    for package in ("suite", "kbga", "baselines"):
        shutil.copytree(
            ROOT / package, source / package, ignore=shutil.ignore_patterns("__pycache__")
        )
    for file in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / file, source)
    shutil.copytree(PLUGIN, folder / "plugin")
    venv = folder / "venv"
    done(sys.executable, "-m", "venv", "--without-pip", venv)
    python = venv / "bin" / "python"
    purelib = Path(
        done(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))")[:-1]
    )
    # A line adds a folder and does not read its .pth files: our editable install stays unseen.
    (purelib / "borrowed.pth").write_text(sysconfig.get_path("purelib") + "\n")
    installed(python, source)
    installed(python, folder / "plugin")
    return venv / "bin"


def test_the_suite_that_runs_there_is_our_wheel(environment):
    file = done(environment / "python", "-P", "-c", "import suite; print(suite.__file__)")
    assert file.startswith(str(environment.parent))


def test_it_is_listed(environment):
    rows = json.loads(done(environment / "kbga-bench", "list", "planners", "--format", "json"))
    (row,) = [row for row in rows if row["name"] == "small-prm"]
    assert (row["distribution"], row["available"]) == ("small-prm", True)
    assert row["version"].startswith("1.0 sha256-")
    assert {"kbga", "visibility-graph"} < {row["name"] for row in rows}


@pytest.mark.slow
def test_it_keeps_the_contract(monkeypatch):
    monkeypatch.setenv(VARIABLE, "[]")  # and taken back afterwards
    monkeypatch.setattr(sys, "path", list(sys.path))
    (plugin,) = name_plugins([str(PLUGIN / "small_prm.py")])
    results = examine(Subject(plugin.load()))
    assert [r for r in results if r.kind in (Kind.BROKEN, Kind.WARNING)] == []


@pytest.mark.slow
def test_it_keeps_the_contract_where_it_is_installed(environment):
    assert "small-prm: keeps the contract" in done(environment / "kbga-bench", "check", "small-prm")


@pytest.mark.slow
def test_a_matrix_runs_it_and_the_tables_hold_it(environment, tmp_path):
    (tmp_path / "matrix.toml").write_text(MATRIX)
    command = environment / "kbga-bench"
    arguments = ("run", "matrix.toml", "--store", "s.db", "--jobs", 2)
    done(command, *arguments, cwd=tmp_path, env=INTERPRETED)
    runs = read_runs(tmp_path / "s.db")
    theirs = runs[runs["variant"] == "small-prm"]
    assert theirs["status"].tolist() == ["solved", "solved"]
    assert set(theirs["distribution"]) == {"small-prm"}
    assert (theirs["gap"] > 0).all()
    table = done(command, "tables", "s.db", "--format", "csv", cwd=tmp_path)
    assert re.search(r"obstacles_20,small-prm,2,2,", table)


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", README, flags=re.DOTALL)


@pytest.fixture
def lucky(monkeypatch, tmp_path):
    """The planner that is shown, in a file that is named as with --plugin."""
    monkeypatch.setenv(VARIABLE, "[]")  # and taken back afterwards
    monkeypatch.setattr(sys, "path", list(sys.path))
    (source,) = blocks("python")
    (tmp_path / "lucky.py").write_text(source)
    (plugin,) = name_plugins([str(tmp_path / "lucky.py")])
    return plugin


def test_the_planner_of_the_readme_keeps_the_contract(lucky):
    results = examine(Subject(lucky.load()))
    assert [r for r in results if r.kind in (Kind.BROKEN, Kind.WARNING)] == []


def test_the_matrix_of_the_readme_is_one_that_can_be_run(lucky, tmp_path):
    (text,) = (block for block in blocks("toml") if "[[planner]]" in block)
    (tmp_path / "mine.toml").write_text(text)
    matrix = load_matrix(tmp_path / "mine.toml")
    assert matrix.name == "mine"
    assert matrix.variants[0].plugin.name == lucky.name


def test_it_is_one_module_that_is_read_in_minutes():
    lines = (PLUGIN / "small_prm.py").read_text(encoding="utf-8").splitlines()
    assert 20 <= len(lines) <= 60
    assert [path.name for path in PLUGIN.glob("*.py")] == ["small_prm.py"]
