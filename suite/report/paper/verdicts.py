"""Every figure that the paper reports, ours beside it, and what the two say about each other.

A verdict says how ours stands to the paper's figure, and why it is so called. Each can come out
either way: where our own drawing of a scene, another machine or our own choice decides, the two are
not comparable, and ours is shown all the same. The costs of our scenes are drawn to be the paper's,
so costs are compared by what the drawing does not decide: how far above the best they are.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from suite.paper.reported import (
    KBGA,
    KBGA_PLUS,
    PLAIN_GA,
    RUNS,
    Reported,
    best_reported,
    reported,
    spread_of,
)
from suite.report.paper.tables import kinds_of_sides
from suite.report.rows import feasible, settings_of
from suite.report.statistics.agreement import (
    AGREES,
    DIFFERS,
    NOT_COMPARABLE,
    ROUNDING,
    Compared,
    Sample,
    best_of,
    compare_means,
    compare_spreads,
    sample_of,
    shares_differ,
)
from suite.report.statistics.generations import clock_columns, cut_off, generations_column
from suite.report.statistics.inference import Array
from suite.report.table import Table
from suite.report.tables.simulated import UNKNOWN, reactions
from suite.report.words import fixed

BETTER, WORSE = "better", "worse"
SETTING, NO_DATA = "setting", "no data"

OTHER_MACHINE = "another machine; ratios are among the contrasts"
NOTE = (
    "ours: over the runs that found a path; {plus}setting: what we set, which is no result and is "
    "not counted. Our scenes are drawn so that their optimum is the paper's best cost, so that "
    "costs near it agree by construction: compared is the excess, of the paper over its best cost "
    "on the scene, of ours over the exact optimum, and so are its spread and the range of our "
    "runs. agrees: the 95 % interval of the difference (Welch) holds 0 and is narrower than the "
    "paper's own figure, so that a planner without any excess can't agree; spreads (F) within a "
    "factor of 3; a single run of the paper within the range of ours, if that ends below twice "
    "the figure. differs: the interval does not hold 0, or too many of our runs found no path. "
    "Where some did not, a verdict on a mean stands only if it is the same over those that did and "
    "over all, penalties included. better, worse: differs, where the scene is not drawn to the "
    "cost. not comparable: neither is shown, or the reason beside it. What the paper states twice "
    "stands here twice."
)
PLUS_NOTE = f"{KBGA_PLUS}: ours, beside, without a verdict; "

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
    word : AGREES, DIFFERS, BETTER, WORSE, NOT_COMPARABLE, SETTING or NO_DATA.
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
    shown = [(figure, given) for figure, given in found if given.word != NO_DATA]
    if all(given.word == SETTING for _, given in shown):
        return None
    beside = of_kbga_plus(rows)
    frame = pd.DataFrame(
        [_as_row(figure, given, verdict(figure, beside).ours) for figure, given in shown]
    )
    has_plus = bool(frame[f"ours, {KBGA_PLUS}"].notna().any())
    if not has_plus:
        frame = frame.drop(columns=f"ours, {KBGA_PLUS}")
    note = f"{_counted(frame, len(found))} {NOTE.format(plus=PLUS_NOTE if has_plus else '')}"
    title = "Every figure of the paper, and ours"
    return Table("paper-figures", title, frame, note, kinds=kinds_of_sides(frame))


def _counted(frame: pd.DataFrame, of: int) -> str:
    counts = frame["verdict"].value_counts()
    words = (AGREES, BETTER, WORSE, DIFFERS, NOT_COMPARABLE)
    told = ", ".join(f"{counts[word]} {word}" for word in words if word in counts)
    settings = int(counts.get(SETTING, 0))
    beside = f"; {settings} setting{'s' * (settings > 1)} beside" if settings else ""
    missing = of - len(frame)
    rest = f" For {missing} more there are no such runs here." if missing else ""
    return f"{len(frame) - settings} figures: {told}{beside}.{rest}"


def of_kbga_plus(rows: Rows) -> Rows:
    """The same rows with our planner in the place of the paper's, to be shown beside it."""
    planned, driven = (_renamed(frame) for frame in (rows.planned, rows.driven))
    return replace(rows, planned=planned, driven=driven)


def _renamed(runs: pd.DataFrame) -> pd.DataFrame:
    ours = runs[runs["variant"].str.match(f"{KBGA_PLUS}(?:-|$)")]
    return ours.assign(variant=ours["variant"].str.replace(KBGA_PLUS, KBGA, n=1, regex=False))


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
        return _initial(figure, ours, rows.first)
    return _STATISTICS[figure.statistic](figure, ours)


