"""A variable is the planner's fault if its code sets it; not if the import of a library does."""

# ruff: noqa: ARG002

import os
import sys

import numpy as np
import pytest

from suite.conformance.finding import Finding
from suite.conformance.rules_of.side_effects import leaves_the_environment_alone
from suite.conformance.subject import Subject
from suite.planner import Plan, Planner, PlanStatus

LIBRARY = """
import os

def set_variable():
    os.environ["SET_BY_A_LIBRARY"] = "1"

set_variable()
"""


class Calm(Planner):
    name = "calm"

    def plan(self, scene, query, budget, rng, recorder):
        self.act()
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))

    def act(self):
        pass


class ImportsInPlan(Calm):
    def act(self):
        import library_of_others  # noqa: F401


class ImportsInWarmUp(Calm):
    def warm_up(self):
        import library_of_others  # noqa: F401


class Calls(Calm):
    def act(self):
        import library_of_others

        library_of_others.set_variable()


class SetsItself(Calm):
    def act(self):
        os.environ["SET_BY_A_LIBRARY"] = "1"


class TakesAway(ImportsInWarmUp):
    def act(self):
        del os.environ["HOME"]


@pytest.fixture(autouse=True)
def library(tmp_path, monkeypatch):
    (tmp_path / "library_of_others.py").write_text(LIBRARY)
    monkeypatch.syspath_prepend(tmp_path)
    yield
    sys.modules.pop("library_of_others", None)


@pytest.mark.parametrize("planner", [Calm, ImportsInPlan, ImportsInWarmUp])
def test_what_the_import_of_a_library_sets_is_not_the_planners(planner):
    assert leaves_the_environment_alone(Subject(planner)) is None


@pytest.mark.parametrize(
    ("planner", "variable"),
    [(Calls, "SET_BY_A_LIBRARY"), (SetsItself, "SET_BY_A_LIBRARY"), (TakesAway, "HOME")],
)
def test_what_its_own_code_sets_or_has_set_is_the_planners(planner, variable):
    found = leaves_the_environment_alone(Subject(planner))
    assert isinstance(found, Finding)
    assert f"changed: {variable}" in found.found
