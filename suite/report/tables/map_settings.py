"""Which settings of a planner do best on maps: those of a sweep, in their order.

The rule that names a planner's tuned settings, written down before any sweep was run.
"""

from typing import Any

import numpy as np
import pandas as pd

from suite.report.statistics.over_queries import EQUAL, time_to
from suite.report.table import INFINITE, Table

NOTE = (
    "A row for each setting of a planner that has several, the best of the planner first: that of "
    "the lowest gap, of equals that which comes within 1 % in the least CPU time, of equals again "
    "the first that was run. gap: of each map the median over its queries of the gap to the "
    "optimum, no path counting as infinite; then the median over the maps. to 1 %: likewise of the "
    "CPU time to come so near, 'never' being infinite. worst gap: that of the map on which it is "
    "the largest. Only queries count that all settings of the planner were asked."
)
GAP, WORST, TIME = "gap (%)", "worst gap (%)", "cpu to 1 % (ms)"


def settings_tables(measures: pd.DataFrame, runs: pd.DataFrame) -> list[Table]:
    """The table of a sweep; none where each planner has one setting.

    Parameters
    ----------
    measures : DataFrame
        Of :func:`suite.report.statistics.over_queries.query_measures`.
    runs : DataFrame
        The rows that these are of.
    """
    frame = best_settings(measures, dict(zip(runs["variant"], runs["planner"], strict=True)))
    if frame.empty:
        return []
    title = "Maps: settings of a planner, the best first"
    gaps = dict.fromkeys((GAP, WORST), INFINITE)
    return [Table("maps-settings", title, frame, NOTE, "never", infinite_in=gaps)]


def best_settings(measures: pd.DataFrame, planner_of: dict[str, str]) -> pd.DataFrame:
    """The settings of each planner that has several, the best first.

    Parameters
    ----------
    measures : DataFrame
        Of :func:`suite.report.statistics.over_queries.query_measures`.
    planner_of : dict from variant to planner
        What a setting is of.

    Returns
    -------
    DataFrame
        planner, rank, setting, maps, queries, with path, gap (%), worst gap (%), cpu to 1 % (ms).
    """
    known = measures[measures["optimum"].notna()]
    known = known.assign(gap=known["gap"].where(known["found"] > 0, np.inf))
    rows = [
        {"planner": planner, "rank": rank} | row
        for planner, mine in known.groupby(known["variant"].map(planner_of), sort=False)
        for rank, row in enumerate(_best_first(mine), start=1)
    ]
    return pd.DataFrame(rows)


def _best_first(known: pd.DataFrame) -> list[dict[str, Any]]:
    """What is told of each setting of one planner; nothing where it has but one."""
    settings = known["variant"].nunique()
    asked = known.groupby(["place", "query"], sort=False)["variant"].transform("nunique")
    if settings == 1:
        return []
    shared = known[asked == settings].groupby("variant", sort=False)
    return sorted((_row(name, group) for name, group in shared), key=_order)


def _order(row: dict[str, Any]) -> tuple[float, float]:
    """Gaps that are equal but for rounding are one number."""
    return float(np.round(row[GAP] / (100.0 * EQUAL))), row[TIME]


def _row(variant: Any, group: pd.DataFrame) -> dict[str, Any]:
    by_map = group.groupby("place", sort=False)
    gaps = 100.0 * by_map["gap"].median()
    return {
        "setting": variant,
        "maps": len(gaps),
        "queries": len(group),
        "with path": int((group["found"] > 0).sum()),
        GAP: float(gaps.median()),
        WORST: float(gaps.max()),
        TIME: 1e3 * float(by_map[f"cpu {time_to(0.01)}"].median().median()),
    }
