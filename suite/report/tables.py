"""All tables of a store's runs: pure functions of its rows."""

import pandas as pd

from suite.report.newest import newest
from suite.report.paper_tables import paper_tables
from suite.report.summary import summary_table
from suite.report.table import Table


def all_tables(runs: pd.DataFrame) -> list[Table]:
    """The summary, then the paper's comparisons that these runs can answer.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read_runs` gives it.

    Returns
    -------
    list of Table
    """
    kept = newest(runs)
    return [summary_table(kept, len(runs) - len(kept)), *paper_tables(kept)]
