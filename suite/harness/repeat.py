"""Runs that had no core for themselves, once more when the machine has one to give.

A row that was made while the machine was busy tells the wrong time, and if wall time ended its run,
the wrong outcome. It stays until a run has taken its place that had a core for itself, whatever
came of that: only the load chooses, never the result. A planner that sleeps or waits for files is
contended each time; so each row is tried a few times and no more.
"""

import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import replace

from suite.harness.matrix import Matrix
from suite.harness.patience import Patience
from suite.harness.run import Progress, contended_cells, run_each, session
from suite.processes.cores import honest_jobs
from suite.store.record import Cell, RunRecord
from suite.store.write import Store

ATTEMPTS = 3
"""Repetitions of a row in one go: a machine that is busy now and then lets it through by then."""

WAITING = 0.5
"""Share of the patience that may go to waiting; the rest is for runs, for short ones slip through
where no core is ever free."""


def repeat_contended(
    matrix: Matrix,
    store: Store,
    progress: Progress,
    *,
    patience_s: float,
    jobs: int | None = None,
    quick: bool = False,
    executor: Executor | None = None,
    on_progress: Callable[[Progress], None] = lambda _: None,
) -> Progress:
    """Run the contended rows of a matrix again, those of earlier sessions too.

    Parameters
    ----------
    matrix : Matrix
    store : Store
        Open for writing, with the rows of :func:`suite.harness.run.run_matrix`.
    progress : Progress
        What that returned; it goes on here.
    patience_s : float
        Seconds after which no further run is begun; 0 for none at all. Half of them may go to
        waiting for a free core, where runs are run on this machine.
    jobs : int, optional
        Runs at a time; never more on this machine than leaves their timing honest.
    quick, executor, on_progress : as there.

    Raises
    ------
    HarnessError, KeyboardInterrupt
        As there. A row whose repetition is lost is the row that it was.
    """
    deadline = time.monotonic() + patience_s
    cells = matrix.cells(quick=quick)
    again = contended_cells(cells, store)
    if not again or patience_s <= 0.0:
        return progress
    progress.repeated = len(again)
    waited_s = progress.waited_s
    attempts = store.attempts()
    patience = Patience(WAITING * patience_s, for_all=True)
    if executor is None:
        jobs = min(jobs or honest_jobs(), honest_jobs())

    def keep(record: RunRecord) -> None:
        progress.repeats_done += 1
        progress.waited_s = waited_s + patience.waited_s
        _keep(record, store, attempts)

    with session(matrix, again, store, executor, jobs, patience) as own:
        for _ in range(ATTEMPTS):
            progress.repeats_wanted += len(again)
            run_each(_until(deadline, again), own, keep, progress, on_progress)
            again = contended_cells(cells, store)
            progress.contended = len(again)
            if not again or time.monotonic() >= deadline:
                break
    return progress


def _until(deadline: float, cells: list[Cell]) -> Iterator[Cell]:
    """The cells, as long as there is time."""
    for cell in cells:
        if time.monotonic() >= deadline:
            return
        yield cell


def _keep(record: RunRecord, store: Store, attempts: dict[str, int]) -> None:
    """Put a record in the place of its row, if it had a core for itself; count it in any case."""
    key = record.cell.key
    attempts[key] += 1
    if record.contended is False:
        store.add(replace(record, attempts=attempts[key]), replace=True)
    else:
        store.count_attempt(key)
