"""The goals of the harness, and how far what was measured is from them."""

import json
from collections.abc import Mapping
from pathlib import Path
from statistics import median, quantiles
from typing import Any

import pandas as pd

from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.table import Table
from tests.perf.performance_table import Row

OVERHEAD_MS = 30.0
ROWS, ROWS_MIN = 10_000, 8.0
MEMORY_MB = 300.0
TABLES_S = 5.0


def goals(measured: Mapping[str, Any]) -> list[Row]:
    """Every goal, with what was measured."""
    rows = measured["rows"]
    many, jobs = f"{rows['rows']:,} rows", f"{rows['jobs']} jobs"
    # The goals are of 10,000 rows; of fewer, only a proportional share of the time is granted.
    share = rows["rows"] / ROWS
    return [
        _overhead(measured["overhead"]),
        Row(f"time of a matrix of {many}", jobs, "min", "<=", ROWS_MIN * share,
            rows["run"]["seconds"] / 60,
            f"{1e3 * rows['run']['seconds'] / rows['rows']:.1f} ms a row"),
        Row("memory of its parent, most", many, "MB", "<=", MEMORY_MB,
            rows["run"]["most_bytes"] / 1e6),
        Row("kbga-bench tables", many, "s", "<=", TABLES_S, rows["tables"]["seconds"]),
    ]  # fmt: skip


def _overhead(measured: Mapping[str, Any]) -> Row:
    overheads = [1e3 * (r["run_s"] + r["store_s"] - r["plan_s"]) for r in measured["runs"]]
    low, _, high = quantiles(overheads, n=4)
    plan_ms = 1e3 * median(r["plan_s"] for r in measured["runs"])
    where = f"{measured['planner']} on {measured['scene']}"
    remark = f"{len(overheads)} runs, quartiles {low:.1f} and {high:.1f}; plan: {plan_ms:.1f} ms"
    goal = "overhead of a run beyond `plan`, median"
    return Row(goal, where, "ms", "<=", OVERHEAD_MS, median(overheads), remark)


def goals_table(measured: Mapping[str, Any]) -> Table:
    """A row per goal."""
    rows = goals(measured)
    met = sum(row.reached == "yes" for row in rows)
    frame = pd.DataFrame(
        {
            "goal": [row.goal for row in rows],
            "of": [row.scene for row in rows],
            "unit": [row.unit for row in rows],
            "wanted": [f"{row.sign} {row.wanted:g}" for row in rows],
            "measured": [row.measured for row in rows],
            "reached": [row.reached for row in rows],
            "remark": [row.remark for row in rows],
        }
    )
    return Table(
        "harness",
        f"Goals of the harness: {met} of {len(rows)} reached",
        frame,
        "Overhead: from the call that starts a run to its row in the store, one run at a time, "
        "less the seconds that the run itself gives for `plan`. Rows: the command `kbga-bench run` "
        "with a planner that takes no time, from its start to its end; memory is the largest "
        "resident set of its own process, without those of the runs. Tables: the whole command.",
    )


def parts_table(measured: Mapping[str, Any]) -> Table:
    """Where the overhead of a run goes."""
    runs = measured["overhead"]["runs"]
    parts = {
        "process: fork, messages, end": [
            r["run_s"] - r["plan_s"] - r["before_s"] - r["after_s"] for r in runs
        ],
        "before `plan`: scene, settings, warm-up": [r["before_s"] for r in runs],
        "after `plan`: referee": [r["after_s"] for r in runs],
        "store": [r["store_s"] for r in runs],
    }
    frame = pd.DataFrame(
        {
            "part": list(parts),
            "median (ms)": [1e3 * median(values) for values in parts.values()],
        }
    )
    return Table(
        "parts",
        "Where the overhead of a run goes",
        frame,
        "`before` and `after` are of the same runs in one process, with all loaded; `process` is "
        "what is left of the runs in processes of their own.",
    )


def write(measured: Mapping[str, Any], folder: Path) -> str:
    """Write the tables and the manifest, and return the tables as plain text."""
    folder.mkdir(parents=True, exist_ok=True)
    tables = [goals_table(measured), parts_table(measured)]
    texts = {
        "harness.md": "\n".join(render(table, TableFormat.MARKDOWN) for table in tables),
        "harness.csv": render(tables[0], TableFormat.CSV),
        "manifest.json": json.dumps(measured["provenance"], indent=2) + "\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return "\n".join(render(table, TableFormat.TABLE) for table in tables)
