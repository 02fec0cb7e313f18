import numpy as np
import pytest

from suite.harness.matrix import load_matrix
from suite.harness.single import cell_for
from suite.paper.reported import find
from suite.planner import Budget
from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.tables.studies import (
    FIRST_POPULATION,
    MUTATION_RATE,
    PENALTY,
    RESOLUTION,
    STUDIES,
    TUNING,
    best_value,
    best_values,
    obstacles,
    picked_again,
    study_tables,
    sweep,
)
from tests.suite.report.study_rows import run, runs_of


def plain(rate, cost, **changes):
    settings = {"mutation_probability": rate, "penalty": 100.0}
    return run(f"plain-ga-{rate}", settings, cost, planner="plain-ga", **changes)


def names(runs):
    return [table.name for table in study_tables(runs)]


def resolutions(**changes):
    return [
        run(f"kbga-{n}", {"resolution": n, "rounds": 8}, 110.0, cpu_s=0.01 * n, **changes)
        for n in (100, 200, 400)
    ]


def test_a_study_is_made_of_a_planner_at_several_values_of_a_setting():
    assert names(runs_of(*resolutions())) == ["study-resolution", "study-resolution-rows"]
    assert names(runs_of(plain(0.4, 110.0), plain(0.5, 110.0))) == [
        "study-mutation-rate", "study-mutation-rate-best", "study-mutation-rate-rows",
    ]  # fmt: skip


def test_one_value_is_no_study_nor_are_runs_that_differ_in_more_than_it():
    assert names(runs_of(*resolutions()[:1])) == []
    two = {"resolution": 200, "rounds": 1}
    assert names(runs_of(resolutions()[0], run("other", two, 110.0))) == []
    assert names(runs_of()) == []


def test_the_papers_times_and_ratios_stand_beside_ours_where_it_has_any():
    frame = sweep(runs_of(*resolutions(scene="unstructured"), *resolutions()), RESOLUTION)
    frame = frame.set_index(["scene", "value"])
    here = frame.loc["unstructured"]
    assert here["paper time (s)"].tolist() == [7.81, 9.03, 12.25]
    assert here["paper ratio"].tolist() == pytest.approx([1.0, 1.156, 1.568], abs=1e-3)
    assert here["ratio total"].tolist() == pytest.approx([1.0, 2.0, 4.0])
    assert frame.loc["zigzag"]["paper time (s)"].isna().all()


def test_columns_that_say_nothing_are_left_out():
    (_, table) = study_tables(runs_of(*resolutions()))
    assert not any(column.startswith("paper") for column in table.frame)
    assert "cost with penalties mean" not in table.frame, "all runs are feasible"
    assert table.frame["resolution"].tolist() == [100, 200, 400]
    (*_, table) = study_tables(runs_of(plain(0.4, None), plain(0.5, 110.0)))
    assert table.frame["cost with penalties mean"].tolist() == [1000.0, 110.0]


def test_planners_and_rounds_are_compared_with_their_own_reference():
    records = [
        run(f"{planner}-C{c}", {"penalty": c}, 110.0, planner=planner, cpu_s=c * scale)
        for planner, scale in (("kbga", 1e-4), ("plain-ga", 1e-3))
        for c in (10.0, 100.0)
    ]
    frame = sweep(runs_of(*records), PENALTY)
    assert frame["family"].tolist() == ["kbga", "kbga", "plain-ga", "plain-ga"]
    assert frame["ratio total"].tolist() == pytest.approx([0.1, 1.0, 0.1, 1.0])
    tuned = [
        run(f"{r}-{a}", {"adaptation_rate": a, "rounds": r}, 110.0) for r in (8, 1) for a in (0, 1)
    ]
    assert list(dict.fromkeys(sweep(runs_of(*tuned), TUNING)["family"])) == [
        "kbga, rounds 8", "kbga, rounds 1",
    ]  # fmt: skip


def test_the_share_of_feasible_chromosomes_in_the_first_population_is_of_generation_0():
    runs = runs_of(
        *(
            run(f"informed-{share}", {"informed_share": share}, 110.0, seed=seed)
            for share in (0.0, 1.0)
            for seed in (0, 1)
        )
    )
    first = runs.set_index("key")[[]].assign(feasible_share=[0.0, 0.1, 0.8, 1.0])
    frame = sweep(runs, FIRST_POPULATION, first)
    assert frame["first feasible (%)"].tolist() == pytest.approx([5.0, 90.0])
    assert "first feasible (%)" in study_tables(runs, first)[1].frame
    assert "first feasible (%)" not in study_tables(runs)[1].frame


@pytest.mark.parametrize(
    ("costs", "best"),
    [
        ({0.3: [110, None], 0.5: [300, 300]}, 0.5),
        ({0.3: [110, 120], 0.5: [110, 110]}, 0.5),
        ({0.3: [110, 110], 0.5: [110, 110]}, 0.3),
    ],
)
def test_the_best_rate_has_most_feasible_runs_then_the_lowest_cost(costs, best):
    runs = runs_of(
        *(plain(rate, c, seed=i) for rate, found in costs.items() for i, c in enumerate(found))
    )
    assert best_value(sweep(runs, MUTATION_RATE), "zigzag") == best


