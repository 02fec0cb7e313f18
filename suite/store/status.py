"""How a store stands, read from another shell while the harness goes on writing to it."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from suite.planner import PlanStatus
from suite.store.read import read_conflicts, read_runs, read_sessions, read_wanted, stored_cell
from suite.store.row_names import DIGITS
from suite.store.scene_files import FileChange, changed_files
from suite.store.write import is_being_written
from suite.typed import plain

MOST_FAILURES = 5
"""Failed rows that are named to people."""

MOST_FILES = 5
"""Files of scenes that are: a store that comes from elsewhere may name hundreds."""


def status(store: Path) -> dict[str, Any]:
    """How a store stands, as plain data.

    Returns
    -------
    dict
        ``wanted``, ``done`` and ``missing`` count the runs of the matrices as they were run last;
        ``other`` rows are of scenes and settings that no matrix wants any more. ``by_status`` and
        ``planners``, in the order of the matrix, count wanted runs. ``failures`` are the wanted
        rows that ended in one of PlanStatus.FAILURES (all of them, if no matrix wants any): key,
        name, status and reason. ``contended`` counts the rows, of these, whose runs had no core for
        themselves. ``scene_files`` are those that are gone or hold another scene than rows ran on:
        file, change, rows, and how many of these have the scene in the store.
        ``writer`` says who has it open for writing, or is null.

    Raises
    ------
    StoreError
        If it can't be read.
    """
    wanted = read_wanted(store).drop_duplicates("key")
    runs = read_runs(store)
    done = wanted["status"].notna()
    sessions = read_sessions(store)
    return {
        "store": str(store),
        "wanted": len(wanted),
        "done": int(done.sum()),
        "missing": int((~done).sum()),
        "other": int((~runs["key"].isin(wanted["key"])).sum()),
        "conflicts": len(read_conflicts(store)),
        "contended": int(_of_matrices(runs, wanted)["contended"].fillna(value=False).sum()),
        "by_status": _counts(wanted["status"]),
        "planners": {
            str(variant): {
                "wanted": len(group),
                "done": int(group["status"].notna().sum()),
                "succeeded": int(group["status"].isin(PlanStatus.SUCCESSES).sum()),
                "failed": int(group["status"].isin(PlanStatus.FAILURES).sum()),
            }
            for variant, group in wanted.groupby("variant", sort=False)
        },
        "failures": _failures(runs, wanted),
        "scene_files": [plain(change) for change in changed_files(store, runs)],
        "last_row_at": runs["started_at"].max() if len(runs) else None,
        "writer": _writer(sessions[-1] if sessions else {}) if is_being_written(store) else None,
    }


def as_text(found: dict[str, Any]) -> str:
    """What :func:`status` gives, in a few lines for people."""
    share = (
        f"{100 * found['done'] // found['wanted']} %" if found["wanted"] else "no matrix was run"
    )
    lines = [
        f"{found['store']}: {found['done']} of {found['wanted']} runs done ({share}), "
        f"{found['missing']} missing"
    ]
    writer = found["writer"]
    if writer is None:
        lines.append("  nobody is writing to it")
    else:
        lines.append(
            f"  process {writer['pid']} on {writer['host']} is running {writer['matrix']}, since "
            f"{writer['since']}"
        )
    lines += [f"  {name}: {count}" for name, count in found["by_status"].items()]
    for name, tally in found["planners"].items():
        failed = f", {tally['failed']} failed" if tally["failed"] else ""
        good = f"{tally['succeeded']} succeeded"
        lines.append(f"  {name}: {tally['done']} of {tally['wanted']}, {good}{failed}")
    lines += _failures_as_text(found["failures"])
    lines += _files_as_text(found["scene_files"])
    if found["contended"]:
        lines.append(
            f"  {found['contended']} rows had no core for themselves; the same `kbga-bench run` "
            "tries them again"
        )
    if found["other"]:
        lines.append(
            f"  {found['other']} more rows, of scenes or settings that no matrix wants now"
        )
    if found["conflicts"]:
        lines.append(
            f"  {found['conflicts']} rows of merged stores had another outcome, and are kept beside"
        )
    return "\n".join(lines)


def _failures(runs: pd.DataFrame, wanted: pd.DataFrame) -> list[dict[str, Any]]:
    ours = _of_matrices(runs, wanted)
    failed = ours[ours["status"].isin(PlanStatus.FAILURES)]
    return [
        {
            "key": row["key"],
            "name": stored_cell(row).label,
            "status": row["status"],
            "reason": row["reason"] if isinstance(row["reason"], str) else None,
        }
        for row in failed.to_dict("records")
    ]


def _of_matrices(runs: pd.DataFrame, wanted: pd.DataFrame) -> pd.DataFrame:
    """The rows that a matrix wants; all, if none wants any."""
    return runs[runs["key"].isin(wanted["key"])] if len(wanted) else runs


def _failures_as_text(failures: Sequence[Mapping[str, Any]]) -> list[str]:
    """The first failures with their keys, and how many more there are."""
    if not failures:
        return []
    lines = ["  failed (once more, here: kbga-bench rerun STORE KEY):"]
    for row in failures[:MOST_FAILURES]:
        reason = (row["reason"] or "").strip().splitlines()
        why = f": {reason[-1]}" if reason else ""
        lines.append(f"    {row['key'][:DIGITS]}  {row['name']}  {row['status']}{why}")
    more = len(failures) - MOST_FAILURES
    return lines + ([f"    and {more} more; --format json has all"] if more > 0 else [])


def _files_as_text(changes: Sequence[Mapping[str, Any]]) -> list[str]:
    """The first files that are not what they were, those first of which the store lacks scenes."""
    files = sorted((FileChange(**change) for change in changes), key=lambda c: c.kept == c.rows)
    lines = [f"  {change.as_text()}" for change in files[:MOST_FILES]]
    more = len(files) - MOST_FILES
    return lines + ([f"  and {more} more scene files; --format json has all"] if more > 0 else [])


def _counts(values: Any) -> dict[str, int]:
    return {str(k): int(v) for k, v in values.dropna().value_counts().sort_index().items()}


def _writer(session: dict[str, Any]) -> dict[str, Any]:
    return {
        "pid": session.get("pid"),
        "host": session.get("host"),
        "matrix": session.get("matrix"),
        "since": session.get("started_at"),
    }
