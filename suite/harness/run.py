"""A matrix, run: only what the store lacks, each row kept when its run ends.

``concurrent.futures.Executor`` is the only idea of "where": by default threads that wait for local
processes. Rows come back to the caller's thread, which is the store's one writer.
"""

import os
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, wait
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Self

import numpy as np

from suite.harness.cell import refused
from suite.harness.cluster.executors import Coming, Crew, crew, record_of
from suite.harness.cluster.worker import Answer
from suite.harness.fork_server import Warmth
from suite.harness.matrix import Limits, Matrix
from suite.harness.patience import Patience
from suite.harness.provenance import provenance
from suite.planner import PlanStatus
from suite.store.record import Cell, RunRecord, canonical_json
from suite.store.row_names import rows_in_words
from suite.store.write import Store

ORDER_SEED = 2003
"""Of the order in which runs are started; any number will do, as long as it stays."""


class Which(StrEnum):
    """Which runs of a matrix are to be run."""

    MISSING = "missing"
    """Those that the store lacks."""
    FAILED = "failed"
    """Those too that ended in one of PlanStatus.FAILURES; their rows are replaced."""
    ALL = "all"
    """All; rows that are there are replaced, each when its new run has ended."""


@dataclass(slots=True)
class Tally:
    """How the runs of one planner variant stand.

    wanted, done : runs.
    succeeded : of these solved, or proved to be infeasible.
    failed : of these ended in one of PlanStatus.FAILURES.
    """

    wanted: int = 0
    done: int = 0
    succeeded: int = 0
    failed: int = 0

    def count(self, status: str) -> None:
        """Count one row."""
        self.done += 1
        self.succeeded += status in PlanStatus.SUCCESSES
        self.failed += status in PlanStatus.FAILURES


@dataclass(slots=True)
class Progress:
    """How far a matrix is.

    wanted : runs of the matrix.
    done : of these in the store, those of earlier sessions included.
    found : of these done in earlier sessions.
    found_failed : of those found, the ones that ended in one of PlanStatus.FAILURES.
    failed : runs of this session that ended so.
    running : labels of the runs that were handed out and are not back.
    last : the row that came last.
    left : runs that still go on elsewhere after an interruption; their rows are dropped.
    contended : rows of the matrix whose runs had no core for themselves.
    repeated : rows that were run again for that reason, or are about to be.
    repeats_wanted, repeats_done : runs that this takes, as far as it is known, and has taken.
    waited_s : seconds that runs waited for a free core.
    planners : by the name of each variant, all its runs.
    """

    wanted: int
    done: int
    found: int
    found_failed: int = 0
    failed: int = 0
    running: list[str] = field(default_factory=list)
    last: RunRecord | None = None
    left: int = 0
    contended: int = 0
    repeated: int = 0
    repeats_wanted: int = 0
    repeats_done: int = 0
    waited_s: float = 0.0
    planners: dict[str, Tally] = field(default_factory=dict)

    @classmethod
    def at_first(
        cls, cells: Sequence[Cell], missing: Sequence[Cell], there: Mapping[str, str]
    ) -> Self:
        """How a matrix stands before its first run."""
        found = len(cells) - len(missing)
        progress = cls(wanted=len(cells), done=found, found=found)
        again = {cell.key for cell in missing}
        for cell in cells:
            tally = progress.planners.setdefault(cell.variant, Tally())
            tally.wanted += 1
            if cell.key not in again:
                tally.count(there[cell.key])
                progress.found_failed += there[cell.key] in PlanStatus.FAILURES
        return progress

    def count(self, record: RunRecord) -> None:
        """Count a run that has ended."""
        self.done += 1
        self.failed += record.status in PlanStatus.FAILURES
        self.last = record
        self.planners[record.cell.variant].count(record.status)

    def summary(self) -> str:
        """One line that says how the matrix ended."""
        ran = self.done - self.found
        old = f", {self.found_failed} of these failed;" if self.found_failed else ","
        text = f"{self.done} of {self.wanted} runs are in the store: {self.found} were there{old} "
        again = " To run failed ones again, give --only-failed." if self.found_failed else ""
        return f"{text}{ran} ran now, {self.failed} of these failed.{again}{self._of_the_clock()}"

    def _of_the_clock(self) -> str:
        """What a busy machine did to the rows, if it did anything."""
        waited = f" {self.waited_s:.0f} s went to waiting for a core." if self.waited_s > 1 else ""
        if self.repeated:
            verb = "is" if self.contended == 1 else "are"
            still = f"{self.contended or 'none'} still {verb}"
            rows = rows_in_words(self.repeated)
            return f"{waited} {rows} had no core and ran again; {still} contended."
        if self.contended:
            rows = rows_in_words(self.contended)
            return f"{waited} {rows} had no core to run on: see `run --patience`."
        return waited