def test_the_best_rate_stands_beside_the_papers_where_the_paper_chose_it():
    records = [
        plain(rate, cost, scene=scene)
        for scene in ("zigzag", "maze")
        for rate, cost in ((0.3, 110.0), (0.5, None))
    ]
    frame = best_values(runs_of(*records), MUTATION_RATE).set_index("scene")
    assert frame["best mutation rate"].tolist() == [0.3, 0.3]
    assert frame.loc["zigzag", "paper's best"] == 0.5
    assert frame["paper's best"].isna().tolist() == [False, True]
    assert frame["feasible, best"].tolist() == [1, 1]
    assert frame["feasible, 0.5"].tolist() == [0, 0]


def test_a_best_rate_that_chance_made_is_not_picked_again_each_time():
    def shares(cost_of_other):
        close = {0.3: [110, 130, 120, None], 0.5: cost_of_other}
        runs = runs_of(
            *(plain(rate, c, seed=i) for rate, found in close.items() for i, c in enumerate(found))
        )
        return picked_again(runs, MUTATION_RATE, "zigzag", np.random.default_rng(1))

    level = shares([111, 129, 121, None])
    assert level.sum() == pytest.approx(1.0)
    assert 0.4 < level[0.3] < 0.6
    assert shares([None] * 4)[0.3] == pytest.approx(1.0, abs=0.02)


def test_mutation_rates_are_compared_with_the_one_that_the_paper_found_best():
    (paper,) = find(planner="plain-ga", statistic="setting", quantity="mutation_probability")
    assert paper.value == MUTATION_RATE.reference


@pytest.mark.parametrize("matrix", ["mutation-rate", "resolution", "penalty"])
def test_the_matrix_of_a_study_varies_its_setting_alone_around_the_default(matrix):
    study = next(study for study in STUDIES if study.name == matrix)
    variants = load_matrix(matrix).variants
    assert {variant.budget for variant in variants} == {Budget()}
    for planner in study.planners:
        mine = [dict(variant.settings) for variant in variants if variant.plugin.name == planner]
        default = dict(
            cell_for("zigzag", planner, seed=0, query=None, settings={}, budget=Budget()).settings
        )
        assert default in mine
        values = [settings.pop(study.setting) for settings in mine]
        assert len(set(values)) == len(values) > 1
        assert study.reference in values
        assert all(settings == mine[0] for settings in mine)


def test_the_number_of_obstacles_is_compared_with_20_across_scenes():
    records = [
        run("kbga", {}, 110.0, scene=scene, cpu_s=cpu, checks=checks)
        for scene, cpu, checks in (
            ("obstacles_40", 0.4, 8000),
            ("obstacles_20", 0.1, 4000),
            ("scattered_1000", 1.0, 10_000),
            ("zigzag", 9.0, 1),
        )
    ]
    frame = obstacles(runs_of(*records))
    assert frame["value"].tolist() == [20, 40, 1000]
    assert frame["ratio total"].tolist() == pytest.approx([1.0, 4.0, 10.0])
    assert frame["cpu per check (us)"].tolist() == pytest.approx([25.0, 50.0, 100.0])
    assert frame["paper time (s)"].tolist()[:2] == [5.53, 18.96]
    assert frame["paper ratio"].tolist()[:2] == pytest.approx([1.0, 3.43], abs=2e-3)
    assert frame["paper ratio"].isna().tolist() == [False, False, True]


def test_our_own_planner_is_studied_beside_and_has_no_times_of_the_paper():
    def both(make):
        return [make("kbga"), make("kbga-plus")]

    records = [
        record
        for resolution in (100, 200)
        for record in both(
            lambda name, r=resolution: run(
                f"{name}-resolution-{r}", {"resolution": r}, 110.0, scene="unstructured",
                planner=name,
            )
        )
    ]  # fmt: skip
    frame = sweep(runs_of(*records), RESOLUTION).set_index(["family", "value"])
    assert frame.loc["kbga", "paper time (s)"].tolist() == [7.81, 9.03]
    assert frame.loc["kbga-plus", "paper time (s)"].isna().all()
    counted = runs_of(
        *(
            record
            for n in (20, 30)
            for record in both(
                lambda name, n=n: run(name, {}, 110.0, scene=f"obstacles_{n}", planner=name)
            )
        )
    )
    (table,) = [t for t in study_tables(counted) if t.name == "study-obstacles"]
    assert table.frame["planner"].tolist() == ["kbga"] * 2 + ["kbga-plus"] * 2
    assert table.frame["paper time (s)"].notna().tolist() == [True, True, False, False]
    assert "planner" not in obstacles_table_of("kbga", counted)


def obstacles_table_of(planner, runs):
    (table,) = [t for t in study_tables(runs[runs["variant"] == planner])
                if t.name == "study-obstacles"]  # fmt: skip
    return table.frame


def test_a_single_number_of_obstacles_and_other_planners_make_no_such_table():
    assert obstacles(runs_of(run("kbga", {}, 110.0, scene="obstacles_20"))).empty
    others = [run("rrt", {}, 110.0, scene=f"obstacles_{n}") for n in (20, 30)]
    assert obstacles(runs_of(*others)).empty


def test_every_table_of_a_study_can_be_printed():
    runs = runs_of(
        *resolutions(),
        plain(0.4, None),
        plain(0.5, 110.0),
        *(run("kbga", {}, 110.0, scene=f"obstacles_{n}") for n in (20, 30)),
    )
    tables = study_tables(runs)
    assert len(tables) == 6
    for table in tables:
        for style in TableFormat:
            assert "nan" not in render(table, style).replace("nant", "")
