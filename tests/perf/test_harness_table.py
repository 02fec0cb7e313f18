import json

import pytest

from tests.perf.harness import measure
from tests.perf.harness_table import goals, parts_table, write


def run(run_s, plan_s=0.002):
    return {"run_s": run_s, "store_s": 0.001, "plan_s": plan_s, "before_s": 0.003, "after_s": 0.001}


def record(*runs, rows=10_000, seconds=300.0):
    command = {"seconds": seconds, "most_bytes": 200_000_000}
    return {
        "provenance": {"cpu": "a processor"},
        "overhead": {"scene": "zigzag", "planner": "kbga", "runs": list(runs)},
        "rows": {"rows": rows, "jobs": 2, "run": command, "tables": {"seconds": 6.0}},
    }


def test_the_time_of_the_planner_is_not_overhead():
    overhead = goals(record(run(0.020), run(0.050, plan_s=0.032), run(0.100)))[0]
    assert overhead.measured == pytest.approx(19.0)
    assert overhead.reached == "yes"


def test_the_parts_add_up_to_the_whole():
    parts = parts_table(record(run(0.020))).frame["median (ms)"]
    assert parts.sum() == pytest.approx(19.0)


def test_a_goal_that_is_missed_says_so_and_fewer_rows_get_less_time():
    found = {row.goal: row.reached for row in goals(record(run(0.1), run(0.1), rows=5_000))}
    assert found["overhead of a run beyond `plan`, median"].startswith("no, 3.3")
    assert found["time of a matrix of 5,000 rows"] == "no, 1.25 times off"
    assert found["kbga-bench tables"] == "no, 1.2 times off"
    assert found["memory of its parent, most"] == "yes"


@pytest.mark.slow
def test_a_small_measurement_measures_everything(tmp_path):
    found = measure(runs=3, rows=4, jobs=2)
    text = write(found, tmp_path)
    assert len(found["overhead"]["runs"]) == 3
    assert all(row.measured > 0 for row in goals(found))
    assert "4 rows" in text
    assert json.loads((tmp_path / "manifest.json").read_text())["matrix"] == "harness"
    assert {file.name for file in tmp_path.iterdir()} == {
        "harness.md", "harness.csv", "manifest.json",
    }  # fmt: skip
