"""All planners that come with the suite keep the contract that strangers are held to."""

from importlib.metadata import entry_points

import pytest

from suite.conformance.finding import Kind
from suite.conformance.rules import examine
from suite.conformance.subject import Subject
from suite.plugins.discovery import GROUP, load_planner
from suite.plugins.settings import make_settings

OURS = [p.name for p in entry_points(group=GROUP) if p.dist and p.dist.name == "kbga-bench"]

FEWER = {"extremitypathfinder": 24}
"""Rules kept by one that refuses some scenes: then no rule about repeated runs applies."""


SAMPLE = {"kbga", "visibility-graph", "ompl-rrtstar"}
"""One of each kind. `make test-slow` examines the others, and so does `kbga-bench check`."""


@pytest.mark.parametrize(
    "name",
    [n if n in SAMPLE else pytest.param(n, marks=pytest.mark.slow) for n in OURS],
)
def test_it_breaks_no_rule_and_needs_no_warning(name):
    planner_class = load_planner(name)
    # OMPL's planners without a budget run for a second, which would be most of the test.
    short = {"default_wall_s": 0.1} if name.startswith("ompl-") else {}
    results = list(examine(Subject(planner_class, make_settings(planner_class, short))))
    assert [r for r in results if r.kind in (Kind.BROKEN, Kind.WARNING)] == []
    assert sum(r.kind is Kind.KEPT for r in results) >= FEWER.get(name, 26)


def test_there_are_planners_to_examine():
    assert {"kbga", "plain-ga", "visibility-graph", "ompl-rrtstar"} <= set(OURS)
    assert set(OURS) >= SAMPLE
