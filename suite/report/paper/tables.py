"""The paper's comparisons, with the paper's figures beside ours. Nothing is bent to agree."""

from collections.abc import Iterable
from typing import Any

import pandas as pd

from suite.paper.reported import KBGA, KBGA_PLUS, PLAIN_GA, Reported, best_reported, find, reported
from suite.report.rows import feasible
from suite.report.statistics.generations import COUNTED, clock_columns, cut_off, generations_column
from suite.report.table import Kind, Table

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

GENERATIONS_NOTE = (
    "needed: until the final best was first found, or until the stop, whichever the planner's "
    "setting generations_counted names (else the first); the other one stands below. A run that "
    "its limit cut off would have needed more."
)
PLUS_NOTE = f"{KBGA_PLUS} is ours, and no figure of the paper speaks of it."

UNTIL_BEST, UNTIL_STOP = "generations until the best", "generations until the stop"

MEASURES = {
    "cost": "cost",
    "generations needed": "generations",
    UNTIL_BEST: "generations",
    UNTIL_STOP: "generations",
    "time needed (s)": "time_s",
}
"""Rows for each scene, and the paper's quantities beside them."""


def paper_table_1(runs: pd.DataFrame) -> pd.DataFrame:
    """Table 1: zigzag, the GA with and without its specialised operators.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        Columns quantity, statistic, then paper and ours, with and without; at the end kbga-plus
        with all its operators, if it was run.
    """
    variants = {"with": KBGA, "without": PLAIN_GA}
    ours = {side: _of(runs, TABLE_1_SCENE, variant) for side, variant in variants.items()}
    plus = _of(runs, TABLE_1_SCENE, KBGA_PLUS)
    if len(plus):
        ours[f"with, {KBGA_PLUS}"] = plus
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
        for side, group in ours.items():
            row[f"ours {side}"] = _statistic(_values(group, _NEEDED[quantity]), statistic)
        rows.append(row)
    rows += _table_1_extras(ours)
    columns = ["quantity", "statistic", "paper with", "ours with", "paper without", "ours without"]
    columns += [f"ours {side}" for side in ours if side not in variants]
    # Objects: counts stay whole among measures.
    return pd.DataFrame(rows, columns=columns, dtype=object)


_TABLE_1_WORDS = {
    "cost": "best found path cost",
    "generations": "generations needed",
    "time_s": "time needed (s)",
}


