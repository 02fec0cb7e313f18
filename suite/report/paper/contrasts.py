"""What the paper says of two things side by side: its ablations, and what time depends on.

The claim of an ablation is a contrast, whole against ablated, and so it is tested as one: whether
there is a difference at all, and whether it is of the paper's size. Ratios of times are the only
figures of its machine that another one can answer.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from suite.paper.reported import (
    KBGA,
    PLAIN_GA,
    RUNS,
    WITHOUT_CROSSOVER_AND_MUTATION,
    Reported,
    best_reported,
    find,
    spread_of,
)
from suite.report.paper.tables import kinds_of_sides
from suite.report.rows import feasible
from suite.report.statistics.agreement import (
    AGREES,
    DIFFERS,
    NOT_COMPARABLE,
    Compared,
    Sample,
    compare_contrasts,
    interval_of,
    sample_of,
    shares_differ,
)
from suite.report.statistics.generations import clock_columns, cut_off, generations_column
from suite.report.statistics.inference import Array
from suite.report.table import Table
from suite.report.tables.ablation import CLASSICAL, NOTHING, SPECIALISED, ablated
from suite.report.words import fixed

VARIATION = 2.58 / 7.81
"""Standard deviation over mean of the paper's times on its unstructured scene: section IV states
none for its ratios."""

ABLATIONS = {PLAIN_GA: SPECIALISED, WITHOUT_CROSSOVER_AND_MUTATION: CLASSICAL}
"""Names under which the paper's figures stand, and what is off in our runs that answer them."""

NOTE = (
    "Section IV. paper, ours: the other less the one, or the other's time over the one's, with its "
    "95 % interval (Welch). Costs are in per cent of the best of the scene: of the paper's lowest "
    "cost, and of our optimum. agrees: told from none, of the paper's sign, and its size not told "
    "from the paper's; differs: otherwise; not comparable: neither is shown, or the reason beside "
    "it. Success is tested by Fisher's exact test, the paper's being all of 20 runs against none. "
    "Where some runs found no path, a verdict on cost stands only if it is the same over those "
    "that did and over all, penalties included. Ratios of times: of the processor's time, without "
    "contended runs; of the paper's times only one has a spread (33 %), which is taken for all. "
    "Rows without a verdict are of no planner of the paper."
)


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """Two things that are compared.

    scene, one, other : for the table; the difference is the other's less the one's.
    figures : the paper's two, the whole first.
    runs : DataFrames of ours, likewise.
    """

    scene: str
    one: str
    other: str
    figures: tuple[Reported, Reported]
    runs: tuple[pd.DataFrame, pd.DataFrame]


@dataclass(frozen=True, slots=True)
class Contrast:
    """What came of a contrast.

    paper, ours, low, high : float; nan if there is none.
    word, why : str
    """

    paper: float
    ours: float
    low: float
    high: float
    word: str
    why: str


def contrast_table(runs: pd.DataFrame) -> Table | None:
    """The paper's contrasts that these runs can answer; None if there is none.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    """
    rows = [*_ablations(runs), *_times(runs)]
    if not rows:
        return None
    frame = pd.DataFrame(rows)
    title = "The paper's contrasts, and ours"
    return Table("paper-contrasts", title, frame, NOTE, kinds=kinds_of_sides(frame))


def _ablations(runs: pd.DataFrame) -> Iterator[dict[str, Any]]:
    rows = ablated(runs)
    if rows.empty:
        return
    plain = rows[rows["variant"] == PLAIN_GA]
    for name, off in ABLATIONS.items():
        for _, mine in rows[rows["variant"] != PLAIN_GA].groupby("family", sort=False):
            whole, without = (_one_variant(mine[mine["value"] == v]) for v in (NOTHING, off))
            for there in (without, plain) if off == SPECIALISED else (without,):
                yield from _ablation(name, whole, there)


def _one_variant(runs: pd.DataFrame) -> pd.DataFrame:
    """The runs of one name, the shortest, where the same settings were run under several."""
    names = sorted(set(runs["variant"]), key=len)
    return runs[runs["variant"].isin(names[:1])]


