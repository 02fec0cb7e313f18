import pytest

from suite.harness.matrix import load_matrix
from suite.report.all_tables import all_tables
from suite.report.tables.ablation import OPERATORS, ablation, ablation_tables, paper_ablation
from tests.suite.report.study_rows import run, runs_of

WHOLE = {
    "crossover_probability": 0.9,
    "mutation_probability": 0.2,
    "repair_probability": 0.9,
    "deletion_probability": 0.9,
    "improvement_probability": 0.9,
    "rounds": 8,
}
SPECIALISED = ("repair", "deletion", "improvement")
PLAIN_GA = {"mutation_probability": 0.5, "crossover_probability": 0.9}


def kbga(cost, *off, name=None, rounds=8, **changes):
    settings = WHOLE | {"rounds": rounds} | {f"{operator}_probability": 0.0 for operator in off}
    name = name or "-".join([f"kbga-{rounds}", *off])
    return run(name, settings, cost, **changes)


def plain_ga(cost, **changes):
    return run("plain-ga", PLAIN_GA, cost, planner="plain-ga", **changes)


def test_a_row_says_what_was_switched_off_and_is_compared_with_the_whole_of_its_reading():
    frame = ablation(
        runs_of(
            kbga(110.0, cpu_s=0.1),
            kbga(120.0, "repair", cpu_s=0.2),
            kbga(130.0, "crossover", "mutation", cpu_s=0.3),
            kbga(110.0, rounds=1, cpu_s=1.0),
            kbga(120.0, *SPECIALISED, rounds=1, cpu_s=0.5),
        )
    )
    assert frame[["family", "value"]].to_numpy().tolist() == [
        ["kbga, rounds 8", "nothing"],
        ["kbga, rounds 8", "repair"],
        ["kbga, rounds 8", "crossover, mutation"],
        ["kbga, rounds 1", "nothing"],
        ["kbga, rounds 1", "repair, deletion, improvement"],
    ]
    assert frame["ratio total"].tolist() == pytest.approx([1.0, 2.0, 3.0, 1.0, 0.5])


def test_the_plain_ga_stands_beside_them_and_is_compared_with_nobody():
    frame = ablation(runs_of(kbga(110.0), kbga(120.0, "repair"), plain_ga(150.0)))
    row = frame.iloc[-1]
    assert (row["family"], row["value"]) == ("plain-ga", "repair, deletion, improvement")
    assert frame["ratio total"].isna().tolist() == [False, False, True]


def test_another_probability_is_tuning_and_not_ablation():
    tuned = run("tuned", WHOLE | {"mutation_probability": 0.4}, 110.0)
    frame = ablation(runs_of(kbga(110.0), kbga(120.0, "repair"), tuned))
    assert frame["variant"].tolist() == ["kbga-8", "kbga-8-repair"]


def test_there_is_no_such_table_without_both_the_whole_and_a_part():
    assert ablation_tables(runs_of(kbga(110.0), plain_ga(150.0)), "") == []
    assert ablation_tables(runs_of(kbga(110.0, "repair"), plain_ga(150.0)), "") == []
    assert ablation_tables(runs_of(), "") == []


def test_both_readings_stand_beside_the_papers_figures():
    frame = paper_ablation(
        runs_of(
            kbga(160.0),
            kbga(250.0, "crossover", "mutation"),
            kbga(120.0, "repair"),
            plain_ga(300.0),
            plain_ga(None, seed=1),
            kbga(160.0, rounds=1),
            kbga(170.0, "crossover", "mutation", rounds=1),
            kbga(120.0, scene="double_u"),
        )
    ).set_index("planner")
    assert "kbga-8-repair" not in frame.index, "the paper reports no such run"
    assert frame["scene"].unique().tolist() == ["zigzag"]
    without = frame[frame["switched off"] == "crossover, mutation"]
    assert without["paper cost mean"].tolist() == [251.56, 251.56]
    assert without["ours cost mean"].tolist() == [250.0, 170.0]
    assert without["paper gen mean"].tolist() == [174.0, 174.0]
    assert frame.loc["kbga-8", "paper cost SD"] == "1.99 / 0.47"
    plain = frame.loc["plain-ga"]
    assert (plain["paper cost mean"], plain["paper cost SD"]) == (352.35, "42.36")
    assert plain["ours feasible"] == "1 of 2"
    assert plain["ours cost with penalties mean"] == (300.0 + 1000.0) / 2


def test_our_own_planner_is_ablated_beside_and_has_no_figures_of_the_paper():
    records = [kbga(160.0), kbga(250.0, "crossover", "mutation")]
    ours = [
        kbga(156.0, name="kbga-plus", planner="kbga-plus"),
        kbga(157.0, "crossover", "mutation", name="kbga-plus-without", planner="kbga-plus"),
    ]
    frame = paper_ablation(runs_of(*records, *ours)).set_index("planner")
    assert frame.loc["kbga-8", "paper cost mean"] == 156.31
    papers = [column for column in frame if column.startswith("paper")]
    for name in ("kbga-plus", "kbga-plus-without"):
        assert not any(value and value == value for value in frame.loc[name, papers])
    assert frame.loc["kbga-plus-without", "ours cost mean"] == 157.0


def test_where_the_paper_never_found_a_path_it_is_said_so():
    frame = paper_ablation(
        runs_of(
            kbga(410.0, scene="maze"),
            kbga(410.0, "crossover", "mutation", scene="maze"),
            plain_ga(None, scene="maze"),
        )
    ).set_index("switched off")
    assert frame["paper feasible"].to_dict() == {
        "nothing": "", "repair, deletion, improvement": "never", "crossover, mutation": "never",
    }  # fmt: skip
    assert frame.loc["crossover, mutation", "ours feasible"] == "1 of 1"


def test_the_glance_shows_failures_and_the_note_says_why_there_are_two_gas_without_knowledge():
    runs = runs_of(kbga(110.0), kbga(None, *SPECIALISED), plain_ga(150.0))
    tables = {table.name: table for table in all_tables(runs)}
    assert {"paper-ablation", "study-ablation", "study-ablation-rows"} <= set(tables)
    assert tables["study-ablation"].frame["zigzag"].tolist() == ["10.00", "0 of 1", "50.00"]
    assert "plain-ga is the paper's GA" in tables["study-ablation"].note


@pytest.mark.parametrize("planner", ["kbga", "kbga-plus"])
def test_the_matrix_switches_off_every_operator_of_both_planners_and_nothing_else(planner):
    variants = [v for v in load_matrix("ablation").variants if v.plugin.name == planner]
    mine = [dict(v.settings) for v in variants]
    (whole,) = [s for v, s in zip(variants, mine, strict=True) if v.name == planner]
    probabilities = {f"{name}_probability" for name in OPERATORS}
    for settings in mine:
        changed = {name for name, value in settings.items() if value != whole[name]}
        assert changed <= probabilities
        assert {settings[name] for name in changed} <= {0.0}
    off = {
        tuple(name for name in OPERATORS if settings[f"{name}_probability"] == 0.0)
        for settings in mine
    }
    singles = {(name,) for name in OPERATORS}
    assert off == {(), SPECIALISED, ("crossover", "mutation")} | singles
