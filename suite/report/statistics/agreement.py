"""Whether a figure of ours agrees with one of the paper's, judged by the spreads of both.

Agreement has to be shown, just as a difference has. That no difference was found is not enough: of
few runs, or of widely spread ones, none ever is. So a figure agrees only if the interval of the
difference holds nought and is narrower than the figure itself, which ours would else be told
neither from none at all nor from twice as much. A planner without any excess can't agree so.

References
----------
Welch (1947), The generalization of Student's problem when several different population variances
are involved. Schuirmann (1987), two one-sided tests of equivalence. Fisher's exact test.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

from suite.report.statistics.inference import LEVEL, Array

AGREES, DIFFERS, NOT_COMPARABLE = "agrees", "differs", "not comparable"

RATIO_AT_MOST = 3.0
"""Standard deviations that agree are shown to be within this factor of each other. With 20 runs on
either side the interval of their ratio always is, once it holds 1."""

ROUNDING = 1e-9
"""Relative: figures that differ by less are equal."""


@dataclass(frozen=True, slots=True)
class Sample:
    """What is known of the runs behind a figure.

    mean, sd : float; sd is nan if there is but one run.
    runs : int
    """

    mean: float
    sd: float
    runs: int


@dataclass(frozen=True, slots=True)
class Compared:
    """What two figures say about each other.

    word : AGREES, DIFFERS, or NOT_COMPARABLE where there are too few runs to show either.
    low, high : ends of the 95 % interval of ours less the paper's, or of their ratio.
    """

    word: str
    low: float
    high: float


def sample_of(values: Array) -> Sample:
    """The sample of these values; there is one at least."""
    mean = float(values.mean())
    sd = float(values.std(ddof=1)) if len(values) > 1 else float("nan")
    # Equal values have a deviation of this order at most, which says nothing.
    return Sample(mean, 0.0 if sd <= ROUNDING * max(abs(values).max(), 1.0) else sd, len(values))


def compare_means(ours: Sample, paper: Sample, level: float = LEVEL) -> Compared:
    """Compare two means by Welch's interval of their difference.

    Parameters
    ----------
    ours, paper : Sample
        The mean of the paper's is its distance from the value that says nothing: an excess of 0.
    level : float

    Returns
    -------
    Compared

    Examples
    --------
    >>> paper = Sample(1.70, 1.00, 20)
    >>> [compare_means(Sample(mean, 0.8, 20), paper).word for mean in (0.4, 1.5)]
    ['differs', 'agrees']
    >>> compare_means(Sample(0.0, 0.0, 20), Sample(0.3, 1.2, 20)).word
    'not comparable'
    """
    return _compared(ours.mean - paper.mean, paper.mean, [ours, paper], level)


def compare_contrasts(
    ours: tuple[Sample, Sample], paper: tuple[Sample, Sample], level: float = LEVEL
) -> Compared:
    """Compare a difference of two means of ours with one of the paper's.

    Parameters
    ----------
    ours, paper : (Sample, Sample)
        The contrast is the second less the first.
    level : float

    Returns
    -------
    Compared
        It agrees only if ours is told from none, too.

    Examples
    --------
    >>> paper = Sample(156.0, 1.0, 20), Sample(250.0, 24.0, 20)
    >>> small, large, none = (Sample(mean, 20.0, 20) for mean in (190.0, 245.0, 150.0))
    >>> [compare_contrasts((Sample(156.0, 1.0, 20), o), paper).word for o in (small, large, none)]
    ['differs', 'agrees', 'differs']
    """
    contrasts = [second.mean - first.mean for first, second in (ours, paper)]
    compared = _compared(contrasts[0] - contrasts[1], contrasts[1], [*ours, *paper], level)
    low, high = interval_of(*ours, level=level)
    if compared.word == AGREES and low <= 0.0 <= high:
        return Compared(NOT_COMPARABLE, compared.low, compared.high)
    return compared


def interval_of(first: Sample, second: Sample, level: float = LEVEL) -> tuple[float, float]:
    """Welch's interval of the second mean less the first.

    Returns
    -------
    low, high : float; nan where one run has no spread.
    """
    half = _half_width([first, second], level)
    return second.mean - first.mean - half, second.mean - first.mean + half


def _compared(
    difference: float, size: float, samples: Sequence[Sample], level: float = LEVEL
) -> Compared:
    """The word for a difference between two figures, the paper's being of some size."""
    half = _half_width(samples, level)
    if np.isnan(half):
        return Compared(NOT_COMPARABLE, half, half)
    slack = ROUNDING * max(abs(sample.mean) for sample in samples)
    low, high = difference - half, difference + half
    if low > slack or high < -slack:
        return Compared(DIFFERS, low, high)
    return Compared(AGREES if max(-low, high) < abs(size) else NOT_COMPARABLE, low, high)


