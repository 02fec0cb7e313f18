import numpy as np
import pytest

from suite.planner import PlanStatus
from suite.report.ranking import ranking_tables, rankings, scene_scores
from tests.suite.report.measured_rows import measured, steps

BEST, GOOD, BAD = [(5.0, 100.0)], [(1.0, 100.8)], [(1.0, 130.0)]


def ranks(*records):
    found = rankings(scene_scores(steps(*records)))
    return [ranking.ranks.to_dict("index") for ranking in found]


def test_a_success_is_worth_more_than_any_gap():
    half = [measured("half", 0, BEST), measured("half", 1, [])]
    full = [measured("full", 0, BAD), measured("full", 1, BAD)]
    by_gap, _ = ranks(*half, *full)
    assert by_gap == {"zigzag": {"half": 2.0, "full": 1.0}}


def test_among_equals_the_median_gap_decides_and_the_time_is_another_ranking():
    by_gap, by_time = ranks(measured("best", 0, BEST), measured("good", 0, GOOD))
    assert by_gap == {"zigzag": {"best": 1.0, "good": 2.0}}
    assert by_time == {"zigzag": {"best": 2.0, "good": 1.0}}


def test_ties_have_the_mean_of_their_ranks():
    records = [measured(name, 0, reports) for name, reports in
               (("a", GOOD), ("b", BAD), ("c", BAD), ("d", []), ("e", []), ("f", []))]  # fmt: skip
    by_gap, by_time = ranks(*records)
    assert list(by_gap["zigzag"].values()) == [1.0, 2.5, 2.5, 5.0, 5.0, 5.0]
    # None but a comes within 1 %.
    assert list(by_time["zigzag"].values()) == [1.0, 4.0, 4.0, 4.0, 4.0, 4.0]


def test_scenes_that_not_all_planners_ran_do_not_count():
    records = [measured("a", 0, GOOD), measured("b", 0, BAD), measured("a", 0, GOOD, scene="maze")]
    assert ranks(*records)[0].keys() == {"zigzag"}
    assert ranks(measured("a", 0, GOOD), measured("b", 0, BAD, scene="maze")) == []


def test_where_there_is_no_path_the_proof_of_it_wins_and_there_is_no_time():
    nothing = {"optimum": None, "scene": "closed"}
    proof = measured("exact", 0, [], status=PlanStatus.INFEASIBLE, **nothing)
    gave_up = measured("rrt", 0, [], **nothing)
    (by_gap,) = ranks(proof, gave_up)
    assert by_gap == {"closed": {"exact": 1.0, "rrt": 2.0}}


def many():
    scenes = ("zigzag", "maze", "double_u", "clustered")
    pairs = (("a", BEST), ("b", GOOD), ("c", BAD))
    return [measured(p, seed, r, scene=s) for s in scenes for p, r in pairs for seed in range(2)]


def test_the_table_has_mean_ranks_tests_and_the_ranks_behind_them():
    ranking, detail = ranking_tables(steps(*many()))
    assert ranking.frame.to_dict("list") == {
        "planner": ["a", "b", "c"], "rank by gap": [1.0, 2.0, 3.0], "rank by time": [2.0, 1.0, 3.0],
    }  # fmt: skip
    # Four scenes with the same order: the largest chi-square that there is, N (k - 1).
    assert "Friedman's chi-square 8.00 with 2 degrees of freedom, p = 0.018" in ranking.note
    # Demsar (2006), Table 5: 2.343 for three; times sqrt(3 * 4 / (6 * 4)).
    assert f"more than {2.343 * np.sqrt(0.5):.2f} apart" in ranking.note
    assert len(detail.frame) == 12
    assert detail.frame["rank by gap"].tolist() == [1.0, 2.0, 3.0] * 4


def test_a_scene_without_an_optimum_has_no_rank_by_time_among_the_rows():
    closed = [measured(p, 0, [], scene="closed", optimum=None) for p in "abc"]
    detail = ranking_tables(steps(*many(), *closed))[1].frame.set_index("scene")
    assert detail.loc["closed", "rank by time"].isna().all()
    assert detail.loc["closed", "rank by gap"].tolist() == [2.0, 2.0, 2.0]


def test_one_planner_has_no_rank_and_two_have_no_test():
    assert ranking_tables(steps(measured("a", 0, GOOD))) == []
    table = ranking_tables(steps(measured("a", 0, GOOD), measured("b", 0, BAD)))[0]
    assert table.frame["rank by gap"].tolist() == pytest.approx([1.0, 2.0])
    assert "too few ranks for a test" in table.note
