"""What planners print, and leave running, is kept out of what a command says and of its end."""

import json
import subprocess
import sys

import pytest

CODE = """
import atexit, ctypes, multiprocessing, os, threading, time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from suite.planner import Plan, Planner, PlanStatus

print("printed at import")
os.write(1, b"written at import\\n")
os.system("echo echoed at import")

@dataclass(frozen=True)
class LoudSettings:
    leaves: str = "nothing"

class Loud(Planner):
    name = "loud"
    Settings = LoudSettings

    def __init__(self, settings=None):
        super().__init__(settings)
        print("printed at construction")

    def plan(self, scene, query, budget, rng, recorder):
        print("printed in plan")
        ctypes.CDLL(None).puts(b"put by C")
        atexit.register(print, "printed at exit")
        if self.settings.leaves == "a thread":
            threading.Thread(target=time.sleep, args=(3600,)).start()
        if self.settings.leaves == "a process":
            multiprocessing.Process(target=time.sleep, args=(3600,)).start()
        if self.settings.leaves == "a pool":
            Loud.pool = ProcessPoolExecutor(1)
            Loud.pool.submit(time.sleep, 3600)
        if self.settings.leaves == "an exit handler":
            atexit.register(time.sleep, 3600)
        return Plan(PlanStatus.EXHAUSTED)
"""


@pytest.fixture(scope="module")
def loud(tmp_path_factory):
    file = tmp_path_factory.mktemp("plugin") / "loud.py"
    file.write_text(CODE)
    return file


def kbga_bench(*arguments, code):
    done = subprocess.run(
        [sys.executable, "-m", "suite", *map(str, arguments)], capture_output=True, text=True
    )
    assert done.returncode == code, done.stderr
    return done


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("plan", "{wall}", "--planner", "loud"), 1),
        (("list", "planners"), 0),
        pytest.param(("simulate", "{wall}", "--planner", "loud", "--time-limit", "1"), 1,
                     marks=pytest.mark.slow),
        pytest.param(("check", "loud"), 1, marks=pytest.mark.slow),
    ],
)  # fmt: skip
def test_json_is_all_there_is_on_standard_output_whatever_a_planner_prints(
    loud, wall_file, arguments, code
):
    words = [word.format(wall=wall_file) for word in arguments]
    done = kbga_bench(*words, "--plugin", loud, "--format", "json", code=code)
    json.loads(done.stdout)
    for printed in ("printed", "written", "echoed"):
        assert f"{printed} at import" in done.stderr


@pytest.mark.slow
def test_a_row_again_is_json_and_nothing_else(loud, wall_file, tmp_path):
    matrix, store = tmp_path / "m.toml", tmp_path / "s.db"
    text = f'scenes = ["{wall_file}"]\nseeds = 1\n[[planner]]\nplanner = "loud"\n'
    matrix.write_text(text)
    told = kbga_bench("run", matrix, "--store", store, "--plugin", loud, code=0).stdout
    assert told.startswith("1 of 1 runs are in the store")
    words = ("rerun", store, "wall/loud/0", "--format", "json", "--plugin", loud)
    assert json.loads(kbga_bench(*words, code=0).stdout)["status"] == "exhausted"


@pytest.mark.parametrize(
    ("leaves", "words"),
    [
        ("a thread", "1 thread still ran"),
        pytest.param("a process", "1 process still ran", marks=pytest.mark.slow),
        ("a pool", "1 thread and 1 process still ran"),
        pytest.param("an exit handler", "", marks=pytest.mark.slow),
    ],
)
def test_plan_ends_whatever_a_planner_leaves_running(loud, wall_file, leaves, words):
    told = ("--plugin", loud, "--set", f"leaves={leaves}", "--format", "json")
    done = kbga_bench("plan", wall_file, "--planner", "loud", *told, code=1)
    assert json.loads(done.stdout)["status"] == "exhausted"
    assert words in done.stderr


def test_a_closed_standard_output_is_no_fault():
    command = f"{sys.executable} -m suite list matrices >&-"
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


SLOW_TO_TAKE_DOWN = """
import sys, time
from suite.processes import farewell

class Slow:
    def __del__(self, sleep=time.sleep):
        sleep(20)

farewell.FAREWELL_S = 1
kept = Slow()
with farewell.ending(print):
    sys.exit(3)
"""


def test_a_command_keeps_its_exit_code_where_taking_down_the_interpreter_takes_long():
    # As on a busy machine: four runs of a matrix were done, and the code was that of an alarm.
    done = subprocess.run([sys.executable, "-c", SLOW_TO_TAKE_DOWN], timeout=600, check=False)
    assert done.returncode == 3
