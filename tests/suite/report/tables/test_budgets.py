import math

import numpy as np
import pytest

from suite.planner import Budget
from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.tables.budgets import budget_tables, fixed_budget
from tests.suite.report.measured_rows import measured, steps

FAST = [(2.0, 150.0), (20.0, 101.0)]


def after(frame, ms):
    (found,) = frame[np.isclose(frame["budget (ms)"], ms)].to_dict("records")
    return found


def test_a_run_without_a_path_yet_is_worse_than_any_and_not_left_out():
    frame = fixed_budget(
        steps(*(measured("kbga", i, reports) for i, reports in enumerate([FAST, FAST, []])))
    )
    early, late = after(frame, 1), after(frame, 3)
    assert (early["runs"], early["with path"], early["with path (%)"]) == (3, 0, 0.0)
    assert math.isinf(early["gap median (%)"])
    assert late["with path"] == 2
    assert late["gap median (%)"] == pytest.approx(50.0)


def test_a_run_that_ended_by_itself_keeps_its_last_path():
    # It ends after 50 ms.
    frame = fixed_budget(steps(measured("kbga", 0, FAST)))
    assert after(frame, 1000)["gap median (%)"] == pytest.approx(1.0)


def test_nobody_knows_what_a_run_would_have_found_after_its_own_budget():
    cut = measured("rrt", 0, FAST, budget=Budget(wall_s=0.05))
    assert fixed_budget(steps(cut))["budget (ms)"].tolist() == pytest.approx([1, 3, 10, 30])
    # One that needed less than it was given ended by itself.
    own = measured("rrt", 0, FAST, budget=Budget(wall_s=0.2))
    assert len(fixed_budget(steps(own))) == 7


def test_at_a_glance_planners_stand_together_and_no_path_is_said():
    runs = [measured("a", i, FAST) for i in range(3)]
    runs += [measured("a", 0, [], scene="maze"), measured("b", 0, FAST, scene="maze")]
    glance, detail = budget_tables(steps(*runs))
    assert glance.frame["planner"].tolist() == ["a"] * 7 + ["b"] * 7
    first = glance.frame.iloc[0]
    assert (first["after"], first["zigzag"], first["maze"]) == (
        "1 ms", "no path (0 of 3)", "no path (0 of 1)",
    )  # fmt: skip
    # b was never run on zigzag.
    assert glance.frame.iloc[-1].tolist() == ["b", "1000 ms", "", "1.00"]
    assert "no path" in render(detail, TableFormat.MARKDOWN)


def test_a_scene_without_an_optimum_has_no_gap():
    assert budget_tables(steps(measured("kbga", 0, FAST, optimum=None))) == []
