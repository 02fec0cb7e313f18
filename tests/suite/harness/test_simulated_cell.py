"""A simulated run as a row: what its columns mean when a planner plans many times."""

from statistics import median

import pytest
import shapely

from suite.harness.cell import run_cell
from suite.harness.simulated_cell import exact_length
from suite.harness.single import cell_for, world_for
from suite.planner import Budget, PlanStatus
from suite.scenes.dynamics import Dynamics, constant_speed
from suite.scenes.geojson import write_scene
from suite.scenes.scene import Obstacle, make_scene


@pytest.fixture
def file_of(tmp_path):
    def write(*obstacles):
        scene = make_scene("hall", shapely.box(0, 0, 10, 10), obstacles, ((1, 5), (9, 5)))
        write_scene(scene, tmp_path / "hall.geojson")
        return str(tmp_path / "hall.geojson")

    return write


def run(source, planner, *, cold=False, budget=None, **world):
    world = world_for(source, {"charge": "zero", "interval": 1.0, **world}, cold=cold)
    return run_cell(cell_for(source, planner, seed=0, world=world, budget=budget or Budget()))


WALL = Obstacle("wall", shapely.box(4, 2, 6, 10))
PRESS = Obstacle("press", shapely.box(0, 7, 3, 9), Dynamics(constant_speed((0, -4), 0, 1)))


def test_a_robot_that_arrives_unhurt_is_solved_at_the_length_of_its_way(file_of):
    record = run(file_of(WALL), "kbga")
    assert record.status is PlanStatus.SOLVED
    assert record.cost == pytest.approx(record.optimum, rel=1e-2)
    assert record.gap == record.cost / record.optimum - 1.0
    replans = record.simulation["replans"]
    assert len(replans) == 6
    assert record.generations == sum(r["generations"] for r in replans)
    assert record.checks == sum(r["checks"] for r in replans)
    assert record.wall_s == pytest.approx(sum(r["latency_s"] for r in replans))
    assert record.path.tolist() == [[x, y] for _, x, y in record.simulation["trajectory"]]


def test_what_a_planner_says_of_each_plan_is_kept_and_its_medians_stand_in_the_row(file_of):
    record = run(file_of(WALL), "ompl-rrtconnect", budget=Budget(checks=2000))
    shares = [r["details"]["callback_share"] for r in record.simulation["replans"]]
    assert len(set(shares)) > 1
    assert record.details["callback_share"] == median(shares)
    assert run(file_of(WALL), "visibility-graph").details == {}


def test_a_robot_that_is_hit_is_invalid_and_the_reason_says_by_what_and_when(file_of):
    record = run(file_of(PRESS), "visibility-graph", speed=0.1)
    assert record.status is PlanStatus.INVALID
    assert record.reason.startswith("hit by press at 0.5")
    assert record.cost is None


def test_a_robot_that_does_not_arrive_in_time_is_exhausted(file_of):
    record = run(file_of(), "visibility-graph", time_limit=2.0)
    assert record.status is PlanStatus.EXHAUSTED
    assert record.reason == "not at the goal after 2 s."


def test_a_planner_that_always_raises_is_an_error_with_its_traceback(file_of, hostile):
    record = run(file_of(), "raises", time_limit=2.0)
    assert record.status is PlanStatus.ERROR
    assert "RuntimeError: no luck today" in record.reason
    assert [r["status"] for r in record.simulation["replans"]] == ["error", "error"]


def test_a_planner_that_refuses_is_refused_and_nothing_is_driven(file_of):
    source = file_of()
    cell = cell_for(
        source,
        "ompl-rrtstar",
        seed=0,
        budget=Budget(generations=9),
        world=world_for(source),
    )
    record = run_cell(cell)
    assert record.status is PlanStatus.REFUSED
    assert record.simulation is None


def test_the_exact_planner_goes_as_far_as_the_yardstick(file_of):
    record = run(file_of(WALL), "visibility-graph")
    assert record.cost == pytest.approx(record.optimum, abs=1e-9)


def test_there_is_no_yardstick_where_the_exact_robot_is_hit(file_of):
    source = file_of(PRESS)
    assert exact_length(source, "main", world_for(source, {"speed": 0.1})) is None


def test_cold_and_warm_are_two_variants_with_two_streams(file_of):
    source = file_of(WALL)
    warm, cold = (cell_for(source, "kbga", seed=0, world=world_for(source, cold=c)) for c in (0, 1))
    assert (warm.variant, cold.variant) == ("kbga", "kbga-cold")
    assert warm.key != cold.key


def test_another_world_is_another_row(file_of):
    source = file_of(WALL)
    keys = {
        cell_for(source, "kbga", seed=0, world=world).key
        for world in (None, world_for(source), world_for(source, {"speed": 3.0}))
    }
    assert len(keys) == 3


def test_a_drive_whose_planner_waited_is_contended(hostile, file_of):
    assert run(file_of(WALL), "sleeper").contended
