"""Two stores of the same matrix, before and after a change: what got better, what got worse.

Each measure of each scene and planner is one question; a verdict needs a difference that Mann and
Whitney's test, corrected by Holm for the number of questions of that measure, finds at 5 %. Runs
that failed count as the worst.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.report.newest import newest
from suite.report.statistics import LEVEL, REPETITIONS, holm, mann_whitney
from suite.report.summary import SUCCESSES
from suite.report.table import Table

PLACE = ["scene", "query", "world", "variant"]

BOOTSTRAP_SEED = 2026

BETTER, WORSE, SAME = "better", "worse", "same"

NOTE = (
    "change: of the mean over the runs that have the measure, new over old, with its 95 % interval "
    "of a bootstrap over both. p: Mann-Whitney over all runs, failures as the worst, corrected by "
    "Holm within each measure. A verdict needs p below 0.05."
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
    worse, better : numbers of the verdicts that count.
    """

    table: Table
    worse: int
    better: int

    def summary(self) -> str:
        """One line."""
        return f"{self.better} better, {self.worse} worse, of {len(self.table.frame)} comparisons."


def compare_versions(
    old: pd.DataFrame, new: pd.DataFrame, rng: np.random.Generator, *, with_times: bool = False
) -> Changes:
    """Compare the runs of two stores, scene by scene and planner by planner.

    Parameters
    ----------
    old, new : DataFrame
        As :func:`suite.store.read_runs` gives them. What only one of them has is counted in the
        note.
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
    rows = [row for measure in MEASURES for row in _rows(measure, common, before, after, rng)]
    frame = pd.DataFrame(rows, columns=list(_EMPTY) if not rows else None)
    counted = frame if with_times else frame[~frame["measure"].isin(_TIMES)]
    note = NOTE + _left_out(before, after, common)
    if not with_times:
        same = set(old["host"]) == set(new["host"])
        note += TIME_NOTE.format(where="one host" if same else "different hosts")
    return Changes(
        Table("versions", "What changed", frame, note),
        int((counted["verdict"] == WORSE).sum()),
        int((counted["verdict"] == BETTER).sum()),
    )


_TIMES = [measure.name for measure in MEASURES if measure.is_time]
_EMPTY = (
    "scene", "planner", "measure", "old", "new", "change (%)", "low (%)", "high (%)", "p",
    "verdict",
)  # fmt: skip


def _groups(runs: pd.DataFrame) -> Iterator[tuple[tuple[str, ...], pd.DataFrame]]:
    for place, group in newest(runs).groupby(PLACE, sort=False, dropna=False):
        yield tuple(part if isinstance(part, str) else "" for part in place), group


def _rows(
    measure: Measure,
    places: list[tuple[str, ...]],
    before: dict[tuple[str, ...], pd.DataFrame],
    after: dict[tuple[str, ...], pd.DataFrame],
    rng: np.random.Generator,
) -> list[dict[str, Any]]:
    pairs = [(_scores(before[place], measure), _scores(after[place], measure)) for place in places]
    known = [i for i, pair in enumerate(pairs) if all(len(scores) for scores in pair)]
    p_values = holm(np.array([mann_whitney(*pairs[i]) for i in known])) if known else np.array([])
    return [
        {**_names(places[i]), "measure": measure.name}
        | _change(*pairs[i], rng)
        | {"p": p, "verdict": _verdict(*pairs[i], p)}
        for i, p in zip(known, p_values.tolist(), strict=True)
    ]


def _scores(runs: pd.DataFrame, measure: Measure) -> NDArray[np.float64]:
    """The measure of each run; infinite for one that failed, missing for one that has none."""
    values = measure.factor * runs[measure.column].astype("float64")
    if measure.column == "cost":
        # The right answer that there is no path has no cost, and there is none better.
        values = values.mask(runs["status"].isin(SUCCESSES) & values.isna(), 0.0)
    good = runs["status"].isin(SUCCESSES)
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
        return SAME
    wins = (new[:, None] < old).mean() - (new[:, None] > old).mean()
    return BETTER if wins > 0 else WORSE


def _names(place: tuple[str, ...]) -> dict[str, str]:
    scene, _, world, variant = place
    return {"scene": f"{scene}, {world}" if world else scene, "planner": variant}


def _left_out(before: Any, after: Any, common: list[tuple[str, ...]]) -> str:
    missing = [
        f"{len(place) - len(common)} scenes and planners are in the {which} store only"
        for which, place in (("old", before), ("new", after))
        if len(place) > len(common)
    ]
    return f" Left out: {' and '.join(missing)}." if missing else ""
