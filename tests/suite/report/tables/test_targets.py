import math
import re

import pandas as pd
import pytest

from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.tables.targets import fixed_target, medians, target_tables
from tests.suite.report.measured_rows import measured, steps

FAST = [(2.0, 150.0), (4.0, 101.5)]
SLOW = [(10.0, 100.5)]


def row(frame, target, planner="kbga"):
    (found,) = frame[(frame["planner"] == planner) & (frame["target (%)"] == target)].to_dict(
        "records"
    )
    return found


def test_the_median_is_over_all_runs_and_never_is_longer_than_any_time():
    # Of five runs, two are fast, one is slow, and two never have a path.
    runs = [measured("kbga", i, reports) for i, reports in enumerate([FAST, FAST, SLOW, [], []])]
    frame = fixed_target(steps(*runs))
    near = row(frame, 2.0)
    assert (near["runs"], near["reached"], near["reached (%)"]) == (5, 3, 60.0)
    # Over the three that came so near it would be 4 ms.
    assert near["time median (ms)"] == pytest.approx(10.0)
    assert near["cpu median (ms)"] == pytest.approx(5.0)
    assert (near["gen median"], near["checks median"]) == (10.0, 100.0)
    nearer = row(frame, 1.0)
    assert nearer["reached"] == 1
    assert math.isinf(nearer["time median (ms)"])


def test_half_of_the_runs_are_not_enough_for_a_median():
    frame = fixed_target(steps(measured("kbga", 0, FAST), measured("kbga", 1, [])))
    assert row(frame, 5.0)["reached"] == 1
    assert math.isinf(row(frame, 5.0)["time median (ms)"])


def test_planners_that_do_not_count_generations_have_none_but_a_time():
    silent = [measured("prm", i, SLOW, improvements=(), generations=None) for i in range(3)]
    found = row(fixed_target(steps(*silent)), 1.0, "prm")
    assert math.isnan(found["gen median"])
    assert found["time median (ms)"] == pytest.approx(50.0)


def test_at_a_glance_it_says_how_many_came_so_near():
    runs = [measured("kbga", i, reports) for i, reports in enumerate([FAST, FAST, []])]
    runs += [measured("kbga", i, SLOW, scene="maze") for i in range(2)]
    glance = target_tables(steps(*runs))[0].frame.set_index("within")
    assert glance["zigzag"].tolist() == [
        "4.00 (2 of 3)", "4.00 (2 of 3)", "never (0 of 3)", "never (0 of 3)",
    ]  # fmt: skip
    assert glance["maze"].tolist() == ["10.0", "10.0", "10.0", "never (0 of 2)"]


def test_more_scenes_than_stand_side_by_side_leave_the_rows():
    runs = [measured("kbga", 0, FAST, scene=f"scattered_{i}") for i in range(13)]
    assert [table.name for table in target_tables(steps(*runs))] == ["fixed-target-rows"]
    assert len(target_tables(steps(*runs[:12]))) == 2


def test_csv_holds_infinity_and_people_read_never():
    detail = target_tables(steps(measured("kbga", 0, [])))[1]
    assert detail.detail
    assert ",inf," in render(detail, TableFormat.CSV)
    for style in (TableFormat.TABLE, TableFormat.MARKDOWN, TableFormat.LATEX):
        text = render(detail, style)
        # Four clocks of four targets; the note explains the word once more.
        assert text.count("never") >= 16
        assert not re.search(r"\binf\b", text)


def test_a_scene_without_an_optimum_has_no_target():
    assert target_tables(steps(measured("kbga", 0, FAST, optimum=None))) == []


def test_queries_of_one_scene_are_apart():
    a, b = measured("kbga", 0, FAST), measured("kbga", 0, SLOW, scene="maze")
    assert fixed_target(steps(a, b))["scene"].unique().tolist() == ["zigzag", "maze"]


def test_a_median_knows_infinity_and_nothing_of_what_is_unknown():
    inf, nan = math.inf, math.nan
    values = pd.DataFrame({"x": [1.0, inf, inf, 1.0, inf, nan, 2.0, 3.0]})
    names = pd.DataFrame({"of": ["b", "b", "b", "a", "a", "c", "c", "d"]})
    assert medians(values, names)["x"].to_dict() == pytest.approx(
        {"b": inf, "a": inf, "c": nan, "d": 3.0}, nan_ok=True
    )
