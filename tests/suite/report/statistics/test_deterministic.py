from suite.report.statistics.deterministic import deterministic
from tests.suite.report.measured_rows import measured, steps


def names(*records):
    return deterministic(steps(*records).runs)


def runs(planner, checks, costs, scene="zigzag"):
    return [
        measured(planner, i, [(1.0, cost)] if cost else [], scene=scene, checks=count)
        for i, (count, cost) in enumerate(zip(checks, costs, strict=True))
    ]


def test_runs_that_are_all_alike_but_for_the_time_are_of_a_planner_that_draws_nothing():
    records = [
        measured("exact", i, [(float(i + 1), 100.0)], wall_s=float(i), checks=7) for i in range(3)
    ]
    assert names(*records) == {"exact"}


def test_the_same_cost_by_other_checks_is_chance_that_found_it_again():
    assert names(*runs("lucky", [7, 8, 7], [100.0] * 3)) == frozenset()


def test_one_scene_that_came_out_otherwise_is_enough():
    alike = runs("a", [7, 7], [100.0] * 2)
    assert names(*alike, *runs("a", [7, 9], [100.0] * 2, "maze")) == frozenset()
    assert names(*alike, *runs("a", [9, 9], [100.0] * 2, "maze")) == {"a"}


def test_counts_that_nobody_made_are_alike():
    assert names(*runs("a", [None, None], [100.0, 100.0])) == {"a"}
    assert names(*runs("a", [None, None], [100.0, 101.0])) == frozenset()


def test_one_run_and_runs_that_found_nothing_tell_nothing():
    assert names(*runs("a", [7], [100.0])) == frozenset()
    assert names(*runs("a", [7, 7], [None, None])) == frozenset()
