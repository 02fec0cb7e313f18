"""How commands print."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

from suite.commands.options import TextFormat

WIDEST = 44
"""Letters of a line in a column of a table."""


def print_json(value: Any) -> None:
    """Print plain data for programs."""
    typer.echo(json.dumps(value, indent=2))


def print_file(file: Path, style: TextFormat) -> None:
    """Name a file that was written; beside JSON, which is for programs, on standard error."""
    typer.echo(file, err=style is TextFormat.JSON)


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
    typer.echo(tabulate(texts, headers, disable_numparse=True, maxcolwidths=WIDEST))


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
