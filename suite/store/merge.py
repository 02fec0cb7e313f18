"""Rows of other stores, taken into one: for matrices that several machines ran.

A row that is there already is left alone if both say the same. If they differ, the row that is
there stays, and the other one is kept beside it as a conflict, by its source. Runs whose time
counts are expected to differ; the others should be the same on every machine.
"""

import json
import sqlite3
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from suite.errors import StoreError
from suite.store.read import read_runs, stored_cell
from suite.store.record import Cell
from suite.store.row_names import rows_in_words
from suite.store.schema import BELONGINGS, columns_of, has_table
from suite.store.write import Store

MOST_NAMED = 5
"""Rows that are named one by one; of more it is said how many each planner has."""

OUTCOME = ("status", "cost", "generations", "checks", "computed_checks")
"""What two runs of one key must agree on, beside the path, to be called the same."""


@dataclass(frozen=True, slots=True)
class Merged:
    """What came of taking in one store.

    source : its file.
    added : number of rows that were not there.
    same : number of rows that were there, with the same outcome.
    conflicts : cells of the rows that were there with another outcome, in the order of the matrix.
    """

    source: Path
    added: int
    same: int
    conflicts: tuple[Cell, ...]

    @property
    def alarming(self) -> tuple[Cell, ...]:
        """The conflicts that should not be: their time does not count."""
        return tuple(cell for cell in self.conflicts if not cell.time_counts)

    def as_text(self) -> str:
        """A few lines for people."""
        lines = [f"{self.source}: {self.added} rows added, {self.same} were there with the same"]
        lines[0] += f" outcome, {len(self.conflicts)} with another one."
        expected = [cell for cell in self.conflicts if cell.time_counts]
        if expected:
            lines.append(
                f"  {rows_in_words(len(expected))} came out otherwise, as is to be expected where "
                f"time counts: {_by_planner(expected)}."
            )
        if self.alarming:
            lines.append(
                f"  {rows_in_words(len(self.alarming))} should be the same bit for bit and came "
                "out otherwise. Another machine, version or plugin?"
            )
            lines += _named(self.alarming)
        if self.conflicts:
            lines.append("  Of each, the row that was there stays, and the other is kept beside.")
        return "\n".join(lines)


def merge(store: Store, sources: Sequence[Path]) -> list[Merged]:
    """Take the rows of other stores into this one.

    Parameters
    ----------
    store : Store
        Open for writing.
    sources : sequence of Path
        Stores; they are only read.

    Returns
    -------
    list of Merged
        One for each source.

    Raises
    ------
    StoreError
        If one of them can't be read, is this store itself, or rows can't be written; then nothing
        of that source was taken in.
    """
    for source in sources:
        if source.exists() and source.samefile(store.path):
            raise StoreError(f"{source}: is the store that it should be merged into. Leave it out.")
        # Says what is wrong with it before anything is written.
        read_runs(source)
    return [_merge(store, source) for source in sources]


def _merge(store: Store, source: Path) -> Merged:
    with store.attached(source) as connection:
        conflicts = _conflicts(connection)
        (common,) = connection.execute(
            "SELECT count(*) FROM other.runs WHERE key IN (SELECT key FROM main.runs)"
        ).fetchone()
        _keep_conflicts(connection, conflicts, str(source))
        connection.execute("INSERT OR IGNORE INTO main.conflicts SELECT * FROM other.conflicts")
        added = _add_missing(connection)
        _add_scenes(connection)
    return Merged(source, added, common - len(conflicts), tuple(conflicts.values()))


def _by_planner(cells: Sequence[Cell]) -> str:
    return ", ".join(f"{name} {count}" for name, count in Counter(c.variant for c in cells).items())


def _named(cells: Sequence[Cell]) -> list[str]:
    """A line for each, or for each planner, if there are many."""
    if len(cells) <= MOST_NAMED:
        return [f"    {cell.label}" for cell in cells]
    return [f"    {_by_planner(cells)}; the first of them is {cells[0].label}"]


def _conflicts(connection: sqlite3.Connection) -> dict[str, Cell]:
    """The cells of the rows that are in both with another outcome, by their keys."""
    # A store that is older than a column says nothing of it.
    known = [name for name in OUTCOME if name in columns_of(connection, "runs", "other")]
    differs = " OR ".join(f"mine.{name} IS NOT its.{name}" for name in known)
    found = connection.execute(
        "SELECT mine.* FROM other.runs AS its JOIN main.runs AS mine USING (key) "
        "LEFT JOIN other.paths AS its_path USING (key) "
        "LEFT JOIN main.paths AS my_path USING (key) "
        f"WHERE {differs} OR my_path.xy IS NOT its_path.xy "
        "ORDER BY mine.position, mine.key"
    )
    names = [column[0] for column in found.description]
    rows = [dict(zip(names, row, strict=True)) for row in found]
    return {row["key"]: stored_cell(row) for row in rows}


def _keep_conflicts(connection: sqlite3.Connection, keys: Iterable[str], source: str) -> None:
    for key in keys:
        with closing(connection.execute("SELECT * FROM other.runs WHERE key = ?", (key,))) as found:
            names = [column[0] for column in found.description]
            row = json.dumps(dict(zip(names, found.fetchone(), strict=True)))
        connection.execute(
            "INSERT OR REPLACE INTO main.conflicts "
            "SELECT ?, ?, ?, (SELECT xy FROM other.paths WHERE key = ?)",
            (key, source, row, key),
        )


def _add_missing(connection: sqlite3.Connection) -> int:
    """Copy the rows whose keys are not there, with what belongs to them and their sessions."""
    missing = "key NOT IN (SELECT key FROM main.runs)"
    connection.execute(f"CREATE TEMP TABLE missing AS SELECT key FROM other.runs WHERE {missing}")
    try:
        sessions = connection.execute(
            "SELECT id, provenance FROM other.sessions WHERE id IN "
            "(SELECT session FROM other.runs WHERE key IN missing) ORDER BY id"
        ).fetchall()
        for old, provenance in sessions:
            new = connection.execute(
                "INSERT INTO main.sessions (provenance) VALUES (?)", (provenance,)
            ).lastrowid
            _copy_runs(connection, old, new)
        for table in BELONGINGS:
            connection.execute(
                f"INSERT INTO main.{table} SELECT * FROM other.{table} WHERE key IN missing"
            )
        (added,) = connection.execute("SELECT count(*) FROM missing").fetchone()
    finally:
        connection.execute("DROP TABLE missing")
    return int(added)


def _add_scenes(connection: sqlite3.Connection) -> None:
    """Copy the scenes that rows ran on, but those that are there."""
    if not has_table(connection, "queries", "other"):
        return
    connection.execute("INSERT OR IGNORE INTO main.queries SELECT * FROM other.queries")
    connection.execute(
        "INSERT OR IGNORE INTO main.scenes SELECT * FROM other.scenes "
        "WHERE digest IN (SELECT digest FROM main.queries)"
    )


def _copy_runs(connection: sqlite3.Connection, old: int, new: int | None) -> None:
    there = columns_of(connection, "runs", "other")
    names = [name for name in columns_of(connection, "runs") if name in there]
    chosen = ", ".join("?" if name == "session" else name for name in names)
    connection.execute(
        f"INSERT INTO main.runs ({', '.join(names)}) SELECT {chosen} FROM other.runs "
        "WHERE session = ? AND key IN missing",
        (new, old),
    )