def _half_width(samples: Sequence[Sample], level: float) -> float:
    """Half the interval of a sum or difference of means, with Satterthwaite's degrees of freedom.

    nan where one of them is of a single run.
    """
    parts = [sample.sd**2 / sample.runs for sample in samples]
    if np.isnan(sum(parts)):
        return float("nan")
    if sum(parts) == 0.0:
        return 0.0
    freedom = sum(parts) ** 2 / sum(
        part**2 / (sample.runs - 1) for part, sample in zip(parts, samples, strict=True)
    )
    return float(stats.t.ppf((1.0 + level) / 2.0, freedom) * np.sqrt(sum(parts)))


def compare_spreads(ours: Sample, paper: Sample, level: float = LEVEL) -> Compared:
    """Compare two standard deviations by the F interval of their ratio, ours over the paper's.

    Parameters
    ----------
    ours, paper : Sample
    level : float

    Returns
    -------
    Compared

    Examples
    --------
    >>> paper = Sample(0.0, 2.0, 20)
    >>> [compare_spreads(Sample(0.0, sd, 20), paper).word for sd in (0.0, 2.5, 6.0)]
    ['differs', 'agrees', 'differs']
    """
    if np.isnan(ours.sd):
        return Compared(NOT_COMPARABLE, float("nan"), float("nan"))
    ends = stats.f.interval(level, ours.runs - 1, paper.runs - 1)
    high, low = (float(ours.sd / paper.sd / np.sqrt(end)) for end in ends)
    if not low <= 1.0 <= high:
        return Compared(DIFFERS, low, high)
    near = low >= 1.0 / RATIO_AT_MOST and high <= RATIO_AT_MOST
    return Compared(AGREES if near else NOT_COMPARABLE, low, high)


def shares_differ(ours: tuple[int, int], other: tuple[int, int], level: float = LEVEL) -> bool:
    """Whether two shares are told apart by Fisher's exact test.

    Parameters
    ----------
    ours, other : (int, int)
        So many, of so many runs.
    level : float

    Examples
    --------
    >>> shares_differ((16, 20), (20, 20)), shares_differ((14, 20), (20, 20))
    (False, True)
    """
    table = np.array([[some, runs - some] for some, runs in (ours, other)])
    return bool(stats.fisher_exact(table).pvalue < 1.0 - level)


def best_of(sample: Sample, level: float = LEVEL) -> tuple[float, float]:
    """Between which values the best of as many runs lies, if runs spread normally.

    Parameters
    ----------
    sample : Sample
        Of two runs at least.
    level : float

    Returns
    -------
    low, high : float

    Examples
    --------
    >>> low, high = best_of(Sample(100.0, 10.0, 20))
    >>> f"{low:.1f} to {high:.1f}"
    '69.8 to 90.4'
    """
    # The best of n is below x with probability 1 - (1 - F(x)) ** n.
    tails = np.array([1.0 - level, 1.0 + level]) / 2.0
    low, high = stats.norm.isf((1.0 - tails) ** (1.0 / sample.runs)) * sample.sd + sample.mean
    return float(low), float(high)
