"""Where the rows come from: machines, versions, commits, settings."""

import json
from collections.abc import Mapping
from typing import Any

import pandas as pd

from suite.report.html.evidence import Evidence
from suite.report.table import Table

_VARIANT = [
    "variant", "planner", "distribution", "version", "settings", "cold",
    "budget_wall_s", "budget_cpu_s", "budget_generations", "budget_checks",
]  # fmt: skip


def provenance_tables(evidence: Evidence) -> list[Table]:
    """Planners with their settings, and the sessions that wrote rows."""
    return [
        Table("planners", "Planners, their versions, settings and budgets", _planners(evidence)),
        Table("sessions", "Sessions that wrote rows", _sessions(evidence)),
    ]


def _planners(evidence: Evidence) -> pd.DataFrame:
    different = evidence.current[_VARIANT].drop_duplicates()
    rows = [
        {
            "planner": row["variant"],
            "plugin": row["planner"],
            "from": f"{row['distribution']} {row['version']}",
            "budget": _budget(row),
            "settings": _settings(row["settings"]),
        }
        for row in different.to_dict("records")
    ]
    return pd.DataFrame(rows, columns=["planner", "plugin", "from", "budget", "settings"])


def _budget(row: Mapping[Any, Any]) -> str:
    parts = [
        f"{row[column]:g} {unit}"
        for column, unit in (
            ("budget_wall_s", "s"),
            ("budget_cpu_s", "s of CPU time"),
            ("budget_generations", "generations"),
            ("budget_checks", "checks"),
        )
        if not pd.isna(row[column])
    ]
    return ", ".join(parts) or "its own stop"


def _settings(text: str) -> str:
    return ", ".join(f"{name} = {value}" for name, value in json.loads(text).items())


def _sessions(evidence: Evidence) -> pd.DataFrame:
    counts = evidence.runs["session"].value_counts()
    rows = [
        {
            "session": session["id"],
            "rows": int(counts.get(session["id"], 0)),
            "matrix": session.get("matrix", ""),
            "started": session.get("started_at", ""),
            "machine": _machine(session),
            "Python and packages": _packages(session),
            "commit": _commit(session.get("git")),
        }
        for session in evidence.sessions
    ]
    columns = [
        "session", "rows", "matrix", "started", "machine", "Python and packages", "commit",
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def _machine(session: Mapping[str, Any]) -> str:
    memory = session.get("memory_bytes")
    parts = [
        session.get("host"),
        session.get("cpu"),
        f"{session['cores']} cores" if session.get("cores") else None,
        f"{memory / 2**30:.0f} GiB" if memory else None,
        session.get("os"),
    ]
    return ", ".join(str(part) for part in parts if part)


def _packages(session: Mapping[str, Any]) -> str:
    versions = {"Python": session.get("python", "?"), **session.get("versions", {})}
    return ", ".join(f"{name} {version}" for name, version in versions.items())


def _commit(git: Mapping[str, Any] | None) -> str:
    if not git:
        return "not known"
    changed = ", with changes" if git.get("dirty") else ""
    return f"{str(git.get('commit', ''))[:10]}{changed}"
