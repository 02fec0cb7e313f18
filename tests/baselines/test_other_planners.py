"""Other people's algorithms behind our door: what all of them promise."""

import importlib
import sys

import numpy as np
import pytest
import shapely
from hypothesis import given, settings

from baselines.cma_es import CmaEsPlanner, CmaEsSettings
from baselines.extremity import ExtremityPlanner
from baselines.grid_astar import GridAstarPlanner, GridAstarSettings
from suite.errors import PluginError
from suite.harness.cell import run_cell
from suite.planner import Budget, Plan, Planner, PlanStatus, Recorder
from suite.plugins.discovery import available_planners, load_planner
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene, make_scene, scene_fingerprint
from tests.strategies import scenes
from tests.suite.harness.records import make_cell

OTHERS = {
    "cmaes": CmaEsPlanner(CmaEsSettings(waypoints=2, penalty=10.0, restarts=0)),
    "extremitypathfinder": ExtremityPlanner(),
    "grid-astar": GridAstarPlanner(GridAstarSettings(resolution=20)),
}
ROOM = shapely.box(0, 0, 10, 10)
BOX = make_scene("box", ROOM, [shapely.box(4, 2, 6, 7)], ((1, 5), (9, 5)))
RING = shapely.box(6, 6, 10, 10).difference(shapely.box(7, 7, 9, 9))
CLOSED = make_scene("closed", ROOM, [RING], ((1, 1), (8, 8)))
FEW = Budget(generations=12)

each = pytest.mark.parametrize("planner", OTHERS.values(), ids=OTHERS)


def plan(
    planner: Planner,
    scene: Scene = BOX,
    budget: Budget = FEW,
    query: Query | None = None,
    seed: int = 0,
    recorder: Recorder | None = None,
) -> Plan:
    rng = np.random.default_rng(seed)
    return planner.plan(scene, query or scene.query(), budget, rng, recorder or Recorder())


@each
@settings(max_examples=20)
@given(scene=scenes())
def test_paths_are_valid_and_no_shorter_than_the_shortest_where_everything_touches(planner, scene):
    query = scene.query()
    shortest = shortest_path(scene, query)
    made = plan(planner, scene)
    if made.status is PlanStatus.INFEASIBLE:
        assert shortest.path is None
    elif made.status is PlanStatus.SOLVED:
        seen = judge(scene, query, made.path)
        assert seen.valid, seen.reason
        assert seen.length >= shortest.length - 1e-9
        assert made.claimed_cost == pytest.approx(seen.length, abs=1e-9)
    else:
        assert made.status is PlanStatus.EXHAUSTED


@each
def test_a_path_around_a_box_is_found_and_its_improvements_are_reported(planner):
    recorder = Recorder()
    made = plan(planner, budget=Budget(), recorder=recorder)
    assert judge(BOX, BOX.query(), made.path).valid
    costs = [improvement.cost for improvement in recorder.improvements]
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] == made.claimed_cost
    # The other way around is 1.14 times as long.
    assert costs[-1] < 1.2 * shortest_path(BOX, BOX.query()).length


@each
def test_who_stands_where_he_wants_to_go_is_there(planner):
    here = Query("here", BOX.query().start, BOX.query().start)
    made = plan(planner, query=here, budget=Budget(generations=500))
    assert judge(BOX, here, made.path).valid
    assert made.claimed_cost == pytest.approx(0.0, abs=0.1)


@each
def test_an_end_inside_an_obstacle_is_infeasible(planner):
    inside = Query("inside", BOX.query().start, np.array([5.0, 4.0]))
    assert plan(planner, query=inside).status is PlanStatus.INFEASIBLE


@each
def test_without_a_path_only_the_exact_one_calls_it_infeasible(planner):
    made = plan(planner, CLOSED)
    exact = planner.abilities.exact
    assert made.status is (PlanStatus.INFEASIBLE if exact else PlanStatus.EXHAUSTED)
    assert made.path is None


@each
def test_time_that_is_over_ends_the_run(planner):
    made = plan(planner, load_scene("clustered"), Budget(wall_s=1e-6))
    assert (made.status, made.path) == (PlanStatus.EXHAUSTED, None)


@pytest.mark.parametrize("name", ["cmaes", "grid-astar"])
@pytest.mark.parametrize("checks", [1, 17, 1000, 1700, 1710])
def test_no_check_more_is_made_than_the_budget_allows(name, checks):
    made = plan(OTHERS[name], budget=Budget(checks=checks))
    assert 0 <= made.checks <= checks
    assert made.status is PlanStatus.EXHAUSTED or judge(BOX, BOX.query(), made.path).valid


# A package that is missing


MODULES = {
    "cmaes": ("baselines.cma_es", "cmaes", "cmaes"),
    "extremitypathfinder": (
        "baselines.extremity",
        "extremitypathfinder",
        "extremitypathfinder",
    ),
    "grid-astar": ("baselines.grid_astar", "tcod.path", "tcod"),
}


@pytest.fixture(params=MODULES)
def missing(request, monkeypatch):
    """The name of a planner and the sentence that it is unavailable with, its package missing."""
    module, imported, package = MODULES[request.param]
    monkeypatch.delitem(sys.modules, module, raising=False)
    monkeypatch.setitem(sys.modules, imported, None)
    yield (
        request.param,
        f"it needs the package {package}. "
        f'Install it with: pip install "kbga-bench[{request.param}]"',
    )
    monkeypatch.undo()
    importlib.import_module(module)


def test_without_its_package_a_planner_is_listed_with_its_install_line(missing):
    name, sentence = missing
    listed = {info.name: info for info in available_planners()}
    assert listed[name].reason == f"unavailable: {sentence}"
    assert all(info.available for other, info in listed.items() if other != name)
    with pytest.raises(PluginError, match="is unavailable: it needs the package"):
        load_planner(name)


def test_without_its_package_a_run_is_a_row_that_says_how_to_install_it(missing):
    name, sentence = missing
    scene = load_scene("double_u")
    cell = make_cell(
        scene="double_u",
        scene_source="double_u",
        scene_hash=scene_fingerprint(scene, scene.query()),
        planner=name,
        variant=name,
        settings={},
    )
    record = run_cell(cell)
    assert record.status is PlanStatus.ERROR
    assert record.reason == f"planner '{name}' is unavailable: {sentence}"
