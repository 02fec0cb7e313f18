"""Rows as OMPL's benchmark logs, and as the database that Planner Arena reads.

The log is the format of ``ompl_benchmark_statistics`` (Moll, Sucan and Kavraki 2015): one for each
query, since Planner Arena pools planners by name. The database is made of the logs by OMPL's own
reader. Seconds, metres; what is not known is left empty.
"""

import contextlib
import io
import json
import os
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from suite.errors import StoreError, writing
from suite.planner import PlanStatus
from suite.report.export.files import made_folder
from suite.report.optima import check_optima
from suite.report.rows import is_simulated, newest
from suite.store.read import read_events, read_runs, read_sessions

STATUSES = tuple(status.value for status in PlanStatus)

SAMPLES = 50
"""Of the progress of a run. Planner Arena's plot wants 40 at least."""

Column = tuple[str, Callable[[Any], Any]]

COLUMNS: tuple[Column, ...] = (
    ("time REAL", lambda row: row.wall_s),
    ("memory REAL", lambda _: None),
    ("solved BOOLEAN", lambda row: int(row.status == "solved")),
    ("correct solution BOOLEAN", lambda row: int(row.status == "solved")),
    ("approximate solution BOOLEAN", lambda _: 0),
    ("status ENUM", lambda row: STATUSES.index(row.status)),
    # Planner Arena adds it to the time: empty, it would empty the sum.
    ("simplification time REAL", lambda _: 0.0),
    ("solution length REAL", lambda row: row.cost),
    ("solution clearance REAL", lambda row: row.clearance),
    ("solution segments INTEGER", lambda row: row.segments),
    ("solution turning REAL", lambda row: row.turning),
    ("best cost REAL", lambda row: row.cost),
    ("optimality gap REAL", lambda row: row.gap),
    ("time to best REAL", lambda row: row.time_to_best_s),
    ("iterations INTEGER", lambda row: row.generations),
    ("collision checks INTEGER", lambda row: row.checks),
    ("computed checks INTEGER", lambda row: row.computed_checks),
    ("contended BOOLEAN", lambda row: row.contended),
    ("scene preparation REAL", lambda row: row.prepare_s),
    ("exact optimum REAL", lambda row: row.exact_s),
    ("random seed INTEGER", lambda row: row.seed),
)
"""Names that OMPL's tools know, where there is one, and ours."""


def write_ompl_logs(store: Path, directory: Path) -> list[Path]:
    """Write a log for each query of each scene.

    Parameters
    ----------
    store : Path
        Its newest rows are written; those of simulated runs are not, for OMPL has no such thing.
    directory : Path
        Made if it is missing.

    Returns
    -------
    list of Path
        The logs.

    Raises
    ------
    StoreError
        If the store can't be read or has no such rows, or a file can't be written.
    """
    runs = newest(read_runs(store))
    runs = runs[~is_simulated(runs)]
    if runs.empty:
        raise StoreError(f"{store}: it holds no runs that a log could hold.")
    check_optima(runs)
    events = dict(tuple(read_events(store).groupby("key")))
    sessions = {session["id"]: session for session in read_sessions(store)}
    folder = made_folder(directory)
    files = []
    for (scene, query), group in runs.groupby(["scene", "query"], sort=False):
        file = folder / f"{_word(scene)}-{_word(query)}.log"
        lines = _log(f"{_word(scene)}-{_word(query)}", group, events, sessions)
        with writing(file, StoreError):
            file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        files.append(file)
    return files


