"""The table of faults: what became of the row, the matrix, the store and the command."""

import platform
import re
import sqlite3
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import pandas as pd

from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.table import Table
from tests.perf.faults.fault import CRITERIA, Fault, Outcome

MOST_WORDS = 240
"""Letters of a command's words that a table has room for."""


@dataclass(frozen=True, slots=True)
class Line:
    """A fault in the table."""

    fault: str
    how: str
    row: str
    matrix: str
    store: str
    exit_code: str
    words: str
    verdict: str


def line_of(fault: Fault, outcome: Outcome | None, missing: str | None, folder: Path) -> Line:
    """What came of a fault, or why it was not tried."""
    if outcome is None:
        return Line(fault.name, fault.how, "", "", "", "", "", missing or "not tried")
    flaws = outcome.flaws()
    verdict = f"NOT contained: {'; '.join(flaws)}" if flaws else "contained"
    code = outcome.said.code
    return Line(
        fault.name,
        fault.how,
        outcome.statuses(outcome.end) + _why(outcome, folder),
        _matrix(outcome),
        _store(outcome),
        "none" if code is None else str(code),
        _plain(outcome.words(), folder),
        _plain(verdict, folder),
    )


def _why(outcome: Outcome, folder: Path) -> str:
    reason = outcome.reason()
    return f" ({_plain(reason, folder)})" if reason else ""


def _matrix(outcome: Outcome) -> str:
    now, end, wanted = len(outcome.found.rows), len(outcome.end.rows), outcome.wanted
    if now == wanted:
        return f"all {wanted} rows"
    return f"{now} of {wanted} rows, {end} after the same command again"


def _store(outcome: Outcome) -> str:
    whole = "whole" if outcome.found.whole and outcome.end.whole else "BROKEN"
    kept = sum(outcome.found.rows.get(key) == row for key, row in outcome.before.rows.items())
    return f"{whole}; {kept} of {len(outcome.before.rows)} earlier rows as they were"


def _plain(text: str, folder: Path) -> str:
    """Without what is of this one machine and moment."""
    text = " ".join(text.replace(str(folder), "FOLDER").split())
    text = re.sub(r"\(process \d+ on \S+, (.*?), since [^)]*\)", r"(process N on HOST, \1)", text)
    return text if len(text) <= MOST_WORDS else f"{text[: MOST_WORDS // 2]} ... {text[-40:]}"


def table(lines: list[Line]) -> Table:
    """A row per fault."""
    contained = sum(line.verdict == "contained" for line in lines)
    tried = sum(not line.verdict.startswith("not tried") for line in lines)
    frame = pd.DataFrame([asdict(line) for line in lines])
    frame.columns = pd.Index([name.replace("_", " ") for name in frame.columns])
    return Table(
        "faults",
        f"Faults: {contained} of {tried} contained, {len(lines) - tried} not tried",
        frame,
        "Each fault strikes `kbga-bench run` on a small matrix, half of whose runs are of a "
        "planner that does what it should, in a store that has rows already. Contained means: "
        + "; ".join(CRITERIA)
        + ". Words: what the command printed of it, or its last line. Last tried with Python "
        f"{platform.python_version()} and SQLite {sqlite3.sqlite_version} on {platform.system()}.",
    )


def write(lines: list[Line], folder: Path, order: Sequence[str]) -> str:
    """Write the table as Markdown and CSV, and return it as plain text.

    order : names of all faults. Those that were not tried now keep the line that is there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    known = {line.fault: line for line in (*_written(folder), *lines)}
    made = table([known[name] for name in order if name in known])
    (folder / "faults.md").write_text(render(made, TableFormat.MARKDOWN), encoding="utf-8")
    (folder / "faults.csv").write_text(render(made, TableFormat.CSV), encoding="utf-8")
    return render(made, TableFormat.TABLE)


def _written(folder: Path) -> list[Line]:
    """The lines of the table that is there."""
    file = folder / "faults.csv"
    if not file.exists():
        return []
    frame = pd.read_csv(file, dtype=str, keep_default_na=False)
    return [Line(*row) for row in frame.itertuples(index=False, name=None)]
