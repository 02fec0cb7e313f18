"""Tables at a glance: scenes side by side, one text for each planner in each."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from suite.report.words import fixed, of_some

SIDE_BY_SIDE = 12
"""Scenes that a table has room for: of more, there are only the rows."""


def at_a_glance(
    frame: pd.DataFrame,
    rows: Sequence[str],
    cell: Callable[[Mapping[Any, Any]], str] | None = None,
) -> pd.DataFrame:
    """A comparison with the scenes side by side.

    Parameters
    ----------
    frame : DataFrame
        Of :func:`suite.report.tables.compared.compare`, or any with a column ``scene``.
    rows : sequence of str
        Its columns that name a row here.
    cell : callable, optional
        What to write of a row of the frame; by default its mean gap, see :func:`glance`.

    Returns
    -------
    DataFrame
        Cells such as ``0.24``, ``81.28 (19 of 20)`` where some runs found no path, and ``0 of 20``
        where none did.
    """
    places = list(dict.fromkeys(frame["scene"]))
    lines: dict[tuple[Any, ...], dict[str, str]] = {}
    for row in frame.to_dict("records"):
        line = lines.setdefault(tuple(row[name] for name in rows), {})
        line.setdefault(str(row["scene"]), (cell or glance)(row))
    return pd.DataFrame(
        [
            dict(zip(rows, name, strict=True)) | {place: line.get(place, "") for place in places}
            for name, line in lines.items()
        ],
        columns=[*rows, *places],
    )


def planners_together(frame: pd.DataFrame, by: str, *, falling: bool = False) -> pd.DataFrame:
    """The rows of each planner below each other, by a column; planners by their first rows."""
    order = {name: i for i, name in enumerate(dict.fromkeys(frame["planner"]))}
    values = -frame[by] if falling else frame[by]
    return frame.iloc[np.lexsort([values, frame["planner"].map(order)])]


def glance(row: Mapping[Any, Any]) -> str:
    """A row's mean gap, and how many of its runs it is over if not all."""
    runs, found = row["runs"], row["feasible"]
    return of_some(fixed(row["gap mean (%)"]), found, runs) if found else f"0 of {runs}"
