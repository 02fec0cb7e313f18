"""The paper's comparisons, with the paper's figures beside ours. Nothing is bent to agree."""

from collections.abc import Iterable
from typing import Any

import pandas as pd

from suite.paper.reported import KBGA, PLAIN_GA, find, reported
from suite.report.summary import feasible
from suite.report.table import Table

TIME_NOTE = (
    "The paper's times are from a Pentium III at 933 MHz and can't be compared as such: only their "
    "ratios can."
)
COST_NOTE = (
    "Our costs are the referee's path lengths over feasible runs. The paper does not say whether "
    "its costs of the GA without specialised operators hold penalties of infeasible paths; ours "
    "with penalties are the planner's own costs, over all runs."
)
SCENE_NOTE = (
    "The paper's figures are not available: our scenes are reconstructions, calibrated to its best "
    "costs, so that costs of different scenes and planners can be compared, and no digit more."
)

TABLE_1_SCENE = "zigzag"

COLUMNS = {"cost": "cost", "generations": "generation_of_best", "time_s": "time_to_best_s"}
"""Quantities of the paper, and the columns of ours that answer them. Its "needed" is ours "to the
best": until the final best was first found."""

LABELS = {"cost": "cost", "generations": "generations needed", "time_s": "time needed (s)"}


def paper_table_1(runs: pd.DataFrame) -> pd.DataFrame:
    """Table 1: zigzag, the GA with and without its specialised operators.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read_runs` gives it.

    Returns
    -------
    DataFrame
        Columns quantity, statistic, then paper and ours, with and without.
    """
    variants = {"with": KBGA, "without": PLAIN_GA}
    ours = {side: _of(runs, TABLE_1_SCENE, variant) for side, variant in variants.items()}
    rows = [
        {"quantity": "number of runs", "statistic": ""}
        | {f"ours {side}": len(group) for side, group in ours.items()}
        | {f"paper {side}": 20 for side in variants},
        {"quantity": "feasible runs", "statistic": ""}
        | {f"ours {side}": len(feasible(group)) for side, group in ours.items()},
    ]
    for quantity, statistic in _pairs(("cost", "generations", "time_s")):
        row: dict[str, Any] = {"quantity": f"{_TABLE_1_WORDS[quantity]}", "statistic": statistic}
        for side, variant in variants.items():
            row[f"paper {side}"] = _reported(
                variant, TABLE_1_SCENE, quantity, statistic, source="Table 1"
            )
            row[f"ours {side}"] = _statistic(_values(ours[side], quantity), statistic)
        rows.append(row)
    rows += _table_1_extras(ours)
    columns = ["quantity", "statistic", "paper with", "ours with", "paper without", "ours without"]
    # Objects: counts stay whole among measures.
    return pd.DataFrame(rows, columns=columns, dtype=object)


_TABLE_1_WORDS = {
    "cost": "best found path cost",
    "generations": "generations needed",
    "time_s": "time needed (s)",
}


def _table_1_extras(ours: dict[str, pd.DataFrame]) -> list[dict[str, Any]]:
    """What the paper's table leaves out, of ours."""
    rows = []
    for what, column in (
        ("cost, penalties included", "claimed_cost"),
        ("generations to that cost", "generation_of_best"),
        ("generations in all", "generations"),
        ("time in all (s)", "wall_s"),
    ):
        for statistic in ("mean", "sd"):
            values = {
                f"ours {side}": _statistic(group[column], statistic) for side, group in ours.items()
            }
            rows.append({"quantity": what, "statistic": statistic, **values})
    return rows


