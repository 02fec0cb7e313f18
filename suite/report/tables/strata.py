"""Maps whose queries come in strata, as the buckets of ``.scen`` files: what was done in each.

A stratum holds queries of a similar difficulty, in most maps of a similar length; how a planner's
gaps and times grow from one to the next is what a mean over all of them hides.
"""

import re
from typing import Any

import numpy as np
import pandas as pd

from suite.report.statistics.anytime import Steps
from suite.report.statistics.clock import by_the_clock, untimed_note
from suite.report.statistics.over_queries import QUERY, quantile, time_to
from suite.report.table import INFINITE, Table
from suite.report.words import joined

STRATUM = "stratum"
"""The column of rows that says of which stratum a query is; None of a query of none."""

MOST_ON_PAGE = 100
"""Rows from which on there are files alone: a file of queries may have hundreds of strata."""

NEAR = 0.02
"""Gap to the optimum that a time is told for."""

GAPS = {"gap median (%)": 0.5, "gap 95th (%)": 0.95, "gap worst (%)": 1.0}

TO_BEST = {"to best (ms)": "time_to_best_s", "cpu to best (ms)": "cpu_to_best_s"}

NOTE = (
    "A row for each map, stratum of its queries and planner. A query's seeds are averaged first; "
    "solved: how many of the queries were solved in every run. gap: over the queries with a path: "
    "95th is the gap that so many in a hundred of them do not exceed. optimum: median length of "
    "the shortest paths. to 2 %: median over the queries of the wall time to come within that of "
    "the optimum; to best: of the time until the path was found that was returned, where there is "
    "one; cpu: the same of the processor. Queries of no stratum are not here."
)


def strata_table(steps: Steps, measures: pd.DataFrame) -> Table | None:
    """The table of strata; None if no query is of one.

    Parameters
    ----------
    steps : Steps
        In the maps. Its rows have a column ``stratum``, or their strata are not known.
    measures : DataFrame
        Of :func:`suite.report.statistics.over_queries.query_measures`, of these.
    """
    runs = steps.runs
    if STRATUM not in runs or runs[STRATUM].isna().all():
        return None
    of_query = runs.dropna(subset=[STRATUM]).drop_duplicates(["place", "query"])
    named = of_query.set_index(["place", "query"])[STRATUM]
    timed = runs.assign(time_to_best_s=runs["time_to_best_s"].where(by_the_clock(runs)))
    best = timed.groupby(QUERY, sort=False)[list(TO_BEST.values())].median()
    known = measures.join(named, on=["place", "query"]).join(best, on=QUERY)
    frame = by_stratum(known[known[STRATUM].notna()])
    return Table(
        "maps-strata", "Maps: the strata of their queries apart", frame,
        joined(NOTE, untimed_note(runs)), "never",
        detail=True, infinite_in=dict.fromkeys(GAPS, INFINITE),
        on_page=len(frame) <= MOST_ON_PAGE,
    )  # fmt: skip


def by_stratum(known: pd.DataFrame) -> pd.DataFrame:
    """Each planner on each stratum of each map.

    Parameters
    ----------
    known : DataFrame
        Measures of queries, with their strata and their times to the best path, seconds.

    Returns
    -------
    DataFrame
        A row for each place, stratum and planner: places and planners in the order of their first
        runs, strata by the numbers in their names.
    """
    groups = known.groupby(["place", STRATUM, "variant"], sort=False)
    rows = [
        {"scene": place, STRATUM: stratum, "planner": variant} | _row(group)
        for (place, stratum, variant), group in groups
    ]
    orders = [{name: i for i, name in enumerate(known[by].unique())} for by in ("place", "variant")]
    places, planners = orders
    rows.sort(key=lambda r: (places[r["scene"]], _natural(r[STRATUM]), planners[r["planner"]]))
    return pd.DataFrame(rows)


def _row(group: pd.DataFrame) -> dict[str, Any]:
    gap = 100.0 * group["gap"].dropna().to_numpy(dtype=np.float64)
    with_optimum = group[group["optimum"].notna()]
    return {
        "queries": len(group),
        "solved": int((group["solved"] == group["runs"]).sum()),
        "optimum (m)": float(group["optimum"].median()),
        **{name: quantile(gap, share) for name, share in GAPS.items()},
        time_to(NEAR).replace("(s)", "(ms)"): 1e3 * float(with_optimum[time_to(NEAR)].median()),
        **{name: 1e3 * float(group[column].median()) for name, column in TO_BEST.items()},
    }


def _natural(name: str) -> list[str | int]:
    """What names with numbers are ordered by, so that 10 comes after 9.

    Examples
    --------
    >>> sorted(["bucket 10", "bucket 9"], key=_natural)
    ['bucket 9', 'bucket 10']
    """
    return [int(part) if i % 2 else part for i, part in enumerate(re.split(r"([0-9]+)", name))]
