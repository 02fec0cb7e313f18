"""What "generations needed" counts in a run, and whether the run was let to its own end.

The paper does not say whether it counts until the best path was found or until the search stops. A
planner's setting ``generations_counted`` tells what its runs are compared by.
"""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.report.rows import settings_of

COUNTED = {"best": "generation_of_best", "stop": "generations"}
"""Values of the setting, and the columns of the runs."""

_LIMITS = {
    "budget_generations": "generations",
    "budget_checks": "checks",
    "budget_wall_s": "wall_s",
}
"""Budgets, and what is spent of them."""


def generations_column(runs: pd.DataFrame) -> str:
    """The column that "generations needed" means for these runs of one variant.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    str
        Of the best, unless all runs count until the stop.
    """
    counted = {values.get("generations_counted", "best") for values in settings_of(runs)}
    return COUNTED["stop" if counted == {"stop"} else "best"]


def clock_columns(runs: pd.DataFrame) -> tuple[str, str]:
    """The columns of wall and CPU time until what :func:`generations_column` counts."""
    if generations_column(runs) == COUNTED["stop"]:
        return "wall_s", "cpu_s"
    return "time_to_best_s", "cpu_to_best_s"


def cut_off(runs: pd.DataFrame) -> NDArray[np.bool_]:
    """Which runs a limit ended before their own stop criterion did.

    What such a run would have needed is not known, only that it is no less.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    (n,) bool
        The limits are the setting ``max_generations`` and the budgets.
    """
    caps = settings_of(runs).map(lambda values: values.get("max_generations"))
    reached = _reached(runs["generations"], caps)
    for limit, spent in _LIMITS.items():
        reached |= _reached(runs[spent], runs[limit])
    return reached


def _reached(spent: "pd.Series[float]", limit: "pd.Series[float]") -> NDArray[np.bool_]:
    # A missing number reaches nothing.
    mine, end = (
        pd.to_numeric(column).to_numpy(dtype=np.float64, na_value=np.nan)
        for column in (spent, limit)
    )
    return np.asarray(mine >= end, dtype=np.bool_)