def paper_static(runs: pd.DataFrame) -> pd.DataFrame:
    """Section III: KBGA on the static environments, and section IV's numbers of obstacles.

    A quantity that the paper states twice has two rows.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read_runs` gives it.

    Returns
    -------
    DataFrame
        A row for each scene, quantity and place in the paper.
    """
    rows = []
    for scene in _in_paper_order(runs):
        ours = _of(runs, scene, KBGA)
        for quantity in COLUMNS if len(ours) else ():
            rows += _static_rows(scene, quantity, ours)
    columns = [
        "scene", "quantity", "paper mean", "paper SD", "paper best", "ours mean", "ours SD",
        "ours best", "feasible", "paper's place",
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def _static_rows(scene: str, quantity: str, ours: pd.DataFrame) -> list[dict[str, Any]]:
    values = _values(ours, quantity)
    single = find(scene=scene, planner=KBGA, quantity=quantity, statistic="single")
    best = min(single, key=lambda r: r.value) if single and quantity == "cost" else None
    common = {
        "scene": scene,
        "quantity": LABELS[quantity],
        "paper best": None if best is None else best.value,
        "ours mean": _statistic(values, "mean"),
        "ours SD": _statistic(values, "sd"),
        "ours best": float(values.min()) if quantity == "cost" else None,
        "feasible": _share(ours),
    }
    means = find(scene=scene, planner=KBGA, quantity=quantity, statistic="mean")
    # The resolutions of section IV are another experiment.
    means = [r for r in means if not r.setting]
    if not means:
        return [] if best is None else [common | {"paper's place": best.source}]
    return [
        common
        | {
            "paper mean": mean.value,
            "paper SD": _reported(KBGA, scene, quantity, "sd", source=mean.source),
            "paper's place": mean.source + (f", {mean.runs} runs" if mean.runs != 20 else ""),
        }
        for mean in means
    ]


def paper_tables(runs: pd.DataFrame) -> list[Table]:
    """The paper's comparisons that these runs can answer, with titles and notes."""
    tables = []
    if not _of(runs, TABLE_1_SCENE, KBGA).empty and not _of(runs, TABLE_1_SCENE, PLAIN_GA).empty:
        tables.append(
            Table(
                "paper-table-1",
                "Paper's Table 1: zigzag, KBGA with and without its specialised operators",
                paper_table_1(runs),
                f"{COST_NOTE} {SCENE_NOTE} {TIME_NOTE}",
            )
        )
    static = paper_static(runs)
    if not static.empty:
        title = "Paper's section III: KBGA in static environments"
        note = (
            "best: of the paper, the cheapest single run that it shows; of ours, the cheapest run. "
            "needed: until the final best was first found. Where the paper states a figure twice, "
            f"both stand here. {SCENE_NOTE} {TIME_NOTE}"
        )
        tables.append(Table("paper-static", title, static, note))
    return tables


def _of(runs: pd.DataFrame, scene: str, variant: str) -> pd.DataFrame:
    return runs[(runs["scene"] == scene) & (runs["variant"] == variant)]


def _in_paper_order(runs: pd.DataFrame) -> list[str]:
    there = set(runs["scene"])
    named = dict.fromkeys(r.scene for r in reported() if r.scene is not None)
    return [scene for scene in named if scene in there]


def _values(ours: pd.DataFrame, quantity: str) -> "pd.Series[float]":
    return feasible(ours)[COLUMNS[quantity]].astype("float64")


def _pairs(quantities: Iterable[str]) -> list[tuple[str, str]]:
    return [(quantity, statistic) for quantity in quantities for statistic in ("mean", "sd")]


def _statistic(values: "pd.Series[Any]", statistic: str) -> float:
    numbers = values.dropna().astype("float64")
    return float(numbers.mean() if statistic == "mean" else numbers.std(ddof=1))


def _reported(
    planner: str, scene: str, quantity: str, statistic: str, *, source: str | None = None
) -> float | None:
    found = find(planner=planner, scene=scene, quantity=quantity, statistic=statistic)
    values = [r.value for r in found if source is None or r.source == source]
    return values[0] if values else None


def _share(ours: pd.DataFrame) -> str:
    return f"{len(feasible(ours))} of {len(ours)}"
