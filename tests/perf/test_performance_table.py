import json
import math

import pytest

from suite.harness.matrix import load_matrix
from suite.plugins.discovery import load_planner
from tests.perf.performance_table import (
    EVERYWHERE,
    Measured,
    Row,
    Series,
    goals,
    main,
    times_table,
)
from tests.perf.series import SCENES, TUNED, planner

AHEAD_OF_KBGA = "time to 1 %: the best of OMPL's planners over kbga"


def record(*benchmarks: dict) -> dict:
    return {
        "machine_info": {"provenance": {"cpu": "a processor"}},
        "benchmarks": [
            {"extra_info": info, "stats": {"median": median}} for median, info in benchmarks
        ],
    }


def near(planner: str, near_s: list, scene: str = "maze") -> tuple:
    info = {"planner": planner, "scene": scene, "near_s": near_s, "seeds": 4, "limit_s": 1.0}
    return 0.0, {"measure": "time to 1 %", **info}


def row(measured: Measured, goal: str, scene: str = "maze", about: str = "") -> Row:
    rows = [r for r in goals(measured) if r.scene == scene]
    named = [r for r in rows if r.goal == goal]
    (found,) = named or [r for r in rows if r.goal.startswith(goal) and about in r.goal]
    return found


def test_runs_that_did_not_come_there_count_in_the_median():
    assert Series([0.1, None, 0.3, 0.2], 4, 1.0).median_s == pytest.approx(0.25)
    assert math.isinf(Series([0.1, None, None, 0.2, None], 5, 1.0).median_s)


def test_runs_that_were_left_out_did_not_come_there():
    assert math.isinf(Series([0.1, None, None, None], 6, 1.0).median_s)


def test_a_goal_is_reached_on_its_side_and_on_the_line():
    assert Row("g", "s", "ms", "<=", 10.0, 10.0).reached == "yes"
    assert Row("g", "s", "ms", "<=", 10.0, 25.0).reached == "no, 2.5 times off"
    assert Row("g", "s", "times", ">=", 3.0, 1.0).reached == "no, 3 times off"
    assert Row("g", "s", "", "<=", 0.0, 0.0).reached == "yes"
    assert Row("g", "s", "%", "<=", 0.2, -1e-15).reached == "yes"
    assert Row("g", "s", "", "<=", 0.0, 1.0).reached == "no"
    assert Row("g", "s", "ms", "<=", 10.0, None).reached == "not measured"
    assert Row("g", "s", "ms", "<=", 10.0, math.inf).reached == "no"


def test_the_best_of_the_rivals_counts():
    measured = Measured(
        record(
            near("kbga", [0.002] * 4),
            near("ompl-rrtstar", [0.9] * 4),
            near("ompl-aorrtc", [0.4, 0.4, None, 0.4]),
        )
    )
    found = row(measured, AHEAD_OF_KBGA)
    assert found.measured == pytest.approx(200.0)
    assert found.reached == "yes"
    assert found.remark == "ompl-aorrtc: 400 ms, 3 of 4 runs; kbga: 2 ms, 4 of 4"


@pytest.mark.parametrize(("ours", "reached"), [(0.005, "yes"), (0.05, "undecided")])
def test_rivals_that_never_came_there_give_a_lower_bound(ours, reached):
    measured = Measured(record(near("kbga", [ours] * 4), near("ompl-rrtstar", [None] * 3)))
    found = row(measured, AHEAD_OF_KBGA)
    assert found.measured == pytest.approx(1.0 / ours)
    assert found.reached == reached


@pytest.mark.parametrize("theirs", [[0.5] * 4, [None] * 3], ids=["they do", "nor do they"])
def test_a_planner_that_never_comes_there_is_not_ahead(theirs):
    measured = Measured(record(near("kbga", [None] * 3), near("ompl-rrtstar", theirs)))
    found = row(measured, AHEAD_OF_KBGA)
    assert found.reached == "no"
    assert "more than half of kbga's runs never come there: 0 of 3 do" in found.remark
    assert row(measured, "time to 1 % of kbga over the exact solver's time").measured is None


