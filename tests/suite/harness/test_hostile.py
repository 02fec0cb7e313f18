"""One matrix of planners that do what strangers' planners may do, and one that behaves."""

import psutil
import pytest

from suite.harness.fleet import stop_server
from suite.harness.matrix import load_matrix
from suite.harness.run import run_matrix
from suite.store.read import read_events, read_first_measures, read_runs, read_traces
from suite.store.write import open_store

ENDLESS = "plan took more than 1 s and was killed."

# variant: how its run must end, and what its row must say.
WANTED = {
    "backdates": ("error", "reported improvements: a time of -1 s in a run"),
    "changes-obstacles": ("error", "FrozenInstanceError"),
    "changes-signals": ("solved", None),
    "changes-the-scene": ("error", "read-only"),
    "changes-the-world": ("solved", None),
    "cheats": ("invalid", "enters obstacle 1"),
    "closes-descriptors": ("crashed", "the process ended with exit code"),
    "comes-back-twice": ("solved", None),
    "counts-beyond-measure": ("error", "checks of the plan is 1000000"),
    "daemonizes": ("solved", None),
    "daemonizes-and-dies": ("crashed", "SIGSEGV"),
    "daemonizes-and-hangs": ("timed_out", ENDLESS),
    "daemonizes-in-warm-up": ("solved", None),
    "describes-in-words": ("error", "the measure 'phase' is 'repair'"),
    "eats-all-memory": ("out_of_memory", "above 600 MB, and was killed."),
    "eats-memory": ("out_of_memory", "MemoryError"),
    "exits": ("crashed", "exit code 3"),
    "exits-in-warm-up": ("crashed", "exit code 4"),
    "forks": ("solved", None),
    "gives-up": ("exhausted", None),
    "generates": ("error", "plan returned generator"),
    "hangs": ("timed_out", ENDLESS),
    "hangs-in-c": ("timed_out", ENDLESS),
    "hangs-in-kernel": ("timed_out", ENDLESS),
    "hangs-in-warm-up": ("timed_out", "warm-up took more than 3 s"),
    "interrupts": ("error", "KeyboardInterrupt"),
    "leaves-threads": ("solved", None),
    "leaves-its-session-and-hangs": ("timed_out", ENDLESS),
    "lets-a-daemon-eat": ("out_of_memory", "above 600 MB"),
    "moves-the-goal": ("error", "changed the start or the goal"),
    "prints": ("solved", None),
    "prints-a-little-into-pipes": ("timed_out", ENDLESS),
    "prints-into-pipes": ("error", "wrote into the pipe"),
    "raises": ("error", "RuntimeError: no luck today"),
    "raises-base-exception": ("error", "GeneratorExit"),
    "reports-as-numpy-does": ("solved", None),
    "reports-nan": ("error", "reported improvements: a cost of nan m"),
    "restarts-the-clock": ("error", "plan started the clock anew"),
    "returns-a-generator": ("invalid", "not a path"),
    "returns-a-wrong-shape": ("invalid", "(4, 3)"),
    "returns-nan": ("invalid", "must be finite"),
    "returns-none": ("error", "plan returned NoneType"),
    "says-half-a-character": ("error", "RuntimeError: no ? file"),
    "segfaults": ("crashed", "SIGSEGV"),
    "system-exits": ("error", "SystemExit: 3"),
    "visibility-graph": ("solved", None),
}


# All have all the time that a busy machine may take, but those that never end: they have a budget
# of wall time, to which these limits add little.
LIMITS = "[limits]\nwall_s = 600.0\nfactor = 1.0\ngrace_s = 0.5\nmemory_mb = 600\n"
HANGING = [name for name, (_, reason) in WANTED.items() if reason == ENDLESS]
# While the fork server tries it, others wait for it: here one that needs no time itself.
IN_WARM_UP = ("hangs-in-warm-up", "gives-up")
SHORT_WARM_UP = "warm_up_s = 3.0\n"


def matrix_text(scene, planners, limits):
    entries = "".join(
        f'[[planner]]\nplanner = "{name}"\n' + "budget = { wall_s = 0.5 }\n" * (name in HANGING)
        for name in planners
    )
    return f'scenes = ["{scene}"]\nseeds = 1\n{limits}{entries}'


@pytest.fixture
def rows(hostile, wall_file, tmp_path):
    file, store = tmp_path / "matrix.toml", tmp_path / "store.db"
    with open_store(store) as opened:
        for planners, limits in (
            ([name for name in WANTED if name not in IN_WARM_UP], LIMITS),
            (IN_WARM_UP, LIMITS + SHORT_WARM_UP),
        ):
            file.write_text(matrix_text(wall_file, planners, limits))
            stop_server()  # the next one tries these
            run_matrix(load_matrix(file), opened, jobs=2)
    # What one of them reports must not keep anybody from reading what the others did.
    read_first_measures(store)
    read_traces(store)
    counts = read_events(store)[["generation", "checks"]].dropna()
    assert counts.to_numpy().tolist() == [[1, 2]]
    return read_runs(store).set_index("variant")


def test_every_hostile_planner_is_one_row_and_leaves_nothing(rows):
    assert rows["status"].to_dict() == {name: status for name, (status, _) in WANTED.items()}
    for name, (_, reason) in WANTED.items():
        assert reason is None or reason in rows.loc[name, "reason"], name
    assert rows.loc["eats-all-memory", "stderr"] == "hungry"
    assert rows.loc["visibility-graph", "gap"] == pytest.approx(0.0, abs=1e-12)
    left = psutil.Process().children(recursive=True)
    # The fork server adopts what its children leave: it would be found here.
    assert [p for p in left if not {"-c", "-s"} & set(p.cmdline())] == []
    assert len([p for p in left if "forkserver" in " ".join(p.cmdline())]) == 1