def _runs_of(figure: Reported, runs: pd.DataFrame) -> pd.DataFrame:
    name = figure.planner
    if "resolution" in figure.setting:
        name = f"{KBGA}-resolution-{figure.setting['resolution']:g}"
    return runs[(runs["scene"] == figure.scene) & (runs["variant"] == name)]


def _mean(figure: Reported, ours: pd.DataFrame) -> Verdict:
    values = _values(figure, ours)
    shown = float(values.mean()) if len(values) else float("nan")
    early = _not_asked(figure, ours, shown)
    if early is not None:
        return early
    if len(feasible(ours)) < len(ours):
        return _over_fewer(figure, ours, shown)
    mine = sample_of(_beyond(figure, values, _scale(figure, ours)))
    papers = _paper_sample(figure, mine)
    compared = compare_means(mine, papers)
    cut = _cut_off(figure, ours)
    if cut and not compared.low > 0.0:
        return Verdict(shown, NOT_COMPARABLE, f"{cut}: the mean is a lower bound")
    why = _apart(figure, mine, papers, compared)
    return Verdict(shown, _word(figure, compared), f"{why}; {cut}" if cut else why)


def _sd(figure: Reported, ours: pd.DataFrame) -> Verdict:
    values = _values(figure, ours)
    shown = float(values.std(ddof=1)) if len(values) > 1 else float("nan")
    early = _not_asked(figure, ours, shown)
    if early is not None:
        return early
    if len(feasible(ours)) < len(ours):
        return Verdict(shown, NOT_COMPARABLE, _without_path(ours))
    cut = _cut_off(figure, ours)
    if cut:
        return Verdict(shown, NOT_COMPARABLE, f"{cut}: the spread is not seen")
    scale = _scale(figure, ours)
    paper = Sample(0.0, figure.value / _paper_scale(figure), figure.runs or RUNS)
    compared = compare_spreads(sample_of(values / scale), paper)
    if compared.word == NOT_COMPARABLE:
        return Verdict(shown, NOT_COMPARABLE, f"{len(values)} runs are too few for a spread")
    if compared.high == 0.0:
        return Verdict(shown, compared.word, "ours have no spread at all")
    return Verdict(
        shown, compared.word, f"{compared.low:.2g} to {compared.high:.2g} times the paper's"
    )


def _single(figure: Reported, ours: pd.DataFrame) -> Verdict:
    """Whether one run of the paper could be one of ours."""
    values = _values(figure, ours)
    shown = float(np.median(values)) if len(values) else float("nan")
    early = _not_asked(figure, ours, shown)
    if early is not None:
        return early
    if _is_calibrated(figure) and figure.value == best_reported(figure.scene):
        return Verdict(shown, NOT_COMPARABLE, "our median; the scene is drawn to this cost")
    mine = _beyond(figure, values, _scale(figure, ours))
    papers = float(_beyond(figure, figure.value, _paper_scale(figure)))
    low, high = float(mine.min()), float(mine.max())
    why = f"our median; {_range(figure, papers, low, high, len(values))}"
    lost = len(ours) - len(feasible(ours))
    if lost:
        why += f"; {_without_path(ours)}"
    if lost > len(ours) / 2:
        # The paper's run found one.
        return Verdict(shown, DIFFERS, why)
    cut = _cut_off(figure, ours)
    if cut and not low > papers:
        return Verdict(shown, NOT_COMPARABLE, f"{why}; {cut}")
    if _is_within(papers, low, high):
        if high > 2.0 * papers:
            # Almost any figure would lie in it.
            return Verdict(shown, NOT_COMPARABLE, f"too wide to tell: {why}")
        return Verdict(shown, AGREES, why)
    return Verdict(shown, _by_sign(figure, is_less=high < papers), why)


def _is_within(value: float, low: float, high: float) -> bool:
    return low - ROUNDING <= value <= high + ROUNDING


def _range(figure: Reported, papers: float, low: float, high: float, runs: int) -> str:
    """Where one value of the paper lies beside the range of ours, in the unit of the comparison."""
    if figure.quantity == "cost":
        percent, least, most = (fixed(100.0 * value) for value in (papers, low, high))
        return f"excess {percent} %, of our {runs} runs {least} to {most} %"
    return f"our {runs} runs: {low:.4g} to {high:.4g}"


