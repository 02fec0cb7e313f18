"""Held to scipy, and to how often the words are right over many drawn samples."""

import numpy as np
import pytest
from scipy import stats

from suite.report.statistics.agreement import (
    AGREES,
    DIFFERS,
    NOT_COMPARABLE,
    Sample,
    best_of,
    compare_contrasts,
    compare_means,
    compare_spreads,
    interval_of,
    sample_of,
    shares_differ,
)

PAPER = Sample(1.7, 1.0, 20)


def test_the_interval_is_welchs():
    rng = np.random.default_rng(1)
    one, other = rng.normal(1.0, 2.0, 12), rng.normal(2.0, 0.5, 20)
    wanted = stats.ttest_ind(other, one, equal_var=False).confidence_interval(0.95)
    found = interval_of(sample_of(one), sample_of(other))
    assert found == pytest.approx((wanted.low, wanted.high))
    compared = compare_means(sample_of(other), sample_of(one))
    assert (compared.low, compared.high) == pytest.approx(found)


def words(mean, sd, runs=20, draws=400):
    """How often each word is said of samples from such runs."""
    rng = np.random.default_rng(0)
    said = [
        compare_means(
            sample_of(rng.normal(mean, sd, runs)),
            # The paper's sample is drawn, too.
            sample_of(rng.normal(PAPER.mean, PAPER.sd, PAPER.runs)),
        ).word
        for _ in range(draws)
    ]
    return {word: said.count(word) / draws for word in (AGREES, DIFFERS, NOT_COMPARABLE)}


def test_the_same_runs_agree_but_for_the_level_of_the_test_and_others_differ():
    assert words(1.7, 1.0)[AGREES] == pytest.approx(0.95, abs=0.03)
    assert words(0.0, 0.2)[AGREES] == 0.0
    assert words(0.0, 0.2)[DIFFERS] > 0.99
    assert words(5.0, 1.0)[DIFFERS] > 0.99


def test_few_or_wide_runs_do_not_agree_for_want_of_proof():
    assert words(1.7, 1.0, runs=2)[AGREES] < 0.2
    assert words(1.7, 20.0)[AGREES] < 0.05


@pytest.mark.parametrize("spread", [0.01, 0.3, 1.0, 2.0])
def test_no_excess_at_all_never_agrees_whatever_the_papers_spread(spread):
    none = Sample(0.0, 0.0, 20)
    assert compare_means(none, Sample(0.3, spread, 20)).word != AGREES
    assert compare_spreads(none, Sample(0.3, spread, 20)).word == DIFFERS


def test_equal_values_have_no_spread_and_their_mean_can_be_told_exactly():
    assert sample_of(np.full(20, 155.76678)).sd == 0.0
    same = compare_means(Sample(2.0, 0.0, 20), Sample(2.0, 0.0, 20))
    assert (same.word, same.low, same.high) == (AGREES, 0.0, 0.0)
    assert compare_means(Sample(2.1, 0.0, 20), Sample(2.0, 0.0, 20)).word == DIFFERS


def test_one_run_has_no_spread_and_says_nothing():
    one = sample_of(np.array([1.7]))
    assert np.isnan(one.sd)
    assert compare_means(one, PAPER).word == NOT_COMPARABLE
    assert compare_spreads(one, PAPER).word == NOT_COMPARABLE


def test_a_contrast_that_is_not_told_from_none_does_not_agree():
    paper = Sample(0.0, 1.0, 20), Sample(1.0, 1.0, 20)
    wide = Sample(0.0, 1.3, 20), Sample(0.7, 1.3, 20)
    assert interval_of(*wide)[0] < 0.0
    assert compare_contrasts(wide, paper).word == NOT_COMPARABLE
    other_sign = Sample(0.0, 0.1, 20), Sample(-1.0, 0.1, 20)
    assert compare_contrasts(other_sign, paper).word == DIFFERS


def test_the_best_of_many_normal_runs_lies_where_it_is_said_to():
    low, high = best_of(Sample(100.0, 10.0, 20))
    best = np.random.default_rng(2).normal(100.0, 10.0, (20_000, 20)).min(axis=1)
    assert np.quantile(best, [0.025, 0.975]) == pytest.approx([low, high], abs=0.6)


def test_shares_are_told_apart_by_fishers_test():
    assert not shares_differ((4, 20), (0, 20))
    assert shares_differ((5, 20), (0, 20))
