"""Runs of variants compared with those of one of them: the machinery of all studies."""

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from suite.report.rows import BUDGET, feasible
from suite.report.table import Kind

NOTE = (
    "feasible: runs with a path that the referee accepted. cost, gap, gen to best and cpu to "
    "best: means over these, and over no others; checks and cpu total: over all runs. cpu: time "
    "of the processor, which other processes on the machine disturb less than the clock."
)
PENALTIES_NOTE = (
    "cost with penalties: the planner's own lowest cost, over all runs, feasible or not."
)
RATIO_NOTE = "ratio: of the cpu time to that of {reference}."

COLUMNS = [
    "cost mean", "cost SD", "gap mean (%)", "cost with penalties mean", "gen to best mean",
    "checks mean", "cpu to best mean (ms)", "cpu total median (ms)", "ratio to best", "ratio total",
]  # fmt: skip
KINDS = {"gen to best mean": Kind.COUNT, "checks mean": Kind.COUNT}
"""Of :func:`compare`: what a table of all measures shows, and what these are."""


def families(
    runs: pd.DataFrame, settings: "pd.Series[Any]", apart_from: Iterable[str]
) -> "pd.Series[str]":
    """Names of the families: runs of one planner that differ in nothing but some settings.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    settings : Series of dict
        Of these runs; see :func:`settings_of`.
    apart_from : iterable of str
        The settings in which members of one family may differ.

    Returns
    -------
    Series of str
        The planner's name; where a planner has several families, also what they differ in.
    """
    left_out = set(apart_from)
    # Few different dicts stand in many rows.
    different = {id(values): values for values in settings}
    texts = {number: _canonical(values, left_out) for number, values in different.items()}
    keys = [
        (planner, texts[id(values)], budget)
        for planner, values, budget in zip(
            runs["planner"], settings, map(str, runs[BUDGET].to_numpy().tolist()), strict=True
        )
    ]
    members: dict[tuple[str, str, str], Mapping[str, Any]] = {}
    for key, values in zip(keys, settings, strict=True):
        members.setdefault(key, values)
    names = {
        key: _family_name(key, [k for k in members if k[0] == key[0]], members, left_out)
        for key in members
    }
    return pd.Series([names[key] for key in keys], index=runs.index, dtype="object")


def _canonical(values: Mapping[str, Any], left_out: set[str]) -> str:
    return json.dumps({k: v for k, v in values.items() if k not in left_out}, sort_keys=True)


def _family_name(
    key: tuple[str, str, str],
    siblings: Sequence[tuple[str, str, str]],
    members: Mapping[tuple[str, str, str], Mapping[str, Any]],
    left_out: set[str],
) -> str:
    mine = members[key]
    differing = [
        f"{name} {value}"
        for name, value in mine.items()
        if name not in left_out and any(members[s].get(name) != value for s in siblings)
    ]
    if len({s[2] for s in siblings}) > 1:
        differing.append(f"budget {key[2]}")
    return ", ".join([key[0], *differing])


def compare(
    runs: pd.DataFrame, *, by: Sequence[str], within: Sequence[str], reference: Any
) -> pd.DataFrame:
    """Measures of each group of runs, and the ratios of its times to those of a reference.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it, with a column ``value`` of what varies.
    by : sequence of str
        Columns that name a row.
    within : sequence of str
        Some of these: rows that agree in them are compared with the one of them whose ``value``
        is the reference.
    reference : float or str

    Returns
    -------
    DataFrame
        A row for each group, in the order of their first runs.
    """
    groups = runs.groupby(list(by), sort=False, dropna=False)
    rows = [dict(zip(by, name, strict=True)) | _measures(group) for name, group in groups]
    frame = pd.DataFrame(rows)
    if frame.empty:
        return frame
    for what, ratio in (("cpu to best mean (ms)", "to best"), ("cpu total median (ms)", "total")):
        frame[f"ratio {ratio}"] = frame[what] / _of_reference(frame, what, within, reference)
    return frame


def _measures(group: pd.DataFrame) -> dict[str, Any]:
    found = feasible(group)
    cost = found["cost"]
    return {
        "runs": len(group),
        "feasible": len(found),
        "cost mean": float(cost.mean()),
        "cost SD": float(cost.std(ddof=1)),
        "gap mean (%)": 100.0 * float(found["gap"].mean()),
        "cost with penalties mean": float(group["claimed_cost"].mean()),
        "cost with penalties over optimum": float(
            (group["claimed_cost"] / group["optimum"]).mean()
        ),
        "gen to best mean": float(found["generation_of_best"].astype("float64").mean()),
        "checks mean": float(group["checks"].astype("float64").mean()),
        "cpu to best mean (ms)": 1e3 * float(found["cpu_to_best_s"].mean()),
        "cpu total median (ms)": 1e3 * float(group["cpu_s"].median()),
    }


def _of_reference(
    frame: pd.DataFrame, column: str, within: Sequence[str], reference: Any
) -> "pd.Series[float]":
    """The reference's measure, beside every row that is compared with it."""
    there = frame[column].where(frame["value"] == reference)
    if not within:
        return pd.Series(there.dropna().iloc[:1].mean(), index=frame.index)
    # The first: a store may hold the reference under two names.
    return there.groupby([frame[name] for name in within]).transform("first")


def whole_where_whole(values: "pd.Series[float]") -> "pd.Series[Any]":
    """Numbers without a fraction as whole ones, if all are: 100, not 100.00."""
    if (values == values.round()).all():
        return values.astype("int64")
    return values
