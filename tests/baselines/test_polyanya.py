"""The solver of the optima as a planner: the optimum, or why there is no path; and its time."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings

from baselines.polyanya import PolyanyaPlanner
from suite.geometry.mesh import mesh_of
from suite.harness.cell import run_cell
from suite.planner import Budget, Plan, PlanStatus, Recorder
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import prepare, shortest_path
from suite.scenes.geojson import write_scene
from suite.scenes.scene import Query, Scene, make_scene, scene_fingerprint
from suite.scenes.visibility import tangent_path
from tests.strategies import scenes
from tests.suite.harness.records import make_cell
from tests.suite.scenes.real_maps import FOLDER, MISSING, REASON

ROOM = shapely.box(0, 0, 10, 10)
RING = shapely.box(6, 6, 10, 10).difference(shapely.box(7, 7, 9, 9))
CLOSED = make_scene("closed", ROOM, [RING], ((1, 1), (8, 8)))
BOX = make_scene("box", ROOM, [shapely.box(4, 0, 6, 7)], ((0, 3), (10, 3)))


def plan(scene: Scene, query: Query | None = None, recorder: Recorder | None = None) -> Plan:
    query, recorder = query or scene.query(), recorder or Recorder()
    return PolyanyaPlanner().plan(scene, query, Budget(), np.random.default_rng(0), recorder)


@pytest.mark.parametrize(
    "name", ["clustered", "maze", "zigzag@turn=17,shift=5e6:-3e5", "double_u@turn=200,scale=1e-3"]
)
def test_its_path_is_the_optimum_and_the_referee_takes_it(name):
    scene = load_scene(name)
    made = plan(scene)
    seen = judge(scene, scene.query(), made.path)
    assert seen.valid, seen.reason
    # Another algorithm, which asks about segments.
    other, _ = tangent_path(scene, scene.query())
    length = judge(scene, scene.query(), other).length
    assert made.claimed_cost == pytest.approx(length, rel=1e-12)
    assert seen.length == pytest.approx(length, rel=1e-12)


@settings(max_examples=30)
@given(scene=scenes())
def test_where_everything_touches_it_finds_the_shortest_path_or_says_why_there_is_none(scene):
    made = plan(scene)
    other, _ = tangent_path(scene, scene.query())
    if other is None:
        assert (made.status, made.path) == (PlanStatus.INFEASIBLE, None)
        assert made.reason.startswith("no way: the ")
    else:
        seen = judge(scene, scene.query(), made.path)
        assert seen.valid, seen.reason
        assert seen.length == pytest.approx(judge(scene, scene.query(), other).length, abs=1e-9)
        assert made.reason is None


@pytest.mark.skipif(MISSING, reason=REASON)
def test_on_a_real_map_its_paths_have_the_published_lengths():
    scene = load_scene(FOLDER / "ironharvest_scene_mp_2p_01.mesh")
    for query in scene.queries[::500]:
        length = scene.properties["published"][query.name]
        assert plan(scene, query).claimed_cost == pytest.approx(length, rel=1e-5)


def test_an_enclosed_goal_is_infeasible_with_the_proof_in_a_sentence():
    made = plan(CLOSED)
    assert (made.status, made.path, made.claimed_cost) == (PlanStatus.INFEASIBLE, None, None)
    assert made.reason == (
        "no way: the start lies in a part of free space of 84 m2, which does not hold the goal."
    )


@pytest.mark.parametrize(
    ("ends", "what"),
    [(((5, 4), (1, 1)), "the start (5, 4)"), (((1, 1), (5, 4)), "the goal (5, 4)")],
)
def test_an_end_inside_an_obstacle_is_named(ends, what):
    query = Query("inside", *(np.array(end, dtype=np.float64) for end in ends))
    made = plan(BOX, query)
    assert (made.status, made.reason) == (
        PlanStatus.INFEASIBLE,
        f"no way: {what} lies in no free space.",
    )


def test_a_row_keeps_the_sentence(tmp_path):
    file = tmp_path / "closed.geojson"
    write_scene(CLOSED, file)
    scene = load_scene(file)
    cell = make_cell(
        scene="closed",
        scene_source=str(file),
        scene_hash=scene_fingerprint(scene, scene.query()),
        query="main",
        planner="polyanya",
        variant="polyanya",
        settings={},
        budget=Budget(),
    )
    record = run_cell(cell)
    assert (record.status, record.reason) == (PlanStatus.INFEASIBLE, plan(CLOSED).reason)
    assert record.checks is None


def test_a_mesh_that_is_kept_with_the_scene_is_not_used(monkeypatch):
    """So a row's time does not depend on whether the optimum was asked before."""
    scene = load_scene("clustered")
    fresh = plan(scene)
    assert "mesh" not in vars(scene)
    other = load_scene("clustered")
    kept = prepare(other)
    made = []

    def watched(*given):
        made.append(given)
        return mesh_of(*given)

    monkeypatch.setattr("baselines.polyanya.mesh_of", watched)
    again = plan(other)
    assert len(made) == 1
    assert other.mesh is kept
    assert np.array_equal(fresh.path, again.path)
    counts = [(p.details["triangles"], p.details["looked_into"]) for p in (fresh, again)]
    assert counts[0] == counts[1]


def test_what_mesh_and_search_took_are_told_apart_and_are_its_time():
    recorder = Recorder()
    made = plan(load_scene("clustered"), recorder=recorder)
    (improvement,) = recorder.improvements
    mesh, search = (made.details[f"{what}_cpu_s"] for what in ("mesh", "search"))
    assert mesh > 0.0
    assert search > 0.0
    assert mesh + search <= improvement.cpu_s
    assert improvement.cost == made.claimed_cost
    assert improvement.checks is None


def test_where_no_mesh_can_be_made_the_path_is_the_shortest_all_the_same(monkeypatch):
    monkeypatch.setattr("baselines.polyanya.mesh_of", lambda *_: None)
    made = plan(BOX)
    assert made.claimed_cost == pytest.approx(shortest_path(BOX, BOX.query()).length, rel=1e-12)
    assert made.details["triangles"] == made.details["looked_into"] == 0
    assert plan(CLOSED).status is PlanStatus.INFEASIBLE
