"""CMA-ES on waypoints: its cost is what it says, and its budget and its stream are kept."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString

from baselines.cma_es import CmaEsPlanner, CmaEsSettings, lengths
from suite.planner import Budget, Plan, PlanStatus, Recorder
from suite.scenes.catalogue import load_scene
from suite.scenes.scene import Scene, make_scene
from tests.strategies import SIDE, scenes

ROOM = shapely.box(0, 0, 10, 10)
WALL = make_scene("wall", ROOM, [shapely.box(4, 0, 6, 8)], ((1, 1), (9, 1)))
BOX = make_scene("box", ROOM, [shapely.box(4, 2, 6, 7)], ((1, 5), (9, 5)))


def plan(budget: Budget, seed: int = 1, scene: Scene = BOX, **settings) -> Plan:
    planner, rng = CmaEsPlanner(CmaEsSettings(**settings)), np.random.default_rng(seed)
    return planner.plan(scene, scene.query(), budget, rng, Recorder())


@settings(max_examples=40)
@given(scenes(), st.integers(0, 2**32))
def test_the_length_inside_obstacles_is_shapelys(scene, seed):
    path = np.random.default_rng(seed).uniform(-1.0, SIDE + 1.0, (5, 2))
    whole, inside = lengths(path, scene.arrays)
    assert whole == pytest.approx(LineString(path).length)
    legs = [LineString(leg) for leg in pairwise(path)]
    wanted = sum(leg.intersection(scene.arrangement.solid).length for leg in legs)
    assert inside == pytest.approx(wanted, abs=1e-9)


def test_what_runs_along_an_edge_is_outside():
    path = np.array([[1.0, 8.0], [9.0, 8.0], [9.0, 1.0]])
    assert lengths(path, WALL.arrays) == (15.0, 0.0)


def test_it_finds_the_way_around_a_box_to_within_a_hundredth():
    made = plan(Budget(generations=400), waypoints=2)
    assert made.status is PlanStatus.SOLVED
    assert made.claimed_cost == pytest.approx(2 + 2 * np.hypot(3, 2), rel=0.01)
    assert 0 < made.generation_of_best <= made.generations <= 400


def test_same_seed_same_path_and_another_seed_another():
    first, again, other = (plan(Budget(generations=60), seed) for seed in (1, 1, 2))
    assert np.array_equal(first.path, again.path)
    assert first.checks == again.checks
    assert not np.array_equal(first.path, other.path)


def test_with_a_small_penalty_the_cheapest_path_goes_through_the_wall_and_is_not_returned():
    # Through it: 8 m and 0.1 times 2 m; over it: 17.2 m.
    made = plan(Budget(generations=200), scene=WALL, penalty=0.1, sigma=0.01, restarts=0)
    assert (made.status, made.path) == (PlanStatus.EXHAUSTED, None)


def test_it_starts_again_with_twice_the_population_until_it_may_not():
    budget, few = Budget(generations=10_000), {"waypoints": 1, "stagnation": 5}
    once, twice = (plan(budget, restarts=n, **few) for n in (0, 1))
    assert once.generations < twice.generations < 10_000
    # One waypoint makes two segments; 4 + int(3 ln 2) = 6 paths a generation, then 12.
    assert once.checks >= 2 * 6 * once.generations
    later = twice.generations - once.generations
    assert twice.checks - once.checks >= 2 * 12 * later


def test_the_maze_is_beyond_it_and_it_says_exhausted():
    made = plan(Budget(generations=100), scene=load_scene("maze"))
    assert made.status is PlanStatus.EXHAUSTED
    assert made.claimed_cost is None


@pytest.mark.parametrize(
    ("setting", "value", "rule"),
    [
        ("waypoints", 0, "1 or more"),
        ("population_size", 1, "2 or more"),
        ("restarts", -1, "0 or more"),
        ("penalty", 0.0, "a number above 0"),
        ("sigma", float("nan"), "a number above 0"),
    ],
)
def test_a_bad_setting_is_refused_by_name(setting, value, rule):
    with pytest.raises(ValueError, match=f"{setting} is {value}. It must be {rule}"):
        CmaEsSettings(**{setting: value})


@pytest.mark.parametrize("factor", [2.0**-10, 2.0**17])
def test_a_room_of_another_size_has_the_same_path(factor):
    # The package takes a first step of more than 1e4 for divergence, in metres or whatever.
    scaled = make_scene(
        "box",
        shapely.box(0, 0, 10 * factor, 10 * factor),
        [shapely.box(*(factor * x for x in (4, 2, 6, 7)))],
        ((factor, 5 * factor), (9 * factor, 5 * factor)),
    )
    here, there = (plan(Budget(generations=60), scene=scene) for scene in (BOX, scaled))
    assert here.status is there.status is PlanStatus.SOLVED
    # Where a scene is snapped, a tenth of a nanometre counts; the search does not.
    assert there.claimed_cost == pytest.approx(factor * here.claimed_cost, rel=1e-6)
