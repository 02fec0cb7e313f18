"""Every figure that the paper reports, ours beside it, and what the two say about each other.

A verdict says how ours stands to the paper's figure, and why it is so called. Nothing is bent:
where another machine, our own drawing of a scene or our own choice of a constant decides, the two
are not comparable, and ours is shown all the same.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from suite.paper.reported import KBGA, PLAIN_GA, Reported, reported
from suite.report.compared import settings_of
from suite.report.paper_tables import COLUMNS
from suite.report.simulated import UNKNOWN, reactions
from suite.report.summary import feasible
from suite.report.table import Table

AGREES, BETTER, WORSE = "agrees", "better", "worse"
NOT_COMPARABLE, NO_DATA = "not comparable", "no data"

CALIBRATION = 0.015
"""Our scenes are drawn so that their optimum is within this of the paper's best cost, relative."""

LEVEL = 0.95

OTHER_MACHINE = "a Pentium III at 933 MHz; only ratios of times are comparable"
CHANCE = "within what chance explains (95 %)"

NOTE = (
    "ours: over the runs that found a path. agrees: costs within the 1.5 % to which our scenes are "
    "calibrated, or whatever chance explains (Welch's t for means, F for standard deviations, the "
    "range of our runs for a single run of the paper). better: less cost, fewer generations, less "
    "spread, more paths. What the paper states twice stands here twice."
)

SETTING_NAMES: Mapping[str, tuple[str, ...]] = {
    "other_probability": (
        "crossover_probability",
        "repair_probability",
        "deletion_probability",
        "improvement_probability",
    ),
}
"""What the paper sets with one figure, and our settings of it."""

WORLD_NAMES = {
    "obstacle_speed": "obstacle_speed_factor",
    "robot_speed": "speed",
    "update_interval_s": "interval",
}
"""Figures of the paper's worlds, and our settings. The bar of the door moves at 1 m/s times the
factor."""

