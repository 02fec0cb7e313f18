"""The tables of a store and their columns, as they are made today.

A column is declared here once: what is written, what is read, and as which type, follows.
"""

import sqlite3
from contextlib import closing
from functools import cache

APPLICATION_ID = 0x4B424741  # "KBGA"
SCHEMA_VERSION = 2

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
    cost REAL, claimed_cost REAL, claim_differs BOOLEAN, optimum REAL, gap REAL,
    clearance REAL, segments INTEGER, turning REAL,
    generations INTEGER, generation_of_best INTEGER, checks INTEGER, computed_checks INTEGER,
    wall_s REAL, time_to_best_s REAL, cpu_s REAL, cpu_to_best_s REAL,
    load REAL, contended BOOLEAN, attempts INTEGER, prepare_s REAL, exact_s REAL,
    planner TEXT NOT NULL, distribution TEXT NOT NULL, version TEXT NOT NULL,
    settings TEXT NOT NULL, settings_hash TEXT NOT NULL, world_settings TEXT, cold BOOLEAN NOT NULL,
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

SCENES = """
CREATE TABLE IF NOT EXISTS scenes (
    digest TEXT PRIMARY KEY, document BLOB NOT NULL, files TEXT
);
CREATE TABLE IF NOT EXISTS queries (
    scene TEXT NOT NULL, scene_hash TEXT NOT NULL, query TEXT NOT NULL,
    digest TEXT NOT NULL REFERENCES scenes (digest),
    start_x REAL NOT NULL, start_y REAL NOT NULL, goal_x REAL NOT NULL, goal_y REAL NOT NULL,
    stratum TEXT,
    PRIMARY KEY (scene, scene_hash, query)
) WITHOUT ROWID;
"""
"""Scenes that rows ran on, each once, and the queries of it that rows asked.

A query is found by what a row says of it. Stores that are older are stores without: a table is made
when they are next written to, and their rows have no scene until their matrix is run again.
"""

BELONGINGS = ("events", "traces", "paths", "simulations", "snapshots")
"""Tables that hold more of a run, by its key."""


def create_tables(connection: sqlite3.Connection) -> None:
    """Make an empty file a store, whole or not at all."""
    # WAL is set first: it can't be changed inside a transaction. All else is one, so that a store
    # exists whole or not at all.
    connection.execute("PRAGMA journal_mode = WAL")
    connection.executescript(
        f"BEGIN EXCLUSIVE; {SCHEMA} {SCENES} PRAGMA application_id = {APPLICATION_ID};"
        f"PRAGMA user_version = {SCHEMA_VERSION}; COMMIT;"
    )


def add_what_is_new(connection: sqlite3.Connection) -> None:
    """Stores that are older than a column or a table are stores of the same version without it."""
    for statement in filter(str.strip, SCENES.split(";")):
        connection.execute(statement)
    for table in ("runs", "wanted"):
        there = columns_of(connection, table)
        for name, kind in columns_now(table).items():
            if name not in there:
                connection.execute(f"ALTER TABLE {table} ADD COLUMN {name} {kind}")


def columns_of(connection: sqlite3.Connection, table: str, database: str = "main") -> list[str]:
    """Names of the columns that a table has in a file, which may be older than this code."""
    return [row[1] for row in connection.execute(f"PRAGMA {database}.table_info({table})")]


def has_table(connection: sqlite3.Connection, table: str, database: str = "main") -> bool:
    """Whether a file, which may be older than this code, has a table."""
    return bool(columns_of(connection, table, database))


@cache
def columns_now(table: str) -> dict[str, str]:
    """Names and declared types of the columns of a table that is made today, in their order.

    table : one of those of SCHEMA. The type of a column that can't be NULL ends with NOT NULL.
    """
    with closing(sqlite3.connect(":memory:")) as connection:
        connection.executescript(SCHEMA)
        rows = connection.execute(f"PRAGMA table_info({table})").fetchall()
    return {name: kind + " NOT NULL" * bool(is_set) for _, name, kind, is_set, *_ in rows}
