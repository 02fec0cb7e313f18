"""What each operator contributes: KBGA whole beside KBGA with operators switched off (section IV).

A run's row says itself what was switched off: an operator of probability 0.
"""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from suite.paper.reported import (
    KBGA,
    KBGA_PLUS,
    PLAIN_GA,
    WITHOUT_CROSSOVER_AND_MUTATION,
    find,
)
from suite.report.rows import feasible, places, settings_of
from suite.report.statistics.generations import cut_off
from suite.report.table import Kind, Table
from suite.report.tables.compared import (
    COLUMNS,
    KINDS,
    NOTE,
    PENALTIES_NOTE,
    RATIO_NOTE,
    compare,
    families,
)
from suite.report.tables.glance import at_a_glance
from suite.report.tables.studies import GLANCE_NOTE

OPERATORS = ("crossover", "mutation", "repair", "deletion", "improvement")
NOTHING = "nothing"
SPECIALISED = "repair, deletion, improvement"
CLASSICAL = "crossover, mutation"

WHOLE = (KBGA, KBGA_PLUS)
"""Planners that have all operators, unless some are switched off: the paper's, and ours."""

REPORTED = {NOTHING: KBGA, SPECIALISED: PLAIN_GA, CLASSICAL: WITHOUT_CROSSOVER_AND_MUTATION}
"""What the paper switched off, and the names under which its figures stand."""

PLAIN_GA_NOTE = (
    "plain-ga is the paper's GA without specialised operators: with the mutation rate that was "
    "found to be best for it, and a patience of 200 generations. KBGA without its specialised "
    "operators keeps its own mutation rate, 0.2, and its own patience, and so stops sooner."
)


def ablation(runs: pd.DataFrame) -> pd.DataFrame:
    """KBGA whole and without operators, on each scene: a row for each family and what is off.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        Of :func:`suite.report.tables.compared.compare`; its column ``value`` says what is off.
        Empty if no KBGA was run both whole and ablated.
    """
    rows = ablated(runs)
    if rows.empty:
        return rows
    return compare(
        rows,
        by=["scene", "family", "variant", "value"],
        within=["scene", "family"],
        reference=NOTHING,
    )


def ablated(runs: pd.DataFrame) -> pd.DataFrame:
    """The runs of families that were ablated, and of the plain GA.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        With ``family``, and ``value``, which says what is off; empty if none was run both whole
        and ablated.
    """
    runs = runs[runs["planner"].isin(WHOLE) | (runs["variant"] == PLAIN_GA)]
    settings = settings_of(runs)
    rows = runs.assign(
        value=settings.map(_off),
        family=families(runs, settings, [_probability(name) for name in OPERATORS]),
        scene=places(runs),
    )
    is_kbga = rows["planner"].isin(WHOLE)
    # A run with another probability above 0 is tuned, not ablated: it is another study's.
    above = settings.map(_probabilities_above_0)
    whole = {
        name: above[group.index[0]]
        for name, group in rows[is_kbga & (rows["value"] == NOTHING)].groupby("family", sort=False)
    }
    fits = [
        not kbga or (name in whole and chances.items() <= whole[name].items())
        for kbga, name, chances in zip(is_kbga, rows["family"], above, strict=True)
    ]
    rows = rows[pd.Series(fits, index=rows.index, dtype=bool)]
    is_kbga = rows["planner"].isin(WHOLE)
    several = rows.groupby("family")["value"].transform("nunique") > 1
    return rows[several | ~is_kbga] if several.any() else rows.iloc[:0]


def _probability(operator: str) -> str:
    return f"{operator}_probability"


def _probabilities_above_0(settings: Mapping[str, Any]) -> dict[str, float]:
    chances = {name: float(settings.get(_probability(name), 0.0)) for name in OPERATORS}
    return {name: chance for name, chance in chances.items() if chance > 0.0}


def _off(settings: Mapping[str, Any]) -> str:
    on = _probabilities_above_0(settings)
    return ", ".join(name for name in OPERATORS if name not in on) or NOTHING


