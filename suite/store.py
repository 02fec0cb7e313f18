"""The result store: an SQLite file in WAL mode with one writer, a row committed when its run ends.

A row and all that belongs to it is written in one transaction, so kill -9 costs the runs in flight
and nothing else. pandas reads it; see :func:`read_runs`.
"""

import json
import math
import sqlite3
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import fields
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
import pandas as pd
from filelock import BaseFileLock, FileLock, Timeout
from numpy.typing import NDArray

from suite.errors import StoreError
from suite.planner import Snapshot
from suite.record import Cell, RunRecord, canonical_json, short_hash

APPLICATION_ID = 0x4B424741  # "KBGA"
SCHEMA_VERSION = 2
BUSY_S = 10.0
"""How long to wait for another process that writes."""

SCHEMA = """
CREATE TABLE sessions (
    id INTEGER PRIMARY KEY,
    provenance TEXT NOT NULL
);
CREATE TABLE runs (
    key TEXT PRIMARY KEY, position INTEGER NOT NULL,
    session INTEGER NOT NULL REFERENCES sessions (id),
    scene TEXT NOT NULL, query TEXT NOT NULL, world TEXT, variant TEXT NOT NULL,
    seed INTEGER NOT NULL,
    status TEXT NOT NULL, reason TEXT,
    cost REAL, claimed_cost REAL, claim_differs INTEGER, optimum REAL, gap REAL,
    clearance REAL, segments INTEGER, turning REAL,
    generations INTEGER, generation_of_best INTEGER, checks INTEGER, computed_checks INTEGER,
    wall_s REAL, time_to_best_s REAL, cpu_s REAL, cpu_to_best_s REAL,
    load REAL, contended INTEGER, attempts INTEGER,
    planner TEXT NOT NULL, distribution TEXT NOT NULL, version TEXT NOT NULL,
    settings TEXT NOT NULL, settings_hash TEXT NOT NULL, world_settings TEXT, cold INTEGER NOT NULL,
    budget_wall_s REAL, budget_generations INTEGER, budget_checks INTEGER, budget_cpu_s REAL,
    scene_source TEXT NOT NULL, scene_hash TEXT NOT NULL,
    host TEXT, started_at TEXT, details TEXT NOT NULL, stderr TEXT NOT NULL
);
CREATE TABLE events (
    key TEXT NOT NULL REFERENCES runs (key), number INTEGER NOT NULL,
    wall_s REAL NOT NULL, cpu_s REAL NOT NULL, cost REAL NOT NULL,
    generation INTEGER, checks INTEGER,
    PRIMARY KEY (key, number)
) WITHOUT ROWID;
CREATE TABLE traces (key TEXT PRIMARY KEY REFERENCES runs (key), trace TEXT NOT NULL);
CREATE TABLE paths (key TEXT PRIMARY KEY REFERENCES runs (key), xy BLOB NOT NULL);
CREATE TABLE simulations (key TEXT PRIMARY KEY REFERENCES runs (key), data TEXT NOT NULL);
CREATE TABLE snapshots (
    key TEXT NOT NULL REFERENCES runs (key), generation INTEGER NOT NULL, data BLOB NOT NULL,
    PRIMARY KEY (key, generation)
) WITHOUT ROWID;
CREATE TABLE wanted (
    matrix TEXT NOT NULL, key TEXT NOT NULL, scene TEXT NOT NULL, variant TEXT NOT NULL,
    position INTEGER,
    PRIMARY KEY (matrix, key)
) WITHOUT ROWID;
CREATE TABLE conflicts (
    key TEXT NOT NULL, source TEXT NOT NULL, row TEXT NOT NULL, xy BLOB,
    PRIMARY KEY (key, source)
) WITHOUT ROWID;
"""

BELONGINGS = ("events", "traces", "paths", "simulations", "snapshots")
"""Tables that hold more of a run, by its key."""

_CELL_COLUMNS = tuple(f.name for f in fields(Cell) if f.name not in ("settings", "budget", "world"))
_OUTCOME_COLUMNS = tuple(
    f.name
    for f in fields(RunRecord)
    if f.name not in ("cell", "improvements", "trace", "path", "details", "simulation", "snapshots")
)


