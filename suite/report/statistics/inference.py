"""Statistics of scores that are better the lower they are: pure functions over runs x tasks arrays.

A task is a scene. A run without a path scores infinity, the worst there is; where a task has fewer
runs than another, the column is filled up with nan. Randomness comes in as a Generator, so the
same scores and the same seed give the same interval.

References
----------
Agarwal, Schwarzer, Castro, Courville and Bellemare (2021), Deep reinforcement learning at the edge
of the statistical precipice: interquartile mean, stratified bootstrap, probability of improvement.
Holm (1979), A simple sequentially rejective multiple test procedure. Wilcoxon (1945), Individual
comparisons by ranking methods. Demsar (2006), Statistical
comparisons of classifiers over multiple data sets: Friedman's and Nemenyi's tests.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from math import comb
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import stats

Array = NDArray[np.float64]

REPETITIONS = 1000
"""Resamples of a bootstrap."""

LEVEL = 0.95
"""Of an interval, and 1 less the level of a test."""

AT_ONCE = 1_000_000
"""Numbers that are drawn at once: bounds the memory, whatever the number of runs."""

CONSTANT = 0
"""In the place of a number of runs: they all came out the same, and are a constant."""

SIGNS_AT_MOST = 100
"""Differences whose signs are all counted: the time grows with the third power of their number."""

ORDERS_AT_MOST = 4000
"""Of two samples with ties: fewer are all counted, as the normal distribution is too kind there."""


@dataclass(frozen=True, slots=True)
class Interval:
    """An estimate between the ends of its interval.

    estimate, low, high : float; nan for the ends where a task has a single run.
    """

    estimate: float
    low: float
    high: float


def interquartile_mean(scores: Array) -> Array:
    """Mean of the middle half of the scores, along the last axis.

    It is infinite if more than a quarter of the runs have no path: then no number says how good the
    others were and how many there were.

    Parameters
    ----------
    scores : (..., n) float64

    Returns
    -------
    (...) float64

    Examples
    --------
    >>> float(interquartile_mean(np.array([1.0, 3.0, 5.0, np.inf])))
    4.0
    """
    return np.asarray(stats.trim_mean(scores, 0.25, axis=-1))


def bootstrap(
    scores: Array,
    statistic: Callable[[Array], Array],
    rng: np.random.Generator,
    *,
    repetitions: int = REPETITIONS,
    level: float = LEVEL,
) -> Interval:
    """Estimate a statistic of all runs, with its percentile interval of a stratified bootstrap.

    Runs are resampled within each task: the tasks are given, the runs are a sample.

    Parameters
    ----------
    scores : (runs, tasks) float64
        nan where there is no run.
    statistic : callable
        From (..., n) float64 to (...) float64.
    rng : numpy.random.Generator
    repetitions : int
    level : float, between 0 and 1

    Returns
    -------
    Interval
    """
    strata = _strata(scores)
    pooled = np.concatenate(strata)
    estimate = float(statistic(pooled))
    if min(map(len, strata)) < 2:
        return Interval(estimate, np.nan, np.nan)
    sizes = np.concatenate([np.full(len(stratum), len(stratum)) for stratum in strata])
    starts = np.concatenate(
        [
            np.full(len(stratum), start)
            for stratum, start in zip(strata, _starts(strata), strict=True)
        ]
    )
    estimates = [
        # Faster than integers below many bounds, and as even to 1 part in 10 ** 12.
        statistic(pooled[starts + (sizes * rng.random((count, len(pooled)))).astype(np.int64)])
        for count in _portions(repetitions, len(pooled))
    ]
    return _between(estimate, np.concatenate(estimates), level)


def probability_better(a: Array, b: Array) -> float:
    """Probability that a run of A scores lower than one of B; a tie counts half.

    It is Mann and Whitney's U over the number of pairs, averaged over the tasks.

    Parameters
    ----------
    a, b : (runs, tasks) float64
        nan where there is no run; the same tasks.

    Returns
    -------
    float, 0 to 1

    Examples
    --------
    >>> probability_better(np.array([[1.0], [3.0]]), np.array([[2.0], [3.0]]))
    0.625
    """
    tasks = [
        _share_of_wins(np.bincount(i, minlength=n)[None], np.bincount(j, minlength=n)[None])
        for i, j, n in _coded(a, b)
    ]
    return float(np.mean(tasks))


def probability_interval(
    a: Array,
    b: Array,
    rng: np.random.Generator,
    *,
    repetitions: int = REPETITIONS,
    level: float = LEVEL,
) -> Interval:
    """The probability that A is better than B, with its interval of a stratified bootstrap.

    Parameters
    ----------
    a, b : (runs, tasks) float64
        nan where there is no run; the same tasks.
    rng : numpy.random.Generator
    repetitions : int
    level : float, between 0 and 1

    Returns
    -------
    Interval
    """
    estimate = probability_better(a, b)
    if min(map(len, [*_strata(a), *_strata(b)])) < 2:
        return Interval(estimate, np.nan, np.nan)
    tasks = [
        np.concatenate(
            [
                _share_of_wins(_resampled(i, n, rng, count), _resampled(j, n, rng, count))
                for count in _portions(repetitions, len(i) + len(j))
            ]
        )
        for i, j, n in _coded(a, b)
    ]
    return _between(estimate, np.mean(tasks, axis=0), level)


def mann_whitney(a: Array, b: Array) -> float:
    """Two-sided p-value that the scores of A and of B are from one distribution.

    Parameters
    ----------
    a : (m,) float64
    b : (n,) float64

    Returns
    -------
    float
        1 if all scores are equal. Exact for small samples.
    """
    distinct = len(np.unique(np.concatenate([a, b])))
    if distinct == 1:
        return 1.0
    method = _counted_or_approximated(len(a), len(b)) if distinct < len(a) + len(b) else "auto"
    return float(stats.mannwhitneyu(a, b, alternative="two-sided", method=method).pvalue)


def _counted_or_approximated(m: int, n: int) -> Literal["auto", "exact"] | stats.PermutationMethod:
    """How to find the p-value where scores tie: scipy itself counts orders only where none do."""
    if min(m, n) == 1:
        return "exact"
    if comb(m + n, m) <= ORDERS_AT_MOST:
        return stats.PermutationMethod(n_resamples=ORDERS_AT_MOST)
    return "auto"


def sign_test(scores: Array, constant: float) -> float:
    """Two-sided p-value that scores lie as often below a constant as above it.

    For a planner that is compared with one that gives the same result each time, which is one
    score and no sample.

    Parameters
    ----------
    scores : (n,) float64
    constant : float

    Returns
    -------
    float
        1 if all are equal to the constant, which say nothing. Exact.

    Examples
    --------
    >>> round(sign_test(np.array([2.0, 3.0, 4.0, np.inf, 1.0]), 1.0), 4)
    0.125
    """
    below, above = int((scores < constant).sum()), int((scores > constant).sum())
    if below + above == 0:
        return 1.0
    return float(stats.binomtest(below, below + above).pvalue)


def signed_rank(differences: Array) -> float:
    """Two-sided p-value of Wilcoxon's signed-rank test that differences are symmetric about 0.

    Parameters
    ----------
    differences : (n,) float64
        Of pairs. Those of 0 are left out, after Wilcoxon; infinite ones are the largest.

    Returns
    -------
    float
        1 if none is left. Exact, ties or not: all signs are counted. Of more than
        :data:`SIGNS_AT_MOST` it is the normal distribution's, with the variance that the ties have.

    Examples
    --------
    >>> signed_rank(np.array([1.0, 2.0, 3.0, 3.0, 5.0])), signed_rank(np.array([1.0, -1.0]))
    (0.0625, 1.0)
    """
    there = differences[differences != 0.0]
    if len(there) == 0:
        return 1.0
    # Twice a rank is a whole number, also where ranks tie.
    ranks = np.rint(2.0 * stats.rankdata(np.abs(there))).astype(np.int64)
    if len(there) > SIGNS_AT_MOST:
        return _normal_signed_rank(ranks.astype(np.float64), there > 0.0)
    ways = np.ones(1)
    for rank in ranks:
        ways = np.append(ways, np.zeros(rank)) + np.append(np.zeros(rank), ways)
    positive = int(ranks[there > 0.0].sum())
    low = min(positive, int(ranks.sum()) - positive)
    return float(min(1.0, 2.0 * ways[: low + 1].sum() / ways.sum()))


def _normal_signed_rank(ranks: Array, is_positive: NDArray[np.bool_]) -> float:
    """The same of many differences: their signed ranks have nearly a normal sum."""
    # Each sign is a fair coin: the variance of the sum of the positive ranks is exact.
    off = abs(float(ranks[is_positive].sum() - 0.5 * ranks.sum()))
    deviation = 0.5 * float(np.sqrt((ranks**2).sum()))
    # Doubled ranks are whole: sums are one apart, and half of that is the correction.
    return float(min(1.0, 2.0 * stats.norm.sf(max(off - 0.5, 0.0) / deviation)))


@cache
def smallest_p(m: int, n: int) -> float:
    """The smallest p-value for so many scores: all of A below all of B.

    Parameters
    ----------
    m, n : int
        Of :func:`mann_whitney`; where one of them is :data:`CONSTANT`, of :func:`sign_test`.

    Returns
    -------
    float

    Examples
    --------
    >>> round(smallest_p(5, 5), 4), round(smallest_p(2, 2), 4)
    (0.0079, 0.3333)
    """
    if CONSTANT in (m, n):
        return sign_test(np.ones(max(m, n)), 0.0)
    return mann_whitney(np.zeros(m), np.ones(n))


def holm(p_values: Array) -> Array:
    """P-values corrected for their number, after Holm (1979).

    Parameters
    ----------
    p_values : (n,) float64

    Returns
    -------
    (n,) float64
        In the same order, at most 1.

    Examples
    --------
    >>> holm(np.array([0.01, 0.04, 0.03, 0.005])).round(3).tolist()
    [0.03, 0.06, 0.06, 0.02]
    """
    order = np.argsort(p_values, kind="stable")
    factors = np.arange(len(p_values), 0, -1)
    corrected = np.empty(len(p_values))
    # None is below a smaller one's: the procedure stops at the first that it does not reject.
    corrected[order] = np.minimum(np.maximum.accumulate(factors * p_values[order]), 1.0)
    return corrected


def friedman(ranks: Array) -> tuple[float, float]:
    """Friedman's chi-square, corrected for ties, and its p-value.

    Parameters
    ----------
    ranks : (tasks, planners) float64

    Returns
    -------
    tuple of float
        nan with fewer than three planners or two tasks, or if all are tied in all tasks.
    """
    tasks, planners = ranks.shape
    if planners < 3 or tasks < 2 or (ranks == ranks[:, :1]).all():
        return np.nan, np.nan
    found = stats.friedmanchisquare(*ranks.T)
    return float(found.statistic), float(found.pvalue)


@cache
def nemenyi(difference: float, planners: int, tasks: int) -> float:
    """P-value of Nemenyi's test for a difference of two mean ranks.

    Parameters
    ----------
    difference : float
    planners, tasks : int

    Returns
    -------
    float
    """
    scale = np.sqrt(planners * (planners + 1) / (6.0 * tasks))
    quantile = abs(difference) / scale * np.sqrt(2.0)
    return float(stats.studentized_range.sf(quantile, planners, np.inf))


def critical_difference(planners: int, tasks: int, level: float = LEVEL) -> float:
    """How far apart mean ranks must be for two planners to differ, by Nemenyi's test.

    Parameters
    ----------
    planners, tasks : int
    level : float
        1 less the probability that any two that are equal seem to differ.

    Returns
    -------
    float
    """
    # Demsar (2006), section 3.2.2: Studentised range for infinite degrees of freedom, over sqrt(2).
    quantile = float(stats.studentized_range.ppf(level, planners, np.inf)) / np.sqrt(2.0)
    return float(quantile * np.sqrt(planners * (planners + 1) / (6.0 * tasks)))


def _strata(scores: Array) -> list[Array]:
    return [column[~np.isnan(column)] for column in scores.T]


def _starts(strata: list[Array]) -> NDArray[np.int64]:
    return np.cumsum([0, *map(len, strata[:-1])])


def _portions(repetitions: int, size: int) -> Iterator[int]:
    """Numbers of repetitions that are done at once."""
    portion = max(1, AT_ONCE // size)
    while repetitions > 0:
        yield min(portion, repetitions)
        repetitions -= portion


def _coded(a: Array, b: Array) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64], int]]:
    """For each task, the places of the scores of A and of B among its distinct scores."""
    for mine, other in zip(_strata(a), _strata(b), strict=True):
        distinct, codes = np.unique(np.concatenate([mine, other]), return_inverse=True)
        yield codes[: len(mine)], codes[len(mine) :], len(distinct)


def _resampled(
    codes: NDArray[np.int64], distinct: int, rng: np.random.Generator, count: int
) -> NDArray[np.int64]:
    """(count, distinct) int64: how often each score is in each resample."""
    drawn = codes[rng.integers(len(codes), size=(count, len(codes)))]
    drawn += distinct * np.arange(count)[:, None]
    return np.bincount(drawn.ravel(), minlength=count * distinct).reshape(count, distinct)


def _share_of_wins(a: NDArray[np.int64], b: NDArray[np.int64]) -> Array:
    """Share of pairs in which A scores lower, ties half, of counts of the distinct scores."""
    below = np.cumsum(a, axis=1) - 0.5 * a
    return np.asarray((below * b).sum(axis=1) / (a.sum(axis=1) * b.sum(axis=1)))


def _between(estimate: float, estimates: Array, level: float) -> Interval:
    # Not interpolated: half way between a number and infinity is no estimate.
    ends = np.quantile(estimates, [(1 - level) / 2, (1 + level) / 2], method="inverted_cdf")
    return Interval(estimate, float(ends[0]), float(ends[1]))
