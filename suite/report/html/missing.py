"""What the store does not hold, counted: a reader must know what a table does not speak of."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from suite.report.html.evidence import Evidence
from suite.report.html.maps import MapPanel
from suite.report.html.scenes import ScenePicture
from suite.report.rows import is_blocked, is_of_map
from suite.report.statistics.clock import by_the_clock
from suite.report.table import Table
from suite.report.words import some_of

NAMES_AT_MOST = 8


def missing_table(evidence: Evidence, pictures: Sequence[ScenePicture | MapPanel]) -> Table:
    """What is missing: a row for each kind, also where nothing is.

    Parameters
    ----------
    evidence : Evidence
    pictures : sequence of ScenePicture or MapPanel
    """
    rows = [
        _not_done(evidence),
        _outdated(evidence),
        _without_events(evidence),
        _without_count(evidence, "generation"),
        _without_count(evidence, "checks"),
        _without_optimum(evidence),
        _blocked(evidence),
        _not_drawn(pictures),
        _contended(evidence),
        _conflicts(evidence),
    ]
    # Nothing follows from what is not missing.
    rows = [(what, count, where, follows if count else "") for what, count, where, follows in rows]
    frame = pd.DataFrame(rows, columns=["what is missing", "count", "where", "what follows"])
    return Table("missing", "What is missing", frame)


_Row = tuple[str, int, str, str]


def _not_done(evidence: Evidence) -> _Row:
    wanted = evidence.wanted.drop_duplicates("key")
    left = wanted[wanted["status"].isna()]
    follows = "the same `kbga-bench run` runs them"
    return (
        "runs that a matrix wants and that were not done",
        len(left),
        _by(left["variant"]),
        follows,
    )


def _outdated(evidence: Evidence) -> _Row:
    current = set(evidence.current["key"])
    old = evidence.runs[~evidence.runs["key"].isin(current)]
    follows = "scene, planner, settings or budget changed since; no table speaks of them"
    return "rows that are outdated", len(old), _by(old["variant"]), follows


def _without_events(evidence: Evidence) -> _Row:
    """Runs that are solved and reported nothing on their way have one step, at their end."""
    steps = evidence.steps
    count = np.bincount(steps.run, minlength=len(steps.runs))
    last = np.full(len(steps.runs), np.nan)
    last[steps.run] = steps.clocks["wall_s"]
    silent = steps.runs[(count == 1) & (last == steps.runs["wall_s"].to_numpy())]
    follows = "they count as having found their path when they ended"
    return (
        "runs with a path that reported nothing on the way",
        len(silent),
        _by(silent["variant"]),
        follows,
    )


def _without_count(evidence: Evidence, clock: str) -> _Row:
    steps = evidence.steps
    runs = steps.runs.loc[np.unique(steps.run[np.isnan(steps.clocks[clock])])]
    what = f"runs with a path and no count of {'generations' if clock == 'generation' else clock}"
    return what, len(runs), _by(runs["variant"]), "they are not in the charts over it"


def _without_optimum(evidence: Evidence) -> _Row:
    runs = evidence.steps.runs
    runs = runs.assign(on_map=is_of_map(runs))[np.isnan(evidence.steps.optimum)]
    queries = runs[["place", "query", "on_map"]].drop_duplicates()
    follows = "no path exists, or no run came far enough to be told it; there is no gap"
    return "queries without an optimum", len(queries), _named(queries), follows


def _blocked(evidence: Evidence) -> _Row:
    runs = evidence.current
    runs = runs[is_blocked(runs)].rename(columns={"scene": "place"})
    queries = runs[["place", "query"]].drop_duplicates().assign(on_map=True)
    follows = "a start or a goal is not free; they count for no planner and against none"
    return "queries that can't be asked", len(queries), _named(queries), follows


def _named(queries: pd.DataFrame) -> str:
    """Places of queries; of a map with their number."""
    counts = queries.groupby(["place", "on_map"], sort=False).size()
    names = [
        f"{place} {number}" if on_map else str(place)
        for (place, on_map), number in zip(counts.index.tolist(), counts.tolist(), strict=True)
    ]
    return some_of(names, NAMES_AT_MOST)


def _not_drawn(pictures: Sequence[ScenePicture | MapPanel]) -> _Row:
    names = [picture.name for picture in pictures if picture.drawing is None]
    return (
        "scenes that are gone or have changed since",
        len(names),
        some_of(names, NAMES_AT_MOST),
        "they are not drawn",
    )


def _contended(evidence: Evidence) -> _Row:
    runs = evidence.current[~by_the_clock(evidence.current)]
    follows = (
        "they had no core for themselves: no table compares their times, nor what the clock ended"
    )
    return "runs whose wall time can't be relied on", len(runs), _by(runs["variant"]), follows


def _conflicts(evidence: Evidence) -> _Row:
    follows = "the rows that were there first are shown"
    return "rows of merged stores that say something else", evidence.conflicts, "", follows


def _by(planners: "pd.Series[str]") -> str:
    counts = planners.value_counts(sort=False)
    return some_of((f"{name} {count}" for name, count in counts.items()), NAMES_AT_MOST)
