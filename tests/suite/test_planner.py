"""The interface itself: which runs are begun."""

# ruff: noqa: ARG002

import pytest
import shapely

from suite.errors import ContractError
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, refusal
from suite.scenes.scene import make_scene

SCENE = make_scene("room", shapely.box(0, 0, 9, 9), [], ((1, 1), (8, 8)))


class Keeps(Planner):
    name = "keeps"

    def __init__(self, *budgets):
        super().__init__()
        self.abilities = Abilities(budgets=frozenset(budgets))

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.EXHAUSTED)


def why(planner, **budget):
    return refusal(planner, SCENE, SCENE.query(), Budget(**budget))


@pytest.mark.parametrize(
    ("kept", "budget", "reason"),
    [
        (
            ("wall_s", "generations"), {"checks": 200},
            "keeps keeps no budget of checks. Give one that it keeps: generations, wall_s.",
        ),
        (
            (), {"checks": 200, "generations": 1},
            "keeps keeps no budget of generations or checks. It keeps none: give none.",
        ),
        (
            ("wall_s", "generations"), {"cpu_s": 2.0},
            "keeps keeps no budget of cpu_s. Give one that it keeps: generations, wall_s.",
        ),
    ],
)  # fmt: skip
def test_a_limit_that_nobody_would_keep_is_no_run(kept, budget, reason):
    assert why(Keeps(*kept), **budget) == reason


@pytest.mark.parametrize(
    ("kept", "budget"),
    [
        (("checks",), {"checks": 200}),
        (("checks",), {"checks": 200, "generations": 5}),
        ((), {}),
        ((), {"wall_s": 1.0}),
        (("checks",), {"wall_s": 1.0, "generations": 5}),
        (("cpu_s",), {"cpu_s": 1.0}),
        (("checks",), {"checks": 5, "cpu_s": 1.0}),
        ((), {"wall_s": 1.0, "cpu_s": 1.0}),
    ],
)
def test_one_limit_that_is_kept_will_do_and_wall_time_is_watched_anyway(kept, budget):
    assert why(Keeps(*kept), **budget) is None


def test_where_a_limit_is_kept_the_planner_has_the_last_word():
    class OnMondays(Keeps):
        def refuse(self, scene, query, budget):
            return "not on a Monday"

    assert why(OnMondays("checks"), checks=1) == "not on a Monday"
    assert why(OnMondays("checks")) == "not on a Monday"


@pytest.mark.parametrize("name", ["generations", "checks"])
def test_a_budget_that_no_row_can_hold_is_refused(name):
    Budget(**{name: 2**63 - 1})
    with pytest.raises(ContractError, match="It must be 9223372036854775807 or less"):
        Budget(**{name: 2**63})