def _ablation(name: str, whole: pd.DataFrame, without: pd.DataFrame) -> Iterator[dict[str, Any]]:
    """The contrasts of one ablation: of cost and of generations, or of success."""
    for scene in dict.fromkeys(f.scene for f in find(planner=name) if f.scene):
        one, other = (side[side["scene"] == scene] for side in (whole, without))
        if one.empty or other.empty:
            continue
        names = (str(one["variant"].iloc[0]), str(other["variant"].iloc[0]))
        planner = str(one["planner"].iloc[0])
        for quantity, test in (("cost", _cost), ("generations", _generations)):
            figures = _pair_of_means(scene, name, quantity)
            if figures:
                pair = Pair(scene, *names, figures, (one, other))
                yield _as_row(pair, _MEASURES[quantity], test(pair), planner)
        never = find(scene=scene, planner=name, quantity="success")
        if never:
            pair = Pair(scene, *names, (never[0], never[0]), (one, other))
            yield _as_row(pair, "success (%)", _success(pair), planner)


_MEASURES = {"cost": "cost over the best (%)", "generations": "generations needed"}


def _pair_of_means(scene: str, name: str, quantity: str) -> tuple[Reported, Reported] | None:
    wanted = {"scene": scene, "quantity": quantity, "statistic": "mean"}
    # Section IV contrasts with the runs of Table 1.
    whole = find(planner=KBGA, source="Table 1", **wanted)
    without = find(planner=name, **wanted)
    return (whole[0], without[0]) if whole and without else None


def _cost(pair: Pair) -> Contrast:
    scale = (float(pair.runs[0]["optimum"].max()) or np.nan) / 100.0
    papers = best_reported(pair.scene) or np.nan
    paper = tuple(_paper_sample(figure, papers / 100.0) for figure in pair.figures)
    found = [_numbers(feasible(runs)["cost"]) / scale for runs in pair.runs]
    lost = "; ".join(
        f"{len(runs) - len(values)} of {len(runs)} runs found no path"
        for runs, values in zip(pair.runs, found, strict=True)
        if len(values) < len(runs)
    )
    outcome = _of_means(found, (paper[0], paper[1]))
    if not lost:
        return outcome
    claimed = [_numbers(runs["claimed_cost"]) / scale for runs in pair.runs]
    over_all = _of_means(claimed, (paper[0], paper[1]))
    word = outcome.word if outcome.word == over_all.word else NOT_COMPARABLE
    why = f"{lost}; over all, penalties included: {over_all.ours:.1f}"
    return Contrast(outcome.paper, outcome.ours, outcome.low, outcome.high, word, why)


def _generations(pair: Pair) -> Contrast:
    columns = [generations_column(runs) for runs in pair.runs]
    found = [feasible(runs) for runs in pair.runs]
    paper = tuple(_paper_sample(figure, 1.0) for figure in pair.figures)
    values = [_numbers(runs[column]) for runs, column in zip(found, columns, strict=True)]
    outcome = _of_means(values, (paper[0], paper[1]))
    cut = [int(cut_off(runs).sum()) for runs in found]
    lost = [len(runs) - len(there) for runs, there in zip(pair.runs, found, strict=True)]
    if not any(cut) and not any(lost):
        return outcome
    reasons = [
        f"{count} of {len(runs)} {words}"
        for counts, words in ((lost, "runs found no path"), (cut, "were cut off by the limit"))
        for count, runs in zip(counts, pair.runs, strict=True)
        if count
    ]
    ends = (outcome.paper, outcome.ours, outcome.low, outcome.high)
    return Contrast(*ends, NOT_COMPARABLE, "; ".join(reasons))


def _of_means(values: list[Array], paper: tuple[Sample, Sample]) -> Contrast:
    contrast = paper[1].mean - paper[0].mean
    if any(len(each) == 0 for each in values):
        nothing = (float("nan"),) * 3
        return Contrast(contrast, *nothing, NOT_COMPARABLE, "one side found no path")
    first, second = (sample_of(each) for each in values)
    # Where the paper tells no spread, ours has to do.
    told = [
        Sample(p.mean, o.sd, p.runs) if np.isnan(p.sd) else p
        for p, o in zip(paper, (first, second), strict=True)
    ]
    compared = compare_contrasts((first, second), (told[0], told[1]))
    low, high = interval_of(first, second)
    ours = second.mean - first.mean
    why = _why(compared, ours, contrast, low, high)
    return Contrast(contrast, ours, low, high, compared.word, why)


def _why(compared: Compared, ours: float, paper: float, low: float, high: float) -> str:
    if np.isnan(low):
        return "one run has no spread"
    if compared.word == NOT_COMPARABLE:
        return "too wide to tell"
    size = f"{fixed(ours / paper)} of the paper's"
    if low <= 0.0 <= high:
        return f"not told from none; {size}"
    return f"same sign; {size}" if ours * paper > 0.0 else "the other sign"


