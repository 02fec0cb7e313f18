"""How good the planners are over all scenes, and how surely they differ.

Everything is computed from the gaps of the runs on the scenes that have an optimum and that all
planners ran. A run without an accepted path has an infinite gap: in ranks and probabilities it is
worse than any path, and an interquartile mean is given only where at most a quarter of all runs
have none; no other number is put in its place.
"""

from collections.abc import Callable, Iterable, Mapping
from collections.abc import Set as AbstractSet
from typing import Any

import numpy as np
import pandas as pd

from suite.errors import KbgaBenchError
from suite.report.statistics.anytime import Steps, final_gaps
from suite.report.statistics.deterministic import deterministic
from suite.report.statistics.few_runs import too_few
from suite.report.statistics.inference import (
    CONSTANT,
    Array,
    Interval,
    bootstrap,
    holm,
    interquartile_mean,
    mann_whitney,
    probability_better,
    probability_interval,
    sign_test,
)
from suite.report.table import Kind, Table
from suite.report.tables.glance import SIDE_BY_SIDE, at_a_glance
from suite.report.words import counted

REFERENCE = "kbga"
"""The planner that the others are compared with, unless another one is asked for; the first one
where it is missing."""

IQM_NOTE = (
    "IQM: mean of the middle half of the gaps of all runs, in which a run without path has an "
    "infinite one; 'none' where more than a quarter have no path."
)
INTERVAL_NOTE = (
    "Low and high: 95 % intervals of a bootstrap that resamples the runs within each scene; empty "
    "where a scene has one run."
)
CONSTANT_NOTE = (
    "Came out the same in every run of a scene, and so count once: {names}. They have no interval "
    "of their own; others are compared with their one result by a sign test of the runs above and "
    "below it."
)
PAIR_NOTE = (
    "P({reference} better): probability that a run of {reference} ends with a smaller gap than a "
    "run of the planner that the row names, on the same scene: 1 where {reference} always does, 0 "
    "where the other one always does, 0.5 where neither is better. A tie counts half; a run "
    "without path is worse than any path"
)


def check_reference(planners: Iterable[str], reference: str | None) -> None:
    """Refuse a reference that is none of the planners.

    Raises
    ------
    KbgaBenchError
        With the names that there are.
    """
    names = list(dict.fromkeys(planners))
    if reference is not None and reference not in names:
        raise KbgaBenchError(
            f"--reference: there is no planner '{reference}' in the store. Take one of: "
            f"{', '.join(names) or 'none, for it is empty'}."
        )


def scores_by_planner(steps: Steps) -> tuple[list[str], dict[str, Array]]:
    """Gaps of each planner as an array of runs x scenes.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    list of str
        The scenes with an optimum that all planners ran.
    dict from str to (runs, scenes) float64
        Infinite where a run has no accepted path, nan where there is no run.
    """
    gaps = steps.runs[["place", "variant"]].assign(gap=final_gaps(steps))[~np.isnan(steps.optimum)]
    ran = gaps.groupby("place", sort=False)["variant"].nunique()
    scenes = list(ran.index[ran == steps.runs["variant"].nunique()])
    shared = gaps[gaps["place"].isin(scenes)]
    return scenes, {
        str(planner): _side_by_side([here.loc[here["place"] == s, "gap"] for s in scenes])
        for planner, here in shared.groupby("variant", sort=False)
    }


def _side_by_side(columns: "list[pd.Series[Any]]") -> Array:
    scores = np.full((max(map(len, columns)), len(columns)), np.nan)
    for j, column in enumerate(columns):
        scores[: len(column), j] = column
    return scores


def planner_statistics(
    scores: Mapping[str, Array],
    rng: np.random.Generator,
    reference: str,
    constant: AbstractSet[str] = frozenset(),
) -> pd.DataFrame:
    """Interquartile mean of the gap and probability that the reference is better, with intervals.

    Parameters
    ----------
    scores : mapping from planner to (runs, scenes) float64
        See :func:`scores_by_planner`.
    rng : numpy.random.Generator
    reference : str
        One of the planners.
    constant : set of str
        Those whose runs of a scene are one; see :mod:`suite.report.statistics.deterministic`.

    Returns
    -------
    DataFrame
        A row for each planner.
    """
    rows = []
    for planner, mine in scores.items():
        # Equal runs drawn again are the same, so the draws below need no other scores.
        counted = mine[:1] if planner in constant else mine
        mean = bootstrap(mine, interquartile_mean, rng)
        row: dict[str, Any] = {
            "planner": planner,
            "runs": int((~np.isnan(counted)).sum()),
            "without path": int(np.isinf(counted).sum()),
            **_named("gap IQM (%)", _in_per_cent(_one(mean) if planner in constant else mean)),
        }
        if planner != reference:
            better = probability_interval(scores[reference], mine, rng)
            both = {planner, reference} <= constant
            row |= _named(_better(reference), _one(better) if both else better)
        rows.append(row)
    return pd.DataFrame(rows)


