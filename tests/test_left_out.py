"""OMPL, which the newest Python lacks, and parquet may be missing: the rest works and says how."""

import json
import subprocess
import sys

import pytest

from tests.suite.commands import in_own_process

WITHOUT = "import sys; sys.modules[{!r}] = None; from suite.cli import main; main()"
OMPL = "made for Python 3.11 to 3.13. Install kbga-bench for one of these"


@pytest.fixture
def command(tmp_path):
    def run(lacking, *arguments, code=0):
        done = subprocess.run(
            [sys.executable, "-c", WITHOUT.format(lacking), *arguments],
            capture_output=True, text=True, cwd=tmp_path, check=False,
        )  # fmt: skip
        assert done.returncode == code, done.stderr
        return done

    return run


@pytest.fixture
def small_store(tmp_path):
    (tmp_path / "m.toml").write_text(
        'scenes = ["zigzag"]\nseeds = 1\n[[planner]]\nplanner = "visibility-graph"\n'
    )
    in_own_process("run", tmp_path / "m.toml", "--store", tmp_path / "s.db")
    return tmp_path / "s.db"


def test_without_ompl_its_planners_are_unavailable_and_no_other(command):
    rows = json.loads(command("ompl", "list", "planners", "--format", "json").stdout)
    lost = {row["name"] for row in rows if not row["available"]}
    assert lost == {row["name"] for row in rows if row["name"].startswith("ompl-")}
    reasons = {row["reason"] for row in rows if not row["available"]}
    assert reasons == {f"unavailable: it needs the package ompl, which is {OMPL}"}


def test_without_ompl_a_run_of_its_planner_says_so(command):
    said = command("ompl", "plan", "zigzag", "--planner", "ompl-rrtstar", code=2)
    assert OMPL in said.stderr


@pytest.mark.slow
def test_without_pyarrow_rows_are_exported_as_csv_and_parquet_says_how(command, small_store):
    assert command("pyarrow", "export", small_store, "rows", "--to", "csv").stdout
    for arguments in (("export", small_store, "rows"), ("results", small_store, "folder")):
        assert 'pip install "kbga-bench[parquet]"' in command("pyarrow", *arguments, code=2).stderr
