"""OMPL's anytime planners live through real maps, with settings for maps and robots with a size."""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.suite.scenes.real_maps import FOLDER, MISSING, REASON

pytestmark = pytest.mark.skipif(MISSING, reason=REASON)

ROOT = Path(__file__).parents[3]
MATRIX = tomllib.loads((ROOT / "suite/harness/matrices/real-maps.toml").read_text("utf-8"))
TUNED = {
    v["planner"]: v.get("settings", {})
    for v in MATRIX["planner"]
    if v["planner"].startswith("ompl-")
}

ORDINARY = ("ompl-aorrtc", "Denver_1_256.map@radius=0.3")
"""The one that died on such maps, before rooms were scaled; all others are slow tests."""

# A process of its own for each planner; in one that dies, nothing is printed.
PROGRAM = """
import json, sys, numpy as np
from suite.harness.prepared import build_planner
from suite.planner import Budget, PlanStatus, Recorder
from suite.referee.path import Referee
from suite.scenes.catalogue import load_scene
from suite.scenes.samples import random_queries
planner = build_planner(sys.argv[1], json.loads(sys.argv[2]))
scene, rng, ends = load_scene(sys.argv[3]), np.random.default_rng(4), []
for query in random_queries(scene, 8, seed=3):
    made = planner.plan(scene, query, Budget(checks=4000), rng, Recorder())
    free = made.path is None or Referee(scene).judge(query, made.path).valid
    ends.append(str(made.status) if free else "invalid")
print(json.dumps(ends))
"""


@pytest.mark.parametrize(
    ("planner", "name"),
    [
        pytest.param(
            planner, name,
            marks=[] if (planner, name) == ORDINARY else pytest.mark.slow,
        )
        for planner in TUNED
        for name in (
            "Denver_1_256.map", "Denver_1_256.map@radius=0.3",
            "ironharvest_scene_mp_2p_01.mesh", "ironharvest_scene_mp_2p_01.mesh@radius=0.4",
        )
    ],
)  # fmt: skip
def test_it_answers_eight_queries_with_free_paths(planner, name):
    printed = subprocess.run(
        [sys.executable, "-c", PROGRAM, planner, json.dumps(TUNED[planner]), f"{FOLDER}/{name}"],
        capture_output=True, text=True, check=True, cwd=ROOT,
    )  # fmt: skip
    ends = json.loads(printed.stdout)
    assert len(ends) == 8
    assert set(ends) <= {"solved", "exhausted"}
    assert ends.count("solved") >= 4  # whatever the settings that a sweep puts there
