"""A table with its title and its note."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum, auto

import pandas as pd

from suite.errors import KbgaBenchError

INFINITE = "infinite"


class Kind(Enum):
    """What the numbers of a column are: it says how a reader wants them printed."""

    MEASURE = auto()
    COUNT = auto()
    """Means and medians of whole numbers."""
    TIME = auto()
    P_VALUE = auto()
    PRINTED = auto()
    """The paper's own figures, as it prints them."""
    MIXED = auto()
    """Several quantities below each other."""


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """A table of a report.

    name : of its file.
    title : one line above it.
    frame : DataFrame with one level of columns; the index carries nothing. A column's unit stands
        in brackets at the end of its name: (m), (%), (s), (ms), (us).
    note : what a reader must know to read it rightly.
    infinite : what is printed for an infinite number; CSV holds ``inf``.
    infinite_in : the same for some of the columns.
    detail : whether it holds the rows behind another table, too many to be printed among others.
    on_page : whether the report shows it; of what is too long even for that there are files alone.
    kinds : of columns of numbers that are neither times, by their unit, nor plain measures.
    """

    name: str
    title: str
    frame: pd.DataFrame
    note: str = ""
    infinite: str = INFINITE
    detail: bool = False
    kinds: Mapping[str, Kind] = field(default_factory=dict)
    infinite_in: Mapping[str, str] = field(default_factory=dict)
    on_page: bool = True

    def kind(self, column: str) -> Kind:
        """What the numbers of a column are."""
        is_time = column.endswith(("(s)", "(ms)", "(us)"))
        return self.kinds.get(column, Kind.TIME if is_time else Kind.MEASURE)


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
