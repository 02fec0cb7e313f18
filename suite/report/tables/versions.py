"""Two stores of the same matrix, before and after a change: what got better, what got worse.

Each measure of each scene and planner is one question; a verdict needs a difference that Mann and
Whitney's test, corrected by Holm for the number of questions of that measure, finds at 5 %. A
difference that is not shown is not called none. Runs without a path count as the worst.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.planner import PlanStatus
from suite.report.rows import NAME, is_blocked, newest, with_queries_together
from suite.report.statistics.clock import by_the_clock, dropped_note, fair, untimed_note
from suite.report.statistics.few_runs import too_few
from suite.report.statistics.inference import LEVEL, REPETITIONS, holm, mann_whitney
from suite.report.table import Kind, Table
from suite.report.words import joined

BOOTSTRAP_SEED = 2026

BETTER, WORSE, NOT_SHOWN, SAME = "better", "worse", "not shown", "same"

NOTE = (
    "change: of the mean over the runs that have the measure, new over old, with its 95 % interval "
    "of a bootstrap over both. p: Mann-Whitney over all runs, those without a path as the worst, "
    "corrected by Holm within each measure. better, worse: p is below 0.05. not shown: it is not; "
    "there may be a difference or none. same: the very same values on both sides. Of a map, a "
    "scene of many queries, a row is over the runs of all its queries."
)
TIME_NOTE = (
    " Times come from {where}: their verdicts do not count for the exit code, unless asked for."
)


class Measure(NamedTuple):
    """What is compared; less is better.

    name : with its unit, for tables.
    column : of the runs.
    factor : from the column's unit to that of the name.
    is_time : whether the machine decides as much as the planner.
    """

    name: str
    column: str
    factor: float = 1.0
    is_time: bool = False


MEASURES = (
    Measure("cost (m)", "cost"),
    Measure("checks", "checks"),
    Measure("time to best (ms)", "time_to_best_s", 1e3, is_time=True),
    Measure("time total (ms)", "wall_s", 1e3, is_time=True),
)


@dataclass(frozen=True, slots=True, eq=False)
class Changes:
    """What came of a comparison.

    table : a row for each scene, planner and measure.
    verdicts : how often each came out, among the comparisons that count.
    too_few : says so where there are too few runs for any difference to be shown.
    """

    table: Table
    verdicts: Mapping[str, int]
    too_few: str = ""

    @property
    def worse(self) -> int:
        """Number of measures that count and are shown to be worse."""
        return self.verdicts.get(WORSE, 0)

    @property
    def better(self) -> int:
        """Number of measures that count and are shown to be better."""
        return self.verdicts.get(BETTER, 0)

    def summary(self) -> str:
        """Counts of the verdicts; where there are too few runs, a second line that says so."""
        words = [BETTER, WORSE, *(w for w in (NOT_SHOWN, SAME) if w in self.verdicts)]
        counts = ", ".join(f"{self.verdicts.get(word, 0)} {word}" for word in words)
        counted = sum(self.verdicts.values())
        rest = len(self.table.frame) - counted
        times = f"; {rest} of times are not counted" if rest else ""
        return "\n".join(
            filter(None, [f"{counts}, of {counted} comparisons{times}.", self.too_few])
        )


def compare_versions(
    old: pd.DataFrame, new: pd.DataFrame, rng: np.random.Generator, *, with_times: bool = False
) -> Changes:
    """Compare the runs of two stores, scene by scene and planner by planner.

    Parameters
    ----------
    old, new : DataFrame
        As :func:`suite.store.read.read_runs` gives them. What only one of them has is counted in
        the note.
    rng : Generator
        Of the bootstrap.
    with_times : bool
        Whether verdicts on times count.

    Returns
    -------
    Changes
    """
    before, after = (dict(_groups(runs)) for runs in (old, new))
    common = [place for place in before if place in after]
    scores = {measure: _scored(measure, common, before, after) for measure in MEASURES}
    rows = [row for measure, pairs in scores.items() for row in _rows(measure, pairs, rng)]
    frame = pd.DataFrame(rows, columns=list(_EMPTY) if not rows else None)
    counted = frame if with_times else frame[~frame["measure"].isin(_TIMES)]
    note = joined(NOTE + _left_out(before, after, common), *_busy("old", old), *_busy("new", new))
    if not with_times:
        same = set(old["host"]) == set(new["host"])
        note += TIME_NOTE.format(where="one host" if same else "different hosts")
    counts = {str(word): int(n) for word, n in counted["verdict"].value_counts().items()}
    table = Table("versions", "What changed", frame, note, kinds={"p": Kind.P_VALUE})
    return Changes(table, counts, _too_few(scores))


_TIMES = [measure.name for measure in MEASURES if measure.is_time]
_EMPTY = (
    "scene", "planner", "measure", "old", "new", "change (%)", "low (%)", "high (%)", "p",
    "verdict",
)  # fmt: skip


def _groups(runs: pd.DataFrame) -> Iterator[tuple[tuple[str, ...], pd.DataFrame]]:
    current = newest(runs)
    asked = with_queries_together(fair(current[~is_blocked(current)]))
    for place, group in asked.groupby(NAME, sort=False, dropna=False):
        yield tuple(part if isinstance(part, str) else "" for part in place), group


Places = list[tuple[str, ...]]
Pairs = dict[tuple[str, ...], tuple[NDArray[np.float64], NDArray[np.float64]]]
"""Scores of before and after, by the scene and planner that they are of."""


def _scored(
    measure: Measure,
    places: Places,
    before: dict[tuple[str, ...], pd.DataFrame],
    after: dict[tuple[str, ...], pd.DataFrame],
) -> Pairs:
    """The scores of one measure, where both stores have some."""
    pairs = {
        place: (_scores(before[place], measure), _scores(after[place], measure)) for place in places
    }
    return {place: pair for place, pair in pairs.items() if all(map(len, pair))}


def _rows(measure: Measure, pairs: Pairs, rng: np.random.Generator) -> list[dict[str, Any]]:
    p_values = holm(np.array([mann_whitney(*pair) for pair in pairs.values()]))
    return [
        {**_names(place), "measure": measure.name}
        | _change(*pair, rng)
        | {"p": p, "verdict": _verdict(*pair, p)}
        for (place, pair), p in zip(pairs.items(), p_values.tolist(), strict=True)
    ]


def _too_few(scores: Mapping[Measure, Pairs]) -> str:
    """Where no difference can be shown; with the names of the measures, if not in any of them."""
    told: dict[str, list[str]] = {}
    for measure, pairs in scores.items():
        sentence = too_few([(len(one), len(other)) for one, other in pairs.values()])
        if pairs:
            told.setdefault(sentence, []).append(measure.name)
    return " ".join(
        sentence if len(told) == 1 else f"{', '.join(names)}: {sentence}"
        for sentence, names in told.items()
        if sentence
    )


def _scores(runs: pd.DataFrame, measure: Measure) -> NDArray[np.float64]:
    """The measure of each run; infinite for one without a path, missing for one that has none."""
    if measure.is_time:
        runs = runs[by_the_clock(runs)]
    values = measure.factor * runs[measure.column].astype("float64")
    if measure.column == "cost":
        # The right answer that there is no path has no cost, and there is none better.
        values = values.mask(runs["status"].isin(PlanStatus.SUCCESSES) & values.isna(), 0.0)
    good = runs["status"].isin(PlanStatus.SUCCESSES)
    if not measure.is_time or measure.column == "time_to_best_s":
        values = values.mask(~good, np.inf)
    return np.asarray(values.dropna(), dtype=np.float64)


def _change(
    old: NDArray[np.float64], new: NDArray[np.float64], rng: np.random.Generator
) -> dict[str, float]:
    one, other = old[np.isfinite(old)], new[np.isfinite(new)]
    row = {"old": _mean(one), "new": _mean(other)}
    bounds = [np.nan, np.nan]
    change = 100.0 * (row["new"] / row["old"] - 1.0) if row["old"] else np.nan
    if len(one) > 1 and len(other) > 1 and row["old"]:
        means = [_resampled_means(scores, rng) for scores in (one, other)]
        ratios = 100.0 * (means[1] / means[0] - 1.0)
        tail = 50.0 * (1.0 - LEVEL)
        bounds = np.percentile(ratios, [tail, 100.0 - tail]).tolist()
    return {**row, "change (%)": change, "low (%)": bounds[0], "high (%)": bounds[1]}


def _mean(values: NDArray[np.float64]) -> float:
    return float(values.mean()) if len(values) else float("nan")


def _resampled_means(scores: NDArray[np.float64], rng: np.random.Generator) -> Any:
    return scores[rng.integers(len(scores), size=(REPETITIONS, len(scores)))].mean(axis=1)


def _verdict(old: NDArray[np.float64], new: NDArray[np.float64], p: float) -> str:
    if p >= 1.0 - LEVEL:
        return SAME if np.array_equal(np.sort(old), np.sort(new)) else NOT_SHOWN
    wins = (new[:, None] < old).mean() - (new[:, None] > old).mean()
    return BETTER if wins > 0 else WORSE


def _names(place: tuple[str, ...]) -> dict[str, str]:
    scene, _, world, variant = place
    return {"scene": f"{scene}, {world}" if world else scene, "planner": variant}


def _busy(which: str, runs: pd.DataFrame) -> Iterator[str]:
    """What the load of a machine took out of a store's rows: it must not look like a change."""
    current = newest(runs)
    for sentence in (dropped_note(current), untimed_note(fair(current))):
        if sentence:
            yield f"In the {which} store: {sentence[0].lower()}{sentence[1:]}"


def _left_out(before: Any, after: Any, common: Places) -> str:
    missing = [
        f"{len(place) - len(common)} scenes and planners are in the {which} store only"
        for which, place in (("old", before), ("new", after))
        if len(place) > len(common)
    ]
    return f" Left out: {' and '.join(missing)}." if missing else ""
