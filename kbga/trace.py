"""The trace of a run: what there was to say about each generation, as a table."""

from collections.abc import Iterable
from dataclasses import asdict, fields
from typing import TYPE_CHECKING

from kbga.measures import GenerationReport

if TYPE_CHECKING:
    import pandas as pd


def trace_of(reports: Iterable[GenerationReport]) -> "pd.DataFrame":
    """Put reports into a table, a row for each, a column for each field.

    Parameters
    ----------
    reports : iterable of GenerationReport
        As :meth:`kbga.algorithm.KBGA.report` gives them.

    Returns
    -------
    pandas.DataFrame

    Examples
    --------
    >>> trace_of([GenerationReport(0, 30.5, 42.0, 0.5, 1.0, 120)])
       generation  best  mean  feasible_share  diversity  checks
    0           0  30.5  42.0             0.5        1.0     120
    """
    import pandas as pd  # longer to load than most runs take, and few want a trace

    columns = [field.name for field in fields(GenerationReport)]
    return pd.DataFrame([asdict(report) for report in reports], columns=columns)
