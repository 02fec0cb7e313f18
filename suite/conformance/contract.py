"""The contract for pytest: a class to derive from, whose tests are the rules.

In a test module of a planner's author::

    from my_package import MyPlanner
    from suite.conformance.contract import PlannerContract

    class TestMyPlanner(PlannerContract):
        planner = MyPlanner

Each rule is a test, ``test_same_seed_same_path`` and so on. Nothing here needs pytest to be
installed: a rule that does not apply raises ``unittest.SkipTest``, which pytest takes as a skip.
"""

import unittest
import warnings
from collections.abc import Callable
from functools import lru_cache
from typing import Any, ClassVar

from suite.conformance.finding import Kind, Result
from suite.conformance.rules import RULES, apply
from suite.conformance.subject import Rule, Subject
from suite.planner import Planner


class ContractWarning(UserWarning):
    """A rule is broken that makes no result wrong."""


class PlannerContract:
    """Tests of the plugin contract. They run in the process of the tests, without time limits.

    planner : the class that is tested.
    settings : its settings; None for the default.
    """

    planner: ClassVar[type[Planner]]
    settings: ClassVar[Any] = None


def judge(result: Result) -> None:
    """Turn what came of a rule into what a test does.

    Raises
    ------
    AssertionError
        If the rule is broken.
    unittest.SkipTest
        If it does not apply.
    """
    __tracebackhide__ = True
    if result.kind in (Kind.NOT_APPLICABLE, Kind.NOT_TESTED):
        raise unittest.SkipTest(result.reason or result.rule)
    if result.finding is None:
        return
    text = (
        f"{result.rule}: {result.claim}\nfound: {result.finding.found}\n"
        f"expected: {result.finding.expected}\nmend: {result.finding.mend}"
    )
    if result.kind is Kind.BROKEN:
        raise AssertionError(text)
    warnings.warn(text, ContractWarning, stacklevel=3)


@lru_cache(maxsize=4)
def _subject(contract: type[PlannerContract]) -> Subject:
    """One for all tests of a class: they share its runs."""
    return Subject(contract.planner, contract.settings)


def _as_test(rule: Rule) -> Callable[[PlannerContract], None]:
    def test(self: PlannerContract) -> None:
        __tracebackhide__ = True  # pytest: the planner is at fault, not these lines
        contract: Any = type(self)
        judge(apply(rule, _subject(contract)))

    test.__name__ = f"test_{rule.__name__}"
    test.__qualname__ = f"{PlannerContract.__name__}.{test.__name__}"
    test.__doc__ = rule.__doc__
    return test


for _rule in RULES:
    setattr(PlannerContract, f"test_{_rule.__name__}", _as_test(_rule))
