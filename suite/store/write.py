"""The result store: an SQLite file in WAL mode with one writer, a row committed when its run ends.

A row and all that belongs to it is written in one transaction, so kill -9 costs the runs in flight
and nothing else. pandas reads it; see :mod:`suite.store.read`.
"""

import json
import math
import sqlite3
import tempfile
import warnings
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import astuple
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from filelock import BaseFileLock, FileLock, Timeout

from suite.errors import StoreError, writing
from suite.planner import Snapshot
from suite.scenes.kept import digest_of, pack_scene
from suite.scenes.scene import Query, Scene
from suite.scenes.source_files import files_digest
from suite.store.connection import (
    check_is_store,
    connect,
    explained,
    missing,
    uri_for_reading,
)
from suite.store.read import read_sessions
from suite.store.record import Cell, RunRecord, canonical_json, short_hash
from suite.store.schema import BELONGINGS, add_what_is_new, columns_now, create_tables

RESTORES = 100
"""How often it is tried to write a store anew that is deleted again and again."""


class Store:
    """An open store, for its one writer. A context manager; made by :func:`open_store`.

    path : Path of the file.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection, lock: BaseFileLock) -> None:
        self.path = path
        self._connection = connection
        self._lock = lock
        self._session: int | None = None
        self._files = _identities(path)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file and let others write. Everything that was added is in it already.

        Raises
        ------
        StoreError
            If the file was deleted and can't be written anew.
        """
        try:
            self._restore_if_gone()
        finally:
            self._connection.close()
            self._lock.release()

    def begin_session(self, provenance: Mapping[str, Any]) -> None:
        """Say what machine and which versions the rows that follow come from."""
        with self._writing() as connection:
            cursor = connection.execute(
                "INSERT INTO sessions (provenance) VALUES (?)", (canonical_json(provenance),)
            )
            self._session = cursor.lastrowid

    def keys(self) -> set[str]:
        """Keys of the rows that are there."""
        with explained(self.path):
            return {key for (key,) in self._connection.execute("SELECT key FROM runs")}

    def statuses(self) -> dict[str, str]:
        """How the rows that are there ended, by their keys."""
        with explained(self.path):
            return dict(self._connection.execute("SELECT key, status FROM runs"))

    def contended(self) -> set[str]:
        """Keys of the rows whose runs waited for the processor."""
        with explained(self.path):
            rows = self._connection.execute("SELECT key FROM runs WHERE contended")
            return {key for (key,) in rows}

    def attempts(self) -> dict[str, int]:
        """How often each row was run, by its key."""
        with explained(self.path):
            return dict(self._connection.execute("SELECT key, coalesce(attempts, 1) FROM runs"))

    def count_attempt(self, key: str) -> None:
        """Note that a row was run once more and stays as it was."""
        with self._writing() as connection:
            connection.execute(
                "UPDATE runs SET attempts = coalesce(attempts, 1) + 1 WHERE key = ?", (key,)
            )

    def want(self, matrix: str, cells: Iterable[Cell]) -> None:
        """Write down what a matrix wants, in place of what it wanted before: for those who ask."""
        rows = [(matrix, cell.key, cell.scene, cell.variant, cell.position) for cell in cells]
        with self._writing() as connection:
            connection.execute("DELETE FROM wanted WHERE matrix = ?", (matrix,))
            connection.executemany("INSERT INTO wanted VALUES (?, ?, ?, ?, ?)", rows)

    def keep_scenes(self, scenes: Mapping[str, Scene], cells: Iterable[Cell]) -> None:
        """Keep the scenes that cells are run on, each once, so that the store needs no other file.

        Those of rows that are there already count too: an older store gets them so.

        Parameters
        ----------
        scenes : mapping from the name of each scene to it
        cells : iterable of Cell
        """
        wanted = {(c.scene, c.scene_hash, c.query): c.scene_source for c in cells}
        with self._writing() as connection:
            there = set(connection.execute("SELECT scene, scene_hash, query FROM queries"))
            missing = {name: source for name, source in wanted.items() if name not in there}
            digests = {
                name: _keep_document(connection, scenes[name], source)
                for name, source in {name: source for (name, *_), source in missing.items()}.items()
            }
            connection.executemany(
                "INSERT INTO queries VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
                [
                    (scene, fingerprint, query, digests[scene], *_ends(scenes[scene].query(query)))
                    for scene, fingerprint, query in missing
                ],
            )

    def add(self, record: RunRecord, *, replace: bool = False) -> None:
        """Write one row and all that belongs to it, whole or not at all.

        Parameters
        ----------
        record : RunRecord
        replace : bool
            In place of the row of the same key, if there is one.

        Raises
        ------
        StoreError
            If the row is there already, no session was begun, or the file can't be written.
        """
        if self._session is None:
            raise StoreError(f"{self.path}: begin a session before adding rows.")
        row = _as_row(record) | {"session": self._session}
        key = row["key"]
        with self._writing() as connection:
            if replace:
                for table in (*BELONGINGS, "runs"):
                    connection.execute(f"DELETE FROM {table} WHERE key = ?", (key,))
            connection.execute(_insert("runs", row), row)
            connection.executemany(
                "INSERT INTO events VALUES (?, ?, ?, ?, ?, ?, ?)",
                [(key, i, *astuple(report)) for i, report in enumerate(record.improvements)],
            )
            if record.trace:
                connection.execute(
                    "INSERT INTO traces VALUES (?, ?)", (key, json.dumps(_columns(record.trace)))
                )
            if record.path is not None:
                blob = np.ascontiguousarray(record.path, dtype="<f8").tobytes()
                connection.execute("INSERT INTO paths VALUES (?, ?)", (key, blob))
            if record.simulation is not None:
                data = json.dumps(record.simulation)
                connection.execute("INSERT INTO simulations VALUES (?, ?)", (key, data))

    def add_snapshots(self, key: str, snapshots: Iterable[Snapshot]) -> None:
        """Write the populations of a row that is there, in place of those it had."""
        rows = [(key, snapshot.generation, _packed(snapshot)) for snapshot in snapshots]
        with self._writing() as connection:
            connection.execute("DELETE FROM snapshots WHERE key = ?", (key,))
            connection.executemany("INSERT INTO snapshots VALUES (?, ?, ?)", rows)

    @contextmanager
    def attached(self, other: Path) -> Iterator[sqlite3.Connection]:
        """One transaction on this store (``main``) beside another one (``other``, read only)."""
        self._restore_if_gone()
        with explained(other):
            self._connection.execute("ATTACH ? AS other", (uri_for_reading(other),))
        try:
            with self._writing() as connection:
                yield connection
        finally:
            self._connection.execute("DETACH other")

    @contextmanager
    def _writing(self) -> Iterator[sqlite3.Connection]:
        self._restore_if_gone()
        with explained(self.path), self._connection:
            yield self._connection

    def _restore_if_gone(self) -> None:
        """Write the file anew, with all its rows, if somebody has deleted it.

        SQLite would go on in the deleted file without a word, and all rows would be lost at the
        end. Until then everything is still there, for this connection alone.
        """
        there = _identities(self.path)
        if there == self._files:
            return
        with explained(self.path):
            rows = self._connection.serialize()
        if there[0] not in (None, self._files[0]):
            kept = _kept(rows, Path(f"{self.path}.rescued"))
            raise StoreError(
                f"{self.path}: was replaced by another file while it was written to. Its rows are "
                f"kept in {kept}: put that in its place, and run the same command again."
            )
        # Closed before the new file is there: SQLite deletes the journals of its name with it.
        self._connection.close()
        self._write_anew(rows)
        (count,) = self._connection.execute("SELECT count(*) FROM runs").fetchone()
        warnings.warn(
            f"{self.path}: was deleted while it was written to, or its journal was. It is written "
            f"anew, with all its {count} rows. Find out who deletes it: a planner?",
            stacklevel=2,
        )

    def _write_anew(self, rows: bytes) -> None:
        """Put a file of these bytes in its place; whoever deletes it may do so in the middle."""
        for _ in range(RESTORES):
            try:
                _make_folder(self.path)
                if not _lock_file(self.path).exists():
                    self._lock.release()
                    self._lock = _locked(self.path)
                kept = _kept(rows, Path(f"{self.path}.rescued"))
                wanted = _identity(kept)
                kept.replace(self.path)
                connection = _open_for_writing(self.path)
            except (StoreError, OSError):
                continue
            files = _identities(self.path)
            # Deleted a moment ago, it would have been made anew as an empty one.
            if files[0] == wanted and None not in files:
                self._connection, self._files = connection, files
                return
            connection.close()
        kept = _kept(rows, Path(tempfile.mkdtemp(prefix="kbga-bench-"), self.path.name))
        raise StoreError(
            f"{self.path}: was deleted while it was written to, and can't be written anew. Its "
            f"rows are kept in {kept}: put that in its place, and run the same command again."
        )


