from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from suite.harness.matrix import load_matrix
from suite.harness.run import Which, interleaved, run_matrix
from suite.plugins.from_file import name_plugins
from suite.store.read import read_paths, read_runs, read_sessions
from suite.store.status import status
from suite.store.write import open_store
from tests.suite.harness.records import make_cell


@pytest.fixture
def matrix(hostile, wall_file, tmp_path):
    def make(*planners, seeds=2):
        """Those that never end have half a second, the others all the time that they need."""
        file = tmp_path / "matrix.toml"
        limits = "wall_s = 600.0\nfactor = 1.0\ngrace_s = 0.4\n"
        text = f'scenes = ["{wall_file}"]\nseeds = {seeds}\n[limits]\n{limits}'
        text += "".join(
            f'[[planner]]\nplanner = "{planner}"\n'
            + "budget = { wall_s = 0.1 }\n" * (planner == "hangs")
            for planner in planners
        )
        file.write_text(text)
        return load_matrix(file)

    return make


@pytest.fixture
def run(tmp_path):
    file = tmp_path / "store.db"

    def run_it(matrix, **options):
        with open_store(file) as store:
            return run_matrix(matrix, store, **{"jobs": 2} | options)

    run_it.file = file
    return run_it


def test_every_cell_becomes_a_row_whatever_its_planner_does(matrix, run):
    wanted = {
        "visibility-graph": "solved",
        "hangs": "timed_out",
        "exits": "crashed",
        "segfaults": "crashed",
        "raises": "error",
        "refuses": "refused",
        "cheats": "invalid",
        "gives-up": "exhausted",
        "broken": "error",
        "wrong-signature": "error",
        "newer-interface": "error",
        "no-plan": "error",
    }
    end = run(matrix(*wanted, seeds=1))
    runs = read_runs(run.file).set_index("variant")
    assert runs["status"].to_dict() == wanted
    assert list(runs.index) == list(wanted)
    assert (end.wanted, end.done, end.found, end.failed) == (12, 12, 0, 9)
    for planner in ("broken", "wrong-signature", "newer-interface", "no-plan"):
        assert f"planner '{planner}' is unavailable: " in runs.loc[planner, "reason"]


def test_a_second_run_runs_only_what_is_missing(matrix, run):
    run(matrix("wanderer"))
    before = read_runs(run.file)
    end = run(matrix("wanderer", seeds=3))
    after = read_runs(run.file)
    assert (end.found, end.done) == (2, 3)
    kept = after[after["key"].isin(before["key"])].reset_index(drop=True)
    assert kept["started_at"].equals(before["started_at"])
    assert kept["wall_s"].equals(before["wall_s"])
    assert len(read_sessions(run.file)) == 2
    assert run(matrix("wanderer", seeds=3)).done == 3
    assert len(read_sessions(run.file)) == 2


STRAIGHT = """
from suite.planner import Abilities, Plan, Planner, PlanStatus
class Straight(Planner):
    name = "straight"
    abilities = Abilities()
    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.SOLVED, [query.start, query.goal])
"""


def test_a_matrix_brings_its_own_planners_though_processes_were_started_before(
    matrix, run, tmp_path
):
    run(matrix("gives-up", seeds=1))
    (tmp_path / "straight.py").write_text(STRAIGHT)
    file = tmp_path / "own.toml"
    text = (tmp_path / "matrix.toml").read_text()
    file.write_text('plugins = ["straight.py"]\n' + text.replace('"gives-up"', '"straight"'))
    try:
        run(load_matrix(file))
    finally:
        name_plugins([])
    row = read_runs(run.file).set_index("variant").loc["straight"]
    assert row["status"] == "invalid"  # through the wall
    assert (row["distribution"], row["version"][:7]) == ("straight.py", "sha256-")


def test_one_more_planner_leaves_other_rows_unchanged(matrix, run, tmp_path):
    run(matrix("wanderer"))
    alone = read_paths(run.file)
    run.file.rename(tmp_path / "alone.db")
    for suffix in ("-wal", "-shm"):
        (tmp_path / f"store.db{suffix}").unlink(missing_ok=True)
    run(matrix("careless", "wanderer", "visibility-graph"))
    together = read_paths(run.file)
    assert len(alone) == 2
    for key, path in alone.items():
        np.testing.assert_array_equal(together[key], path)


def test_progress_is_told_of_what_runs_and_what_came(matrix, run):
    seen = []
    run(
        matrix("wanderer"),
        on_progress=lambda p: seen.append((p.done, tuple(p.running))),
    )
    assert seen[0] == (0, ())
    assert seen[-1] == (2, ())
    assert any("wall / wanderer / seed" in label for _, running in seen for label in running)


def test_any_executor_will_do_and_is_left_open(matrix, run):
    with ThreadPoolExecutor(1) as mine:
        assert run(matrix("wanderer"), executor=mine).done == 2
        assert mine.submit(int, "7").result() == 7


def test_an_interruption_kills_what_runs_and_keeps_what_is_done(matrix, run):
    def interrupt(progress):
        if progress.done == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(matrix("wanderer", "hangs", seeds=3), on_progress=interrupt)
    assert len(read_runs(run.file)) == 1


def test_the_order_of_runs_is_random_and_always_the_same():
    cells = [make_cell(seed=s) for s in range(20)]
    first, second = interleaved(cells), interleaved(cells)
    assert [c.seed for c in first] == [c.seed for c in second]
    assert [c.seed for c in first] != list(range(20))
    assert sorted(c.seed for c in first) == list(range(20))


def test_a_session_says_where_its_rows_come_from(matrix, run):
    run(matrix("wanderer"))
    (session,) = read_sessions(run.file)
    assert session["matrix"] == "matrix"
    (version,) = session["planner_distributions"].values()
    assert version.startswith("1.0 sha256-")
    assert {"numpy", "numba", "shapely"} <= set(session["versions"])
    assert session["cores"] >= 1
    assert session["memory_bytes"] > 0


def test_forced_runs_replace_their_rows(matrix, run):
    run(matrix("visibility-graph"))
    before = read_runs(run.file)
    end = run(matrix("visibility-graph"), which=Which.ALL)
    assert (end.found, end.done) == (0, 2)
    after = read_runs(run.file)
    assert after["key"].tolist() == before["key"].tolist()
    assert set(after["session"]).isdisjoint(before["session"])
    assert len(read_paths(run.file)) == 2


def test_only_failed_runs_are_run_again(matrix, run):
    run(matrix("visibility-graph", "raises", "gives-up"))
    before = read_runs(run.file).set_index("variant")["session"]
    end = run(matrix("visibility-graph", "raises", "gives-up"), which=Which.FAILED)
    assert (end.found, end.done, end.failed) == (4, 6, 2)
    after = read_runs(run.file).set_index("variant")["session"]
    changed = sorted(set(after[(after != before).to_numpy()].index))
    assert changed == ["raises"]


def test_every_planner_has_its_own_count(matrix, run):
    end = run(matrix("visibility-graph", "raises"))
    tallies = {name: (t.wanted, t.done, t.succeeded, t.failed) for name, t in end.planners.items()}
    assert tallies == {"visibility-graph": (2, 2, 2, 0), "raises": (2, 2, 0, 2)}


def test_what_is_wanted_is_written_down_before_the_first_run(matrix, run):
    def stop(progress):
        if progress.running:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(matrix("visibility-graph"), on_progress=stop)
    found = status(run.file)
    assert (found["wanted"], found["missing"]) == (2, 2)
