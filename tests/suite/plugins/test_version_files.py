"""Data that a planner names belong to its version as its code does."""

import subprocess
import sys

import pytest

from suite.errors import PluginError
from suite.plugins.discovery import load_planner, planner_info, planner_version
from suite.plugins.from_file import VARIABLE, name_plugins, named_plugins

CODE = """
from pathlib import Path
from suite.planner import Plan, Planner, PlanStatus

WEIGHT = (Path(__file__).parent / "weights.txt").read_text()

class Weighs(Planner):
    name = "weighs"
    version_files = ("weights.txt", "tables")

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.EXHAUSTED)
"""


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, "[]")
    monkeypatch.setattr(sys, "path", list(sys.path))
    (tmp_path / "tables" / "deep").mkdir(parents=True)
    (tmp_path / "tables" / "deep" / "one.bin").write_bytes(b"1")
    (tmp_path / "weights.txt").write_text("1")
    made = tmp_path / "weighs.py"
    made.write_text(CODE)
    return made


@pytest.mark.parametrize("changed", ["weights.txt", "tables/deep/one.bin", "tables/new.bin"])
def test_data_that_changed_are_another_version(file, changed):
    (before,) = name_plugins([str(file)])
    (file.parent / "beside.txt").write_text("2")
    assert name_plugins([str(file)]) == [before]
    (file.parent / changed).write_text("2")
    (after,) = name_plugins([str(file)])
    assert after.version != before.version
    assert planner_version("weighs") == after.version


@pytest.mark.slow
def test_rows_of_other_data_are_run_anew(file, wall_file):
    matrix = file.with_name("m.toml")
    matrix.write_text(f'scenes = ["{wall_file}"]\nseeds = 1\n[[planner]]\nplanner = "weighs"\n')
    command = [sys.executable, "-m", "suite", "run", matrix, "--dry-run", "--plugin", file]
    run = [*command[:5], "--plugin", file]

    def said(words):
        words = [*map(str, words), "--store", str(file.with_name("s.db"))]
        return subprocess.run(words, capture_output=True, text=True, check=True).stdout

    assert "0 were there, 1 ran now" in said(run)
    assert "0 of 1 runs would be run" in said(command)
    (file.parent / "weights.txt").write_text("2")
    assert "1 of 1 runs would be run" in said(command)


def test_data_that_changed_since_the_command_began_are_refused(file):
    name_plugins([str(file)])
    (file.parent / "weights.txt").write_text("2")
    with pytest.raises(PluginError, match=r"changed since the command began\. Give it again"):
        load_planner("weighs")


def test_a_missing_file_is_said_before_the_planner_meets_it(file):
    (file.parent / "weights.txt").unlink()
    with pytest.raises(
        PluginError, match=r"names 'weights\.txt' in version_files, and there is no"
    ):
        name_plugins([str(file)])
    assert named_plugins() == []


@pytest.mark.parametrize("names", ['"weights.txt"', "tuple(map(str, ()))", "(1,)"])
def test_names_that_do_not_stand_there_are_refused(file, names):
    file.write_text(CODE.replace('("weights.txt", "tables")', names))
    with pytest.raises(PluginError, match=r"version_files can't be read\. Write them out"):
        name_plugins([str(file)])


def test_names_that_are_made_later_are_refused(file):
    file.write_text(f'{CODE}\nWeighs.version_files = ("made.txt",)\n')
    with pytest.raises(PluginError, match="that can't be read"):
        name_plugins([str(file)])


def test_a_file_outside_the_folder_is_refused(file):
    (file.parent / "inner").mkdir()
    inner = file.rename(file.parent / "inner" / "weighs.py")
    inner.write_text(CODE.replace('"weights.txt", "tables"', '"../weights.txt",'))
    with pytest.raises(PluginError, match="which lies outside of its folder"):
        name_plugins([str(inner)])


def test_an_installed_planner_names_files_too(file, monkeypatch):
    info = file.parent / "weighs-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: weighs\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[kbga_bench.planners]\nweighs = weighs:Weighs\n")
    monkeypatch.syspath_prepend(str(file.parent))
    before = planner_version("weighs")
    assert before.startswith("1.0 sha256-")
    assert planner_info("weighs").version == before
    (file.parent / "weights.txt").write_text("2")
    assert planner_version("weighs") != before
    (file.parent / "weights.txt").unlink()
    assert planner_info("weighs").reason.startswith("unavailable: weighs.py names 'weights.txt'")
