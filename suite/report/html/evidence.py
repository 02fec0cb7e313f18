"""All that the page is made of, read from the store once."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.planner import Snapshot
from suite.report.all_tables import read_tables
from suite.report.figures.style import numbered
from suite.report.optima import check_optima
from suite.report.rows import is_blocked, is_simulated, newest
from suite.report.statistics.anytime import Steps, steps_of
from suite.report.statistics.clock import fair
from suite.report.table import Table
from suite.store.read import (
    read_conflicts,
    read_events,
    read_paths,
    read_runs,
    read_sessions,
    read_snapshots,
    read_wanted,
)
from suite.store.scenes import KeptScenes


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """The rows of a store, and what is derived of them for several sections.

    store : its file.
    runs : all rows.
    current : those of the newest version of each scene and planner.
    steps : the current runs that were not simulated, as step functions; without those of queries
        that can't be asked.
    planners : number of each planner, which chooses its colour and line everywhere.
    tables : all tables.
    paths : by key, (n, 2) float64, metres.
    snapshots : by key.
    wanted : what the matrices want.
    conflicts : number of rows of other stores that say something else.
    sessions : provenance.
    scenes : that the rows ran on.
    """

    store: Path
    runs: pd.DataFrame
    current: pd.DataFrame
    steps: Steps
    planners: dict[str, int]
    tables: list[Table]
    paths: dict[str, NDArray[np.float64]]
    snapshots: dict[str, list[Snapshot]]
    wanted: pd.DataFrame
    conflicts: int
    sessions: list[dict[str, Any]]
    scenes: KeptScenes

    @property
    def driven(self) -> pd.DataFrame:
        """The current runs that were simulated."""
        return fair(self.current[is_simulated(self.current) & ~is_blocked(self.current)])


def read_evidence(store: Path, reference: str | None = None) -> Evidence:
    """Read a store.

    Parameters
    ----------
    store : Path
    reference : str, optional
        The planner that the statistics compare the others with; default: kbga, or else the first.

    Raises
    ------
    StoreError
        If it can't be read.
    KbgaBenchError
        If no run is of the reference, or a path is shorter than the shortest.
    """
    runs, events = read_runs(store), read_events(store)
    current = newest(runs)
    check_optima(current)
    planned = current[~is_simulated(current) & ~is_blocked(current)]
    return Evidence(
        store=store,
        runs=runs,
        current=current,
        steps=steps_of(fair(planned), events),
        planners=numbered(current["variant"]),
        tables=[] if runs.empty else read_tables(store, reference, runs=runs, events=events),
        paths=read_paths(store),
        snapshots=read_snapshots(store),
        wanted=read_wanted(store),
        conflicts=len(read_conflicts(store)),
        sessions=read_sessions(store),
        scenes=KeptScenes(store),
    )
