"""All tables of a store's runs: pure functions of its rows."""

import pandas as pd

from suite.report.ablation import ablation_tables
from suite.report.newest import newest
from suite.report.paper_tables import COST_NOTE, paper_tables
from suite.report.simulated import is_simulated, simulated_tables
from suite.report.studies import study_tables
from suite.report.summary import summary_table
from suite.report.table import Table


def all_tables(
    runs: pd.DataFrame,
    first: pd.DataFrame | None = None,
    *,
    simulations: pd.DataFrame | None = None,
    replans: pd.DataFrame | None = None,
) -> list[Table]:
    """The summary, then the paper's comparisons and the studies that these runs can answer.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read_runs` gives it.
    first : DataFrame, optional
        As :func:`suite.store.read_first_measures` gives it.
    simulations, replans : DataFrame, optional
        As :func:`suite.store.read_simulations` and :func:`suite.store.read_replans` give them.
        Without them there are no tables of simulated runs.

    Returns
    -------
    list of Table
    """
    kept = newest(runs)
    left_out = len(runs) - len(kept)
    driven = kept[is_simulated(kept)]
    kept = kept[~is_simulated(kept)]
    moving = []
    if simulations is not None and replans is not None:
        moving = simulated_tables(driven, simulations, replans)
    if kept.empty and moving:
        return moving
    return [
        summary_table(kept, left_out),
        *moving,
        *paper_tables(kept),
        *ablation_tables(kept, COST_NOTE),
        *study_tables(kept, first),
    ]
