"""All baselines that keep a budget of time keep one of CPU time; none asks more than it may."""

import numpy as np
import pytest

from suite.planner import Budget, PlanStatus, Recorder
from suite.plugins.discovery import load_planner
from suite.scenes.catalogue import load_scene

BY_THE_CLOCK = ("cmaes", "grid-astar", "extremitypathfinder", "ompl-rrtstar", "ompl-shortcut")
BY_CHECKS = (
    "cmaes", "grid-astar", "ompl-aorrtc", "ompl-bfmt", "ompl-bitstar", "ompl-fmt",
    "ompl-informedrrtstar", "ompl-prm", "ompl-prmstar", "ompl-rrt", "ompl-rrtconnect",
    "ompl-rrtstar", "ompl-shortcut", "ompl-sorrtstar",
)  # fmt: skip


def plan(name: str, budget: Budget, recorder: Recorder):
    planner, scene = load_planner(name)(), load_scene("clustered")
    planner.warm_up()
    recorder.start_clock()
    return planner.plan(scene, scene.query(), budget, np.random.default_rng(3), recorder)


@pytest.mark.parametrize("name", BY_THE_CLOCK)
def test_planners_that_keep_wall_time_keep_cpu_time_too(name):
    assert {"wall_s", "cpu_s"} <= load_planner(name).abilities.budgets


@pytest.mark.parametrize("name", BY_THE_CLOCK)
@pytest.mark.parametrize("clock", ["wall_s", "cpu_s"])
def test_a_clock_that_has_run_out_ends_the_run(name, clock):
    class Late(Recorder):
        pass

    setattr(Late, clock, lambda _: 100.0)
    made = plan(name, Budget(**{clock: 99.0}), Late())
    assert (made.status, made.path) == (PlanStatus.EXHAUSTED, None)


@pytest.mark.parametrize("name", BY_THE_CLOCK)
def test_the_other_clock_does_not_end_the_run(name):
    class Late(Recorder):
        def wall_s(self) -> float:
            return 100.0

    made = plan(name, Budget(cpu_s=3.0, checks=30_000), Late())
    assert made.status is not PlanStatus.EXHAUSTED or made.checks > 20_000


@pytest.mark.parametrize("name", BY_CHECKS)
@pytest.mark.parametrize("checks", [500, 3000])
def test_a_budget_of_checks_is_kept(name, checks):
    recorder = Recorder()
    made = plan(name, Budget(checks=checks), recorder)
    assert made.checks <= checks
    assert made.details.get("state_checks", 0) <= made.checks
    assert all(i.checks <= checks for i in recorder.improvements)


@pytest.mark.parametrize("name", ["cmaes", "ompl-rrtstar", "ompl-prmstar", "ompl-shortcut"])
@pytest.mark.parametrize("checks", [500, 3000])
def test_a_search_that_goes_on_uses_its_budget_of_checks_up_to_2_percent(name, checks):
    made = plan(name, Budget(checks=checks), Recorder())
    assert made.checks >= 0.98 * checks
