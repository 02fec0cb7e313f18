import os

import pytest

from suite.processes import cores
from suite.processes.cores import honest_jobs, own_core


@pytest.fixture
def four_processors(monkeypatch, tmp_path):
    """Two cores of two hyperthreads: 0 and 2, 1 and 3."""
    for processor, siblings in enumerate(("0,2", "1,3", "0,2", "1,3")):
        (tmp_path / str(processor)).write_text(siblings + "\n")
    monkeypatch.setattr(cores, "TOPOLOGY", f"{tmp_path}/{{}}")
    monkeypatch.setattr(cores, "QUOTA", tmp_path / "cpu.max")
    monkeypatch.setattr(cores, "honest_cores", cores.honest_cores.__wrapped__)

    def allow(*processors):
        monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(processors), raising=False)
        return tmp_path / "cpu.max"

    return allow


@pytest.mark.parametrize(
    ("allowed", "honest"),
    [((0, 1, 2, 3), (0, 1)), ((2, 3), (2, 3)), ((0, 2), (0,)), ((1, 2, 3), (1, 2))],
)
def test_hyperthreads_of_one_core_count_once(four_processors, allowed, honest):
    four_processors(*allowed)
    assert cores.honest_cores() == honest
    assert honest_jobs() == len(honest)


@pytest.mark.parametrize(
    ("quota", "jobs"), [("max 100000", 2), ("150000 100000", 1), ("50000 100000", 1)]
)
def test_a_container_s_quota_of_time_counts(four_processors, quota, jobs):
    four_processors(0, 1, 2, 3).write_text(quota + "\n")
    assert honest_jobs() == jobs


def test_here_is_at_least_one_core():
    assert honest_jobs() >= 1


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system can't pin")
def test_a_core_is_given_to_one_run_at_a_time_and_then_to_the_next(monkeypatch):
    mine = (10_000 + os.getpid(), 20_000_000 + os.getpid())
    monkeypatch.setattr(cores, "honest_cores", lambda: mine)
    with own_core() as first, own_core() as second, own_core() as none_left:
        assert (first, second, none_left) == (*mine, None)
    with own_core() as again:
        assert again == mine[0]