def paper_ablation(runs: pd.DataFrame) -> pd.DataFrame:
    """Section IV: the ablations that the paper reports, in each reading that was run.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        A row for each scene that the paper did this on, what is off, and variant of ours.
    """
    rows = ablated(runs)
    if rows.empty:
        return rows
    found = []
    scenes = dict.fromkeys(r.scene for r in find(planner=PLAIN_GA) if r.scene)
    for scene in scenes:
        for off, reported_as in REPORTED.items():
            wanted = rows[(rows["scene"] == scene) & (rows["value"] == off)]
            for variant, ours in wanted.groupby("variant", sort=False):
                found.append(_paper_row(scene, off, reported_as, str(variant), ours))
    return pd.DataFrame(found)


def _paper_row(
    scene: str, off: str, reported_as: str, variant: str, ours: pd.DataFrame
) -> dict[str, Any]:
    def paper(quantity: str, statistic: str) -> list[float]:
        if KBGA_PLUS in set(ours["planner"]):
            # It is none of the paper's.
            return []
        figures = find(planner=reported_as, scene=scene, quantity=quantity, statistic=statistic)
        return [r.value for r in figures]

    there = feasible(ours)
    generations = there["generation_of_best"].astype("float64")
    return {
        "scene": scene,
        "switched off": off,
        "planner": variant,
        "paper cost mean": next(iter(paper("cost", "mean")), None),
        # The paper states some twice.
        "paper cost SD": " / ".join(f"{value:g}" for value in paper("cost", "sd")),
        "ours cost mean": float(there["cost"].mean()),
        "ours cost SD": float(there["cost"].std(ddof=1)),
        "ours cost with penalties mean": float(ours["claimed_cost"].mean()),
        "paper gen mean": next(iter(paper("generations", "mean")), None),
        "ours gen mean": float(generations.mean()),
        "ours gen SD": float(generations.std(ddof=1)),
        "ours gen until stop mean": float(there["generations"].astype("float64").mean()),
        "ours cut off": int(cut_off(ours).sum()),
        "paper feasible": "never" if 0.0 in paper("success", "mean") else "",
        "ours feasible": f"{len(there)} of {len(ours)}",
    }


def ablation_tables(runs: pd.DataFrame, cost_note: str) -> list[Table]:
    """The paper's ablations beside ours; all of ours at a glance; and all their measures.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    cost_note : str
        What costs are, for the table with the paper's.
    """
    frame = ablation(runs)
    if frame.empty:
        return []
    beside = paper_ablation(runs)
    tables = []
    if len(beside):
        note = (
            "Two SDs of the paper: it states both. ours gen: until the best was found, and until "
            "the stop, of the runs that found a path; cut off: runs that a limit ended, of all. "
            f"Verdicts stand in the table of contrasts. {cost_note}"
        )
        title = "Paper's section IV: what the operators contribute"
        kinds = {"paper cost mean": Kind.PRINTED, "paper gen mean": Kind.PRINTED}
        tables.append(Table("paper-ablation", title, beside, note, kinds=kinds))
    title = "KBGA without some of its operators"
    seen = frame.rename(columns={"value": "switched off", "family": "settings"})
    has_plain_ga = PLAIN_GA in set(frame["variant"])
    plain = f" {PLAIN_GA_NOTE}" if has_plain_ga else ""
    tables.append(
        Table(
            "study-ablation",
            f"{title}: mean gap (%)",
            at_a_glance(seen, ["settings", "switched off"]),
            GLANCE_NOTE + plain,
        )
    )
    columns = ["scene", "settings", "switched off", "runs", "feasible", *COLUMNS]
    ratios = RATIO_NOTE.format(reference="the same settings with nothing switched off")
    note = f"{NOTE} {PENALTIES_NOTE} {ratios}{plain}"
    rows = f"{title}: all measures"
    return [*tables, Table("study-ablation-rows", rows, seen[columns], note, kinds=KINDS)]
