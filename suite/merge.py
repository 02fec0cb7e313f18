"""Rows of other stores, taken into one: for matrices that several machines ran.

A row that is there already is left alone if both say the same. If they differ, as timed runs do,
the row that is there stays, and the other one is kept beside it as a conflict, by its source.
"""

import json
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from suite.errors import StoreError
from suite.store import BELONGINGS, Store, read_runs

OUTCOME = ("status", "cost", "generations", "checks")
"""What two runs of one key must agree on, beside the path, to be called the same."""


@dataclass(frozen=True, slots=True)
class Merged:
    """What came of taking in one store.

    source : its file.
    added : number of rows that were not there.
    same : number of rows that were there, with the same outcome.
    conflicts : keys of rows that were there with another outcome.
    """

    source: Path
    added: int
    same: int
    conflicts: tuple[str, ...]

    def summary(self) -> str:
        """One line."""
        text = f"{self.source}: {self.added} rows added, {self.same} were there"
        return f"{text}, {len(self.conflicts)} in conflict."


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
    return Merged(source, added, common - len(conflicts), tuple(conflicts))


def _conflicts(connection: sqlite3.Connection) -> list[str]:
    differs = " OR ".join(f"mine.{name} IS NOT its.{name}" for name in OUTCOME)
    rows = connection.execute(
        "SELECT its.key FROM other.runs AS its JOIN main.runs AS mine USING (key) "
        "LEFT JOIN other.paths AS its_path USING (key) "
        "LEFT JOIN main.paths AS my_path USING (key) "
        f"WHERE {differs} OR my_path.xy IS NOT its_path.xy ORDER BY its.key"
    )
    return [key for (key,) in rows]


def _keep_conflicts(connection: sqlite3.Connection, keys: Sequence[str], source: str) -> None:
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


def _copy_runs(connection: sqlite3.Connection, old: int, new: int | None) -> None:
    names = [row[1] for row in connection.execute("PRAGMA main.table_info(runs)")]
    chosen = ", ".join("?" if name == "session" else name for name in names)
    connection.execute(
        f"INSERT INTO main.runs ({', '.join(names)}) SELECT {chosen} FROM other.runs "
        "WHERE session = ? AND key IN missing",
        (new, old),
    )
