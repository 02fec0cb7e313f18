"""The tables of simulated runs, on rows made by hand."""

import pytest

from suite.harness.matrix import load_matrix
from suite.harness.run import run_matrix
from suite.planner import PlanStatus
from suite.report.all_tables import read_tables
from suite.report.results_folder import write_results
from suite.store.record import World
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record


def replan(time, cost, *, changed=False, latency_s=0.002, optimum=None, **more):
    return {
        "time": time, "changed": changed, "status": "solved" if cost else "exhausted",
        "cost": cost, "optimum": optimum or cost or 10.0, "latency_s": latency_s,
        "generations": 15, "checks": 100, **more,
    }  # fmt: skip


def run(seed=0, *, variant="kbga", scene="door", world="Fig. 11", status=PlanStatus.SOLVED, **data):
    simulation = {
        "outcome": "reached", "opening": "left", "time": 10.0, "waiting_time": 1.0, "hits": [],
        "replans": [replan(0.0, 20.0, optimum=16.0), replan(2.0, None, latency_s=0.004)],
        **data,
    }  # fmt: skip
    cell = make_cell(
        scene=scene, variant=variant, seed=seed, world=World(world, {"speed": 2.0}, cold=False)
    )
    good = status is PlanStatus.SOLVED
    return make_record(
        cell,
        status=status,
        cost=24.0 if good else None,
        optimum=20.0,
        gap=0.2 if good else None,
        simulation=simulation,
    )


@pytest.fixture
def tables_of(tmp_path):
    def read(*records):
        with open_store(tmp_path / "s.db") as store:
            store.begin_session({})
            for record in records:
                store.add(record)
        return {table.name: table.frame for table in read_tables(tmp_path / "s.db")}

    return read


def test_ways_are_measured_over_the_runs_that_arrived_unhurt(tables_of):
    hit = {"time": 3.0, "obstacle": "bar", "place": [0, 0]}
    records = [run(0), run(1), run(2, status=PlanStatus.INVALID, hits=[hit], opening="right")]
    (row,) = tables_of(*records)["simulations"].to_dict("records")
    assert (row["world"], row["planner"], row["runs"]) == ("Fig. 11", "kbga", 3)
    assert row["unhurt (%)"] == pytest.approx(200 / 3)
    assert row["hit"] == 1
    assert row["passed"] == "left 2, right 1"
    assert row["length mean (m)"] == 24.0
    assert row["above exact (%)"] == pytest.approx(20.0)
    assert (row["time mean (s)"], row["waiting mean (s)"]) == (10.0, 1.0)
    assert row["otherwise"] == "invalid 1"


def test_latencies_are_over_all_updates_and_beside_those_of_kbga(tables_of):
    slow = [replan(0.0, 20.0, optimum=16.0, latency_s=0.03)]
    frame = tables_of(run(), run(variant="slow", replans=slow))["replanning"]
    kbga, other = frame.to_dict("records")
    assert kbga["latency median (ms)"] == pytest.approx(3.0)
    assert kbga["latency worst (ms)"] == pytest.approx(4.0)
    assert (kbga["x kbga"], other["x kbga"]) == (1.0, pytest.approx(10.0))
    assert kbga["gap worst (%)"] == pytest.approx(25.0)
    assert (kbga["no path"], other["no path"]) == (1, 0)
    assert (kbga["replans per run"], kbga["gen per replan"]) == (2.0, 15.0)


def test_without_kbga_there_is_nothing_to_compare_latencies_with(tables_of):
    frame = tables_of(run(variant="slow"))["replanning"]
    assert frame["x kbga"].isna().all()


def test_the_paper_is_answered_by_the_opening_that_kbga_passed(tables_of):
    records = [run(0), run(1, opening="right"), run(2, status=PlanStatus.EXHAUSTED)]
    (row,) = tables_of(*records, run(3, variant="other"))["paper-dynamic"].to_dict("records")
    assert (row["of the paper"], row["runs"], row["ours so"]) == ("Fig. 11", 3, 1)


def test_a_reaction_is_what_the_planner_took_when_the_change_was_seen(tables_of):
    replans = [
        replan(0.0, 100.0),
        replan(1.0, 105.0, changed=True, latency_s=0.005),
        replan(2.0, 103.0, changed=True, latency_s=0.006),
        replan(3.0, 101.0),
        replan(4.0, 80.0, changed=True, latency_s=0.007),
    ]
    records = [run(scene="unknown_obstacles", world="section III-E", replans=replans)]
    frame = tables_of(*records)["paper-dynamic"]
    assert frame["ours so"].tolist() == [1, 1, 1]
    assert frame["detour (m)"].tolist() == pytest.approx([7.0, 0.0, -19.0])
    assert frame["ours reaction (s)"].tolist() == pytest.approx([0.005, 0.006, 0.007])
    assert frame["paper reaction (s)"].tolist()[::2] == [1.10, 0.08]


def test_rows_that_stand_still_and_rows_that_move_do_not_mix(tables_of):
    tables = tables_of(run(), make_record(make_cell(scene="zigzag")))
    assert tables["summary"]["scene"].tolist() == ["zigzag"]
    assert tables["simulations"]["scene"].tolist() == ["door"]


def test_a_store_without_simulated_runs_has_no_tables_of_them(tables_of):
    assert "simulations" not in tables_of(make_record())
    assert "simulations" not in tables_of()


def test_a_run_whose_process_died_counts_and_breaks_nothing(tables_of):
    cell = make_cell(scene="door", world=World("Fig. 11", {"speed": 2.0}), seed=5)
    dead = make_record(cell, status=PlanStatus.CRASHED, cost=None, gap=None, simulation=None)
    (row,) = tables_of(run(), dead)["simulations"].to_dict("records")
    assert (row["runs"], row["unhurt (%)"], row["otherwise"]) == (2, 50.0, "crashed 1")


MATRIX = """
scenes = ["door"]
seeds = 1
[[world]]
name = "fast robot"
settings = { speed = 5.0, charge = "zero" }
[[planner]]
planner = "kbga"
[[planner]]
name = "kbga-cold"
planner = "kbga"
cold = true
[[planner]]
planner = "visibility-graph"
"""


def test_a_matrix_of_worlds_is_run_kept_and_shown(tmp_path):
    file, store = tmp_path / "m.toml", tmp_path / "s.db"
    file.write_text(MATRIX)
    with open_store(store) as opened:
        run_matrix(load_matrix(file), opened, jobs=2)
    files = {path.name for path in write_results(store, tmp_path / "r")}
    assert {"simulations.md", "replanning.csv", "runs.parquet", "replans.parquet"} <= files
    assert {"door-fast-robot.png", "replanning.png"} <= files
    assert "door.png" not in files
    frame = read_tables(store)[0].frame
    assert frame["planner"].tolist() == ["kbga", "kbga-cold", "visibility-graph"]
    assert frame["unhurt (%)"].tolist() == [100.0] * 3
    assert frame["passed"].tolist() == ["right 1"] * 3
    assert frame["above exact (%)"].abs().max() < 1.0
