"""The rows of a store by the names that people give: SCENE/PLANNER/SEED, or a key."""

import re
from pathlib import Path

import pandas as pd

from suite.errors import StoreError
from suite.store.read import read_runs, stored_cell
from suite.store.record import Cell

LEAST_DIGITS = 4
"""Of a key that is cut short: fewer name too many rows to be meant."""

DIGITS = 8
"""Of a key that is shown to people: enough for a store with some ten thousand rows."""

MOST_NAMED = 10
"""Rows that a message names: more is not read."""


def cell_of(store: Path, name: str) -> Cell:
    """The cell of a row.

    Parameters
    ----------
    store : Path
    name : str
        ``SCENE/PLANNER/SEED``, with the query or the world, or both, after the scene where there
        are several; also as progress and status write it, ``SCENE / PLANNER / seed SEED``. Or the
        row's key, or the beginning of it.

    Raises
    ------
    StoreError
        If no row, or more than one, is called so. The message lists what there is.
    """
    runs = read_runs(store)
    found = _named(runs, name) if "/" in name else _with_key(runs, name)
    if len(found) == 1:
        return stored_cell(found.to_dict("records")[0])
    if len(found) > 1:
        what = f"{len(found)} rows are called '{name}': {_listed(found)}. Say which."
    elif "/" in name:
        what = f"no row is called '{name}'. {_all_names(runs)}"
    else:
        what = (
            f"no row has a key that begins with '{name}'. Give {LEAST_DIGITS} digits at least "
            "(`kbga-bench status` shows those of failed rows), or SCENE/PLANNER/SEED. "
            f"{_all_names(runs)}"
        )
    raise StoreError(f"{store}: {what}")


def named(cell: Cell) -> str:
    """A row for people: what it is called, and the beginning of its key."""
    return f"{cell.label} ({cell.key[:DIGITS]})"


def _with_key(runs: pd.DataFrame, key: str) -> pd.DataFrame:
    return runs[runs["key"].str.startswith(key)] if len(key) >= LEAST_DIGITS else runs[:0]


def _named(runs: pd.DataFrame, name: str) -> pd.DataFrame:
    """The rows of a name, which may leave out query and world."""
    wanted = re.sub(r"/seed +", "/", _joined(name))
    chosen = pd.Series(data=False, index=runs.index)
    for more in ((), ("query",), ("world",), ("query", "world")):
        parts = [runs[column].fillna("").astype(str) for column in ("scene", *more, "variant")]
        names = parts[0].str.cat([*parts[1:], runs["seed"].astype(str)], sep="/")
        chosen |= names.map(_joined) == wanted
    return runs[chosen]


def _joined(name: str) -> str:
    """Without spaces around the strokes."""
    return re.sub(r" */ *", "/", name.strip())


def _listed(rows: pd.DataFrame) -> str:
    cells = [stored_cell(row) for row in rows[:MOST_NAMED].to_dict("records")]
    more = f" and {len(rows) - MOST_NAMED} more" if len(rows) > MOST_NAMED else ""
    return ", ".join(map(named, cells)) + more


def _all_names(runs: pd.DataFrame) -> str:
    """What there is, part by part."""
    if runs.empty:
        return "It has no rows."
    parts = {"scenes": "scene", "worlds": "world", "planners": "variant", "seeds": "seed"}
    texts = [
        f"{what}: {_all_of(runs[column].dropna())}"
        for what, column in parts.items()
        if runs[column].notna().any()
    ]
    return f"It has {'; '.join(texts)}."


def _all_of(values: pd.Series) -> str:
    found = values.drop_duplicates().tolist()
    if values.name == "seed" and len(found) == max(found) - min(found) + 1 > 2:
        return f"{min(found)} to {max(found)}"
    return ", ".join(map(str, found))


def rows_in_words(count: int) -> str:
    """A number of rows, as one says it: "1 row", "2 rows"."""
    return "1 row" if count == 1 else f"{count} rows"
