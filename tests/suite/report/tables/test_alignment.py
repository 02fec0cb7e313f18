import pytest

from suite.report.all_tables import all_tables
from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.tables.alignment import alignment, alignment_tables, without_repeats
from tests.suite.report.study_rows import run, runs_of


def runs_on(scene, *costs, planner="kbga"):
    """A run for each cost (optimum 100 m); None for one without a path."""
    return [
        run(planner, {}, cost, scene=scene, planner=planner, seed=seed)
        for seed, cost in enumerate(costs)
    ]


def verdict(drawn, moved):
    frame = alignment(runs_of(*runs_on("maze", *drawn), *runs_on("maze@twin=1", *moved)))
    return frame["verdict"].item()


def test_the_gaps_as_drawn_moved_and_aligned_stand_in_one_row():
    frame = alignment(
        runs_of(
            *runs_on("maze", 102.0, 104.0),
            *runs_on("maze@twin=1", 101.0, 103.0),
            *runs_on("maze@twin=2", 106.0),
            *runs_on("maze_aligned", 100.0),
        )
    )
    row = frame.to_dict("records")[0]
    assert (row["scene"], row["planner"]) == ("maze", "kbga")
    numbers = {
        "as drawn (%)": 3.0,
        "moved (%)": 10.0 / 3.0,
        "worst (%)": 6.0,
        "difference (%)": 1.0 / 3.0,
        "allowed (%)": 0.7,
        "aligned (%)": 0.0,
    }
    assert {name: row[name] for name in numbers} == pytest.approx(numbers)
    assert (row["with path as drawn"], row["with path moved"]) == ("2 of 2", "3 of 3")
    assert row["verdict"] == "holds"


def test_it_holds_up_to_a_tenth_of_a_point_and_a_fifth_of_the_gap_on_either_side():
    assert verdict([102.0], [102.49]) == "holds"
    assert verdict([102.0], [102.51]) == "differs: gap"
    assert verdict([102.0], [101.51]) == "holds"
    assert verdict([102.0], [101.49]) == "differs: gap"
    assert verdict([100.0], [100.09]) == "holds"
    assert verdict([100.0], [100.11]) == "differs: gap"


def test_paths_that_are_found_less_often_are_a_difference_whatever_their_gap():
    assert verdict([102.0] * 10, [102.0] * 3 + [None] * 7) == "differs: runs with a path"
    assert verdict([102.0] * 10, [102.0] * 9 + [None]) == "holds"


def test_without_a_path_there_is_nothing_to_compare():
    assert verdict([None] * 10, [None] * 10) == "not comparable: no path"
    assert verdict([102.0], [None]) == "not comparable: no path"


def test_a_control_has_a_verdict_of_its_own_below_the_scenes_and_is_not_counted():
    runs = runs_of(
        *runs_on("maze_aligned", 100.0),
        *runs_on("maze_aligned@twin=1", 102.0),
        *runs_on("maze", 102.0),
        *runs_on("maze@twin=1", 102.0),
    )
    assert alignment(runs)[["scene", "verdict"]].to_numpy().tolist() == [
        ["maze", "holds"],
        ["maze_aligned", "differs: gap"],
    ]
    (table,) = alignment_tables(runs)
    assert table.note.endswith("it holds on 1 of 1 for kbga.")
    assert "maze_aligned" in render(table, TableFormat.MARKDOWN)


def test_each_planner_is_compared_with_itself():
    frame = alignment(
        runs_of(
            *runs_on("maze", 100.0),
            *runs_on("maze@twin=1", 102.0),
            *runs_on("maze", 103.0, planner="ompl-rrtstar"),
            *runs_on("maze@twin=1", 103.0, planner="ompl-rrtstar"),
        )
    )
    assert dict(zip(frame["planner"], frame["verdict"], strict=True)) == {
        "kbga": "differs: gap",
        "ompl-rrtstar": "holds",
    }


@pytest.mark.parametrize("scenes", [[], ["maze"], ["maze@twin=1"], ["maze", "zigzag@twin=1"]])
def test_there_is_no_such_table_without_a_scene_as_drawn_and_moved(scenes):
    assert alignment_tables(runs_of(*(r for scene in scenes for r in runs_on(scene, 101.0)))) == []


def test_other_tables_do_not_count_the_same_problem_twice():
    runs = runs_of(
        *runs_on("maze", 102.0),
        *runs_on("maze@twin=1", 102.0),
        *runs_on("maze_aligned", 100.0),
        *runs_on("maze_aligned@twin=1", 100.0),
        *runs_on("zigzag@twin=1", 102.0),
        *runs_on("double_u_aligned", 100.0),
    )
    left = ["maze", "zigzag@twin=1", "double_u_aligned"]
    assert without_repeats(runs)["scene"].tolist() == left
    tables = {table.name: table.frame for table in all_tables(runs)}
    assert set(tables["summary"]["scene"]) == set(left)
    assert tables["alignment"]["scene"].tolist() == ["maze", "maze_aligned"]


def test_a_radius_makes_another_problem_and_a_twin_of_it_is_the_same():
    names = ["zigzag", "zigzag@radius=0.2", "zigzag@radius=0.2,twin=1"]
    runs = runs_of(*[run("kbga", {}, 101.0, scene=name) for name in names])
    assert list(without_repeats(runs)["scene"]) == names[:2]
    assert list(alignment(runs)["scene"]) == ["zigzag@radius=0.2"]