def test_a_planner_that_comes_later_is_so_many_times_off():
    measured = Measured(record(near("kbga", [0.4] * 4), near("ompl-shortcut", [0.02] * 4)))
    assert row(measured, AHEAD_OF_KBGA).reached == "no, 2,000 times off"


def test_each_planner_of_ours_has_its_own_goal():
    measured = Measured(
        record(
            near("kbga", [0.1] * 4), near("kbga-plus", [0.001] * 4), near("ompl-aorrtc", [0.2] * 4)
        )
    )
    assert row(measured, AHEAD_OF_KBGA).measured == pytest.approx(2.0)
    assert row(measured, f"{AHEAD_OF_KBGA}-plus").measured == pytest.approx(200.0)


def test_what_was_not_measured_is_a_row_that_says_so():
    rows = goals(Measured(record()))
    assert {r.reached for r in rows} == {"not measured"}
    assert len(rows) > 40


def test_a_goal_for_all_scenes_is_judged_on_the_worst():
    runs = {s: (1.0, {"measure": "gap", "scene": s, "resolution": 100, "gaps": [0.0] * 20})
            for s in SCENES}  # fmt: skip
    runs["zigzag"][1]["gaps"].pop()
    found = row(Measured(record(*runs.values())), "feasible runs", EVERYWHERE, "100")
    assert (found.measured, found.remark) == (19.0, "zigzag")
    del runs["maze"]
    assert row(Measured(record(*runs.values())), "feasible", EVERYWHERE, "100").measured is None


def test_the_gap_is_the_mean_of_the_feasible_runs():
    info = {"measure": "gap", "scene": "maze", "resolution": 100, "seeds": 4}
    measured = Measured(record((1.0, {**info, "gaps": [0.001, 0.003, 0.002]})))
    assert row(measured, "mean gap at resolution 100").measured == pytest.approx(0.2)


def test_times_are_listed_beside_each_other():
    measured = Measured(record(near("kbga", [0.01] * 4), near("ompl-bitstar", [None] * 3)))
    rows = times_table(measured).frame.to_dict("records")
    assert [(r["planner"], r["sign"], r["over kbga"]) for r in rows] == [
        ("kbga", "=", 1.0), ("ompl-bitstar", ">", 100.0)
    ]  # fmt: skip


def test_no_ratio_stands_beside_a_planner_that_did_not_come_there():
    measured = Measured(record(near("kbga", [None] * 3), near("ompl-bitstar", [0.2] * 4)))
    rows = times_table(measured).frame.to_dict("records")
    assert [(r["planner"], r["sign"]) for r in rows] == [("kbga", ">"), ("ompl-bitstar", "=")]
    assert all(r["over kbga"] is None for r in rows)


def test_the_tuned_settings_are_those_of_the_matrix_of_all_planners():
    variants = {v.name: v for v in load_matrix("all-planners").variants}
    for name, settings in TUNED.items():
        assert dict(variants[f"{name}-tuned"].settings).items() >= settings.items()


def test_every_tuned_planner_has_settings_of_its_own():
    for name, settings in TUNED.items():
        made = planner(f"{name}-tuned")
        assert made.name == name
        assert made.settings != load_planner(name).Settings()
        assert all(getattr(made.settings, key) == value for key, value in settings.items())


def test_a_record_becomes_tables_a_figure_and_a_manifest(tmp_path, capsys):
    file = tmp_path / "performance.json"
    file.write_text(json.dumps(record(near("kbga", [0.01] * 4), near("ompl-prmstar", [None] * 3))))
    main(str(file), str(tmp_path / "made"))
    assert {p.name for p in (tmp_path / "made").iterdir()} == {
        "performance.md", "performance.csv", "time_to_1_percent.csv", "time_to_1_percent.png",
        "manifest.json",
    }  # fmt: skip
    assert "ompl-prmstar" in capsys.readouterr().out
