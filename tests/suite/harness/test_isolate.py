import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import replace
from multiprocessing.util import get_temp_dir

import numpy as np
import psutil
import pytest

from suite.harness import fork_server
from suite.harness.cell import build_planner
from suite.harness.fleet import stop_server
from suite.harness.fork_server import Warmth
from suite.harness.isolate import run_isolated
from suite.harness.matrix import Limits
from suite.harness.single import cell_for
from suite.planner import PlanStatus
from suite.processes.cores import honest_cores

AMPLE = Limits(wall_s=600.0, warm_up_s=600.0)
"""For those who end by themselves, however busy the machine is."""

SHORT = replace(AMPLE, wall_s=0.5)
"""For those who never do."""


@pytest.fixture
def run(hostile, wall_file):
    def run_planner(name, seed=0, limits=AMPLE):
        return run_isolated(cell_for(str(wall_file), name, seed=seed), limits, Warmth())

    return run_planner


def servers():
    children = psutil.Process().children()
    return [p for p in children if "multiprocessing.forkserver" in " ".join(p.cmdline())]


def test_a_run_comes_back_whole(run):
    record = run("wanderer")
    assert record.status is PlanStatus.SOLVED
    assert len(record.improvements) == 2
    assert record.path.shape[1] == 2
    assert record.stderr == ""


def test_another_process_finds_the_same_path(run):
    np.testing.assert_array_equal(run("wanderer").path, run("wanderer").path)


def test_another_fork_server_gives_strings_the_same_hashes(run, monkeypatch):
    monkeypatch.delenv("PYTHONHASHSEED", raising=False)
    one = run("salted").path
    stop_server()
    np.testing.assert_array_equal(run("salted").path, one)


def test_a_salt_that_the_user_gives_is_kept(run, monkeypatch):
    one = run("salted").path
    stop_server()
    monkeypatch.setenv("PYTHONHASHSEED", "7")
    other = run("salted").path
    stop_server()  # the next one is for everybody
    assert not np.array_equal(one, other)


@pytest.mark.parametrize(
    ("planner", "status", "reason"),
    [
        ("raises", PlanStatus.ERROR, "no luck today"),
        ("exits", PlanStatus.CRASHED, "ended with exit code 3"),
        ("segfaults", PlanStatus.CRASHED, "was ended by SIGSEGV"),
        ("exits-in-warm-up", PlanStatus.CRASHED, "ended with exit code 4"),
        ("prints", PlanStatus.SOLVED, None),
        ("cheats", PlanStatus.INVALID, "enters obstacle 1"),
    ],
)
def test_whatever_a_planner_does_is_one_row(run, planner, status, reason):
    record = run(planner)
    assert record.status is status
    assert reason is None or reason in record.reason


@pytest.mark.parametrize("planner", ["hangs", "hangs-in-c"])
def test_who_does_not_end_is_killed_at_the_limit(run, planner):
    record = run(planner, limits=SHORT)
    assert record.status is PlanStatus.TIMED_OUT
    assert record.reason == "plan took more than 0.5 s and was killed."


def test_warming_up_has_a_limit_of_its_own(run):
    record = run("hangs-in-warm-up", limits=replace(AMPLE, warm_up_s=0.5))
    assert record.status is PlanStatus.TIMED_OUT
    assert record.reason.startswith("warm-up took more than 0.5 s")


def test_the_last_words_of_a_crashed_process_are_kept(run):
    assert run("exits").stderr == "going down"


@pytest.mark.parametrize("planner", ["forks", "daemonizes", "daemonizes-and-dies"])
def test_a_process_that_a_planner_leaves_behind_is_killed(run, planner):
    run("wanderer")
    (server,) = servers()
    assert run(planner).status in (PlanStatus.SOLVED, PlanStatus.CRASHED)
    # It adopts whatever loses its parent.
    assert server.children(recursive=True) == []