def run_matrix(
    matrix: Matrix,
    store: Store,
    *,
    jobs: int | None = None,
    quick: bool = False,
    which: Which = Which.MISSING,
    patience_s: float = 0.0,
    executor: Executor | None = None,
    on_progress: Callable[[Progress], None] = lambda _: None,
) -> Progress:
    """Run what is missing of a matrix, and keep each row as soon as it is there.

    Parameters
    ----------
    matrix : Matrix
    store : Store
        Open for writing.
    jobs : int, optional
        Runs at a time; default: what leaves their timing honest; of a dask cluster the number of
        its threads.
    quick : bool
        Only the first two seeds.
    which : Which
        Which rows that are there are run again.
    patience_s : float
        So many seconds in all may runs that wall time ends wait for a free core. Rows that are
        contended all the same are for :func:`suite.harness.repeat.repeat_contended`.
    executor : Executor, optional
        Where the runs are waited for, each in a process that its worker starts; default: threads
        of this process. It is left open.
    on_progress : callable
        Told of each start and each row.

    Returns
    -------
    Progress
        At the end.

    Raises
    ------
    HarnessError
        If the executor is lost, or its workers can do no runs. All finished rows are in the store.
    KeyboardInterrupt
        After Ctrl-C, when the runs in flight are killed; a note says if some could not be. All
        finished rows are in the store.
    """
    cells = matrix.cells(quick=quick)
    there = store.statuses()
    missing = to_run(cells, there, which)
    progress = Progress.at_first(cells, missing, there)
    on_progress(progress)
    store.want(matrix.name, cells)

    def keep(record: RunRecord) -> None:
        store.add(record, replace=record.cell.key in there)
        progress.count(record)

    asked = can_be_asked(matrix, missing)
    if len(asked) < len(missing):
        _refuse(matrix, missing, store, keep)
        on_progress(progress)
    if asked:
        patience = Patience(patience_s)
        with session(matrix, asked, store, executor, jobs, patience) as own:
            run_each(asked, own, keep, progress, on_progress)
        progress.waited_s = patience.waited_s
    progress.contended = len(contended_cells(cells, store))
    return progress


def can_be_asked(matrix: Matrix, cells: Sequence[Cell]) -> list[Cell]:
    """The cells of a matrix whose queries have both ends in free space."""
    blocked = matrix.blocked
    return [cell for cell in cells if (cell.scene_source, cell.query) not in blocked]


def _refuse(
    matrix: Matrix, cells: Sequence[Cell], store: Store, keep: Callable[[RunRecord], None]
) -> None:
    """Keep a row for each cell whose query can't be asked, without a process and a planner."""
    store.begin_session(provenance(matrix.name) | {"pid": os.getpid()})
    blocked = matrix.blocked
    for cell in cells:
        reason = blocked.get((cell.scene_source, cell.query))
        if reason is not None:
            keep(refused(cell, reason))