def _table_1_extras(ours: dict[str, pd.DataFrame]) -> list[dict[str, Any]]:
    """What the paper's table leaves out, of ours."""
    cut = {f"ours {side}": int(cut_off(group).sum()) for side, group in ours.items()}
    rows: list[dict[str, Any]] = [{"quantity": "runs cut off by a limit", "statistic": ""} | cut]
    what = _not_compared(ours["with"])
    for statistic in ("mean", "sd"):
        values = {
            f"ours {side}": _statistic(_values(group, what), statistic)
            for side, group in ours.items()
        }
        rows.append({"quantity": what, "statistic": statistic, **values})
    for what, column in (
        ("cost, all runs, penalties included", "claimed_cost"),
        ("generations to that cost, all runs", "generation_of_best"),
        ("generations in all, all runs", "generations"),
        ("time in all, all runs (s)", "wall_s"),
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
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        A row for each scene, quantity and place in the paper.
    """
    rows = []
    for scene in _in_paper_order(runs):
        ours = _of(runs, scene, KBGA)
        plus = _of(runs, scene, KBGA_PLUS)
        for what in _measures(ours) if len(ours) else ():
            rows += _static_rows(scene, what, ours, plus)
    columns = [
        "scene", "quantity", "paper mean", "paper SD", "paper best", "paper over best (%)",
        "ours mean", "ours SD", "ours best", "ours over optimum (%)", "feasible", "cut off",
        *_PLUS_COLUMNS, "paper's place",
    ]  # fmt: skip
    frame = pd.DataFrame(rows, columns=columns).astype({"cut off": "Int64"})
    if _of_variant(runs, KBGA_PLUS).empty:
        frame = frame.drop(columns=list(_PLUS_COLUMNS))
    return frame


_PLUS_COLUMNS = (f"ours mean, {KBGA_PLUS}", f"ours SD, {KBGA_PLUS}", f"feasible, {KBGA_PLUS}")


def _static_rows(
    scene: str, what: str, ours: pd.DataFrame, plus: pd.DataFrame
) -> list[dict[str, Any]]:
    quantity = MEASURES[what]
    values = _values(ours, what)
    single = find(scene=scene, planner=KBGA, quantity=quantity, statistic="single")
    best = min(single, key=lambda r: r.value) if single and quantity == "cost" else None
    common = {
        "scene": scene,
        "quantity": what,
        "paper best": None if best is None else best.value,
        "ours mean": _statistic(values, "mean"),
        "ours SD": _statistic(values, "sd"),
        "ours best": float(values.min()) if quantity == "cost" else None,
        "feasible": _share(ours),
        "cut off": int(cut_off(ours).sum()) if quantity == "generations" else None,
    }
    if quantity == "cost":
        common["ours over optimum (%)"] = 100.0 * _statistic(feasible(ours)["gap"], "mean")
    if len(plus):
        theirs = _values(plus, what)
        told = (_statistic(theirs, "mean"), _statistic(theirs, "sd"), _share(plus))
        common |= dict(zip(_PLUS_COLUMNS, told, strict=True))
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
            "paper over best (%)": _over_best(mean) if quantity == "cost" else None,
            "paper's place": mean.source + (f", {mean.runs} runs" if mean.runs != 20 else ""),
        }
        for mean in means
    ]


def _over_best(mean: Reported) -> float | None:
    best = best_reported(mean.scene)
    return None if best is None else 100.0 * (mean.value / best - 1.0)


def paper_tables(runs: pd.DataFrame) -> list[Table]:
    """The paper's comparisons that these runs can answer, with titles and notes."""
    tables = []
    if not _of(runs, TABLE_1_SCENE, KBGA).empty and not _of(runs, TABLE_1_SCENE, PLAIN_GA).empty:
        frame = paper_table_1(runs)
        title = "Paper's Table 1: zigzag, KBGA with and without its specialised operators"
        note = f"{GENERATIONS_NOTE} {COST_NOTE} {SCENE_NOTE} {TIME_NOTE}{_plus_note(runs)}"
        tables.append(Table("paper-table-1", title, frame, note, kinds=kinds_of_sides(frame)))
    static = paper_static(runs)
    if not static.empty:
        title = "Paper's section III: KBGA in static environments"
        note = (
            "best: of the paper, the cheapest single run that it shows; of ours, the cheapest run. "
            "over best, over optimum: what of the cost the drawing of a scene does not decide. "
            f"{GENERATIONS_NOTE} Where the paper states a figure twice, both stand here. Means are "
            f"over the feasible runs. {SCENE_NOTE} {TIME_NOTE}{_plus_note(runs)}"
        )
        tables.append(Table("paper-static", title, static, note, kinds=kinds_of_sides(static)))
    return tables


def kinds_of_sides(frame: pd.DataFrame) -> dict[str, Kind]:
    """Kinds of a table's columns of several quantities, the paper's and ours, named by the side."""
    sides = {"paper": Kind.PRINTED, "ours": Kind.MIXED}
    return {c: kind for c in map(str, frame) for side, kind in sides.items() if c.startswith(side)}


def _of(runs: pd.DataFrame, scene: str, variant: str) -> pd.DataFrame:
    return runs[(runs["scene"] == scene) & (runs["variant"] == variant)]


def _in_paper_order(runs: pd.DataFrame) -> list[str]:
    there = set(runs["scene"])
    named = dict.fromkeys(r.scene for r in reported() if r.scene is not None)
    return [scene for scene in named if scene in there]


def _of_variant(runs: pd.DataFrame, variant: str) -> pd.DataFrame:
    return runs[runs["variant"] == variant]


def _plus_note(runs: pd.DataFrame) -> str:
    return "" if _of_variant(runs, KBGA_PLUS).empty else f" {PLUS_NOTE}"


def _measures(ours: pd.DataFrame) -> list[str]:
    """The rows of a scene, with the other reading of the generations."""
    others = (UNTIL_BEST, UNTIL_STOP)
    return [name for name in MEASURES if name not in others or name == _not_compared(ours)]


def _not_compared(ours: pd.DataFrame) -> str:
    """The generations that these runs are not compared by, to stand beside the others."""
    return UNTIL_BEST if generations_column(ours) == COUNTED["stop"] else UNTIL_STOP


_NEEDED = {"cost": "cost", "generations": "generations needed", "time_s": "time needed (s)"}


def _values(ours: pd.DataFrame, what: str) -> "pd.Series[float]":
    """A measure of the runs that found a path; see :data:`MEASURES`."""
    columns = {
        "cost": "cost",
        "generations needed": generations_column(ours),
        UNTIL_BEST: "generation_of_best",
        UNTIL_STOP: "generations",
        "time needed (s)": clock_columns(ours)[0],
    }
    return feasible(ours)[columns[what]].astype("float64")


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
