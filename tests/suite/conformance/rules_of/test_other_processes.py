"""Another process: who is found there, who is not, and what a planner hands on to it."""

import os
import subprocess
import sys
from pathlib import Path

from suite.conformance.finding import Finding
from suite.conformance.rules_of.other_processes import NOT_FOUND, same_path_in_another_process
from suite.conformance.subject import Subject
from suite.plugins.from_file import VARIABLE, name_plugins
from tests.suite.conformance.broken_planners import (
    Detours,
    DetourSettings,
    DiesInAnotherProcess,
    Remembers,
)

BROKEN = Path(__file__).parents[1] / "broken_planners.py"


def test_a_planner_with_settings_of_its_own_runs_there_with_them():
    assert same_path_in_another_process(Subject(Detours, DetourSettings(tries=7))) is None


def test_a_class_in_a_function_is_not_found_there():
    class Nested(Detours):
        name = "nested"

    assert same_path_in_another_process(Subject(Nested)) is NOT_FOUND


def test_a_class_of_a_script_is_not_found_there_and_the_script_is_not_run_again(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "from suite.conformance.rules_of.other_processes import NOT_FOUND\n"
        "from suite.conformance.rules_of.other_processes import same_path_in_another_process\n"
        "from suite.conformance.subject import Subject\n"
        "from tests.suite.conformance.broken_planners import Detours\n"
        "class Mine(Detours):\n"
        "    name = 'mine'\n"
        "print('begun')\n"
        "print(same_path_in_another_process(Subject(Mine)) is NOT_FOUND)\n"
    )
    done = subprocess.run(
        [sys.executable, script],
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[4])},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.split() == ["begun", "True"]


def test_a_planner_of_a_file_is_found_there(monkeypatch):
    monkeypatch.setenv(VARIABLE, "[]")  # and taken back afterwards
    monkeypatch.setattr(sys, "path", list(sys.path))
    (plugin,) = name_plugins([f"{BROKEN}:GoesThroughASetOfStrings"])
    found = same_path_in_another_process(Subject(plugin.load()))
    assert isinstance(found, Finding)
    assert found.found.endswith("a run in another process differs in path, reports")
    assert "Sort what comes out of a set" in found.mend


def test_strings_that_are_salted_alike_hide_nothing():
    # The other process takes another salt than this one was given.
    program = (
        "from suite.conformance.rules_of import other_processes\n"
        "from suite.conformance.subject import Subject\n"
        "from tests.suite.conformance.broken_planners import GoesThroughASetOfStrings\n"
        "rule = other_processes.same_path_in_another_process\n"
        "print(type(rule(Subject(GoesThroughASetOfStrings))).__name__)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONHASHSEED": "1"},
        cwd=Path(__file__).parents[4],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "Finding"


def test_a_planner_that_dies_there_is_named_with_its_end():
    found = same_path_in_another_process(Subject(DiesInAnotherProcess))
    assert found.found.startswith("another process ended with exit code 5")


def test_a_planner_that_keeps_state_is_told_that_first():
    found = same_path_in_another_process(Subject(Remembers))
    assert found.reason == "it keeps state."
