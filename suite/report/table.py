"""A table with its title and its note."""

from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from suite.errors import KbgaBenchError


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """A table of a report.

    name : of its file.
    title : one line above it.
    frame : DataFrame with one level of columns; the index carries nothing. Columns whose name
        ends in ``(s)`` or ``(ms)`` hold seconds or milliseconds, in ``(%)`` per cent.
    note : what a reader must know to read it rightly.
    infinite : what is printed for an infinite number; CSV holds ``inf``.
    detail : whether it holds the rows behind another table, too many to be printed among others.
    """

    name: str
    title: str
    frame: pd.DataFrame
    note: str = ""
    infinite: str = "infinite"
    detail: bool = False


def named(tables: Sequence[Table], names: Sequence[str]) -> list[Table]:
    """The tables of these names, in the order of the names; all of them if there are none.

    Raises
    ------
    KbgaBenchError
        If there is no table of a name.
    """
    there = {table.name: table for table in tables}
    for name in names:
        if name not in there:
            raise KbgaBenchError(
                f"--only: there is no table '{name}' of this store. Take one of: "
                f"{', '.join(there)}."
            )
    return [there[name] for name in dict.fromkeys(names)] or list(tables)
