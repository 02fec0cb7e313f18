"""What is in a store, for pandas: one function for each table, beside any writer."""

import json
import zlib
from collections.abc import Mapping
from contextlib import closing
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.errors import StoreError
from suite.planner import Budget, Snapshot
from suite.store.connection import explained, open_for_reading
from suite.store.gap import gaps
from suite.store.record import Cell, World
from suite.store.schema import columns_now

_KINDS = {
    "BOOLEAN": "boolean",
    "BOOLEAN NOT NULL": "boolean",
    "INTEGER": "Int64",
    "REAL": "float64",
}
"""Declared types of columns as pandas has them; all others are as SQLite gives them."""

_TEXTS = tuple(field.name for field in fields(Cell) if field.type is str)
"""Fields of a cell that are columns of a row as they are."""


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
        The columns are the fields of :class:`suite.store.record.Cell` and
        :class:`suite.store.record.RunRecord`; settings and details are JSON text. Only simulated
        runs have a ``world``. The gap is that of cost and optimum, see :mod:`suite.store.gap`.
    """
    frame = _read(path, "SELECT * FROM runs ORDER BY position, rowid")
    # An older kbga-bench wrote without some of them, a younger one added those at the end.
    columns = columns_now("runs")
    frame = frame.reindex(columns=list(columns))
    # A column without a single value would arrive as objects.
    kinds = {name: _KINDS[kind] for name, kind in columns.items() if kind in _KINDS}
    frame = frame.astype(kinds)
    # What a row holds is another's arithmetic, and can't be infinite.
    return frame.assign(gap=gaps(frame["cost"], frame["optimum"]))


def read_events(path: Path) -> pd.DataFrame:
    """Improvements of all runs: key, number, wall_s, cpu_s, cost, generation, checks."""
    return _read(path, "SELECT * FROM events ORDER BY key, number")


def read_traces(path: Path) -> pd.DataFrame:
    """Measures of the generations of all runs that described them: key, then what they gave."""
    with closing(open_for_reading(path)) as connection, explained(path):
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
    with closing(open_for_reading(path)) as connection, explained(path):
        # SQLite takes the first of each measure out of the text: traces are long.
        rows = connection.execute(
            "SELECT traces.key, measure.key, json_extract(measure.value, '$[0]') "
            "FROM traces, json_each(traces.trace) AS measure"
        ).fetchall()
    frame = pd.DataFrame(rows, columns=["key", "measure", "first"])
    return frame.pivot(index="key", columns="measure", values="first")  # noqa: PD010


def read_paths(path: Path) -> dict[str, NDArray[np.float64]]:
    """Paths as the planners returned them: key to (n, 2) float64, metres."""
    with closing(open_for_reading(path)) as connection, explained(path):
        rows = connection.execute("SELECT key, xy FROM paths").fetchall()
    return {key: np.frombuffer(xy, dtype="<f8").reshape(-1, 2) for key, xy in rows}


def read_snapshots(path: Path) -> dict[str, list[Snapshot]]:
    """Populations of the runs that they were kept of, generation by generation, by key."""
    with closing(open_for_reading(path)) as connection, explained(path):
        rows = connection.execute("SELECT * FROM snapshots ORDER BY key, generation").fetchall()
    found: dict[str, list[Snapshot]] = {}
    for key, generation, data in rows:
        found.setdefault(key, []).append(_unpacked(generation, data))
    return found


def read_trace(path: Path, key: str) -> pd.DataFrame:
    """Measures of the generations of one run; empty if it did not describe them."""
    with closing(open_for_reading(path)) as connection, explained(path):
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
    """All of one simulated run, as :func:`suite.simulation.record.as_data` gave it.

    Raises
    ------
    StoreError
        If the store has no simulation of that key.
    """
    with closing(open_for_reading(path)) as connection, explained(path):
        row = connection.execute("SELECT data FROM simulations WHERE key = ?", (key,)).fetchone()
    if row is None:
        raise StoreError(f"{path}: row {key} is no simulated run.")
    data: dict[str, Any] = json.loads(row[0])
    return data


def read_sessions(path: Path) -> list[dict[str, Any]]:
    """Provenance of each session that wrote rows, oldest first, with its ``id``."""
    with closing(open_for_reading(path)) as connection, explained(path):
        rows = connection.execute("SELECT id, provenance FROM sessions ORDER BY id").fetchall()
    return [{"id": number, **json.loads(text)} for number, text in rows]


def _unpacked(generation: int, packed: bytes) -> Snapshot:
    data = json.loads(zlib.decompress(packed))
    paths = tuple(np.array(path, dtype=np.float64) for path in data["paths"])
    best = None if data["best"] is None else np.array(data["best"], dtype=np.float64)
    return Snapshot(generation, paths, best)


def _read(path: Path, query: str) -> pd.DataFrame:
    with closing(open_for_reading(path)) as connection, explained(path):
        return pd.read_sql_query(query, connection)


def stored_cell(row: Mapping[Any, Any]) -> Cell:
    """The cell of a row.

    Parameters
    ----------
    row : mapping
        One of :func:`suite.store.read.read_runs`.
    """
    world = None
    if isinstance(row["world_settings"], str):
        settings = json.loads(row["world_settings"])
        world = World(row["world"], settings, bool(row["cold"]))
    counts = {name: _whole(row[f"budget_{name}"]) for name in ("generations", "checks")}
    wall_s, cpu_s = (_seconds(row.get(f"budget_{name}")) for name in ("wall_s", "cpu_s"))
    return Cell(
        **{name: row[name] for name in _TEXTS},
        settings=json.loads(row["settings"]),
        budget=Budget(wall_s, cpu_s=cpu_s, **counts),
        seed=int(row["seed"]),
        world=world,
        position=int(row["position"]),
    )


def _seconds(value: Any) -> float | None:
    return None if value is None or pd.isna(value) else float(value)


def _whole(value: Any) -> int | None:
    return None if pd.isna(value) else int(value)
