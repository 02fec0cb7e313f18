"""What holds of KBGA in every dynamic scene: no crash, no undetected hit, and an end."""

from functools import lru_cache

import numpy as np
import pytest
import shapely
from shapely.affinity import translate

from kbga.plugin import KBGAPlanner
from suite.harness.prepared import named_stream
from suite.planner import Budget
from suite.scenes.dynamics import Dynamics, Removal, constant_speed
from suite.scenes.moving import TIME_LIMIT, moving
from suite.scenes.scene import Obstacle, Scene, make_scene
from suite.simulation.run import ENCLOSED, Simulation, simulate
from suite.simulation.settings import world_settings
from suite.simulation.trajectory import make_trajectory
from tests.suite.simulation.samples import DEEPER, leaves_the_room, sampled_hits

SAMPLE = 8
ALL = 1_000
FEW_GENERATIONS = Budget(generations=30)
"""For a single plan: where there is no path, KBGA goes on for as long as it may."""

SEEDS = [
    *range(SAMPLE),
    *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(SAMPLE, SAMPLE + ALL)),
]


@lru_cache(maxsize=SAMPLE)
def run(seed: int) -> Simulation:
    scene = moving(seed)
    query = scene.query()
    replanner = KBGAPlanner().replanner(named_stream(scene.name, query.name, "kbga", seed))
    settings = world_settings(scene, {"charge": "zero"})
    return simulate(scene, query, replanner, settings, FEW_GENERATIONS)


@pytest.mark.parametrize("seed", SEEDS)
def test_no_crash_no_undetected_hit_and_every_run_ends(seed):
    done = run(seed)
    check_that_it_ended(done)
    check_that_no_plan_failed(done)
    check_that_no_hit_is_undetected(done)
    check_that_no_hit_is_made_up(done)
    check_that_it_never_drove_into_what_it_always_knew(done)


def check_that_it_ended(done: Simulation) -> None:
    way = done.trajectory
    assert done.reached == np.array_equal(way.xy[-1], done.query.goal)
    assert done.reached or way.end == TIME_LIMIT
    assert (np.diff(way.times) >= 0.0).all()
    most = done.settings.speed * np.diff(way.times) + 2e-6
    assert (np.hypot(*np.diff(way.xy, axis=0).T) <= most).all(), "faster than it can be"


def check_that_no_plan_failed(done: Simulation) -> None:
    allowed = {"solved", "infeasible", "exhausted", ENCLOSED}
    failed = [(r.time, r.status, r.reason) for r in done.replans if r.status not in allowed]
    assert failed == []


def check_that_no_hit_is_undetected(done: Simulation) -> None:
    reported = {hit.obstacle: hit.time for hit in done.hits}
    for obstacle, time in sampled_hits(done.scene, done.trajectory).items():
        assert obstacle in reported, f"in {obstacle} at {time} s, not noticed"
        assert reported[obstacle] <= time, f"in {obstacle} at {time} s already"
    assert not leaves_the_room(done.scene, done.trajectory)


def check_that_no_hit_is_made_up(done: Simulation) -> None:
    obstacles = {o.name: o for o in done.scene.obstacles}
    for hit in done.hits:
        obstacle = obstacles[hit.obstacle]
        dynamics = obstacle.dynamics or Dynamics()
        assert dynamics.is_there(hit.time)
        there = translate(obstacle.polygon, *dynamics.offset(hit.time))
        assert there.distance(shapely.Point(hit.place)) < DEEPER


def check_that_it_never_drove_into_what_it_always_knew(done: Simulation) -> None:
    static = {o.name for o in done.scene.obstacles if o.dynamics is None}
    assert not static & {hit.obstacle for hit in done.hits}


def test_some_of_them_reach_the_goal_some_do_not_and_some_are_hit():
    runs = [run(seed) for seed in range(SAMPLE)]
    assert {done.reached for done in runs} == {True, False}
    assert {bool(done.hits) for done in runs} == {True, False}
    assert {replan.status for done in runs for replan in done.replans} >= {"solved", ENCLOSED}


# The oracle itself


def scene_of(dynamics: Dynamics | None) -> Scene:
    obstacle = Obstacle("box", shapely.box(0, 4, 2, 6), dynamics)
    return make_scene("drawn", shapely.box(0, 0, 20, 20), [obstacle], ((20, 20), (20, 0)))


@pytest.mark.parametrize(
    ("dynamics", "time"),
    [
        (Dynamics(constant_speed((1.0, 0.0), 0.0, 15.0)), 6.0),
        (Dynamics(constant_speed((1.0, 0.0), 0.0, 15.0), appears=7.0), 7.0),
        (Dynamics(constant_speed((1.0, 0.0), 0.0, 15.0), removal=Removal(time=5.0)), None),
        (Dynamics(constant_speed((1.0, 0.0), 0.0, 15.0), removal=Removal(None, (8, 5), 1)), None),
        (None, None),
    ],
)
def test_samples_find_what_comes_upon_a_robot_that_stands_still(dynamics, time):
    still = make_trajectory([(0, 8, 5), (20, 8, 5)])
    found = sampled_hits(scene_of(dynamics), still)
    assert found == ({} if time is None else {"box": pytest.approx(time, abs=0.01)})
