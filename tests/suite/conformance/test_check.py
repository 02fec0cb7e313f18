"""``kbga-bench check`` as authors run it: in a process of its own, which may hang or die."""

import json
import os
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from suite.commands.options import TextFormat
from suite.commands.planners import _check_several
from suite.conformance.check import check, check_each
from suite.errors import PluginError

BROKEN = Path(__file__).parents[1] / "conformance" / "broken_planners.py"
HANGING = """
import ctypes, os, time
from dataclasses import replace
from broken_planners import Detours

class HangsAtTheEnd(Detours):
    name = "hangs-at-the-end"

    def refuse(self, scene, query, budget):
        while scene.name == "seam":
            time.sleep(0.01)

class HangsInWarmUp(Detours):
    name = "exits-in-warm-up"

    def warm_up(self):
        os._exit(3)

class LeavesASpecialCase(Detours):
    name = "dies-of-few-checks"
    abilities = replace(Detours.abilities, budgets=frozenset({"generations", "checks"}))

    def plan(self, scene, query, budget, rng, recorder):
        if budget.checks is not None and budget.generations is None:
            os._exit(5)
        return super().plan(scene, query, budget, rng, recorder)

class Crashes(Detours):
    name = "crashes"

    def plan(self, scene, query, budget, rng, recorder):
        print("talks on standard output", flush=True)
        ctypes.string_at(0)
"""


@pytest.fixture(scope="module")
def hanging(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plugins")
    (folder / "broken_planners.py").write_text(BROKEN.read_text())
    file = folder / "hanging_planners.py"
    file.write_text(HANGING)
    return file


def kbga_bench(*arguments, code):
    done = subprocess.run(
        [sys.executable, "-c", "from suite.cli import main; main()", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == code, done.stderr
    return done


def test_a_planner_that_keeps_the_contract_ends_with_code_0_and_a_warning_does_not_fail():
    plugin = f"{BROKEN}:ClaimsALowerCost"
    done = kbga_bench(
        "check", "claims-a-lower-cost", "--plugin", plugin, "--set", "tries=20", code=0
    )
    assert "claims-a-lower-cost: keeps the contract, 33 rules" in done.stdout.splitlines()[-1]
    assert "kept      same-seed-same-path\n" in done.stdout
    assert "WARNING   claimed-cost-is-the-length\n" in done.stdout


def test_a_broken_rule_is_named_and_how_to_mend_it_and_the_code_is_1():
    arguments = ("check", "goes-straight", "--plugin", f"{BROKEN}:GoesStraight", "--format", "json")
    told = json.loads(kbga_bench(*arguments, code=1).stdout)
    assert (told["planner"], told["kept"]) == ("goes-straight", False)
    (broken,) = [rule for rule in told["rules"] if rule["result"] == "broken"]
    assert broken["rule"] == "path-is-free"
    assert "enters obstacle 1" in broken["found"]
    assert "first_collision" in broken["mend"]


@pytest.mark.slow
def test_a_planner_that_hangs_is_killed_and_the_run_is_named(hanging):
    arguments = ("check", "hangs-at-the-end", "--plugin", hanging, "--limit-s", 10)
    done = kbga_bench(*arguments, code=1)
    assert "BROKEN    runs-end-without-an-exception\n" in done.stdout
    assert "on 'seam' with seed 1 and Budget(generations=10): it did not end within 10 s" in (
        done.stdout
    )
    # The others are tested where they can be, and say where they were not.
    assert "kept      path-is-free: not tested on 'seam'\n" in done.stdout
    assert "kept      same-seed-same-path\n" in done.stdout
    assert "hangs-at-the-end: 1 of 33 rules broken, 6 do not apply.\n" in done.stdout
    left = [p for p in psutil.process_iter(["cmdline"]) if str(hanging) in str(p.info["cmdline"])]
    assert left == []


@pytest.mark.slow
def test_a_budget_that_ends_the_process_breaks_its_rule_and_no_other(hanging):
    done = kbga_bench("check", "dies-of-few-checks", "--plugin", hanging, code=1)
    assert "BROKEN    keeps-checks\n" in done.stdout
    assert "dies-of-few-checks: 1 of 31 rules broken, 8 do not apply.\n" in done.stdout


@pytest.mark.parametrize(
    ("planner", "rule", "end"),
    [
        ("crashes", "runs-end-without-an-exception", "died with signal SIGSEGV"),
        ("exits-in-warm-up", "warms-up", "died with exit code 3"),
    ],
)
def test_a_planner_that_dies_is_named_with_its_end(hanging, planner, rule, end):
    done = kbga_bench("check", planner, "--plugin", hanging, code=1)
    assert f"BROKEN    {rule}\n" in done.stdout
    assert end in done.stdout
    assert "standard output" not in done.stdout
    assert f"not tested same-seed-same-path: mend {rule} first.\n" in done.stdout
    assert "kept      same-seed-same-path" not in done.stdout


def test_what_cannot_be_loaded_or_set_is_an_error_and_no_broken_rule(hostile):
    with pytest.raises(PluginError, match=r"no planner 'kgba'\..*Did you mean 'kbga'"):
        check("kgba")
    with pytest.raises(PluginError, match="planner 'broken' is unavailable: ModuleNotFoundError"):
        check("broken")
    with pytest.raises(PluginError, match="no setting 'populaton'"):
        check("plain-ga", {"populaton": 3})
    assert os.environ.get("KBGA_BENCH_PLUGINS") is None


@pytest.mark.slow
def test_several_are_checked_and_each_has_a_line_at_the_end():
    plugins = ("--plugin", f"{BROKEN}:Detours", "--plugin", f"{BROKEN}:BadName")
    done = kbga_bench("check", "detours", "Bad Name", *plugins, code=1)
    assert done.stdout.count("same-seed-same-path\n") == 2
    assert done.stdout.splitlines()[-2:] == [
        "detours: keeps the contract, 33 rules, 6 do not apply.",
        "Bad Name: 1 of 33 rules broken, 6 do not apply.",
    ]


def test_of_several_one_that_cannot_be_loaded_is_named_and_stops_nobody(hostile):
    told = {c.planner: c for c in check_each(["broken", "visibility-graph", "broken"])}
    assert list(told) == ["broken", "visibility-graph"]
    assert (told["broken"].kept, told["visibility-graph"].kept) == (None, True)
    assert told["broken"].line.startswith("planner 'broken' is unavailable: ModuleNotFoundError")
    assert told["broken"].as_data["rules"] == []
    with pytest.raises(PluginError, match="no planner 'kgba'"):
        next(check_each(["visibility-graph", "kgba"]))


def test_one_that_is_named_and_unavailable_fails_and_one_that_is_only_there_does_not(hostile):
    for lenient in (True, False):
        assert _check_several(["broken"], 30.0, TextFormat.JSON, lenient=lenient) is lenient


def test_all_is_asked_for_without_names_and_settings_are_for_one():
    assert "or --all" in kbga_bench("check", code=2).stderr
    assert "or --all" in kbga_bench("check", "kbga", "--all", code=2).stderr
    assert "--set" in kbga_bench("check", "--all", "--set", "tries=3", code=2).stderr


@pytest.mark.slow
def test_all_planners_that_are_installed_keep_the_contract():
    told = json.loads(kbga_bench("check", "--all", "--format", "json", code=0).stdout)
    assert {"kbga", "ompl-rrtstar", "visibility-graph"} <= {each["planner"] for each in told}
    assert all(each["kept"] for each in told)
