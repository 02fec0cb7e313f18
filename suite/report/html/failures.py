"""The runs without path, with their reasons; first those that failed."""

from typing import Any

import pandas as pd

from suite.planner import PlanStatus
from suite.report.rows import is_blocked, places
from suite.report.table import Table
from suite.report.words import some_of

REASONS_AT_MOST = 30
"""Told in full; of more there is the last line."""

NOTE = (
    "A row for each planner, status and last line of the reason, of which those that differ in "
    "numbers alone are one; first those that failed, which "
    "`kbga-bench run --only-failed` does again. exhausted: the budget or the planner's own stop "
    "criterion ended the run without path, which is no fault of the program; nor is refused. "
    "Example: the key of one such row; `kbga-bench rerun STORE KEY` repeats it."
)

_NUMBERS = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"

WITHOUT_REASON = "no path within the budget or the planner's own stop criterion"


def failures_table(runs: pd.DataFrame) -> Table:
    """The runs that were neither solved nor proved infeasible, by planner, status and reason.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    """
    rows = [
        {
            "planner": planner,
            "status": status,
            "runs": len(group),
            "scenes": some_of(group["place"], 4),
            "reason": group["last"].iloc[0],
            "example": group["key"].iloc[0],
        }
        for (planner, status, _), group in _groups(runs)
    ]
    frame = pd.DataFrame(rows, columns=["planner", "status", "runs", "scenes", "reason", "example"])
    frame = frame.sort_values("runs", ascending=False, kind="stable")
    frame = frame.sort_values(
        "status", key=lambda status: ~status.isin(PlanStatus.FAILURES), kind="stable"
    )
    return Table("failures", "Runs without path, by reason", frame, NOTE)


def full_reasons(runs: pd.DataFrame) -> list[tuple[str, str]]:
    """Reasons of more than one line, and what the processes wrote: (label, text) of one run each.

    Parameters
    ----------
    runs : DataFrame
    """
    found = []
    for (planner, status, _), group in _groups(runs):
        first = group.iloc[0]
        texts = [str(first["reason"] or ""), str(first["stderr"] or "")]
        text = "\n\n".join(part for part in texts if part.strip())
        if text.strip() != first["last"] and status != PlanStatus.EXHAUSTED:
            label = f"{planner} on {first['place']}, seed {first['seed']}: {status}"
            found.append((label, text))
    return found[:REASONS_AT_MOST]


def _groups(runs: pd.DataFrame) -> Any:
    # A query that can't be asked is no failure of a planner.
    asked = runs[~is_blocked(runs)]
    lost = asked.assign(place=places(asked))[~asked["status"].isin(PlanStatus.SUCCESSES)]
    last = lost["reason"].fillna("").astype(str).str.strip().str.rsplit("\n", n=1).str[-1]
    missing = (
        lost["status"]
        .where(lost["status"] != PlanStatus.EXHAUSTED, WITHOUT_REASON)
        .where(lambda text: text == WITHOUT_REASON, "no reason was given")
    )
    lost = lost.assign(last=last.where(last != "", missing))
    # On a map of many queries a reason comes with many places: it is one all the same.
    lost = lost.assign(alike=lost["last"].str.replace(_NUMBERS, "0", regex=True))
    return lost.groupby(["variant", "status", "alike"], sort=False)
