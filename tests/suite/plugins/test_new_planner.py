"""What ``kbga-bench new-planner`` writes runs as it is, and overwrites nothing."""

import subprocess
import sys
import tomllib

import pytest

from suite.conformance.finding import Kind
from suite.conformance.rules import RULES, examine
from suite.conformance.subject import Subject
from suite.errors import PluginError
from suite.plugins.from_file import VARIABLE, name_plugins
from suite.plugins.new_planner import write_new_planner

COMMAND = [sys.executable, "-c", "from suite.cli import main; main()"]


@pytest.fixture
def written(tmp_path):
    return write_new_planner("first-try", tmp_path / "mine")


def test_it_keeps_the_contract_as_it_is(written, monkeypatch):
    monkeypatch.setenv(VARIABLE, "[]")
    monkeypatch.setattr(sys, "path", list(sys.path))
    (plugin,) = name_plugins([str(written[0])])
    assert plugin.name == "first-try"
    results = list(examine(Subject(plugin.load())))
    assert [r for r in results if r.kind in (Kind.BROKEN, Kind.WARNING)] == []
    assert sum(r.kind is Kind.KEPT for r in results) >= 27


def test_its_metadata_declare_the_class_that_is_there(written):
    module, project, test = written
    assert [path.name for path in written] == [
        "first_try.py",
        "pyproject.toml",
        "test_first_try.py",
    ]
    declared = tomllib.loads(project.read_text())["project"]["entry-points"]["kbga_bench.planners"]
    assert declared == {"first-try": "first_try:FirstTry"}
    assert "class FirstTry(Planner[FirstTrySettings]):" in module.read_text()
    assert "planner = FirstTry" in test.read_text()


def test_its_own_test_is_collected_with_a_test_for_each_rule(written):
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "--collect-only", "-p", "no:cacheprovider"],
        cwd=written[0].parent,
        capture_output=True,
        text=True,
    )
    assert "test_first_try.py::TestFirstTry::test_same_seed_same_path" in done.stdout
    assert f"{len(RULES)} tests collected" in done.stdout


def test_its_files_pass_a_linter(written):
    rules = ["--isolated", "--line-length", "100", "--select", "E,F,I,W,UP,B"]
    command = [sys.executable, "-m", "ruff"]
    for check in (["check", *rules], ["format", "--check", "--isolated", "--line-length", "100"]):
        done = subprocess.run(
            [*command, *check, "."], cwd=written[0].parent, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stdout


def test_what_is_there_is_not_overwritten(written):
    before = [path.read_bytes() for path in written]
    with pytest.raises(PluginError, match="is there already"):
        write_new_planner("other", written[0].parent)
    assert [path.read_bytes() for path in written] == before
    assert len(list(written[0].parent.iterdir())) == 3


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("My Planner", "is no name for a planner"),
        ("my_planner", "is no name for a planner"),
        ("2fast", "is no name for a planner"),
        ("../up", "is no name for a planner"),
        ("kbga", "there is a planner 'kbga' already"),
        ("random", "would be the module random, which Python has already"),
        ("numpy", "would be the module numpy, which Python has already"),
        ("class", "would be the module class, which Python has already"),
    ],
)
def test_a_name_that_cannot_be_used_is_refused_before_anything_is_written(name, message, tmp_path):
    with pytest.raises(PluginError, match=message):
        write_new_planner(name, tmp_path / "mine")
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_into_a_folder_of_the_name_and_says_how_to_go_on(tmp_path):
    command = [*COMMAND, "new-planner", "first-try"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert (tmp_path / "first-try" / "first_try.py").is_file()
    assert "kbga-bench check first-try --plugin first-try/first_try.py" in done.stdout
    again = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (again.returncode, again.stdout) == (2, "")
    assert "first-try is there already" in again.stderr
