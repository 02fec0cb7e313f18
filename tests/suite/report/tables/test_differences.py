"""What separates the two planners is read off the rows, one setting at a time, both ways."""

import json

import pandas as pd
import pytest

from suite.report.tables.differences import AS_IT_IS, difference_tables, differences

PAPER = {"rounds": 1, "penalty": 10.0, "resolution": 100}
OURS = {"rounds": 8, "penalty": 100.0, "resolution": 100}


def run(planner: str, variant: str, settings: dict, *, gap: float | None, checks: int = 10) -> dict:
    return {
        "planner": planner,
        "variant": variant,
        "settings": json.dumps(settings),
        "status": "solved" if gap is not None else "exhausted",
        "gap": gap,
        "cost": None if gap is None else 100.0 * (1.0 + gap),
        "checks": checks,
        "cpu_s": 0.001,
    }


def rows(*extra: dict) -> pd.DataFrame:
    return pd.DataFrame(
        [
            run("kbga", "kbga", PAPER, gap=0.02),
            run("kbga", "kbga", PAPER, gap=None),
            run("kbga-plus", "kbga-plus", OURS, gap=0.01),
            *extra,
        ]
    )


def test_each_way_has_the_planner_as_it_is_and_its_steps():
    frame = differences(
        rows(
            run("kbga", "a", PAPER | {"rounds": 8}, gap=0.01),
            run("kbga-plus", "b", OURS | {"penalty": 10.0}, gap=0.03),
        )
    )
    assert frame[["planner", "setting", "value"]].to_numpy().tolist() == [
        ["kbga", AS_IT_IS, ""],
        ["kbga", "rounds", "8"],
        ["kbga-plus", AS_IT_IS, ""],
        ["kbga-plus", "penalty", "10.0"],
    ]
    assert frame["gap mean (%)"].tolist() == pytest.approx([2.0, 1.0, 1.0, 3.0])
    assert frame[["runs", "found"]].iloc[0].tolist() == [2, 1]


def test_what_is_no_step_towards_the_other_is_left_out():
    frame = differences(
        rows(
            run("kbga", "both", PAPER | {"rounds": 8, "penalty": 100.0}, gap=0.01),
            run("kbga", "between", PAPER | {"rounds": 3}, gap=0.01),
            run("kbga", "rounds", PAPER | {"rounds": 8}, gap=0.01),
        )
    )
    assert frame["setting"].tolist() == [AS_IT_IS, "rounds", AS_IT_IS]


def test_without_both_planners_or_a_step_there_is_no_table():
    assert difference_tables(rows()) == []
    only = rows(run("kbga", "rounds", PAPER | {"rounds": 8}, gap=0.01))
    assert difference_tables(only[only["planner"] == "kbga"]) == []