def scene_statistics(
    scenes: list[str],
    scores: Mapping[str, Array],
    reference: str,
    constant: AbstractSet[str] = frozenset(),
) -> pd.DataFrame:
    """Tests of the reference against each other planner on each scene.

    Mann and Whitney's, or a sign test where one of both came out the same each time.

    Parameters
    ----------
    scenes : list of str
    scores : mapping from planner to (runs, scenes) float64
    reference : str
        One of the planners.
    constant : set of str
        Those of which all runs of a scene are one.

    Returns
    -------
    DataFrame
        A row for each other planner and scene; p-values as they are, and corrected for their
        number, after Holm. nan between two constants, which need no test.
    """
    rows = []
    for planner in [name for name in scores if name != reference]:
        for j, scene in enumerate(scenes):
            mine, other = (scores[name][:, j] for name in (reference, planner))
            better = probability_better(mine[:, None], other[:, None])
            p_value = _p_value(
                mine[~np.isnan(mine)],
                other[~np.isnan(other)],
                (reference in constant, planner in constant),
            )
            rows.append(
                {"scene": scene, "planner": planner, _better(reference): better, "p": p_value}
            )
    frame = pd.DataFrame(rows)
    if not rows:
        return frame
    p_values = frame["p"].to_numpy()
    corrected = np.full(len(frame), np.nan)
    corrected[~np.isnan(p_values)] = holm(p_values[~np.isnan(p_values)])
    return frame.assign(**{"Holm's p": corrected})


def _p_value(mine: Array, other: Array, constant: tuple[bool, bool]) -> float:
    """P-value between two planners on a scene, of which either may be one score and no sample."""
    if all(constant):
        return float("nan")
    if constant[0]:
        return sign_test(other, float(mine[0]))
    if constant[1]:
        return sign_test(mine, float(other[0]))
    return mann_whitney(mine, other)


def _one(interval: Interval) -> Interval:
    """An estimate of what does not vary."""
    return Interval(interval.estimate, np.nan, np.nan)


def reference_of(scores: Mapping[str, Array]) -> str:
    """The planner that the others are compared with, if none is asked for."""
    return REFERENCE if REFERENCE in scores else next(iter(scores))


def _better(reference: str) -> str:
    return f"P({reference} better)"


def statistics_tables(
    steps: Steps, rng: np.random.Generator, reference: str | None = None
) -> list[Table]:
    """Statistics of the planners over all scenes, and tests scene by scene.

    Parameters
    ----------
    steps : Steps
    rng : numpy.random.Generator
    reference : str, optional
        The planner that the others are compared with; default: :data:`REFERENCE`.
    """
    scenes, scores = scores_by_planner(steps)
    if not scenes:
        return []
    where = counted(len(scenes), "scene")
    one = reference or reference_of(scores)
    constant = deterministic(steps.runs)
    overall = planner_statistics(scores, rng, one, constant)
    names = ", ".join(name for name in scores if name in constant)
    told = f" {CONSTANT_NOTE.format(names=names)}" if names else ""
    if len(scores) == 1:
        title = f"Gap over {where}, with 95 % intervals"
        return [Table("statistics", title, overall, f"{IQM_NOTE} {INTERVAL_NOTE}{told}", "none")]
    pair = PAIR_NOTE.format(reference=one)
    title = (
        f"Gap over {where}, and probability that {one} is better than the planner of the row, with "
        "95 % intervals"
    )
    note = f"{IQM_NOTE} {pair}; mean over the scenes. {INTERVAL_NOTE}{told}"
    tests = _scene_tables(scenes, scores, one, pair, constant)
    return [Table("statistics", title, overall, note, "none"), *tests]


def _scene_tables(
    scenes: list[str],
    scores: Mapping[str, Array],
    reference: str,
    pair: str,
    constant: AbstractSet[str],
) -> list[Table]:
    """The tests: at a glance, where there is room, and as rows."""
    tested = scene_statistics(scenes, scores, reference, constant)
    warning = too_few(_sizes(scores, reference, constant))
    tests = (
        "Mann and Whitney's two-sided p-value, after Holm's correction for all "
        f"{int(tested['p'].notna().sum())} comparisons of this table."
    )
    if constant & set(scores):
        tests += " Of planners that came out the same each time, a sign test's."
    rows = Table(
        "statistics-scenes-rows",
        f"Tests of {reference} against the planner of the row, scene by scene",
        tested,
        " ".join(filter(None, [f"{pair}. Holm's p: {tests}", warning])),
        detail=True,
        kinds={"p": Kind.P_VALUE, "Holm's p": Kind.P_VALUE},
    )
    if len(scenes) > SIDE_BY_SIDE:
        return [rows]
    glanced = at_a_glance(tested, ["planner"], _tested(reference, with_p=not warning))
    title = f"Probability that {reference} is better than the planner of the row, scene by scene"
    note = f"{pair}. {warning or f'In brackets: {tests}'}"
    return [Table("statistics-scenes", title, glanced, note), rows]


def _sizes(
    scores: Mapping[str, Array], reference: str, constant: AbstractSet[str]
) -> list[tuple[int, int]]:
    """Numbers of runs of the two sides of each comparison that is tested."""
    runs = {
        name: [CONSTANT] * mine.shape[1] if name in constant else (~np.isnan(mine)).sum(axis=0)
        for name, mine in scores.items()
    }
    return [
        (int(mine), int(other))
        for name in scores
        if name != reference and not {name, reference} <= constant
        for mine, other in zip(runs[reference], runs[name], strict=True)
    ]


def _tested(reference: str, *, with_p: bool) -> Callable[[Mapping[Any, Any]], str]:
    def cell(row: Mapping[Any, Any]) -> str:
        better = f"{row[_better(reference)]:.2f}"
        p_value = row["Holm's p"]
        small = "<0.001" if p_value < 0.001 else f"{p_value:.3f}"
        return f"{better} ({small})" if with_p and not np.isnan(p_value) else better

    return cell


def _named(what: str, interval: Interval) -> dict[str, float]:
    return {what: interval.estimate, f"{what} low": interval.low, f"{what} high": interval.high}


def _in_per_cent(interval: Interval) -> Interval:
    return Interval(100.0 * interval.estimate, 100.0 * interval.low, 100.0 * interval.high)
