"""``kbga-bench warm-up``: what it compiles, no later command has to."""

import json
import os

import pytest

from suite.errors import PluginError
from suite.harness.warm_up import EXACT, warm_up_each
from tests.suite.commands import in_own_process

BROKEN = '''
from dataclasses import dataclass
from suite.planner import Abilities, Plan, Planner, PlanStatus

@dataclass(frozen=True)
class Settings:
    pass

class Broken(Planner):
    """Whose warm-up fails."""

    name = "broken"
    Settings = Settings
    abilities = Abilities()

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.EXHAUSTED)

    def warm_up(self):
        raise OSError("no such compiler")
'''


def test_after_a_warm_up_a_plan_compiles_nothing(tmp_path):
    own = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    own.pop("KBGA_BENCH_TOLD_OF_COMPILING", None)
    first = in_own_process("warm-up", "grid-astar", env=own)
    assert [line.partition(":")[0] for line in first.out.splitlines()] == [EXACT, "grid-astar"]
    kernels = {file.name for file in tmp_path.rglob("*.nbc")}
    assert kernels
    in_own_process("plan", "zigzag", "--planner", "grid-astar", env=own)
    assert {file.name for file in tmp_path.rglob("*.nbc")} == kernels


def test_a_planner_that_fails_is_told_of_and_stops_no_other(tmp_path):
    file = tmp_path / "broken.py"
    file.write_text(BROKEN)
    done = in_own_process(
        "warm-up", "broken", "grid-astar", "--plugin", file, "--format", "json", code=1
    )
    _, broken, other = json.loads(done.out)
    assert broken["name"] == "broken"
    assert broken["problem"] == "OSError: no such compiler."
    assert other["name"] == "grid-astar"
    assert other["problem"] is None


def test_a_name_that_no_planner_has_ends_it_before_anything_is_compiled():
    with pytest.raises(PluginError, match="no planner 'kgba'"):
        next(warm_up_each(["kgba"]))
    assert in_own_process("warm-up", "kgba", code=2).out == ""
