"""What was run, how it ended, and the main result."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from suite.planner import PlanStatus
from suite.report.figures.style import LEAST_GAP
from suite.report.html.cells import Sheet, sheet
from suite.report.html.evidence import Evidence
from suite.report.html.shades import shaded
from suite.report.rows import is_blocked
from suite.report.table import Table
from suite.report.tables.glance import at_a_glance
from suite.report.tables.summary import summary
from suite.report.words import fixed, of_some

BLOCKED = "query blocked"
"""Refused as the query can't be asked, which is no matter of the planner."""

GAP_NOTE = (
    "Mean gap of the paths found to the exact shortest one, per cent: 0 is optimal. In brackets "
    "how many runs found a path, where not all did; a mean over few of the runs flatters. Darker "
    "is worse, on a logarithmic scale."
)


def headline(evidence: Evidence) -> str:
    """What was run, in a sentence or two."""
    runs = evidence.runs
    if runs.empty:
        return "The store holds no runs yet. `kbga-bench run MATRIX --store STORE` fills it."
    solved = int((runs["status"] == PlanStatus.SOLVED).sum())
    matrices = list(dict.fromkeys(str(s.get("matrix")) for s in evidence.sessions if "matrix" in s))
    of = f" of {', '.join(matrices)}" if matrices else ""
    queries = len(runs[["scene", "query"]].drop_duplicates())
    asked = f", {queries:,} queries" if queries > runs["scene"].nunique() else ""
    planners, scenes, seeds = (runs[name].nunique() for name in ("variant", "scene", "seed"))
    return (
        f"{_count(len(runs), 'run')}{of}: {_count(planners, 'planner')} in "
        f"{_count(scenes, 'scene')}{asked}, {_count(seeds, 'seed')}. "
        f"{_count(solved, 'run')} ended with a path that the referee accepts."
    )


def overview_sheets(evidence: Evidence) -> list[Sheet]:
    """How runs ended, and the mean gap of each planner in each scene."""
    if evidence.runs.empty:
        return []
    sheets = [sheet(Table("status", "How the runs ended", _by_status(evidence.runs)))]
    if not evidence.steps.runs.empty and not np.isnan(evidence.steps.optimum).all():
        sheets.append(_gaps(summary(evidence.steps.runs)))
    return sheets


def _gaps(found: pd.DataFrame) -> Sheet:
    """Mean gaps, on the colours of their sizes."""
    texts, numbers = (at_a_glance(found, ["planner"], cell) for cell in (_gap, _number))
    table = Table("gaps", "Mean gap to the optimum (%)", texts, GAP_NOTE)
    numbers = numbers.drop(columns="planner").apply(pd.to_numeric, errors="coerce")
    return shaded(sheet(table), numbers, LEAST_GAP)


def _number(row: Mapping[Any, Any]) -> str:
    gap = row["gap mean (%)"]
    return str(gap) if np.isfinite(gap) else ""


def _by_status(runs: pd.DataFrame) -> pd.DataFrame:
    order = dict.fromkeys(runs["variant"])
    ended = runs["status"].where(~is_blocked(runs), BLOCKED)
    counts = pd.crosstab(runs["variant"], ended).reindex(list(order))
    words = [str(word) for word in (*PlanStatus, BLOCKED) if str(word) in counts.columns]
    counts = counts[words]
    counts.insert(0, "runs", counts.sum(axis=1))
    return counts.rename_axis("planner").rename_axis(None, axis=1).reset_index()


def _gap(row: Mapping[Any, Any]) -> str:
    if pd.isna(row["gap mean (%)"]):
        return f"{row['solved']} of {row['runs']}"
    return of_some(fixed(row["gap mean (%)"]), row["solved"], row["runs"])


def _count(number: int, what: str) -> str:
    return f"{number:,} {what}{'' if number == 1 else 's'}"
