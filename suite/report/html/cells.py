"""Tables as the page has them: texts to read, and numbers to sort by."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any

from suite.report.formats import as_texts, is_numeric
from suite.report.table import Table

ROWS_AT_MOST = 1000


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a table.

    text : what is read.
    number : what it is sorted by; None if that is the text.
    style : CSS of this cell alone.
    """

    text: str
    number: float | None
    style: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """A table of the page.

    name : of its file in a results folder, and its anchor here.
    numeric : for each column, whether it is set to the right.
    left_out : number of rows that the page has no room for.
    detail : whether it holds the rows behind another table.
    """

    name: str
    title: str
    note: str
    columns: Sequence[str]
    numeric: Sequence[bool]
    rows: Sequence[Sequence[Cell]]
    left_out: int
    detail: bool


def sheet(table: Table) -> Sheet:
    """A table for the page.

    Parameters
    ----------
    table : Table
    """
    frame = table.frame[:ROWS_AT_MOST]
    texts = as_texts(replace(table, frame=frame))
    columns = [
        [Cell(text, _number(value)) for text, value in zip(texts[name], frame[name], strict=True)]
        for name in frame.columns
    ]
    return Sheet(
        table.name,
        table.title,
        table.note,
        [str(name) for name in frame.columns],
        [is_numeric(frame[name]) for name in frame.columns],
        list(zip(*columns, strict=True)),
        len(table.frame) - len(frame),
        table.detail,
    )


def _number(value: Any) -> float | None:
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    number = float(value)
    # JavaScript reads no "inf"; all numbers that are there are below this one.
    return (
        None
        if math.isnan(number)
        else math.copysign(1e300, number)
        if math.isinf(number)
        else number
    )
