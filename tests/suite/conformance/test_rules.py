"""The kit finds each broken planner, by the name of the rule that it breaks, and no other rule."""

import inspect

import pytest

from suite.conformance.finding import Kind
from suite.conformance.rules import RULES, WARNINGS, apply, rule_name
from suite.conformance.rules_of.other_processes import same_path_in_another_process
from suite.conformance.subject import Subject
from tests.suite.conformance import broken_planners, broken_replanners

CONCRETE = [
    kind
    for module in (broken_planners, broken_replanners)
    for _, kind in inspect.getmembers(module, inspect.isclass)
    if kind.__module__ == module.__name__ and "name" in vars(kind)
]
SLOW = (same_path_in_another_process,)
REPLANNED = [rule for rule in RULES if rule_name(rule).startswith("replans-")]
SHARE = 6
"""One in so many of the broken planners is held to the other rules in an ordinary run."""
BROKEN = [kind for kind in CONCRETE if kind is not broken_planners.Detours]


def named(planner_class, rules=RULES):
    subject = Subject(planner_class)
    results = [apply(rule, subject) for rule in rules]
    return {r.rule: r for r in results if r.kind in (Kind.BROKEN, Kind.WARNING)}


def broken_by(planner_class):
    return [rule for rule in RULES if rule_name(rule) == planner_class.__doc__]


def test_the_planner_that_the_broken_ones_are_made_of_breaks_no_rule():
    assert named(broken_planners.Detours) == {}


def test_the_replanner_that_the_broken_ones_are_made_of_breaks_no_rule():
    results = {rule_name(r): apply(r, Subject(broken_replanners.Replans)) for r in REPLANNED}
    assert len(results) == 5
    assert {r.kind for r in results.values()} == {Kind.KEPT}


def test_rules_about_replanners_say_nothing_of_who_plans_afresh():
    results = [apply(rule, Subject(broken_planners.Detours)) for rule in REPLANNED]
    assert {r.kind for r in results} == {Kind.NOT_APPLICABLE}


@pytest.mark.parametrize("planner_class", BROKEN, ids=lambda kind: kind.__name__)
def test_a_broken_planner_is_found(planner_class):
    found = named(planner_class, broken_by(planner_class))
    assert list(found) == [planner_class.__doc__]
    (result,) = found.values()
    for sentence in (result.finding.found, result.finding.expected, result.finding.mend):
        assert sentence.strip()


@pytest.mark.parametrize(
    "planner_class",
    [
        pytest.param(kind, marks=pytest.mark.slow if number % SHARE else [])
        for number, kind in enumerate(BROKEN)
    ],
    ids=lambda kind: kind.__name__,
)
def test_no_other_rule_names_a_broken_planner(planner_class):
    others = [rule for rule in RULES if rule not in (*SLOW, *broken_by(planner_class))]
    assert named(planner_class, others) == {}


@pytest.mark.slow
@pytest.mark.parametrize(
    "planner_class",
    # What one learns that keeps it in its class, it has learnt from the tests above.
    [kind for kind in BROKEN if kind is not broken_planners.Learns],
    ids=lambda kind: kind.__name__,
)
def test_no_rule_that_takes_its_time_names_a_planner_that_keeps_it(planner_class):
    rules = [rule for rule in SLOW if rule_name(rule) != planner_class.__doc__]
    assert named(planner_class, rules) == {}


def test_each_rule_has_a_planner_that_breaks_it():
    assert {kind.__doc__ for kind in BROKEN} == {rule_name(rule) for rule in RULES}


def test_only_a_claimed_cost_is_a_warning():
    assert {rule_name(rule) for rule in WARNINGS} == {"claimed-cost-is-the-length"}
    kinds = {r.kind for r in named(broken_planners.ClaimsALowerCost).values()}
    assert kinds == {Kind.WARNING}


def test_a_finding_says_where_what_and_how_to_mend():
    (result,) = named(broken_planners.StartsBesideTheStart).values()
    assert result.finding.found.startswith("on 'empty scene' with seed 1 and Budget(generations=")
    assert "(1.000000000001, 5.000000000001)" in result.finding.found
    assert "query.start" in result.finding.mend


def test_what_a_planner_changed_is_put_back():
    import os
    import random

    before = os.getcwd(), dict(os.environ), random.getstate()  # noqa: PTH109
    for planner_class in (
        broken_planners.ChangesTheFolder,
        broken_planners.ChangesTheEnvironment,
        broken_planners.DrawsFromGlobalRandom,
    ):
        named(planner_class)
    assert (os.getcwd(), dict(os.environ), random.getstate()) == before  # noqa: PTH109
