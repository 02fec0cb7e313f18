"""The contract as pytest tests, which any author can derive from."""

import subprocess
import sys
import textwrap
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from suite.conformance.contract import PlannerContract
from suite.conformance.rules import RULES
from tests.suite.conformance.broken_planners import Detours, DetourSettings

ROOT = Path(__file__).parents[3]
OWN_PYTEST = [sys.executable, "-m", "pytest", "-q", "-rfs", "-p", "no:cacheprovider"]


class TestDetours(PlannerContract):
    planner = Detours
    settings = DetourSettings(tries=20)


@dataclass(frozen=True)
class WeightedSettings(DetourSettings):
    weights: list[float] = field(default_factory=lambda: [1.0, 2.0])


class Weighted(Detours):
    name = "weighted"
    Settings = WeightedSettings


class TestSettingsThatHoldAList(PlannerContract):
    planner = Weighted
    settings = WeightedSettings(tries=20)


def test_each_rule_is_a_test_that_says_what_it_asks():
    tests = {name for name in vars(PlannerContract) if name.startswith("test_")}
    assert tests == {f"test_{rule.__name__}" for rule in RULES}
    assert PlannerContract.test_same_seed_same_path.__doc__.startswith("The same seed")


@pytest.fixture
def outcomes(tmp_path):
    """Outcomes of some of the contract's tests for a planner, as an author's pytest run prints
    them. That the others pass, the tests above and those of the rules say.
    """

    def run(planner, *rules):
        file = tmp_path / "test_theirs.py"
        file.write_text(
            textwrap.dedent(f"""
                from suite.conformance.contract import PlannerContract
                from tests.suite.conformance.broken_planners import {planner}

                class TestTheirs(PlannerContract):
                    planner = {planner}
            """)
        )
        done = subprocess.run(
            [*OWN_PYTEST, "-k", " or ".join(rules), str(file)],
            cwd=ROOT,
            capture_output=True,
            text=True,
        )
        return done.stdout

    return run


def test_an_author_sees_the_broken_rule_and_how_to_mend_it(outcomes):
    printed = outcomes("ChangesTheFolder", "leaves_the_folder_alone", "path_is_free", "replans")
    assert "1 failed, 1 passed, 5 skipped" in printed
    assert "FAILED" in printed
    assert "test_leaves_the_folder_alone" in printed
    assert "mend: Use whole paths" in printed
    assert "raise AssertionError" not in printed  # the lines of the kit say nothing to an author


@pytest.mark.slow
def test_an_author_sees_a_warning_and_the_test_passes(outcomes):
    printed = outcomes("ClaimsALowerCost", "claimed_cost_is_the_length", "path_is_free")
    assert "2 passed" in printed
    assert "ContractWarning: claimed-cost-is-the-length" in printed


def test_the_kit_needs_no_pytest():
    program = (
        "import sys; import suite.conformance.contract;"
        "print([name for name in ('pytest', '_pytest') if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
