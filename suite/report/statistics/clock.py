"""What a busy machine has spoilt: the one place that decides which rows the clock may speak of.

A run is contended if it had no core for itself (see :mod:`suite.referee.clock`). Its times are
then as much the machine's as the planner's: no table, rank or picture counts them. If wall time
ended it, or moved its world on, the outcome is the machine's too, and nothing of the row counts.
Counts and CPU time stay: others on the machine hardly change them.
"""

import json

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.report.words import counted

TIMES = ("wall_s", "time_to_best_s")
"""Columns of wall times."""

NAMES_AT_MOST = 8
"""Planners that are named one by one."""

WALL = "wall_s"
"""The one of :data:`suite.report.statistics.anytime.CLOCKS` that others on the machine disturb."""


def by_the_clock(runs: pd.DataFrame) -> NDArray[np.bool_]:
    """Which runs had a core for themselves, so that their wall times can be compared.

    Parameters
    ----------
    runs : DataFrame of r rows
        As :func:`suite.store.read.read_runs` gives it. A run that nobody measured, for it died, was
        not contended as far as is known.

    Returns
    -------
    (r,) bool
    """
    return ~runs["contended"].fillna(value=False).to_numpy(dtype=np.bool_)


def outcome_stands(runs: pd.DataFrame) -> NDArray[np.bool_]:
    """Which runs came out as they do on an idle machine: had a core, or are not ended by the clock.

    Returns
    -------
    (r,) bool
    """
    by_load = runs["budget_wall_s"].notna().to_numpy() | _is_charged(runs)
    return by_the_clock(runs) | ~by_load


def fair(runs: pd.DataFrame) -> pd.DataFrame:
    """The runs without those whose outcome is the machine's; contended ones without wall times.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    """
    kept = runs[outcome_stands(runs)].copy()
    kept.loc[~by_the_clock(kept), list(TIMES)] = np.nan
    return kept


def untimed_note(runs: pd.DataFrame) -> str:
    """How many of the runs a table by the clock leaves out, as a sentence; empty if none."""
    count = int((~by_the_clock(runs)).sum())
    if not count:
        return ""
    return f"Times leave out {count} of {len(runs)} runs, which had no core for themselves."


def dropped_note(runs: pd.DataFrame) -> str:
    """How many rows :func:`fair` drops, and whose, as a sentence; empty if none."""
    dropped = runs.loc[~outcome_stands(runs), "variant"].value_counts(sort=False)
    if dropped.empty:
        return ""
    whose = [f"{name} {count}" for name, count in dropped.items()]
    named = ", ".join(whose[:NAMES_AT_MOST]) + (" and others" * (len(whose) > NAMES_AT_MOST))
    were = counted(int(dropped.sum()), "row")
    return (
        f"Left out: {were} of runs that the clock ended and that had no core for themselves "
        f"({named})."
    )


def _is_charged(runs: pd.DataFrame) -> NDArray[np.bool_]:
    """Which runs are of worlds that move on while the planner plans."""
    texts = runs["world_settings"]
    charged = {
        text: json.loads(text).get("charge") == "measured" for text in texts.dropna().unique()
    }
    return np.array([charged.get(text, False) for text in texts], dtype=np.bool_)
