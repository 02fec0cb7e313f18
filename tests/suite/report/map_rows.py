"""Rows of maps, scenes of many queries, made by hand."""

from typing import Any

from suite.planner import PlanStatus
from suite.store.record import RunRecord
from tests.suite.report.measured_rows import measured

OUTSIDE = "town, start of query 'gate': (-1, 2) lies outside the workspace."


def asked(planner: str, query: str, cost: float | None, seed: int = 0, **more: Any) -> RunRecord:
    """A run on a query of the map ``town``, whose optimum is 100 m; None: it found no path."""
    reports = [] if cost is None else [(2.0, cost)]
    given = {"scene": "town", "query": query, "scene_hash": f"town {query}"}
    return measured(planner, seed, reports, **(given | more))


def blocked(planner: str, query: str, reason: str = OUTSIDE, **more: Any) -> RunRecord:
    """The row of a query that can't be asked."""
    nothing = dict.fromkeys(("optimum", "wall_s", "cpu_s"))
    return asked(planner, query, None, status=PlanStatus.REFUSED, reason=reason, **nothing, **more)