def _success(pair: Pair) -> Contrast:
    """All against none in the paper."""
    one, other = ((len(feasible(runs)), len(runs)) for runs in pair.runs)
    (whole, n), (without, m) = one, other
    ours = 100.0 * (without / m - whole / n)
    why = f"{whole} of {n} against {without} of {m}"
    ends = (float("nan"), float("nan"))
    shown = shares_differ(one, other) and ours < 0.0
    sides = ((one, (RUNS, RUNS)), (other, (0, RUNS)))
    like = not any(shares_differ(mine, papers) for mine, papers in sides)
    if shown and like:
        return Contrast(-100.0, ours, *ends, AGREES, why)
    if shown or not like:
        return Contrast(-100.0, ours, *ends, DIFFERS, why if not shown else f"{why}; less")
    return Contrast(-100.0, ours, *ends, NOT_COMPARABLE, f"{why}: too few runs")


def _times(runs: pd.DataFrame) -> Iterator[dict[str, Any]]:
    """Ratios of times: over resolutions, and over numbers of obstacles."""
    for first, second in _timed():
        sides = tuple(_answering(figure, runs) for figure in (first, second))
        if any(side.empty for side in sides):
            continue
        pair = Pair(
            str(second.scene), _what(first), _what(second), (first, second), (sides[0], sides[1])
        )
        yield _as_row(pair, "time needed, ratio", _ratio(pair), KBGA)


def _timed() -> Iterator[tuple[Reported, Reported]]:
    means = find(planner=KBGA, quantity="time_s", statistic="mean")
    means = [figure for figure in means if figure.source.startswith("section IV")]
    resolutions = [figure for figure in means if figure.setting]
    obstacles = [figure for figure in means if not figure.setting]
    for series in (resolutions, obstacles):
        for figure in series[1:]:
            yield series[0], figure


def _what(figure: Reported) -> str:
    if figure.setting:
        return f"resolution {figure.setting['resolution']:g}"
    return str(figure.scene).replace("obstacles_", "") + " obstacles"


def _answering(figure: Reported, runs: pd.DataFrame) -> pd.DataFrame:
    names = [KBGA]
    if figure.setting:
        names = [f"{KBGA}-resolution-{figure.setting['resolution']:g}"]
    return runs[(runs["scene"] == figure.scene) & runs["variant"].isin(names)]


def _ratio(pair: Pair) -> Contrast:
    paper = pair.figures[1].value / pair.figures[0].value
    quiet = [feasible(runs[runs["contended"] != True]) for runs in pair.runs]  # noqa: E712
    nothing = (float("nan"),) * 3
    if any(len(runs) < 2 for runs in quiet):
        return Contrast(paper, *nothing, NOT_COMPARABLE, "too few runs that were not contended")
    first, second = (_log_sample(_numbers(runs[clock_columns(runs)[1]])) for runs in quiet)
    told = tuple(Sample(float(np.log(f.value)), VARIATION, f.runs or RUNS) for f in pair.figures)
    compared = compare_contrasts((first, second), (told[0], told[1]))
    low, high = interval_of(first, second)
    ours = second.mean - first.mean
    why = _why(compared, ours, float(np.log(paper)), low, high)
    why = why.replace("of the paper's", "of the paper's, as logarithms")
    ours, low, high = (float(np.exp(value)) for value in (ours, low, high))
    return Contrast(paper, ours, low, high, compared.word, why)


def _log_sample(times: Array) -> Sample:
    """The logarithm of a mean; its deviation is the relative one of the times (delta method)."""
    sample = sample_of(times)
    return Sample(float(np.log(sample.mean)), sample.sd / sample.mean, sample.runs)


def _paper_sample(figure: Reported, scale: float) -> Sample:
    spread = spread_of(figure)
    sd = float("nan") if spread is None else spread / scale
    return Sample(figure.value / scale, sd, figure.runs or RUNS)


def _numbers(column: "pd.Series[Any]") -> Array:
    return column.dropna().to_numpy(dtype=np.float64)


def _as_row(pair: Pair, measure: str, outcome: Contrast, planner: str) -> dict[str, Any]:
    is_papers = planner == KBGA
    return {
        "scene": pair.scene,
        "one": pair.one,
        "other": pair.other,
        "measure": measure,
        "paper": outcome.paper if is_papers else float("nan"),
        "ours": outcome.ours,
        "ours low": outcome.low,
        "ours high": outcome.high,
        "verdict": outcome.word if is_papers else "",
        "why": outcome.why if is_papers else "",
    }
