"""The progress of a matrix: a bar on a terminal, plain lines anywhere else."""

import time
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.progress import Progress as Bar

from suite.harness.run import FAILURES, Progress

LINE_EVERY_S = 10.0
"""Plain lines go to logs: often enough to see life, seldom enough to read."""


class Display:
    """Shows each :class:`Progress` that it is called with. A context manager.

    console : where; standard error by default, so that standard output stays for results.
    """

    def __init__(self, title: str, console: Console | None = None) -> None:
        self._title = title
        self._console = console or Console(stderr=True)
        self._bar: Bar | None = None
        self._last_line = -LINE_EVERY_S
        self._shown_failures: set[tuple[str, str]] = set()

    def __enter__(self) -> Self:
        if self._console.is_terminal:
            self._bar = Bar(
                TextColumn("{task.description}"),
                BarColumn(bar_width=None),
                MofNCompleteColumn(),
                TextColumn("[red]{task.fields[failed]}[/red]"),
                TimeElapsedColumn(),
                TimeRemainingColumn(),
                TextColumn("[dim]{task.fields[running]}[/dim]"),
                console=self._console,
            )
            self._bar.start()
            self._task = self._bar.add_task(self._title, total=None, failed="", running="")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, progress: Progress) -> None:
        """Show it."""
        self._show_failure(progress)
        if self._bar is not None:
            self._bar.update(
                self._task,
                total=progress.wanted,
                completed=progress.done,
                failed=f"{progress.failed} failed" if progress.failed else "",
                running=", ".join(progress.running),
            )
        else:
            self._show_line(progress)

    def _show_failure(self, progress: Progress) -> None:
        """Name the first failure of each kind; the count, and the store, have them all."""
        record = progress.last
        if record is None or record.status not in FAILURES:
            return
        reason = (record.reason or "").strip().splitlines()
        what = f"{record.status}: {reason[-1] if reason else ''}"
        if (record.cell.variant, what) in self._shown_failures:
            return
        self._shown_failures.add((record.cell.variant, what))
        text = f"{record.cell.label}: {what}"
        self._console.print(text, style="red", markup=False, highlight=False, soft_wrap=True)

    def _show_line(self, progress: Progress) -> None:
        now = time.monotonic()
        is_end = progress.done == progress.wanted and not progress.running
        if now - self._last_line < LINE_EVERY_S and not is_end:
            return
        self._last_line = now
        left = progress.wanted - progress.done
        text = f"{self._title}: {progress.done} of {progress.wanted} done, {left} left"
        text += f", {progress.failed} failed" if progress.failed else ""
        text += f"; running {', '.join(progress.running)}" if progress.running else ""
        self._console.print(text, markup=False, highlight=False, soft_wrap=True)