class Store:
    """An open store, for its one writer. A context manager; made by :func:`open_store`.

    path : Path of the file.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection, lock: BaseFileLock) -> None:
        self.path = path
        self._connection = connection
        self._lock = lock
        self._session: int | None = None

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
        """Close the file and let others write. Everything that was added is in it already."""
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
        with _explained(self.path):
            return {key for (key,) in self._connection.execute("SELECT key FROM runs")}

    def statuses(self) -> dict[str, str]:
        """How the rows that are there ended, by their keys."""
        with _explained(self.path):
            return dict(self._connection.execute("SELECT key, status FROM runs"))

    def contended(self) -> set[str]:
        """Keys of the rows whose runs waited for the processor."""
        with _explained(self.path):
            rows = self._connection.execute("SELECT key FROM runs WHERE contended")
            return {key for (key,) in rows}

    def attempts(self) -> dict[str, int]:
        """How often each row was run, by its key."""
        with _explained(self.path):
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
        row = _as_row(record)
        row["session"] = self._session
        key = row["key"]
        with self._writing() as connection:
            if replace:
                for table in (*BELONGINGS, "runs"):
                    connection.execute(f"DELETE FROM {table} WHERE key = ?", (key,))
            connection.execute(_insert("runs", row), row)
            connection.executemany(
                "INSERT INTO events VALUES (?, ?, ?, ?, ?, ?, ?)",
                [
                    (key, i, e.wall_s, e.cpu_s, e.cost, e.generation, e.checks)
                    for i, e in enumerate(record.improvements)
                ],
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
        with _explained(other):
            uri = f"{other.absolute().as_uri()}?mode=ro"
            self._connection.execute("ATTACH ? AS other", (uri,))
        try:
            with self._writing() as connection:
                yield connection
        finally:
            self._connection.execute("DETACH other")

    @contextmanager
    def _writing(self) -> Iterator[sqlite3.Connection]:
        with _explained(self.path), self._connection:
            yield self._connection


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
        raise _missing(path)
    if is_new:
        _make_folder(path)
    lock = _locked(path)
    try:
        return Store(path, _open_for_writing(path), lock)
    except BaseException:
        lock.release()
        raise


def _open_for_writing(path: Path) -> sqlite3.Connection:
    connection = _connect(path, writable=True)
    try:
        with _explained(path):
            # In WAL mode NORMAL survives the death of the process; FULL would add an fsync a row
            # and save only rows of the last moment before a power cut, which are run again anyway.
            connection.execute("PRAGMA synchronous = NORMAL")
            if _is_empty(connection):
                _create_tables(connection)
        _check_is_store(path, connection)
        with _explained(path):
            _add_columns(connection)
    except BaseException:
        connection.close()
        raise
    return connection


def _add_columns(connection: sqlite3.Connection) -> None:
    """Stores that are older than a column are stores of the same version without it."""
    for table in ("runs", "wanted"):
        there = columns_of(connection, table)
        for name, kind in _columns_now(table).items():
            if name not in there:
                connection.execute(f"ALTER TABLE {table} ADD COLUMN {name} {kind}")


def columns_of(connection: sqlite3.Connection, table: str, database: str = "main") -> list[str]:
    """Names of the columns that a table has in a file, which may be older than this code."""
    return [row[1] for row in connection.execute(f"PRAGMA {database}.table_info({table})")]


@cache
def _columns_now(table: str) -> dict[str, str]:
    """Names and types of the columns of a table in a store that is made today, in their order."""
    with closing(sqlite3.connect(":memory:")) as connection:
        connection.executescript(SCHEMA)
        return {row[1]: row[2] for row in connection.execute(f"PRAGMA table_info({table})")}


def _locked(path: Path) -> BaseFileLock:
    """The right to write, held until it is released or the process ends, however it ends.

    The lock is on a file beside the store: SQLite's own locks last for a transaction only.
    """
    file = Path(f"{path}.lock")
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
        with FileLock(f"{path}.lock", timeout=0):
            return False
    except Timeout:
        return True
    except OSError:
        # No right to write there: nobody to ask, and nothing that the caller could disturb.
        return False


def read_wanted(path: Path) -> pd.DataFrame:
    """What the matrices of a store want, in their order.

    Returns
    -------
    DataFrame
        matrix, key, scene, variant, position, and the status or nothing.
    """
    frame = _read(
        path,
        "SELECT wanted.*, status FROM wanted LEFT JOIN runs ON runs.key = wanted.key "
        "ORDER BY matrix, wanted.key",
    )
    if "position" not in frame:
        # Written by an older kbga-bench, and not by this one yet.
        frame["position"] = 0
    return frame.sort_values(["matrix", "position", "key"], ignore_index=True)


def read_conflicts(path: Path) -> pd.DataFrame:
    """Rows of other stores that say something else than the ones here: key, source, row (JSON)."""
    return _read(path, "SELECT key, source, row FROM conflicts ORDER BY key, source")


def read_runs(path: Path) -> pd.DataFrame:
    """All rows, one for each run, in the order of their matrix.

    Returns
    -------
    DataFrame
        The columns are the fields of :class:`suite.record.Cell` and
        :class:`suite.record.RunRecord`; settings and details are JSON text. Only simulated runs
        have a ``world``.
    """
    frame = _read(path, "SELECT * FROM runs ORDER BY position, rowid")
    # An older kbga-bench wrote without some of them, a younger one added those at the end.
    frame = frame.reindex(columns=list(_columns_now("runs")))
    for column in ("claim_differs", "contended", "cold"):
        frame[column] = frame[column].astype("boolean")
    for column in (
        "segments", "generations", "generation_of_best", "checks", "computed_checks", "attempts",
    ):  # fmt: skip
        frame[column] = frame[column].astype("Int64")
    numbers = [
        "cost", "claimed_cost", "optimum", "gap", "clearance", "turning", "wall_s",
        "time_to_best_s", "cpu_s", "cpu_to_best_s", "load", "budget_wall_s",
        "budget_cpu_s",
    ]  # fmt: skip
    # A column without a single value would arrive as objects.
    frame[numbers] = frame[numbers].astype("float64")
    return frame


def read_events(path: Path) -> pd.DataFrame:
    """Improvements of all runs: key, number, wall_s, cpu_s, cost, generation, checks."""
    return _read(path, "SELECT * FROM events ORDER BY key, number")


def read_traces(path: Path) -> pd.DataFrame:
    """Measures of the generations of all runs that described them: key, then what they gave."""
    with closing(_open_for_reading(path)) as connection, _explained(path):
        rows = connection.execute("SELECT key, trace FROM traces ORDER BY key").fetchall()
    frames = [pd.DataFrame(json.loads(text)).assign(key=key) for key, text in rows]
    if not frames:
        return pd.DataFrame({"key": pd.Series(dtype="str")})
    frame = pd.concat(frames, ignore_index=True)
    return frame[["key", *(c for c in frame.columns if c != "key")]]


def read_first_measures(path: Path) -> pd.DataFrame:
    """What the runs that described their generations gave of the first one, by key.

    Returns
    -------
    DataFrame
        Indexed by key; a column for each measure.
    """
    with closing(_open_for_reading(path)) as connection, _explained(path):
        # SQLite takes the first of each measure out of the text: traces are long.
        rows = connection.execute(
            "SELECT traces.key, measure.key, json_extract(measure.value, '$[0]') "
            "FROM traces, json_each(traces.trace) AS measure"
        ).fetchall()
    frame = pd.DataFrame(rows, columns=["key", "measure", "first"])
    return frame.pivot(index="key", columns="measure", values="first")  # noqa: PD010


def read_paths(path: Path) -> dict[str, NDArray[np.float64]]:
    """Paths as the planners returned them: key to (n, 2) float64, metres."""
    with closing(_open_for_reading(path)) as connection, _explained(path):
        rows = connection.execute("SELECT key, xy FROM paths").fetchall()
    return {key: np.frombuffer(xy, dtype="<f8").reshape(-1, 2) for key, xy in rows}


def read_snapshots(path: Path) -> dict[str, list[Snapshot]]:
    """Populations of the runs that they were kept of, generation by generation, by key."""
    with closing(_open_for_reading(path)) as connection, _explained(path):
        rows = connection.execute("SELECT * FROM snapshots ORDER BY key, generation").fetchall()
    found: dict[str, list[Snapshot]] = {}
    for key, generation, data in rows:
        found.setdefault(key, []).append(_unpacked(generation, data))
    return found


def read_trace(path: Path, key: str) -> pd.DataFrame:
    """Measures of the generations of one run; empty if it did not describe them."""
    with closing(_open_for_reading(path)) as connection, _explained(path):
        row = connection.execute("SELECT trace FROM traces WHERE key = ?", (key,)).fetchone()
    return pd.DataFrame(json.loads(row[0]) if row else {})


def read_simulations(path: Path) -> pd.DataFrame:
    """What came of the simulated runs: a row for each.

    Returns
    -------
    DataFrame
        key, outcome, opening (the last one passed), hits (number), end_s, waiting_s.
    """
    return _read(
        path,
        "SELECT key, data ->> 'outcome' AS outcome, data ->> 'opening' AS opening, "
        "json_array_length(data, '$.hits') AS hits, data ->> 'time' AS end_s, "
        "data ->> 'waiting_time' AS waiting_s FROM simulations ORDER BY rowid",
    )


def read_replans(path: Path) -> pd.DataFrame:
    """Each time that the planner of a simulated run was asked: a row for each.

    Returns
    -------
    DataFrame
        key, number (from 0), time (simulated seconds), changed (whether the robot knew something
        new), status, cost and optimum (metres), latency_s, generations, checks,
        computed_checks.
    """
    columns = ("time", "changed", "status", "cost", "optimum", "latency_s")
    counts = ("generations", "checks", "computed_checks")
    values = ", ".join(f"replan.value ->> '{name}' AS {name}" for name in (*columns, *counts))
    frame = _read(
        path,
        f"SELECT simulations.key, replan.key AS number, {values} "
        "FROM simulations, json_each(simulations.data, '$.replans') AS replan "
        "ORDER BY simulations.rowid, number",
    )
    numbers = ["cost", "optimum", "latency_s"]
    frame[numbers] = frame[numbers].astype("float64")
    return frame.astype({"changed": "boolean", **dict.fromkeys(counts, "Int64")})


def read_simulation(path: Path, key: str) -> dict[str, Any]:
    """All of one simulated run, as :func:`suite.dynamic.plain.as_data` gave it.

    Raises
    ------
    StoreError
        If the store has no simulation of that key.
    """
    with closing(_open_for_reading(path)) as connection, _explained(path):
        row = connection.execute("SELECT data FROM simulations WHERE key = ?", (key,)).fetchone()
    if row is None:
        raise StoreError(f"{path}: row {key} is no simulated run.")
    data: dict[str, Any] = json.loads(row[0])
    return data


def read_sessions(path: Path) -> list[dict[str, Any]]:
    """Provenance of each session that wrote rows, oldest first, with its ``id``."""
    with closing(_open_for_reading(path)) as connection, _explained(path):
        rows = connection.execute("SELECT id, provenance FROM sessions ORDER BY id").fetchall()
    return [{"id": number, **json.loads(text)} for number, text in rows]


def _as_row(record: RunRecord) -> dict[str, Any]:
    cell = record.cell
    row: dict[str, Any] = {name: getattr(cell, name) for name in _CELL_COLUMNS}
    row |= {name: getattr(record, name) for name in _OUTCOME_COLUMNS}
    row |= {f"budget_{name}": value for name, value in cell.budget_as_dict.items()}
    row["key"] = cell.key
    row["status"] = str(record.status)
    # What an exception says may hold half a character, as names of files do.
    row["reason"] = record.reason and record.reason.encode("utf-8", "replace").decode()
    row["settings"] = canonical_json(cell.settings)
    row["settings_hash"] = short_hash(cell.settings)
    world = cell.world
    row["world"] = None if world is None else world.name
    row["world_settings"] = None if world is None else canonical_json(world.settings)
    row["cold"] = world is not None and world.cold
    row["details"] = canonical_json(record.details)
    return row


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


def _unpacked(generation: int, packed: bytes) -> Snapshot:
    data = json.loads(zlib.decompress(packed))
    paths = tuple(np.array(path, dtype=np.float64) for path in data["paths"])
    best = None if data["best"] is None else np.array(data["best"], dtype=np.float64)
    return Snapshot(generation, paths, best)


def _missing(path: Path) -> StoreError:
    return StoreError(f"{path}: there is no such store. `kbga-bench run` makes one.")


def _make_folder(path: Path) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreError(f"{path}: its folder can't be made ({error.strerror}).") from error


def _connect(path: Path, *, writable: bool) -> sqlite3.Connection:
    with _explained(path):
        if writable:
            # As a URI too, so that other stores can be attached for reading only.
            return sqlite3.connect(f"{path.absolute().as_uri()}", uri=True, timeout=BUSY_S)
        return sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True, timeout=BUSY_S)


def _open_for_reading(path: Path) -> sqlite3.Connection:
    if not path.exists():
        raise _missing(path)
    connection = _connect(path, writable=False)
    try:
        _check_is_store(path, connection)
    except BaseException:
        connection.close()
        raise
    return connection


def _is_empty(connection: sqlite3.Connection) -> bool:
    (tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
    return bool(tables == 0)


def _create_tables(connection: sqlite3.Connection) -> None:
    # WAL is set first: it can't be changed inside a transaction. All else is one, so that a store
    # exists whole or not at all.
    connection.execute("PRAGMA journal_mode = WAL")
    connection.executescript(
        f"BEGIN EXCLUSIVE; {SCHEMA} PRAGMA application_id = {APPLICATION_ID};"
        f"PRAGMA user_version = {SCHEMA_VERSION}; COMMIT;"
    )


def _check_is_store(path: Path, connection: sqlite3.Connection) -> None:
    with _explained(path):
        (application,) = connection.execute("PRAGMA application_id").fetchone()
        (version,) = connection.execute("PRAGMA user_version").fetchone()
    if application != APPLICATION_ID:
        raise StoreError(f"{path}: is an SQLite file, but no store of kbga-bench. Name another.")
    if version != SCHEMA_VERSION:
        raise StoreError(
            f"{path}: is a store of version {version}, and this kbga-bench reads version "
            f"{SCHEMA_VERSION}. Use the kbga-bench that wrote it, or name a new store."
        )


def _read(path: Path, query: str) -> pd.DataFrame:
    with closing(_open_for_reading(path)) as connection, _explained(path):
        return pd.read_sql_query(query, connection)


@contextmanager
def _explained(path: Path) -> Iterator[None]:
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
