"""What separates KBGA from KBGA-plus, and what each difference brings, taken both ways.

From the paper's algorithm towards ours: KBGA with one of our settings. And back: KBGA-plus with one
of the paper's. A row's settings say which it is; the names of variants are for people.
"""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from suite.paper.reported import KBGA, KBGA_PLUS
from suite.report.rows import feasible, settings_of
from suite.report.table import Kind, Table

NOTE = (
    "One setting at a time: in the upper rows KBGA takes it from KBGA-plus, in the lower ones "
    "KBGA-plus gives it back. found: runs with a path. gap: mean over the paths found, on all "
    "scenes together; beside a lower count it is of the easier runs. checks: questions asked, mean "
    "over all runs. cpu: whole run, mean."
)

AS_IT_IS = "as it is"


def difference_tables(runs: pd.DataFrame) -> list[Table]:
    """The table of differences; none if the runs do not hold both planners and steps between.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    """
    frame = differences(runs)
    if frame.empty:
        return []
    title = "What separates kbga from kbga-plus, and what each difference brings"
    return [Table("differences", title, frame, NOTE, kinds={"checks mean": Kind.COUNT})]


def differences(runs: pd.DataFrame) -> pd.DataFrame:
    """A row for each planner as it is, and for each single setting taken from the other.

    Returns
    -------
    DataFrame
        Columns: planner, setting, value, found, runs, gap mean (%), checks, cpu (ms). Empty if the
        runs do not hold both planners and some steps between them.
    """
    runs = runs[runs["planner"].isin([KBGA, KBGA_PLUS])]
    if runs.empty:
        return pd.DataFrame()
    settings = settings_of(runs)
    first = settings.groupby(runs["variant"]).first()
    if not {KBGA, KBGA_PLUS} <= set(first.index):
        return pd.DataFrame()
    ends: dict[str, Mapping[str, Any]] = {name: first[name] for name in (KBGA, KBGA_PLUS)}
    rows = []
    for planner, other in ((KBGA, KBGA_PLUS), (KBGA_PLUS, KBGA)):
        mine = runs[runs["planner"] == planner]
        steps = [_step(values, ends[planner], ends[other]) for values in settings[mine.index]]
        for step, group in mine.groupby(pd.Series(steps, mine.index), sort=False):
            rows.append(_row(planner, str(step), ends[other], group))
    frame = pd.DataFrame(rows)
    return frame if (frame["setting"] != AS_IT_IS).any() else pd.DataFrame()


def _step(
    settings: Mapping[str, Any], mine: Mapping[str, Any], others: Mapping[str, Any]
) -> str | None:
    """The one setting that is the other planner's; AS_IT_IS if none is; None if it is no step."""
    changed = [name for name, value in settings.items() if value != mine.get(name)]
    if not changed:
        return AS_IT_IS
    is_step = len(changed) == 1 and settings[changed[0]] == others.get(changed[0])
    return changed[0] if is_step else None


def _row(planner: str, step: str, others: Mapping[str, Any], group: pd.DataFrame) -> dict[str, Any]:
    found = feasible(group)
    return {
        "planner": planner,
        "setting": step,
        "value": "" if step == AS_IT_IS else str(others[step]),
        "runs": len(group),
        "found": len(found),
        "gap mean (%)": 100.0 * float(found["gap"].mean()),
        "checks mean": float(group["checks"].mean()),
        "cpu mean (ms)": 1e3 * float(group["cpu_s"].mean()),
    }