def open_store(path: Path, *, create: bool = True) -> Store:
    """Open a store for writing.

    Parameters
    ----------
    path : Path
        The file.
    create : bool
        Make it, and the folder that it is in, when it is not there.

    Returns
    -------
    Store

    Raises
    ------
    StoreError
        If the file is missing (and ``create`` is false), is no store, comes from another version,
        can't be written, or another process has it open for writing.
    """
    is_new = not path.exists()
    if is_new and not create:
        raise missing(path)
    if is_new:
        _make_folder(path)
    lock = _locked(path)
    try:
        return Store(path, _open_for_writing(path), lock)
    except BaseException:
        lock.release()
        raise


def _open_for_writing(path: Path) -> sqlite3.Connection:
    connection = connect(path, writable=True)
    try:
        with explained(path):
            # In WAL mode NORMAL survives the death of the process; FULL would add an fsync a row
            # and save only rows of the last moment before a power cut, which are run again anyway.
            connection.execute("PRAGMA synchronous = NORMAL")
            if _is_empty(connection):
                create_tables(connection)
        check_is_store(path, connection)
        with explained(path):
            add_what_is_new(connection)
    except BaseException:
        connection.close()
        raise
    return connection


def _is_empty(connection: sqlite3.Connection) -> bool:
    (tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
    return bool(tables == 0)


def _locked(path: Path) -> BaseFileLock:
    """The right to write, held until it is released or the process ends, however it ends.

    The lock is on a file beside the store: SQLite's own locks last for a transaction only.
    """
    file = _lock_file(path)
    lock = FileLock(file, timeout=0)
    try:
        # The library waits for a folder that can't be written as for a lock that is held.
        file.touch()
        lock.acquire()
    except Timeout as error:
        raise StoreError(f"{path}: {_holder(path)}. Wait for it, or name another store.") from error
    except OSError as error:
        raise StoreError(
            f"{path}: can't be opened or written ({error.strerror}). Check its folder and "
            "permissions."
        ) from error
    return lock


def _lock_file(path: Path) -> Path:
    return Path(f"{path}.lock")


def _holder(path: Path) -> str:
    """Who writes to a store: whoever began the last session."""
    try:
        last = read_sessions(path)[-1]
    except (StoreError, IndexError):
        last = {}
    matrix, start = last.get("matrix", "a matrix"), last.get("started_at", "a moment ago")
    where = f"process {last.get('pid', '?')} on {last.get('host', 'this machine')}"
    return f"another process is writing to it ({where}, {matrix}, since {start})"


def is_being_written(path: Path) -> bool:
    """Whether a process has a store open for writing."""
    try:
        with FileLock(_lock_file(path), timeout=0):
            return False
    except Timeout:
        return True
    except OSError:
        # No right to write there: nobody to ask, and nothing that the caller could disturb.
        return False


def _kept(rows: bytes, file: Path) -> Path:
    """A store's bytes, written to a file."""
    with writing(file, StoreError):
        file.write_bytes(rows)
    return file


def _identities(path: Path) -> tuple[tuple[int, int] | None, ...]:
    """Which files a store's file and its journal are: other ones, or none, if they were deleted.

    SQLite makes the journal with the first change, and keeps it as long as the store is open.
    """
    return tuple(_identity(Path(f"{path}{suffix}")) for suffix in ("", "-wal"))


def _identity(file: Path) -> tuple[int, int] | None:
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino


def _make_folder(path: Path) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreError(f"{path}: its folder can't be made ({error.strerror}).") from error


def _keep_document(connection: sqlite3.Connection, scene: Scene, source: str) -> str:
    """Keep a scene, and return the digest that it is found by."""
    document = pack_scene(scene)
    digest = digest_of(document)
    connection.execute(
        "INSERT OR IGNORE INTO scenes VALUES (?, ?, ?)", (digest, document, files_digest(source))
    )
    return digest


def _ends(query: Query) -> tuple[float | str | None, ...]:
    return (*query.start.tolist(), *query.goal.tolist(), query.stratum)


def _as_row(record: RunRecord) -> dict[str, Any]:
    """The columns of a run: what cell and record call by the same name, and what is put otherwise.

    What a record has beside it stands in tables of its own.
    """
    cell, world = record.cell, record.cell.world
    named: dict[str, Any] = {
        name: getattr(owner, name)
        for owner in (cell, record)
        for name in columns_now("runs")
        if hasattr(owner, name)
    }
    return named | {
        "status": str(record.status),
        # What an exception says may hold half a character, as names of files do.
        "reason": record.reason and record.reason.encode("utf-8", "replace").decode(),
        "settings": canonical_json(cell.settings),
        "settings_hash": short_hash(cell.settings),
        "world": None if world is None else world.name,
        "world_settings": None if world is None else canonical_json(world.settings),
        "cold": world is not None and world.cold,
        "details": canonical_json(record.details),
        **{f"budget_{name}": value for name, value in cell.budget_as_dict.items()},
    }


def _insert(table: str, row: Mapping[str, Any]) -> str:
    return f"INSERT INTO {table} ({', '.join(row)}) VALUES ({', '.join(f':{c}' for c in row)})"


def _columns(trace: tuple[Mapping[str, float], ...]) -> dict[str, list[float | None]]:
    names = dict.fromkeys(name for measures in trace for name in measures)
    return {name: [_finite(measures.get(name)) for measures in trace] for name in names}


def _finite(value: float | None) -> float | None:
    """JSON has no word for NaN and infinity: what is written in its stead can't be read again."""
    return value if value is not None and math.isfinite(value) else None


def _packed(snapshot: Snapshot) -> bytes:
    """A population as compressed JSON, rounded to a micrometre: it is for looking at."""
    best = snapshot.best
    data = {
        "best": None if best is None else best.round(6).tolist(),
        "paths": [path.round(6).tolist() for path in snapshot.paths],
    }
    return zlib.compress(json.dumps(data, separators=(",", ":")).encode(), level=9)
