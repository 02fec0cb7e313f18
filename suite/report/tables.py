"""All tables of a store's runs: pure functions of its rows."""

import pandas as pd

from suite.report.ablation import ablation_tables
from suite.report.newest import newest
from suite.report.paper_tables import COST_NOTE, paper_tables
from suite.report.studies import study_tables
from suite.report.summary import summary_table
from suite.report.table import Table


def all_tables(runs: pd.DataFrame, first: pd.DataFrame | None = None) -> list[Table]:
    """The summary, then the paper's comparisons and the studies that these runs can answer.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read_runs` gives it.
    first : DataFrame, optional
        As :func:`suite.store.read_first_measures` gives it.

    Returns
    -------
    list of Table
    """
    kept = newest(runs)
    return [
        summary_table(kept, len(runs) - len(kept)),
        *paper_tables(kept),
        *ablation_tables(kept, COST_NOTE),
        *study_tables(kept, first),
    ]
