"""The progress of a matrix: bars on a terminal, plain lines anywhere else."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
)
from rich.progress import Progress as Bars

from suite.harness.forecast import duration
from suite.harness.run import Progress, Tally
from suite.planner import PlanStatus

LINE_EVERY_S = 10.0
"""Plain lines go to logs: often enough to see life, seldom enough to read."""

MOST_PLANNERS = 30
"""A terminal has so many lines, about."""

INDENT = "  "

ENOUGH_RUNS = 10
ENOUGH_S = 30.0
"""A rate is told after so many runs, or after so long: a run may take an hour."""

REPEATS = "contended runs again"


@dataclass(slots=True)
class Pace:
    """How fast the runs of a session end, from the end of its first round on.

    What comes before is left out: compiling and loading would be taken for the rate. A round is as
    many runs as go on side by side. They began together, so they may end one right after the other:
    it takes a whole round more to see how long one takes.

    begin : seconds on the caller's clock, when the first round had ended; None before that.
    before : runs that had ended then.
    ran : runs that have ended by now.
    seconds : since ``begin``.
    round : the most runs that went on side by side.
    """

    begin: float | None = None
    before: int = 0
    ran: int = 0
    seconds: float = 0.0
    round: int = 1

    def see(self, ran: int, at_a_time: int, now: float) -> None:
        """Take note of how many runs of this session have ended by now, and go on side by side."""
        self.round = max(self.round, at_a_time)
        if self.begin is None and ran >= self.round:
            self.begin, self.before = now, ran
        if self.begin is not None:
            self.ran, self.seconds = ran, now - self.begin

    def rate(self) -> float | None:
        """Runs per second; None while it would mean nothing."""
        more = self.ran - self.before
        if more < self.round or not self.seconds > 0.0:
            return None
        is_enough = more >= ENOUGH_RUNS or self.seconds >= ENOUGH_S
        return more / self.seconds if is_enough else None


class Display:
    """Shows each :class:`Progress` that it is called with. A context manager.

    console : where; standard error by default, so that standard output stays for results.
    clock : gives seconds.
    """

    def __init__(
        self,
        title: str,
        console: Console | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._title = title
        self._console = console or Console(stderr=True)
        self._bars: Bars | None = None
        self._tasks: dict[str, TaskID] = {}
        self._clock = clock
        self._last_line = clock()
        self._pace = Pace()
        self._is_first = True
        self._shown_failures: set[tuple[str, str]] = set()

    def __enter__(self) -> Self:
        if self._console.is_terminal:
            self._bars = Bars(
                TextColumn("{task.description}"),
                BarColumn(bar_width=None),
                MofNCompleteColumn(),
                TextColumn("[green]{task.fields[good]}[/green]"),
                TextColumn("[red]{task.fields[failed]}[/red]"),
                TextColumn("{task.fields[rate]}"),
                TimeElapsedColumn(),
                TextColumn("[dim]{task.fields[running]}[/dim]"),
                console=self._console,
            )
            self._bars.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._bars is not None:
            self._bars.stop()

    def __call__(self, progress: Progress) -> None:
        """Show it."""
        self._pace.see(progress.done - progress.found, len(progress.running), self._clock())
        self._show_failure(progress)
        if self._bars is not None:
            self._show_bars(self._bars, progress)
        else:
            self._show_line(progress)
        self._is_first = False

    def _show_failure(self, progress: Progress) -> None:
        """Name the first failure of each kind; the count, and the store, have them all."""
        record = progress.last
        if record is None or record.status not in PlanStatus.FAILURES:
            return
        reason = (record.reason or "").strip().splitlines()
        what = f"{record.status}: {reason[-1] if reason else ''}"
        if (record.cell.variant, what) in self._shown_failures:
            return
        self._shown_failures.add((record.cell.variant, what))
        text = f"{record.cell.label}: {what}"
        self._console.print(text, style="red", markup=False, highlight=False, soft_wrap=True)

    def _show_bars(self, bars: Bars, progress: Progress) -> None:
        whole = Tally(progress.wanted, progress.done, failed=progress.failed)
        self._show_bar(bars, self._title, whole, self._rate(progress), ", ".join(progress.running))
        if len(progress.planners) <= MOST_PLANNERS:
            for name, tally in progress.planners.items():
                self._show_bar(bars, INDENT + name, tally)

        if progress.repeats_wanted:
            repeats = Tally(progress.repeats_wanted, progress.repeats_done)
            self._show_bar(bars, f"{INDENT}{REPEATS}", repeats)

    def _show_bar(
        self, bars: Bars, name: str, tally: Tally, rate: str = "", running: str = ""
    ) -> None:
        if name not in self._tasks:
            self._tasks[name] = bars.add_task(
                name, total=None, good="", failed="", rate="", running=""
            )
        bars.update(
            self._tasks[name],
            total=tally.wanted,
            completed=tally.done,
            good=f"{tally.succeeded} good" if tally.succeeded else "",
            failed=f"{tally.failed} failed" if tally.failed else "",
            rate=rate,
            running=running,
        )

    def _show_line(self, progress: Progress) -> None:
        now = self._clock()
        is_end = progress.done == progress.wanted and not progress.running
        if now - self._last_line < LINE_EVERY_S and not is_end and not self._is_first:
            return
        self._last_line = now
        left = progress.wanted - progress.done
        parts = [f"{progress.done} of {progress.wanted} done", f"{left} left"]
        parts += [self._rate(progress)] if self._rate(progress) else []
        if progress.repeats_wanted:
            repeats = f"{progress.repeats_done} of {progress.repeats_wanted}"
            parts.append(f"{REPEATS}: {repeats}")
        if progress.failed:
            names = ", ".join(f"{k} {v.failed}" for k, v in progress.planners.items() if v.failed)
            parts.append(f"{progress.failed} failed{f' ({names})' if names else ''}")
        text = f"{self._title}: {', '.join(parts)}"
        text += f"; running {', '.join(progress.running)}" if progress.running else ""
        self._console.print(text, markup=False, highlight=False, soft_wrap=True)

    def _rate(self, progress: Progress) -> str:
        """Runs per second of this session, and the time left at that rate, once there is one."""
        rate, left = self._pace.rate(), progress.wanted - progress.done
        if rate is None or left == 0:
            return ""
        return f"{rate:.2g} runs/s, about {duration(left / rate)} left"
