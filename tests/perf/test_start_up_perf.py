"""How long the command line takes to answer, with compiled kernels at hand and without."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = str(Path(sys.executable).with_name("kbga-bench"))


@pytest.fixture(scope="module")
def answer(tmp_path_factory):
    """The command, with a cache that is empty at first."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path_factory.mktemp("cache"))}

    def run() -> None:
        subprocess.run(
            [PROGRAM, "plan", "zigzag", "--planner", "kbga"],
            check=True, capture_output=True, env=environment,
        )  # fmt: skip

    return run


def test_answer_from_an_empty_cache(benchmark, answer):
    benchmark.group = "kbga-bench plan zigzag"
    benchmark.pedantic(answer, rounds=1)
    benchmark.extra_info.update(measure="start-up, first compilation")


def test_answer_from_a_warm_cache(benchmark, answer):
    benchmark.group = "kbga-bench plan zigzag"
    benchmark.pedantic(answer, rounds=5, warmup_rounds=1)
    benchmark.extra_info.update(measure="start-up, warm cache")
