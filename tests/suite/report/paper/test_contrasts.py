"""The paper's ablations and ratios of times, each of which can come out either way."""

import numpy as np
import pytest

from suite.report.paper.contrasts import contrast_table
from suite.report.statistics.agreement import AGREES, DIFFERS, NOT_COMPARABLE
from tests.suite.report.study_rows import OPTIMUM, run, runs_of
from tests.suite.report.tables.test_ablation import PLAIN_GA, WHOLE

NOISE = np.random.default_rng(0).standard_normal(20)
NOISE = (NOISE - NOISE.mean()) / NOISE.std(ddof=1)
WITHOUT = "kbga-without-crossover-and-mutation"
OFF = {"crossover_probability": 0.0, "mutation_probability": 0.0}


def group(variant, per_cent, spread, *, found=20, settings=WHOLE, **changes):
    """20 runs so far above the optimum, of which so many found a path."""
    costs = OPTIMUM * (1.0 + (per_cent + spread * NOISE) / 100.0)
    return [
        run(variant, settings, float(cost) if i < found else None, seed=i, **changes)
        for i, cost in enumerate(costs)
    ]


def rows(*groups):
    table = contrast_table(runs_of(*(record for each in groups for record in each)))
    return table.frame.set_index(["other", "measure"])


def without(per_cent, **changes):
    return group(WITHOUT, per_cent, 15.0, settings=WHOLE | OFF, **changes)


COST, GENERATIONS = "cost over the best (%)", "generations needed"


@pytest.mark.parametrize(
    ("per_cent", "word", "why"),
    [
        (61.0, AGREES, "same sign; 0.98 of the paper's"),
        (15.0, DIFFERS, "same sign; 0.23 of the paper's"),
        (1.0, DIFFERS, "not told from none; 0.00 of the paper's"),
    ],
)
def test_an_ablation_agrees_in_sign_and_size(per_cent, word, why):
    row = rows(group("kbga", 1.0, 0.5), without(per_cent)).loc[(WITHOUT, COST)]
    # The paper: 251.56 less 156.31, of 155.89.
    assert row["paper"] == pytest.approx(61.10, abs=0.01)
    assert row["ours"] == pytest.approx(per_cent - 1.0)
    assert (row["verdict"], row["why"]) == (word, why)
    assert row["ours low"] < row["ours"] < row["ours high"]


def test_generations_are_a_contrast_too_but_not_where_a_limit_cut_them_off():
    def row(**changes):
        whole = group("kbga", 1.0, 0.5, generation_of_best=50)
        ablated = without(60.0, generation_of_best=60, **changes)
        return rows(whole, ablated).loc[(WITHOUT, GENERATIONS)]

    assert (row()["ours"], row()["verdict"]) == (10.0, DIFFERS)
    cut = row(generations=100)
    assert (cut["verdict"], cut["why"]) == (NOT_COMPARABLE, "20 of 20 were cut off by the limit")


@pytest.mark.parametrize(
    ("with_it", "without_it", "word"),
    [
        ((20, 20), (0, 20), AGREES),
        ((18, 20), (3, 20), AGREES),
        ((20, 20), (10, 20), DIFFERS),
        ((20, 20), (20, 20), DIFFERS),
        ((2, 20), (18, 20), DIFFERS),
    ],
)
def test_feasible_against_never_is_tested_by_the_numbers_of_paths(with_it, without_it, word):
    frame = rows(
        group("kbga", 1.0, 0.5, found=with_it[0], scene="maze"),
        without(60.0, found=without_it[0], scene="maze"),
    )
    assert frame.loc[(WITHOUT, "success (%)"), "verdict"] == word


def plain(per_cent, found, claimed):
    records = group("plain-ga", per_cent, 25.0, found=found, settings=PLAIN_GA, planner="plain-ga")
    return [
        run("plain-ga", PLAIN_GA, None, seed=i, planner="plain-ga", claimed_cost=claimed)
        if record.cost is None
        else record
        for i, record in enumerate(records)
    ]


def test_where_runs_found_no_path_both_readings_of_the_cost_have_to_agree():
    whole = [*group("kbga", 1.0, 0.5), *without(60.0)]
    mixed = rows(whole, plain(127.0, 13, 900.0)).loc[("plain-ga", COST)]
    assert mixed["verdict"] == NOT_COMPARABLE
    assert mixed["why"].startswith("7 of 20 runs found no path; over all, penalties included:")
    same = rows(whole, plain(127.0, 13, 227.0)).loc[("plain-ga", COST)]
    assert same["verdict"] == AGREES


def test_our_own_planner_stands_beside_without_a_verdict():
    plus = [
        *group("kbga-plus", 0.0, 0.1, planner="kbga-plus"),
        *group(
            "kbga-plus-without-crossover-and-mutation", 0.0, 0.1, settings=WHOLE | OFF,
            planner="kbga-plus",
        ),
    ]  # fmt: skip
    frame = rows(group("kbga", 1.0, 0.5), without(61.0), plus)
    ours = frame[frame["one"] == "kbga-plus"]
    assert len(ours) == 2
    assert set(ours["verdict"]) == {""}
    assert ours["paper"].isna().all()
    assert set(frame.loc[frame["one"] == "kbga", "verdict"]) <= {AGREES, DIFFERS, NOT_COMPARABLE}


def times(scene, variant, seconds, **changes):
    return [
        run(variant, {}, 110.0, seed=i, scene=scene, cpu_to_best_s=s, **changes)
        for i, s in enumerate(seconds * (1.0 + 0.3 * NOISE))
    ]


@pytest.mark.parametrize(("ratio", "word"), [(3.4, AGREES), (1.0, DIFFERS), (12.0, DIFFERS)])
def test_ratios_of_times_are_compared_though_times_are_not(ratio, word):
    frame = rows(times("obstacles_20", "kbga", 1.0), times("obstacles_40", "kbga", ratio))
    row = frame.loc[("40 obstacles", "time needed, ratio")]
    assert row["paper"] == pytest.approx(18.96 / 5.53)
    assert row["ours"] == pytest.approx(ratio)
    assert row["verdict"] == word


def test_contended_runs_are_in_no_ratio():
    quiet = [*times("unstructured", "kbga-resolution-100", 1.0)]
    slow = times("unstructured", "kbga-resolution-400", 9.0, contended=True)
    row = rows(quiet, slow).loc[("resolution 400", "time needed, ratio")]
    assert (row["verdict"], row["why"]) == (
        NOT_COMPARABLE, "too few runs that were not contended",
    )  # fmt: skip
    assert np.isnan(row["ours"])


def test_runs_without_such_a_pair_make_no_table():
    assert contrast_table(runs_of(*group("kbga", 1.0, 0.5))) is None
    assert contrast_table(runs_of()) is None