@contextmanager
def session(
    matrix: Matrix,
    cells: Sequence[Cell],
    store: Store,
    executor: Executor | None,
    jobs: int | None,
    patience: Patience,
) -> Iterator[Crew]:
    """Those who run these cells; the store is told where the rows come from that follow."""
    limits = matrix.limits
    with crew(executor, jobs, patience, limits, warmth_for(cells, limits)) as own:
        distributions = {(cell.distribution, cell.version) for cell in cells}
        place = {"pid": os.getpid(), **own.provenance()}
        store.begin_session(provenance(matrix.name, distributions) | place)
        yield own


def run_each(
    cells: Iterable[Cell],
    crew: Crew,
    keep: Callable[[RunRecord], None],
    progress: Progress,
    on_progress: Callable[[Progress], None],
) -> None:
    """Run cells, and keep each record as it comes; of each, and of each start, somebody is told.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C, when the runs in flight are killed; a note says if some could not be.
    """
    try:
        with closing(_records(cells, crew, progress)) as records:
            for record in records:
                if record is not None:
                    keep(record)
                on_progress(progress)
    except KeyboardInterrupt as interrupt:
        if progress.left:
            interrupt.add_note(_left_in_words(progress.left))
        raise


def _records(
    cells: Iterable[Cell], crew: Crew, progress: Progress
) -> Generator[RunRecord | None, None, None]:
    """Yield each record when it is there, and None when runs were started.

    Runs that are in flight when the caller closes the iterator, or is interrupted, are killed.
    """
    queue = iter(cells)
    in_flight: dict[Coming, Cell] = {}
    try:
        while True:
            jobs = crew.size()
            # One more than can run: it is ready when a run ends, while that one's row is written.
            while len(in_flight) < jobs + 1 and (cell := next(queue, None)) is not None:
                in_flight[crew.start(cell)] = cell
            progress.running = [cell.label for cell in list(in_flight.values())[:jobs]]
            yield None
            if not in_flight:
                return
            done, _ = wait(in_flight, return_when=FIRST_COMPLETED)
            for future in done:
                cell = in_flight.pop(future)
                record = record_of(future, cell)
                if isinstance(record, Answer):
                    in_flight[crew.start(cell, with_luggage=True)] = cell
                else:
                    yield record
    finally:
        progress.left = crew.abandon(in_flight) if in_flight else 0


def contended_cells(cells: Sequence[Cell], store: Store) -> list[Cell]:
    """Those whose rows say that the run had no core for itself, in the order of starting."""
    contended = store.contended()
    return interleaved([cell for cell in cells if cell.key in contended])


def to_run(cells: Sequence[Cell], there: Mapping[str, str], which: Which) -> list[Cell]:
    """The cells that are to be run, in the order in which they are started.

    Parameters
    ----------
    cells : sequence of Cell
    there : mapping from the keys of the rows that a store has to how they ended
    which : Which
    """
    again = {
        Which.MISSING: set[str](),
        Which.FAILED: {key for key, status in there.items() if status in PlanStatus.FAILURES},
        Which.ALL: set(there),
    }[which]
    return interleaved([cell for cell in cells if cell.key not in there or cell.key in again])


def interleaved(cells: Sequence[Cell]) -> list[Cell]:
    """The cells in a random order that is always the same.

    A machine that slows down for an hour then disturbs all planners alike, not one of them.
    """
    order = np.random.default_rng(ORDER_SEED).permutation(len(cells))
    return [cells[i] for i in order]


def warmth_for(cells: Iterable[Cell], limits: Limits) -> Warmth:
    """What the fork server should have ready for these cells."""
    planners = {(c.planner, canonical_json(c.settings)) for c in cells}
    queries = {(c.scene_source, c.query) for c in cells}
    return Warmth(
        tuple(sorted(planners)), tuple(sorted(queries)), limits.warm_up_s, limits.memory_bytes
    )


def _left_in_words(left: int) -> str:
    runs = "1 run goes" if left == 1 else f"{left} runs go"
    return f"{runs} on elsewhere, to the end or the limit; nothing of that is kept."
