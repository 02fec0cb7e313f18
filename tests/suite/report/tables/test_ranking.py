import numpy as np
import pytest

from suite.planner import PlanStatus
from suite.report.figures.ranks import not_told
from suite.report.tables.ranking import ranking_tables, rankings, scene_scores
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
    means = ranking.frame[["planner", "rank by gap", "rank by time"]].to_dict("list")
    assert means == {
        "planner": ["a", "b", "c"], "rank by gap": [1.0, 2.0, 3.0], "rank by time": [2.0, 1.0, 3.0],
    }  # fmt: skip
    # Four scenes with the same order: the largest chi-square that there is, N (k - 1).
    assert "Friedman's chi-square 8.00 with 2 degrees of freedom, p = 0.018" in ranking.note
    # Demsar (2006), Table 5: 2.343 for three; times sqrt(3 * 4 / (6 * 4)).
    assert f"more than {2.343 * np.sqrt(0.5):.2f} of at most 2 apart" in ranking.note
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


def test_beside_the_ranks_stands_who_is_told_from_one_planner_by_either_test():
    table = ranking_tables(steps(*many()), "a")[0]
    frame = table.frame.set_index("planner")
    assert np.isnan(frame.loc["a", ["by gap, Nemenyi p", "by gap, Wilcoxon-Holm p"]]).all()
    # Two ranks apart are more than the critical difference of 1.66, one is not.
    assert frame.loc["b", "by gap, Nemenyi p"] > 0.05 > frame.loc["c", "by gap, Nemenyi p"]
    # Four scenes: two of 16 signs, and three pairs.
    assert frame.loc["c", "by gap, Wilcoxon-Holm p"] == pytest.approx(3 * 2 / 16)
    assert "From a Nemenyi tells c, and not the other, and Wilcoxon-Holm tells none" in (table.note)


def test_the_note_says_for_how_much_so_few_scenes_speak():
    note = ranking_tables(steps(*many()))[0].note
    assert (
        "Wilcoxon's test can tell none of 3 pairs apart over 4 scenes: its smallest p is 0.12"
        in (note)
    )
    scenes = [f"scene{i}" for i in range(8)]
    records = [measured(p, 0, r, scene=s) for s in scenes
               for p, r in (("a", BEST), ("b", GOOD), ("c", BAD))]  # fmt: skip
    enough = ranking_tables(steps(*records))[0].note
    assert "can tell none" not in enough
    assert "From a Nemenyi tells c, and not the other, and Wilcoxon-Holm tells all 2" in enough


def test_planners_that_never_find_a_path_are_equal_and_worse_than_any_that_does():
    scenes = [f"scene{i}" for i in range(6)]
    pairs = (("a", GOOD), ("b", []), ("c", []))
    records = [measured(p, 0, r, scene=s) for s in scenes for p, r in pairs]
    by_gap, by_time = rankings(scene_scores(steps(*records)))
    for ranking in (by_gap, by_time):
        assert ranking.wilcoxon("b", "c") == 1.0
        assert ranking.wilcoxon("a", "b") == pytest.approx(3 * 2 / 64)


def test_groups_that_no_test_tells_apart_are_joined_and_others_are_not():
    apart = {frozenset("ad"), frozenset("bd")}
    groups = not_told("abcd", lambda one, other: 0.01 if frozenset((one, other)) in apart else 1.0)
    assert groups == [(0, 2), (2, 3)]
    assert not_told("abc", lambda *_: 0.01) == []
