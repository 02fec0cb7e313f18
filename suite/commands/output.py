"""How commands print."""

import json
from typing import Any

import typer


def print_json(value: Any) -> None:
    """Print plain data for programs."""
    typer.echo(json.dumps(value, indent=2))


def print_rows(rows: list[dict[str, Any]]) -> None:
    """Print rows as a table for people."""
    from tabulate import tabulate

    headers = list(rows[0]) if rows else []
    texts = [[_as_text(value) for value in row.values()] for row in rows]
    typer.echo(tabulate(texts, headers=headers, disable_numparse=True))


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