def _best(figure: Reported, ours: pd.DataFrame) -> Verdict:
    """Whether the best of the paper's runs could be the best of ours."""
    values = _values(figure, ours)
    if len(values) < 2:
        return Verdict(float("nan"), NOT_COMPARABLE, _without_path(ours))
    shown = float(values.min())
    # The best of them, whatever became of the others: a run without a path is no better.
    low, high = best_of(sample_of(_beyond(figure, values, _scale(figure, ours))))
    papers = float(_beyond(figure, figure.value, _paper_scale(figure)))
    why = f"our best; {_range(figure, papers, low, high, len(values))}, if normal"
    if _is_within(papers, low, high):
        return Verdict(shown, AGREES, why)
    return Verdict(shown, _by_sign(figure, is_less=high < papers), why)


_STATISTICS: Mapping[str, Callable[[Reported, pd.DataFrame], Verdict]] = {
    "mean": _mean,
    "sd": _sd,
    "single": _single,
    "best": _best,
}


def _values(figure: Reported, ours: pd.DataFrame) -> Array:
    """The quantity of each of our runs that found a path and has it."""
    columns = {
        "cost": "cost",
        "time_s": clock_columns(ours)[0],
        "generations": generations_column(ours),
    }
    return feasible(ours)[columns[figure.quantity]].dropna().to_numpy(dtype=np.float64)


def _not_asked(figure: Reported, ours: pd.DataFrame, shown: float) -> Verdict | None:
    """The verdict where no test is needed; None where one is."""
    if figure.quantity == "time_s":
        return Verdict(shown, NOT_COMPARABLE, OTHER_MACHINE)
    if len(feasible(ours)) == 0:
        word = WORSE if figure.quantity == "cost" and not _is_calibrated(figure) else DIFFERS
        return Verdict(shown, word, f"none of our {len(ours)} runs found a path")
    if np.isnan(shown):
        return Verdict(shown, NOT_COMPARABLE, f"ours have no {figure.quantity}, {figure.statistic}")
    if figure.quantity == "cost" and np.isnan(_scale(figure, ours)):
        return Verdict(shown, NOT_COMPARABLE, "there is no optimum to compare with")
    return None


def _over_fewer(figure: Reported, ours: pd.DataFrame, shown: float) -> Verdict:
    """Of a mean over the runs that found a path, where some did not."""
    found, runs = len(feasible(ours)), len(ours)
    why = _without_path(ours)
    if figure.planner == KBGA and shares_differ((found, runs), (RUNS, RUNS)):
        return Verdict(shown, DIFFERS, f"{why}; the paper's mean has no room for that")
    if figure.quantity != "cost":
        return Verdict(shown, NOT_COMPARABLE, f"{why}; over the others")
    claimed = ours["claimed_cost"].dropna().to_numpy(dtype=np.float64)
    scale = _scale(figure, ours)
    samples = [
        sample_of(_beyond(figure, each, scale))
        for each in (_values(figure, ours), claimed)
        if len(each)
    ]
    readings = [_word(figure, compare_means(s, _paper_sample(figure, s))) for s in samples]
    everyone = sample_of(claimed) if len(claimed) else Sample(np.nan, np.nan, 0)
    why += f"; over all, penalties included: {everyone.mean:.2f} +- {everyone.sd:.2f}"
    same = len(readings) == 2 and len(set(readings)) == 1 and figure.planner != KBGA
    return Verdict(shown, readings[0] if same else NOT_COMPARABLE, why)


def _without_path(ours: pd.DataFrame) -> str:
    return f"{len(ours) - len(feasible(ours))} of {len(ours)} runs found no path"


def _cut_off(figure: Reported, ours: pd.DataFrame) -> str:
    """How many runs their limit cut off before their own end; empty if none, or if it is no matter.

    The generations that these would have needed are not known.
    """
    if figure.quantity != "generations":
        return ""
    count = int(cut_off(feasible(ours)).sum())
    return f"{count} of {len(feasible(ours))} cut off by the limit" if count else ""


def _is_calibrated(figure: Reported) -> bool:
    """Whether the scene is drawn to this cost."""
    return figure.quantity == "cost" and figure.planner == KBGA


def _scale(figure: Reported, ours: pd.DataFrame) -> float:
    """What ours are divided by: costs are compared in optima."""
    # Start and goal in one place can't be compared with, either.
    return (float(ours["optimum"].max()) or np.nan) if figure.quantity == "cost" else 1.0


def _paper_scale(figure: Reported) -> float:
    return (best_reported(figure.scene) or np.nan) if figure.quantity == "cost" else 1.0


def _beyond(figure: Reported, value: Any, scale: float) -> Any:
    """Values as they are compared: costs by their excess over the best."""
    return value / scale - 1.0 if figure.quantity == "cost" else value


