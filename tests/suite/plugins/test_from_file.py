"""Planners without packaging: found by file, run in other processes, versioned by their code."""

import os
import subprocess
import sys

import pytest

from suite.cli import main
from suite.errors import PluginError
from suite.plugins.discovery import available_planners, load_planner, planner_names
from suite.plugins.from_file import VARIABLE, name_plugins, named_plugins
from suite.store.read import read_runs

CODE = """
import numpy as np
from suite.planner import Plan, Planner, PlanStatus

class Base(Planner):
    pass

class Straight(Base):
    name = "straight"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))

class Bent(Straight):
    name = "bent"
"""


@pytest.fixture
def file(tmp_path, monkeypatch):
    # Set and deleted, so that whatever a test puts there is taken back.
    monkeypatch.setenv(VARIABLE, "[]")
    monkeypatch.setattr(sys, "path", list(sys.path))
    made = tmp_path / "my_planners.py"
    made.write_text(CODE)
    return made


def test_all_planners_of_a_file_are_found_and_its_bases_are_not(file):
    assert [p.name for p in name_plugins([str(file)])] == ["straight", "bent"]
    assert {"straight", "bent", "kbga"} <= set(planner_names())
    assert load_planner("bent").__name__ == "Bent"


def test_one_class_of_a_file_can_be_named(file):
    assert [p.name for p in name_plugins([f"{file}:Bent"])] == ["bent"]


def test_a_class_of_a_module_in_the_current_folder_can_be_named(file, monkeypatch):
    monkeypatch.chdir(file.parent)
    (plugin,) = name_plugins(["my_planners:Straight"])
    assert (plugin.name, plugin.distribution) == ("straight", "my_planners")
    assert load_planner("straight").__name__ == "Straight"
    del sys.modules["my_planners"]


def test_naming_none_forgets_the_earlier_ones(file):
    name_plugins([str(file)])
    assert name_plugins([]) == []
    assert named_plugins() == []
    assert VARIABLE not in os.environ


def test_its_row_says_the_file_and_a_hash_of_its_code(file):
    name_plugins([str(file)])
    info = next(p for p in available_planners() if p.name == "bent")
    assert (info.distribution, info.available) == ("my_planners.py", True)
    before = info.version
    assert before.startswith("sha256-")
    file.write_text(CODE + "    changed = True\n")
    name_plugins([str(file)])
    assert next(p for p in available_planners() if p.name == "bent").version != before
    assert load_planner("bent").changed


@pytest.mark.parametrize("changed", ["my_planners.py", "helper_of_mine.py"])
def test_code_that_changed_since_is_refused(file, changed):
    (file.parent / "helper_of_mine.py").write_text("")
    file.write_text(f"import helper_of_mine\n{CODE}")
    name_plugins([str(file)])
    with (file.parent / changed).open("a") as code:
        code.write("\n# changed\n")
    with pytest.raises(PluginError, match="changed since the command began"):
        load_planner("bent")


def test_a_name_that_is_installed_already_is_ambiguous(file):
    file.write_text(CODE.replace('"bent"', '"kbga"'))
    name_plugins([str(file)])
    with pytest.raises(PluginError, match=r"kbga-bench and my_planners.py both declare it\. Give"):
        load_planner("kbga")


@pytest.mark.parametrize(
    ("reference", "code", "message"),
    [
        ("{file}x.py", "", "there is no file"),
        ("~nobody-at-all/x.py", "", "there is no file"),
        ("x" * 5000 + ".py", "", "there is no file"),
        ("x\0.py", "", "there is no file"),
        ("{file}:Missing", CODE, "there is no class Missing"),
        ("{file}", "x = 1", "no subclass of suite.planner.Planner"),
        ("{file}", "import no_such_module", "ModuleNotFoundError"),
        ("{file}", "import sys; sys.exit(1)", "SystemExit: 1"),
        ("{file}", CODE.replace("def plan", "def plam"), "Straight does not define plan."),
        ("{file}", CODE.replace(", recorder", ""), "It must be plan(self, scene, query"),
        ("{file}", CODE + "    interface = 7", "is written for version 7 of the plugin interface"),
        ("{file}:Base", CODE.replace("pass", "plan = print"), "Base has no `name`"),
        ("no_such_module:Straight", "", "ModuleNotFoundError"),
        ("straight", "", "neither a .py file nor a class"),
    ],
)
def test_what_cannot_be_used_is_refused_with_its_reason(file, reference, code, message):
    file.write_text(code)
    with pytest.raises(PluginError) as error:
        name_plugins([reference.format(file=file)])
    assert message in str(error.value)
    assert named_plugins() == []


@pytest.mark.parametrize(
    ("arguments", "code", "printed"),
    [
        (["list", "planners"], 0, "my_planners.py"),
        (["plan", "{wall}", "--planner", "bent"], 1, "invalid"),
        (["simulate", "{wall}", "--planner", "bent", "--time-limit", "1"], 1, "wall / bent"),
    ],
)
def test_each_command_that_names_planners_takes_it(
    file, wall_file, arguments, code, printed, monkeypatch, capsys
):
    words = [word.format(wall=wall_file) for word in arguments]
    monkeypatch.setattr(sys, "argv", ["kbga-bench", *words, "--plugin", str(file)])
    with pytest.raises(SystemExit) as ended:
        main()
    assert int(ended.value.code or 0) == code
    assert printed in capsys.readouterr().out


def test_a_plugin_that_cannot_be_used_is_one_line_and_ends_the_command(file, monkeypatch, capsys):
    file.write_text("import no_such_module")
    monkeypatch.setattr(sys, "argv", ["kbga-bench", "list", "planners", "--plugin", str(file)])
    with pytest.raises(SystemExit, match="2"):
        main()
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.count("\n") == 1
    assert "ModuleNotFoundError: No module named 'no_such_module'" in told.err


@pytest.mark.slow
def test_a_matrix_runs_it_in_other_processes_and_changed_code_runs_anew(file, wall_file):
    matrix, store = file.with_name("m.toml"), file.with_name("s.db")
    matrix.write_text(
        f'scenes = ["{wall_file}"]\nseeds = 1\n[[planner]]\nplanner = "straight"\n'
        '[[planner]]\nplanner = "visibility-graph"\n'
    )

    def run(*words):
        words = words or ("run", matrix, "--store", store, "--jobs", "1")
        arguments = [*words, "--plugin", file]
        program = "from suite.cli import main; main()"
        return subprocess.run(
            [sys.executable, "-c", program, *map(str, arguments)],
            capture_output=True,
            text=True,
            check=True,
        ).stdout

    assert "2 ran now, 1 of these failed" in run()
    assert "0 ran now" in run()
    runs = read_runs(store).set_index("variant")
    assert runs.loc["straight", "status"] == "invalid"  # it goes straight on, through the wall
    assert runs.loc["straight", "distribution"] == "my_planners.py"
    assert "the same: invalid" in run("rerun", store, runs.loc["straight", "key"])
    file.write_text(CODE.replace("Plan(PlanStatus.SOLVED, ", "Plan(PlanStatus.EXHAUSTED, "))
    assert "1 ran now, 0 of these failed" in run()
    after = read_runs(store)
    statuses = after.loc[after["variant"] == "straight", "status"]
    assert sorted(statuses) == ["exhausted", "invalid"]
    assert after["version"].str.startswith("sha256-").sum() == 2
