import pytest

from suite.planner import Budget
from suite.report.statistics.generations import cut_off, generations_column
from tests.suite.report.study_rows import run, runs_of


def test_generations_needed_are_those_to_the_best_unless_the_runs_say_otherwise():
    assert generations_column(runs_of(run("a", {}, 110.0))) == "generation_of_best"
    counted = {"generations_counted": "stop"}
    assert generations_column(runs_of(run("a", counted, 110.0))) == "generations"
    best = {"generations_counted": "best"}
    assert generations_column(runs_of(run("a", best, 110.0))) == "generation_of_best"


@pytest.mark.parametrize(
    ("settings", "spent", "is_cut"),
    [
        ({"max_generations": 500}, {"generations": 500}, True),
        ({"max_generations": 500}, {"generations": 499, "budget": Budget()}, False),
        ({}, {"generations": 80}, False),
        ({}, {"generations": 100}, True),  # the budget
        ({}, {"generations": 80, "checks": 9000, "budget": Budget(checks=9000)}, True),
        ({}, {"generations": None, "wall_s": 1.01, "budget": Budget(wall_s=1.0)}, True),
        ({"max_generations": 500}, {"generations": None}, False),
    ],
)
def test_a_run_is_cut_off_by_its_own_cap_or_by_a_budget(settings, spent, is_cut):
    assert cut_off(runs_of(run("a", settings, 110.0, **spent))).tolist() == [is_cut]
