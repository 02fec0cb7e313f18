"""Populations for the report's player: runs of a matrix again, with snapshots and without a clock.

A measured run takes no snapshots: copying fifty paths costs a generation's time. So some runs whose
rows are there are done once more, each from the same random stream in a process of its own, and
their populations are kept beside the row if the same path comes out, bit for bit. One that was
stopped by the clock is stopped at the generation that it had reached then.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from suite.harness.isolate import run_isolated
from suite.harness.matrix import Matrix
from suite.harness.rerun import same_path
from suite.harness.run import warmth_for
from suite.planner import Budget, PlanStatus, Snapshot
from suite.store.read import read_paths, read_runs, read_snapshots
from suite.store.record import Cell, RunRecord
from suite.store.write import Store

MOST_RUNS = 40
"""A store keeps the populations of so many runs of a matrix, unless it is told another number."""

MOST_GENERATIONS = 60
MOST_PATHS = 50
"""As many as the paper's population has."""

ENDED_BY_THEMSELVES = (PlanStatus.SOLVED, PlanStatus.EXHAUSTED)


@dataclass(frozen=True, slots=True)
class Kept:
    """What came of keeping populations.

    runs : number of runs whose populations were kept now.
    differ : number of runs that took another course this time; nothing of them was kept.
    """

    runs: int = 0
    differ: int = 0

    def summary(self) -> str:
        """One line; empty if there was nothing to do."""
        differ = f" {self.differ} took another course when repeated." if self.differ else ""
        if not self.runs and not self.differ:
            return ""
        return f"Populations of {self.runs} runs were kept for the report.{differ}"


def keep_snapshots(
    matrix: Matrix,
    store: Store,
    *,
    most: int = MOST_RUNS,
    on_start: Callable[[Cell], None] = lambda _: None,
) -> Kept:
    """Keep the populations of the first seed of each scene and planner that shows them.

    Parameters
    ----------
    matrix : Matrix
        Whose runs are in the store; those that are not there, or failed, are left out.
    store : Store
        Open for writing.
    most : int
        Of how many runs. The planner that comes first in the matrix has its scenes first.
    on_start : callable
        Told of each run before it is done again.

    Returns
    -------
    Kept
    """
    wanted = _wanted(matrix)[:most]
    if not wanted:
        return Kept()
    there = set(read_snapshots(store.path))
    runs = read_runs(store.path).set_index("key")
    good = runs.index[runs["status"].isin(ENDED_BY_THEMSELVES) & runs["generations"].notna()]
    cells = [cell for cell in wanted if cell.key in good and cell.key not in there]
    paths = read_paths(store.path) if cells else {}
    kept = 0
    for cell in cells:
        on_start(cell)
        row = runs.loc[cell.key].to_dict()
        record = _again(cell, row, matrix)
        if _same(record, row, paths.get(cell.key)):
            store.add_snapshots(cell.key, map(_thinned, record.snapshots))
            kept += 1
    return Kept(kept, len(cells) - kept)


def chosen_generations(last: int, best: int | None = None) -> frozenset[int]:
    """The generations that are shown: dense at first, when most happens, and both ends.

    Parameters
    ----------
    last : int
    best : int, optional
        The one in which the final best was found.

    Examples
    --------
    >>> sorted(chosen_generations(4))
    [0, 1, 2, 3, 4]
    >>> len(chosen_generations(500, 346)), 346 in chosen_generations(500, 346)
    (60, True)
    """
    always = {0, last} | ({best} if best is not None else set())
    # Of whole numbers spaced evenly on a logarithm the first coincide: ask for more until full.
    chosen = always
    for count in range(MOST_GENERATIONS, 100 * MOST_GENERATIONS, 4):
        spaced = np.geomspace(1, last + 1, count).round().astype(int) - 1
        more = always | set(spaced.tolist())
        if len(more) > MOST_GENERATIONS:
            break
        chosen = more
        if len(chosen) > last:
            break
    return frozenset(chosen)


def _wanted(matrix: Matrix) -> list[Cell]:
    """The first seed of each scene, query and planner that shows its population."""
    able = [
        variant.name
        for variant in matrix.variants
        if variant.plugin.abilities is not None and variant.plugin.abilities.population
    ]
    cells = [
        cell
        for cell in matrix.cells()
        if cell.world is None and cell.seed == matrix.seeds[0] and cell.variant in able
    ]
    return sorted(cells, key=lambda cell: able.index(cell.variant))


def _again(cell: Cell, row: Mapping[Any, Any], matrix: Matrix) -> RunRecord:
    last, best = int(row["generations"]), row["generation_of_best"]
    if cell.time_counts:
        cell = replace(cell, budget=Budget(generations=last))
    shown = chosen_generations(last, None if best is None else int(best))
    return run_isolated(cell, matrix.limits, warmth_for([cell], matrix.limits), snapshots_of=shown)


def _same(record: RunRecord, row: Mapping[Any, Any], path: Any) -> bool:
    alike = bool(record.snapshots) and record.status == row["status"]
    return alike and same_path(path, record.path)


def _thinned(snapshot: Snapshot) -> Snapshot:
    count = len(snapshot.paths)
    if count <= MOST_PATHS:
        return snapshot
    some = np.linspace(0, count - 1, MOST_PATHS).round().astype(int)
    return replace(snapshot, paths=tuple(snapshot.paths[i] for i in some))
