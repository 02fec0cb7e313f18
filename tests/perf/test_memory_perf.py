"""What a run of KBGA allocates beyond its scene: numpy and Python, and compiled code."""

import gc
import tracemalloc

import numba.core.runtime
import pytest
from numba.core.runtime import rtsys

from suite.planner import Budget
from tests.perf.series import SCENES, plan, planner

FEW, MANY = 20, 120


@pytest.fixture
def allocations():
    """The number of allocations of compiled code so far."""
    numba.core.runtime._nrt_python.memsys_enable_stats()
    yield lambda: rtsys.get_allocation_stats().alloc
    numba.core.runtime._nrt_python.memsys_disable_stats()


@pytest.mark.parametrize("scene_name", SCENES)
def test_memory_of_a_whole_run(benchmark, scene_name):
    benchmark.group = "whole run, allocations traced"
    runner = planner("kbga-plus")
    plan(runner, scene_name, 0)
    gc.collect()
    tracemalloc.start()
    benchmark.pedantic(plan, args=(runner, scene_name, 1), rounds=1)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    benchmark.extra_info.update(measure="memory", scene=scene_name, peak_bytes=peak)


@pytest.mark.parametrize("scene_name", SCENES)
def test_allocations_of_a_generation(benchmark, allocations, scene_name):
    """A longer run allocates as much as a shorter one, if the loop allocates nothing."""
    benchmark.group = "120 generations, allocations counted"
    runner = planner("kbga-plus", stagnation=1000, max_generations=1000)
    made = []

    def count_allocations(generations: int) -> None:
        before = allocations()
        plan(runner, scene_name, 0, Budget(generations=generations))
        made.append(allocations() - before)

    count_allocations(FEW)
    benchmark.pedantic(count_allocations, args=(MANY,), rounds=1)
    benchmark.extra_info.update(
        measure="allocations",
        scene=scene_name,
        per_generation=(made[1] - made[0]) / (MANY - FEW),
    )
