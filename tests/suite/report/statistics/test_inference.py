"""Held to published worked examples, to scipy, and to what must hold of any scores."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import stats

from suite.report.statistics import inference
from suite.report.statistics.inference import (
    bootstrap,
    critical_difference,
    friedman,
    holm,
    interquartile_mean,
    mann_whitney,
    nemenyi,
    probability_better,
    probability_interval,
    sign_test,
    signed_rank,
    smallest_p,
)

# Aesop's races, the textbook example of Mann and Whitney's test: places of 6 tortoises and 6 hares.
TORTOISES = np.array([[1.0, 7, 8, 9, 10, 11]]).T
HARES = np.array([[2.0, 3, 4, 5, 6, 12]]).T

# Demsar (2006), Table 6: ranks of four classifiers on 14 data sets.
DEMSAR = np.array(
    [
        [4, 3, 2, 1], [1, 2, 3, 4], [4, 1, 2, 3], [4, 1, 3, 2], [4, 2, 3, 1], [1, 2.5, 4, 2.5],
        [3, 2, 4, 1], [2.5, 2.5, 4, 1], [4, 3, 2, 1], [2.5, 2.5, 2.5, 2.5], [4, 2.5, 1, 2.5],
        [3, 2, 4, 1], [4, 1, 2, 3], [3, 1, 4, 2],
    ]
)  # fmt: skip

# Small integers make ties, and some runs fail.
SCORES = st.sampled_from([0.0, 1.0, 2.0, 3.0, np.inf])


def scores(runs=4, tasks=3):
    return arrays(np.float64, (runs, tasks), elements=SCORES)


def test_the_interquartile_mean_of_the_encyclopedias_example():
    # Wikipedia, "Interquartile mean": the quartiles of twelve numbers are cut off.
    numbers = np.array([5.0, 8, 4, 38, 8, 6, 9, 7, 7, 3, 1, 6])
    assert interquartile_mean(numbers) == 6.5


def test_an_interquartile_mean_outlives_a_quarter_of_failures_and_no_more():
    assert interquartile_mean(np.array([1.0, 2.0, 3.0, np.inf])) == 2.5
    assert np.isinf(interquartile_mean(np.array([1.0, 2.0, np.inf, np.inf])))


def test_tortoises_are_worse_than_hares_as_in_the_textbook():
    # U is 11 for the tortoises and 25 for the hares, of 36 races of one against one.
    assert probability_better(TORTOISES, HARES) == pytest.approx(11 / 36)
    assert probability_better(HARES, TORTOISES) == pytest.approx(25 / 36)


def test_demsars_mean_ranks_test_and_critical_difference():
    assert DEMSAR.mean(axis=0) == pytest.approx([3.143, 2.0, 2.893, 1.964], abs=5e-4)
    statistic, p_value = friedman(DEMSAR)
    # He has 9.28 without the correction for ties: three pairs, and four that are all equal.
    correction = 1.0 - (3 * (2**3 - 2) + (4**3 - 4)) / (14 * 4 * (4**2 - 1))
    assert statistic * correction == pytest.approx(9.28, abs=0.005)
    assert p_value == pytest.approx(stats.chi2.sf(statistic, 3))
    assert critical_difference(4, 14) == pytest.approx(1.25, abs=0.005)
    assert critical_difference(4, 14, level=0.90) == pytest.approx(1.12, abs=0.005)


def test_demsars_critical_values_of_nemenyis_test():
    # Table 5a: for 2 to 10 classifiers, at 5 %.
    published = [1.960, 2.343, 2.569, 2.728, 2.850, 2.949, 3.031, 3.102, 3.164]
    for k, value in enumerate(published, start=2):
        found = critical_difference(k, 10) / np.sqrt(k * (k + 1) / 60)
        assert found == pytest.approx(value, abs=1.1e-3)


def test_holms_procedure_rejects_what_demsar_rejects_with_it():
    # Section 3.2.2: p-values against the control; he rejects the first two, at 5 %.
    assert holm(np.array([0.607, 0.016, 0.019])) == pytest.approx([0.607, 0.048, 0.048])


def test_mann_and_whitneys_p_value_is_scipys_and_1_without_any_difference():
    a, b = HARES[:, 0], TORTOISES[:, 0]
    assert mann_whitney(a, b) == stats.mannwhitneyu(a, b).pvalue
    assert mann_whitney(np.ones(3), np.ones(5)) == 1.0
    assert mann_whitney(np.full(20, np.inf), np.arange(20.0)) < 1e-6


def test_ties_in_small_samples_are_counted_and_not_approximated():
    # Twice the share of the 10 ways to choose 3 of 5 that are as extreme on this side.
    assert mann_whitney(np.zeros(3), np.ones(2)) == pytest.approx(2 / 10)
    assert mann_whitney(np.zeros(1), np.ones(5)) == pytest.approx(2 / 6)
    assert mann_whitney(np.array([0.0, 0.0, 1.0]), np.array([1.0, 1.0])) == pytest.approx(
        2 * 3 / 10
    )


@given(st.lists(st.integers(0, 3), min_size=10, max_size=10))
def test_no_p_value_is_smaller_than_the_smallest(drawn):
    a, b = np.array(drawn[:4], dtype=float), np.array(drawn[4:], dtype=float)
    assert mann_whitney(a, b) >= smallest_p(4, 6) * (1.0 - 1e-12)
    assert smallest_p(4, 6) == pytest.approx(2 / 210)


def test_friedman_says_nothing_of_two_planners_of_one_task_or_of_equals():
    for ranks in (DEMSAR[:, :2], DEMSAR[:1], np.full((5, 3), 2.0)):
        assert np.isnan(friedman(ranks)).all()


@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=12))
def test_holms_correction_keeps_the_order_and_lies_below_bonferronis(p_values):
    p = np.array(p_values)
    corrected = holm(p)
    assert (corrected >= p).all()
    assert (corrected <= np.minimum(len(p) * p, 1.0) * (1 + 1e-12)).all()
    assert (np.diff(corrected[np.argsort(p, kind="stable")]) >= 0.0).all()
    assert corrected.min() == pytest.approx(min(len(p) * p.min(), 1.0))


@given(scores(), scores(runs=5))
def test_either_is_better_or_the_other_is(a, b):
    assert probability_better(a, b) + probability_better(b, a) == pytest.approx(1.0)


@given(scores(tasks=1), scores(runs=5, tasks=1))
def test_the_probability_is_mann_and_whitneys_u_over_the_pairs(a, b):
    # scipy counts the pairs in which the first is greater.
    u = stats.mannwhitneyu(b[:, 0], a[:, 0]).statistic
    assert probability_better(a, b) == pytest.approx(u / 20)


@given(scores())
def test_nobody_is_better_than_oneself(a):
    assert probability_better(a, a) == 0.5


def test_tasks_count_alike_however_many_runs_they_have():
    nan = np.nan
    a = np.array([[1.0, 5.0], [1.0, nan], [1.0, nan]])
    b = np.array([[2.0, 4.0], [2.0, 4.0], [nan, 4.0]])
    assert probability_better(a, b) == 0.5


@given(st.integers(0, 2**32 - 1), st.integers(2, 8), st.integers(1, 4))
def test_the_interval_of_symmetrical_scores_holds_the_estimate(seed, runs, tasks):
    half = np.random.default_rng(seed).normal(size=(runs, tasks))
    symmetrical = np.concatenate([half, -half])
    found = bootstrap(symmetrical, interquartile_mean, np.random.default_rng(seed), repetitions=400)
    assert found.low <= found.estimate <= found.high
    # Symmetrical about 0 in every task, so is the middle half of all.
    assert found.estimate == pytest.approx(0.0, abs=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_the_interval_of_a_probability_holds_the_estimate_and_is_a_probability(seed):
    rng = np.random.default_rng(seed)
    a, b = rng.integers(0, 4, size=(10, 2)).astype(float), rng.integers(1, 5, size=(8, 2)) * 1.0
    found = probability_interval(a, b, rng, repetitions=200)
    assert 0.0 <= found.low <= found.estimate <= found.high <= 1.0


def mean(sample):
    return sample.mean(axis=-1)


def test_the_bootstrap_of_one_task_is_scipys():
    sample = np.random.default_rng(3).exponential(size=40)
    ours = bootstrap(sample[:, None], mean, np.random.default_rng(4), repetitions=20_000)
    theirs = stats.bootstrap(
        (sample,), np.mean, n_resamples=20_000, method="percentile", rng=np.random.default_rng(5)
    ).confidence_interval
    width = theirs.high - theirs.low
    assert (ours.low, ours.high) == pytest.approx((theirs.low, theirs.high), abs=0.03 * width)


def test_runs_are_resampled_within_their_task():
    # Tasks that differ, and runs that do not: nothing is left to chance.
    by_task = np.tile([1.0, 100.0], (10, 1))
    found = bootstrap(by_task, mean, np.random.default_rng(0))
    assert (found.low, found.estimate, found.high) == (50.5, 50.5, 50.5)


def test_an_interval_of_95_percent_holds_the_truth_in_about_95_percent():
    rng = np.random.default_rng(7)
    held = 0
    for _ in range(200):
        found = bootstrap(rng.normal(size=(30, 2)), mean, rng, repetitions=300)
        held += found.low <= 0.0 <= found.high
    assert 178 <= held <= 200


def test_the_same_seed_gives_the_same_interval_and_another_one_another():
    sample = np.random.default_rng(1).normal(size=(12, 3))
    one, again, other = (
        bootstrap(sample, interquartile_mean, np.random.default_rng(seed)) for seed in (5, 5, 6)
    )
    assert one == again
    assert one != other


def test_one_run_of_a_task_has_no_interval():
    lone = np.array([[1.0, 2.0], [1.5, np.nan]])
    assert np.isnan(bootstrap(lone, mean, np.random.default_rng(0)).low)
    assert np.isnan(probability_interval(lone, lone, np.random.default_rng(0)).high)


def test_an_interval_reaches_to_infinity_where_failures_may_be_a_quarter():
    sample = np.array([[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, np.inf, np.inf]]).T
    found = bootstrap(sample, interquartile_mean, np.random.default_rng(0))
    assert np.isfinite([found.low, found.estimate]).all()
    assert np.isinf(found.high)


def test_the_sign_test_counts_signs():
    assert sign_test(np.array([1.0, 2.0, 3.0, 4.0]), 2.5) == 1.0
    assert sign_test(np.array([2.0] * 9), 2.0) == 1.0
    # A tie says nothing.
    one, other = np.arange(1.0, 7.0), np.arange(0.0, 7.0)
    assert sign_test(one, 0.0) == sign_test(other, 0.0) == 2 / 2**6
    assert smallest_p(0, 6) == smallest_p(6, 0) == 2 / 2**6


@pytest.mark.parametrize("count", [5, 8, 20])
def test_wilcoxons_test_without_ties_is_scipys_exact_one(count):
    differences = np.random.default_rng(count).normal(0.3, 1.0, count)
    exact = stats.wilcoxon(differences, method="exact").pvalue
    assert signed_rank(differences) == pytest.approx(exact)


@given(arrays(np.float64, 7, elements=st.sampled_from([-2.0, -1.0, 0.0, 1.0, 2.0, np.inf])))
def test_wilcoxons_test_with_ties_counts_all_signs(differences):
    there = differences[differences != 0.0]
    ranks = stats.rankdata(np.abs(there))
    sums = np.array([np.dot(signs, ranks) for signs in product((0, 1), repeat=len(there))])
    found = ranks[there > 0].sum()
    wanted = 2 * min((sums <= found).mean(), (sums >= found).mean()) if len(there) else 1.0
    assert signed_rank(differences) == pytest.approx(min(1.0, wanted))


def test_demsars_example_of_wilcoxons_test():
    # Demsar (2006), Table 2: C4.5 with and without a tuned parameter m; he has R = 12 and p < 0.05.
    plain = [
        0.763,
        0.599,
        0.954,
        0.628,
        0.882,
        0.936,
        0.661,
        0.583,
        0.775,
        1.0,
        0.94,
        0.619,
        0.972,
        0.957,
    ]
    tuned = [
        0.768,
        0.591,
        0.971,
        0.661,
        0.888,
        0.931,
        0.668,
        0.583,
        0.838,
        1.0,
        0.962,
        0.666,
        0.981,
        0.978,
    ]
    assert signed_rank(np.array(tuned) - np.array(plain)) < 0.05


def test_nemenyis_p_is_5_per_cent_at_the_critical_difference():
    assert nemenyi(critical_difference(4, 14), 4, 14) == pytest.approx(0.05)
    assert nemenyi(0.0, 4, 14) == 1.0


def test_of_many_differences_the_normal_distribution_says_what_all_signs_would(monkeypatch):
    rng = np.random.default_rng(1)
    differences = rng.normal(0.15, 1.0, inference.SIGNS_AT_MOST + 20).round(1)
    quick = signed_rank(differences)
    monkeypatch.setattr(inference, "SIGNS_AT_MOST", len(differences))
    assert quick == pytest.approx(signed_rank(differences), rel=0.02)
    assert 0.001 < quick < 0.5
    assert signed_rank(np.repeat(1.0, 5000)) < 1e-100
