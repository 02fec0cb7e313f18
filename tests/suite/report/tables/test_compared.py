import pandas as pd
import pytest

from suite.planner import Budget
from suite.report.rows import settings_of
from suite.report.tables.compared import compare, families, whole_where_whole
from suite.report.tables.glance import at_a_glance
from tests.suite.report.study_rows import run, runs_of


def compared(*records):
    runs = runs_of(*records)
    runs["value"] = runs["variant"]
    return compare(
        runs, by=["scene", "variant", "value"], within=["scene"], reference="whole"
    ).set_index(["scene", "variant"])


def test_means_are_over_feasible_runs_and_say_over_how_many():
    frame = compared(
        run("whole", {}, 110.0, seed=0, generation_of_best=10),
        run("whole", {}, 130.0, seed=1, generation_of_best=20),
        run("whole", {}, None, seed=2, generation_of_best=900, checks=10_000),
    )
    row = frame.loc[("zigzag", "whole")]
    assert (row["runs"], row["feasible"]) == (3, 2)
    assert (row["cost mean"], row["gap mean (%)"]) == (120.0, pytest.approx(20.0))
    assert row["gen to best mean"] == 15.0


def test_costs_with_penalties_and_checks_are_over_all_runs():
    frame = compared(run("whole", {}, 110.0), run("whole", {}, None, seed=1, checks=10_000))
    row = frame.loc[("zigzag", "whole")]
    assert row["cost with penalties mean"] == (110.0 + 1000.0) / 2
    assert row["cost with penalties over optimum"] == pytest.approx((1.1 + 10.0) / 2)
    assert row["checks mean"] == (4000 + 10_000) / 2


def test_a_ratio_is_to_the_reference_of_the_same_scene():
    frame = compared(
        run("whole", {}, 110.0, cpu_s=0.1, cpu_to_best_s=0.05),
        run("half", {}, 110.0, cpu_s=0.3, cpu_to_best_s=0.05),
        run("whole", {}, 110.0, scene="maze", cpu_s=1.0),
        run("half", {}, 110.0, scene="maze", cpu_s=0.5),
        run("half", {}, 110.0, scene="double_u"),
    )
    assert frame["ratio total"].loc[[("zigzag", "half"), ("maze", "half")]].tolist() == (
        pytest.approx([3.0, 0.5])
    )
    assert frame.loc[("zigzag", "half"), "ratio to best"] == pytest.approx(1.0)
    assert frame.loc[("maze", "whole"), "ratio total"] == 1.0
    assert pd.isna(frame.loc[("double_u", "half"), "ratio total"])


def test_at_a_glance_failures_stand_beside_the_gap_that_they_are_not_in():
    frame = compared(
        run("whole", {}, 110.0),
        run("whole", {}, 100.0, scene="maze"),
        run("half", {}, 110.0),
        run("half", {}, None, seed=1),
        run("half", {}, None, scene="maze"),
        run("third", {}, 99.9999999),
    ).reset_index()
    seen = at_a_glance(frame, ["variant"]).set_index("variant")
    assert seen.loc["whole"].tolist() == ["10.00", "0.00"]
    assert seen.loc["half"].tolist() == ["10.00 (1 of 2)", "0 of 1"]
    assert seen.loc["third"].tolist() == ["0.00", ""], "not run on maze, and no zero with a sign"


def test_families_are_named_by_what_they_differ_in():
    one, eight = {"rounds": 1, "C": 10}, {"rounds": 8, "C": 10}
    runs = runs_of(
        run("a", one, 110.0),
        run("b", one | {"C": 100}, 110.0),
        run("c", eight, 110.0),
        run("d", {"rate": 0.5}, 110.0, planner="plain-ga"),
    )
    names = families(runs, settings_of(runs), ["C"])
    assert names.tolist() == ["kbga, rounds 1", "kbga, rounds 1", "kbga, rounds 8", "plain-ga"]


def test_runs_with_another_budget_are_another_family():
    runs = runs_of(
        run("a", {"C": 1}, 110.0, budget=Budget(generations=10)),
        run("b", {"C": 2}, 110.0, budget=Budget(generations=20)),
    )
    assert families(runs, settings_of(runs), ["C"]).nunique() == 2


def test_numbers_are_written_whole_where_all_of_them_are():
    assert whole_where_whole(pd.Series([100.0, 200.0])).tolist() == [100, 200]
    assert whole_where_whole(pd.Series([0.0, 0.5])).dtype == "float64"