WORLDS = {
    "section III-D, Fig. 11": "Fig. 11",
    "section III-D, Fig. 12a": "Fig. 12 (a)",
    "section III-D, Fig. 12b": "Fig. 12 (b)",
    "section III-D, Fig. 12c-d": "Fig. 12 (c, d)",
}
"""Places in the paper, and what the names of our worlds begin with."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """How ours stands to a figure of the paper.

    ours : float; nan if there is none.
    word : AGREES, BETTER, WORSE, NOT_COMPARABLE or NO_DATA.
    why : a few words.
    """

    ours: float
    word: str
    why: str


NOTHING = Verdict(float("nan"), NO_DATA, "no such runs in this store")


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """What verdicts are made from.

    planned, driven : DataFrame of the runs that are planned once, and of the simulated ones.
    first : DataFrame of measures of the first population, by key.
    replans : DataFrame of the replans of the simulated runs.
    """

    planned: pd.DataFrame
    driven: pd.DataFrame
    first: pd.DataFrame
    replans: pd.DataFrame


def verdict_table(rows: Rows) -> Table | None:
    """The figures of the paper that these runs answer, with ours; None if they answer none.

    Settings alone, as those of any run of our KBGA, are no answer.

    Parameters
    ----------
    rows : Rows
    """
    found = [(figure, verdict(figure, rows)) for figure in reported()]
    frame = pd.DataFrame(
        [_as_row(figure, given) for figure, given in found if given.word != NO_DATA]
    )
    if all(figure.statistic == "setting" for figure, given in found if given.word != NO_DATA):
        return None
    counts = frame["verdict"].value_counts()
    words = (AGREES, BETTER, WORSE, NOT_COMPARABLE)
    told = ", ".join(f"{counts[word]} {word}" for word in words if word in counts)
    missing = len(found) - len(frame)
    rest = f" For {missing} more there are no such runs here." if missing else ""
    title = "Every figure of the paper, and ours"
    return Table("paper-figures", title, frame, f"{len(frame)} figures: {told}.{rest} {NOTE}")


def verdict(figure: Reported, rows: Rows) -> Verdict:
    """How our runs stand to one figure."""
    if figure.statistic == "setting":
        return _setting(figure, rows)
    if figure.quantity == "reaction_s":
        return _reaction(figure, rows)
    ours = _runs_of(figure, rows.planned)
    if ours.empty:
        return NOTHING
    if figure.quantity == "success":
        return _success(figure, ours)
    if figure.statistic == "initial":
        return _initial(ours, rows.first)
    values = feasible(ours)[COLUMNS[figure.quantity]].dropna().to_numpy(dtype=np.float64)
    if len(values) == 0:
        return Verdict(float("nan"), WORSE, f"none of our {len(ours)} runs found a path")
    return _STATISTICS[figure.statistic](figure, values)


def _runs_of(figure: Reported, runs: pd.DataFrame) -> pd.DataFrame:
    here = runs[runs["scene"] == figure.scene]
    names = [figure.planner]
    if "resolution" in figure.setting:
        names = [f"{KBGA}-resolution-{figure.setting['resolution']:g}"]
    return here[here["variant"].isin(names)]


def _mean(figure: Reported, values: np.ndarray[Any, Any]) -> Verdict:
    ours = float(values.mean())
    if figure.quantity == "time_s":
        return Verdict(ours, NOT_COMPARABLE, OTHER_MACHINE)
    if figure.quantity == "cost" and abs(ours / figure.value - 1.0) <= CALIBRATION:
        return Verdict(ours, AGREES, "within the calibration of the scene (1.5 %)")
    spread = _reported_spread(figure)
    if spread is not None and figure.runs is not None and len(values) > 1:
        difference = stats.ttest_ind_from_stats(
            ours, values.std(ddof=1), len(values), figure.value, spread, figure.runs,
            equal_var=False,
        )  # fmt: skip
        if difference.pvalue > 1.0 - LEVEL:
            return Verdict(ours, AGREES, CHANCE)
    return _by_sign(figure, ours)


def _sd(figure: Reported, values: np.ndarray[Any, Any]) -> Verdict:
    if len(values) < 2:
        return Verdict(float("nan"), NO_DATA, "one run has no spread")
    ours = float(values.std(ddof=1))
    if figure.quantity == "time_s":
        return Verdict(ours, NOT_COMPARABLE, OTHER_MACHINE)
    low, high = stats.f.interval(LEVEL, len(values) - 1, (figure.runs or 20) - 1)
    if low <= (ours / figure.value) ** 2 <= high:
        return Verdict(ours, AGREES, CHANCE)
    return _by_sign(figure, ours)


def _single(figure: Reported, values: np.ndarray[Any, Any]) -> Verdict:
    """Whether one run of the paper could be one of ours."""
    ours = float(np.median(values))
    if figure.quantity == "time_s":
        return Verdict(ours, NOT_COMPARABLE, f"our median run; {OTHER_MACHINE}")
    slack = 1.0 + (CALIBRATION if figure.quantity == "cost" else 0.0)
    if values.min() / slack <= figure.value <= values.max() * slack:
        return Verdict(ours, AGREES, "our median; the paper's run lies in the range of ours")
    return _by_sign(figure, ours, "our median; ")


_STATISTICS: Mapping[str, Callable[[Reported, np.ndarray[Any, Any]], Verdict]] = {
    "mean": _mean,
    "sd": _sd,
    "single": _single,
}


def _by_sign(figure: Reported, ours: float, before: str = "") -> Verdict:
    word = BETTER if ours < figure.value else WORSE
    less, more = ("fewer", "more") if figure.quantity == "generations" else ("lower", "higher")
    why = f"{before}{less if ours < figure.value else more}"
    if figure.quantity == "generations" and figure.planner != PLAIN_GA:
        why += "; up to eight rounds of operators in each generation of ours"
    return Verdict(ours, word, why)


def _success(figure: Reported, ours: pd.DataFrame) -> Verdict:
    share = len(feasible(ours)) / len(ours)
    if share == figure.value:
        return Verdict(share, AGREES, f"of {len(ours)} runs none finds a path")
    return Verdict(share, BETTER, f"{len(feasible(ours))} of {len(ours)} runs find a path")


def _initial(ours: pd.DataFrame, first: pd.DataFrame) -> Verdict:
    """Best cost of the first population, penalties included."""
    keys = [key for key in ours["key"] if key in first.index]
    if not keys or "best" not in first:
        return NOTHING
    why = "our median; holds penalties, whose constant the paper does not tell"
    return Verdict(float(first.loc[keys, "best"].median()), NOT_COMPARABLE, why)


def _setting(figure: Reported, rows: Rows) -> Verdict:
    if figure.source in WORLDS:
        driven = rows.driven[
            (rows.driven["variant"] == KBGA)
            & rows.driven["world"].fillna("").str.startswith(WORLDS[figure.source])
        ]
        return _same_setting(
            figure, settings_of(driven, "world_settings"), (WORLD_NAMES[figure.quantity],)
        )
    ours = rows.planned[rows.planned["variant"] == figure.planner]
    names = SETTING_NAMES.get(figure.quantity, (figure.quantity,))
    return _same_setting(figure, settings_of(ours), names)


def _same_setting(figure: Reported, settings: "pd.Series[Any]", names: tuple[str, ...]) -> Verdict:
    found = {float(values[name]) for values in settings for name in names if name in values}
    if not found:
        return NOTHING
    ours = found.pop() if len(found) == 1 else float("nan")
    if ours == figure.value:
        return Verdict(ours, AGREES, "set so")
    why = "the best by the paper's own rule in our study" if figure.planner == PLAIN_GA else ""
    return Verdict(ours, NOT_COMPARABLE, why or "set otherwise")


def _reaction(figure: Reported, rows: Rows) -> Verdict:
    if rows.replans.empty:
        return NOTHING
    asked = rows.driven.loc[rows.driven["variant"] == KBGA, ["key", "scene", "world_settings"]]
    news = reactions(asked[asked["scene"] == UNKNOWN].merge(rows.replans, on="key"))
    if news.empty:
        return NOTHING
    change = news["number"].min() if "obstacle A" in figure.note else news["number"].max()
    ours = float(news.loc[news["number"] == change, "latency_s"].median())
    return Verdict(ours, NOT_COMPARABLE, f"our median; {OTHER_MACHINE}")


def _reported_spread(figure: Reported) -> float | None:
    """The standard deviation that the paper states at the same place, if it does."""
    for other in reported():
        same = (other.source, other.scene, other.planner, other.quantity, dict(other.setting))
        if other.statistic == "sd" and same == (
            figure.source, figure.scene, figure.planner, figure.quantity, dict(figure.setting),
        ):  # fmt: skip
            return other.value
    return None


def _as_row(figure: Reported, given: Verdict) -> dict[str, Any]:
    unit = f" ({figure.unit})" if figure.unit else ""
    statistic = "" if figure.statistic == "setting" else f", {figure.statistic}"
    return {
        "paper's place": figure.source,
        "scene": figure.scene or "",
        "planner": figure.planner,
        "figure": f"{_WORDS.get(figure.quantity, figure.quantity)}{statistic}{unit}",
        "paper": figure.value,
        "ours": given.ours,
        "verdict": given.word,
        "why": given.why,
    }


_WORDS = {"time_s": "time needed", "reaction_s": "reaction", "generations": "generations needed"}