def write_planner_arena(store: Path, file: Path) -> Path:
    """Write the database that Planner Arena reads.

    Parameters
    ----------
    store : Path
    file : Path
        Must not be there yet.

    Raises
    ------
    StoreError
        As for :func:`write_ompl_logs`, or if the file is there, or OMPL is not.
    """
    try:
        from ompl.tools import computeViews, readBenchmarkLog
    except ModuleNotFoundError as error:
        raise StoreError(
            f"{file}: OMPL makes it, and the package ompl is made for Python 3.11 to 3.13. "
            "Install kbga-bench for one of these, or export ompl-log."
        ) from error
    if file.exists():
        raise StoreError(f"{file}: is there already. Name a new file.")
    made_folder(file.parent)
    with tempfile.TemporaryDirectory(dir=file.parent) as folder:
        logs = write_ompl_logs(store, Path(folder))
        made = Path(folder) / "arena.db"
        # OMPL's reader says on standard output what it reads.
        with contextlib.redirect_stdout(io.StringIO()):
            readBenchmarkLog(str(made), [str(log) for log in logs], False)
            computeViews(str(made), False)
        os.replace(made, file)  # noqa: PTH105
    return file


def _log(
    name: str,
    runs: pd.DataFrame,
    events: dict[Any, pd.DataFrame],
    sessions: dict[int, dict[str, Any]],
) -> Iterator[str]:
    session = sessions[runs["session"].iloc[-1]]
    suite = session.get("versions", {}).get("kbga-bench", "0")
    groups = list(runs.groupby("variant", sort=False))
    yield f"kbga-bench version {suite}"
    yield f"Experiment {name}"
    yield f"Running on {_word(runs['host'].iloc[-1] or 'unknown')}"
    yield f"Starting at {_date(runs['started_at'].min())}"
    yield "<<<|"
    yield f"scene {runs['scene'].iloc[0]}, query {runs['query'].iloc[0]}"
    yield f"optimum {runs['optimum'].iloc[0]}"
    yield "|>>>"
    yield "<<<|"
    yield str(session.get("cpu", "unknown"))
    yield "|>>>"
    yield "0 is the random seed"
    yield f"{np.nan_to_num(runs['budget_wall_s'].max()):g} seconds per run"
    yield "0 MB per run"
    yield f"{max(len(group) for _, group in groups)} runs per planner"
    yield f"{runs['wall_s'].sum():.6f} seconds spent to collect the data"
    yield "1 enum type"
    yield "|".join(["status", *STATUSES])
    yield f"{len(groups)} planners"
    for variant, group in groups:
        yield from _planner(str(variant), group, events)


def _planner(name: str, runs: pd.DataFrame, events: dict[Any, pd.DataFrame]) -> Iterator[str]:
    settings = json.loads(runs["settings"].iloc[0])
    yield name
    yield f"{len(settings)} common properties"
    yield from (f"{key} = {value}" for key, value in sorted(settings.items()))
    yield f"{len(COLUMNS)} properties for each run"
    yield from (column for column, _ in COLUMNS)
    yield f"{len(runs)} runs"
    for row in runs.itertuples():
        yield "".join(f"{_text(value(row))}; " for _, value in COLUMNS)
    yield "4 progress properties for each run"
    yield from ("time REAL", "best cost REAL", "iterations INTEGER", "collision checks INTEGER")
    yield f"{len(runs)} runs"
    for row in runs.itertuples():
        yield _progress(row, events.get(row.key))
    yield "."


def _progress(row: Any, events: pd.DataFrame | None) -> str:
    """The best so far at evenly spread times, from the start of a run to its end."""
    if events is None or not row.wall_s > 0.0:
        return ""
    times = np.linspace(0.0, row.wall_s, SAMPLES)
    last = np.searchsorted(events["wall_s"].to_numpy(), times, side="right") - 1
    known = events[["cost", "generation", "checks"]]
    samples = []
    for time, number in zip(times, last, strict=True):
        values = known.iloc[number] if number >= 0 else (None, None, None)
        samples.append(",".join(_text(v) for v in (float(time), *values)) + ",;")
    return "".join(samples)


def _text(value: Any) -> str:
    if value is None or pd.isna(value):
        return ""
    number = float(value)
    return str(int(number)) if number.is_integer() else repr(number)


def _word(text: Any) -> str:
    """OMPL's reader takes the last word of a line as a name."""
    return "_".join(str(text).split())


def _date(started_at: Any) -> str:
    return str(pd.Timestamp(started_at).strftime("%Y-%m-%d %H:%M:%S"))
