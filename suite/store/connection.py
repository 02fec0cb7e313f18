"""Opening a store's file, and what SQLite's errors mean to a user."""

import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from suite.errors import StoreError
from suite.store.schema import APPLICATION_ID, SCHEMA_VERSION

BUSY_S = 10.0
"""How long to wait for another process that writes."""


def connect(path: Path, *, writable: bool) -> sqlite3.Connection:
    """Connect to the file of a store, made if it is missing and may be written."""
    # As a URI too, so that other stores can be attached for reading only.
    return _connected(path, path.absolute().as_uri() if writable else uri_for_reading(path))


def _connected(path: Path, uri: str) -> sqlite3.Connection:
    with explained(path):
        return sqlite3.connect(uri, uri=True, timeout=BUSY_S)


def uri_for_reading(path: Path) -> str:
    """How SQLite is told to open a store beside whoever writes to it.

    It wants to write its journal even then. In a folder that can't be written, as on a disk that is
    mounted read-only, it is told that there is no writer, unless there is a journal that says so.
    """
    if not os.access(path.parent, os.W_OK) and not _has_journal(path):
        return _uri_without_writer(path)
    return f"{path.absolute().as_uri()}?mode=ro"


def _uri_without_writer(path: Path) -> str:
    return f"{path.absolute().as_uri()}?mode=ro&immutable=1"


def _has_journal(path: Path) -> bool:
    """Whether there are rows that are not in the file itself yet."""
    journal = Path(f"{path}-wal")
    return journal.exists() and journal.stat().st_size > 0


def open_for_reading(path: Path) -> sqlite3.Connection:
    """Open a store beside whoever writes to it; StoreError if it is missing, or is no store."""
    if not path.exists():
        raise missing(path)
    try:
        return _checked(path, uri_for_reading(path))
    except StoreError as error:
        # The disk is too full for the journal that a reader wants, where there is no writer's.
        kind = getattr(error.__cause__, "sqlite_errorname", "")
        if _has_journal(path) or not kind.startswith(("SQLITE_IOERR", "SQLITE_FULL")):
            raise
        return _checked(path, _uri_without_writer(path))


def _checked(path: Path, uri: str) -> sqlite3.Connection:
    connection = _connected(path, uri)
    try:
        check_is_store(path, connection)
    except BaseException:
        connection.close()
        raise
    return connection


def check_is_store(path: Path, connection: sqlite3.Connection) -> None:
    """Raise StoreError unless the file is a store of this version."""
    with explained(path):
        (application,) = connection.execute("PRAGMA application_id").fetchone()
        (version,) = connection.execute("PRAGMA user_version").fetchone()
    if application != APPLICATION_ID:
        raise StoreError(f"{path}: is an SQLite file, but no store of kbga-bench. Name another.")
    if version != SCHEMA_VERSION:
        raise StoreError(
            f"{path}: is a store of version {version}, and this kbga-bench reads version "
            f"{SCHEMA_VERSION}. Use the kbga-bench that wrote it, or name a new store."
        )


def missing(path: Path) -> StoreError:
    """The error to raise where there is no store."""
    return StoreError(f"{path}: there is no such store. `kbga-bench run` makes one.")


@contextmanager
def explained(path: Path) -> Iterator[None]:
    """Say SQLite's errors in words that name the file and what to do."""
    try:
        yield
    except sqlite3.IntegrityError as error:
        raise StoreError(f"{path}: a row can't be added ({error}).") from error
    except sqlite3.DatabaseError as error:
        raise StoreError(f"{path}: {_in_words(error)}") from error


def _in_words(error: sqlite3.DatabaseError) -> str:
    name = getattr(error, "sqlite_errorname", "")
    if name.startswith("SQLITE_NOTADB"):
        return "is no store (not an SQLite file). Name another."
    if name.startswith(("SQLITE_BUSY", "SQLITE_LOCKED")):
        return "another process is writing to it. Wait for it, or name another store."
    if name.startswith(("SQLITE_READONLY", "SQLITE_CANTOPEN", "SQLITE_PERM")):
        return f"can't be opened or written ({error}). Check its folder and permissions."
    if name.startswith("SQLITE_FULL"):
        return "the disk is full. Make room and run the same command again."
    if name.startswith("SQLITE_IOERR"):
        return f"can't be read or written ({error}). Look after its disk: full, over quota, gone?"
    return f"SQLite says: {error}."