def _paper_sample(figure: Reported, ours: Sample) -> Sample:
    """The paper's runs; ours lend their spread where it tells none."""
    scale = _paper_scale(figure)
    spread = spread_of(figure)
    sd = ours.sd if spread is None else spread / scale
    return Sample(float(_beyond(figure, figure.value, scale)), sd, figure.runs or RUNS)


def _word(figure: Reported, compared: Compared) -> str:
    if compared.word != DIFFERS:
        return compared.word
    return _by_sign(figure, is_less=compared.high < 0.0)


def _by_sign(figure: Reported, *, is_less: bool) -> str:
    """The word for a difference: less is better only where the drawing of a scene is no matter."""
    if figure.quantity != "cost" or _is_calibrated(figure):
        return DIFFERS
    return BETTER if is_less else WORSE


def _apart(figure: Reported, ours: Sample, paper: Sample, compared: Compared) -> str:
    """How far two means are apart, in the unit in which they are compared."""
    lent = "" if spread_of(figure) is not None else "; no SD stated: ours for both"
    if np.isnan(compared.low):
        return "one run has no spread"
    if figure.quantity == "cost":
        mine, papers, low, high = (
            fixed(100.0 * value) for value in (ours.mean, paper.mean, compared.low, compared.high)
        )
        apart = f"excess {mine} %, paper's {papers} %, apart by {low} to {high}"
    else:
        apart = f"apart by {compared.low:.1f} to {compared.high:.1f}"
    few = "too wide to tell: " if compared.word == NOT_COMPARABLE else ""
    return f"{few}{apart}{lent}"


def _success(figure: Reported, ours: pd.DataFrame) -> Verdict:
    """The paper says that there never was a path."""
    found, runs = len(feasible(ours)), len(ours)
    share = found / runs
    why = f"{found} of {runs} runs find a path"
    if found == round(figure.value * runs):
        return Verdict(share, AGREES, why)
    if shares_differ((found, runs), (round(figure.value * RUNS), RUNS)):
        return Verdict(share, BETTER if share > figure.value else WORSE, why)
    return Verdict(share, NOT_COMPARABLE, f"{why}: not never, nor told from none of {RUNS}")


def _initial(figure: Reported, ours: pd.DataFrame, first: pd.DataFrame) -> Verdict:
    """Best cost of the first population, penalties included: it bounds the constant C."""
    keys = [key for key in ours["key"] if key in first.index]
    if not keys or "best" not in first:
        return NOTHING
    best = first.loc[keys, "best"].astype("float64")
    constants = {values.get("penalty") for values in settings_of(ours)} - {None}
    ours_is = f", C = {constants.pop():g}" if len(constants) == 1 else ""
    low, high = float(best.min()), float(best.max())
    word = AGREES if low <= figure.value <= high else DIFFERS
    why = f"our median{ours_is}; our {len(best)} runs: {low:.4g} to {high:.4g}"
    return Verdict(float(best.median()), word, why)


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
        return Verdict(ours, SETTING, "set so")
    why = "the best by the paper's own rule in our study" if figure.planner == PLAIN_GA else ""
    return Verdict(ours, SETTING, why or "set otherwise")


def _reaction(figure: Reported, rows: Rows) -> Verdict:
    if rows.replans.empty:
        return NOTHING
    asked = rows.driven.loc[rows.driven["variant"] == KBGA, ["key", "scene", "world_settings"]]
    news = reactions(asked[asked["scene"] == UNKNOWN].merge(rows.replans, on="key"))
    if news.empty:
        return NOTHING
    change = news["number"].min() if "obstacle A" in figure.note else news["number"].max()
    ours = float(news.loc[news["number"] == change, "latency_s"].median())
    return Verdict(ours, NOT_COMPARABLE, "our median; another machine")


def _as_row(figure: Reported, given: Verdict, plus: float) -> dict[str, Any]:
    unit = f" ({figure.unit})" if figure.unit else ""
    statistic = "" if figure.statistic == "setting" else f", {figure.statistic}"
    return {
        "paper's place": figure.source,
        "scene": figure.scene or "",
        "planner": figure.planner,
        "figure": f"{_WORDS.get(figure.quantity, figure.quantity)}{statistic}{unit}",
        "paper": figure.value,
        "ours": given.ours,
        f"ours, {KBGA_PLUS}": plus,
        "verdict": given.word,
        "why": given.why,
    }


_WORDS = {"time_s": "time needed", "reaction_s": "reaction", "generations": "generations needed"}
