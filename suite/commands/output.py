"""How commands print."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any

import typer

from suite.commands.options import TextFormat
from suite.processes.output import print_aside, words

WIDEST = 44
"""Letters of a line in a column of a table."""


def apart(command: Callable[..., None]) -> Callable[..., None]:
    """A command whose standard output has nothing in it but what it says by :func:`say`.

    What planners and libraries print goes to standard error, whenever they do: imported,
    constructed, planning.
    """

    @wraps(command)
    def run(*arguments: Any, **options: Any) -> None:
        with print_aside():
            command(*arguments, **options)

    return run


def say(text: Any, *, nl: bool = True, err: bool = False) -> None:
    """Write what a command has to say: to standard output, or beside it."""
    typer.echo(text, file=None if err else words(), nl=nl, err=err)


def print_json(value: Any) -> None:
    """Print plain data for programs."""
    say(json.dumps(value, indent=2))


def print_file(file: Path, style: TextFormat) -> None:
    """Name a file that was written; beside JSON, which is for programs, on standard error."""
    say(file, err=style is TextFormat.JSON)


@contextmanager
def working(what: str) -> Iterator[None]:
    """Show on a terminal that something takes its time, and how long it took so far.

    Not for what is timed: the bar moves in a thread of its own.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        bar.add_task(what, total=None)
        yield


def print_rows(rows: list[dict[str, Any]]) -> None:
    """Print rows as a table for people."""
    from tabulate import tabulate

    headers = list(rows[0]) if rows else []
    texts = [[_as_text(value) for value in row.values()] for row in rows]
    say(tabulate(texts, headers, disable_numparse=True, maxcolwidths=WIDEST))


def _as_text(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(map(str, value))
    if isinstance(value, float):
        return f"{value:.3f}"
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return str(value)