def test_a_planner_that_draws_from_the_global_generator_gets_another_stream_in_each_run(run):
    one, again, other = run("careless", seed=1), run("careless", seed=1), run("careless", seed=2)
    np.testing.assert_array_equal(one.path, again.path)
    assert not np.array_equal(one.path, other.path)


def test_what_a_planner_changes_in_its_process_is_not_there_in_the_next(run):
    before = run("looks-around").details
    assert run("changes-the-world").status is PlanStatus.SOLVED
    after = run("looks-around").details
    assert {k: v for k, v in after.items() if k != "core"} == {
        k: v for k, v in before.items() if k != "core"
    }


def test_a_run_has_one_thread(run):
    details = run("looks-around").details
    assert (details["threads"], details["numba_threads"]) == (1.0, 1.0)


def test_a_run_stays_on_the_core_that_it_was_given(run, monkeypatch):
    core = max(honest_cores())
    monkeypatch.setattr("suite.harness.isolate.own_core", lambda: nullcontext(core))
    details = run("looks-around").details
    assert (details["cores"], details["core"]) == (1.0, core)


def test_a_planner_that_kills_the_fork_server_does_not_stop_the_others(run):
    assert run("kills-its-parent").status is PlanStatus.CRASHED
    assert run("wanderer").status is PlanStatus.SOLVED


def test_a_fork_server_that_was_stopped_is_woken(run):
    run("wanderer")
    (server,) = servers()
    server.suspend()
    assert run("wanderer").status is PlanStatus.SOLVED
    assert servers() == [server]


def test_a_fork_server_whose_socket_was_deleted_is_replaced_when_the_other_runs_have_ended(run):
    run("wanderer")
    (server,) = servers()
    with ThreadPoolExecutor(1) as other:
        slow = other.submit(run, "sleeper", limits=Limits(warm_up_s=120.0))
        while not server.children():
            pass
        shutil.rmtree(get_temp_dir())
        assert run("wanderer").status is PlanStatus.SOLVED
        assert slow.result().status is PlanStatus.SOLVED
    assert servers() != [server]


@pytest.mark.slow
def test_a_record_that_is_too_large_is_a_row_that_says_so(run):
    record = run("sends-too-much", limits=Limits(warm_up_s=120.0, memory_mb=6000))
    assert record.status is PlanStatus.ERROR
    assert record.reason == (
        "its record is too large (288 MB, above 268 MB): shorten the path, or report less."
    )


def test_memory_counts_for_all_processes_of_a_run_together(run):
    record = run("lets-a-daemon-eat", limits=replace(AMPLE, memory_mb=400.0))
    assert record.status is PlanStatus.OUT_OF_MEMORY
    assert record.reason.startswith("plan held")


def test_warming_up_has_the_same_limit_on_memory(run):
    record = run("eats-in-warm-up", limits=replace(AMPLE, memory_mb=400.0))
    assert record.status is PlanStatus.OUT_OF_MEMORY
    assert record.reason.startswith("warm-up held")


def test_a_planner_that_takes_the_memory_when_the_fork_server_tries_it_stays_cold(hostile):
    planner = build_planner("eats-in-warm-up", {})
    assert not fork_server._survives(planner.warm_up, limit_s=600.0, memory_bytes=400_000_000)


def test_runs_leave_the_environment_and_the_folder_of_the_harness_alone(run):
    before = dict(os.environ), os.getcwd()  # noqa: PTH109
    run("wanderer")
    assert (dict(os.environ), os.getcwd()) == before  # noqa: PTH109


@pytest.mark.slow
def test_many_threads_may_wait_for_many_processes(run):
    planners = ["wanderer", "exits", "segfaults", "raises"] * 5
    with ThreadPoolExecutor(8) as threads:
        records = list(threads.map(run, planners))
    wanted = {"wanderer": "solved", "exits": "crashed", "segfaults": "crashed", "raises": "error"}
    assert [str(r.status) for r in records] == [wanted[p] for p in planners]
    codes = {r.reason for p, r in zip(planners, records, strict=True) if p == "exits"}
    assert codes == {"the process ended with exit code 3."}
