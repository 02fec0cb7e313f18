"""What a command would run, and about how long, before it runs anything."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import pandas as pd

from suite.harness.matrix import Matrix
from suite.harness.run import Which, can_be_asked, to_run
from suite.processes.cores import honest_jobs
from suite.store.read import read_runs
from suite.store.record import Cell
from suite.store.schema import columns_now

OVERHEAD_S = 0.03
"""Process, referee and store, for each run; about what `make harness` measures."""

NOTHING = pd.DataFrame(columns=list(columns_now("runs")))
"""The rows of a store that is not there yet."""


@dataclass(frozen=True, slots=True)
class Part:
    """The runs of one planner variant that would be run.

    runs : number.
    known : of these, how many have a duration to go by.
    seconds : of one process, for all the known ones.
    """

    variant: str
    runs: int
    known: int
    seconds: float


@dataclass(frozen=True, slots=True)
class Forecast:
    """What a command would run.

    wanted, there : runs of the matrix, and those of them that need not be run.
    parts : what would be run, variant by variant, in the order of the matrix.
    jobs : runs at a time.
    """

    wanted: int
    there: int
    parts: tuple[Part, ...]
    jobs: int

    @property
    def runs(self) -> int:
        """How many would be run."""
        return sum(part.runs for part in self.parts)

    @property
    def seconds(self) -> float:
        """About how long, as far as it is known."""
        return sum(part.seconds for part in self.parts) / self.jobs

    def as_text(self) -> str:
        """A few lines for people."""
        lines = [f"{self.runs} of {self.wanted} runs would be run; {self.there} need not be."]
        for part in self.parts:
            unknown = f", {part.runs - part.known} unknown" if part.known < part.runs else ""
            about = (
                f"about {duration(part.seconds / self.jobs)}{unknown}"
                if part.known
                else ("nobody knows how long")
            )
            lines.append(f"  {part.variant}: {part.runs} runs, {about}")
        return "\n".join([*lines, *self._in_all()])

    def _in_all(self) -> list[str]:
        known = sum(part.known for part in self.parts)
        if not self.runs:
            return []
        if not known:
            return [f"In all nobody knows how long, with {self.jobs} jobs."]
        about = f"about {duration(self.seconds)} with {self.jobs} jobs"
        if known == self.runs:
            return [f"In all {about}, beside the warm-up of the planners."]
        least = f"In all at least {about.removeprefix('about ')}"
        return [f"{least}; {self.runs - known} runs are not in that: nobody knows how long."]


def forecast_matrix(
    matrix: Matrix, store: Path, *, jobs: int | None, quick: bool, which: Which
) -> Forecast:
    """Say what :func:`suite.harness.run.run_matrix` would run.

    Parameters
    ----------
    matrix : Matrix
    store : Path
        Need not exist.
    jobs, quick, which : as there.

    Raises
    ------
    StoreError
        If the file is there and is no store.
    """
    cells = matrix.cells(quick=quick)
    runs = read_runs(store) if store.exists() else NOTHING
    there = dict(zip(runs["key"], runs["status"], strict=True))
    missing = can_be_asked(matrix, to_run(cells, there, which))
    return forecast(len(cells), missing, runs, jobs or honest_jobs())


def forecast(wanted: int, cells: Sequence[Cell], runs: pd.DataFrame, jobs: int) -> Forecast:
    """Say what a command would run.

    Parameters
    ----------
    wanted : int
        Runs of the matrix.
    cells : sequence of Cell
        Those that would be run.
    runs : DataFrame
        Rows of the store, as :func:`suite.store.read.read_runs` gives them: the same variant on the
        same scene will take as long as it did; before that, it is given its whole budget.
    jobs : int
        Runs at a time.
    """
    known = {
        (str(scene), str(variant)): float(wall.median())
        for (scene, variant), wall in runs.groupby(["scene", "variant"])["wall_s"]
    }
    by_variant: dict[str, list[Cell]] = {}
    for cell in sorted(cells, key=lambda cell: cell.position):
        by_variant.setdefault(cell.variant, []).append(cell)
    parts = tuple(_part(variant, group, known) for variant, group in by_variant.items())
    return Forecast(wanted, wanted - len(cells), parts, jobs)


def _part(variant: str, cells: Sequence[Cell], known: Mapping[tuple[str, str], float]) -> Part:
    here = [seconds for (_, name), seconds in known.items() if name == variant]
    guess = median(here) if here else None
    seconds = [known.get((c.scene, variant), _budget(c) if guess is None else guess) for c in cells]
    sure = [value + OVERHEAD_S for value in seconds if value is not None]
    return Part(variant, len(cells), len(sure), sum(sure))


def _budget(cell: Cell) -> float | None:
    """What a run may take; nobody knows how often a simulated one plans."""
    if cell.world is not None:
        return None
    return cell.budget.cpu_s if cell.budget.wall_s is None else cell.budget.wall_s


def duration(seconds: float) -> str:
    """A duration in words, rounded.

    Examples
    --------
    >>> [duration(s) for s in (0.4, 75, 4000, 200_000)]
    ['1 s', '1 min 15 s', '1 h 7 min', '2 d 8 h']
    """
    whole = max(1, round(seconds))
    for big, small, length, part in (("d", "h", 86400, 3600), ("h", "min", 3600, 60)):
        if whole >= length:
            parts, per_length = round(whole / part), length // part
            return f"{parts // per_length} {big} {parts % per_length} {small}"
    return f"{whole // 60} min {whole % 60} s" if whole >= 60 else f"{whole} s"
