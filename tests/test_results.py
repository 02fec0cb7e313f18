"""Tables of results/ come out of the rows beside them; what the READMEs say stands in results/."""

import json
from collections.abc import Sequence
from pathlib import Path

import pandas as pd
import pytest

from suite.report.all_tables import all_tables
from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.statistics.clock import fair
from tests import readme

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "results"
PAPER = ("paper-static", "paper-dynamic", "resolution")
CAMPAIGNS = sorted(path.parents[1] for path in RESULTS.glob("*/rows/runs.parquet"))


def together(name: str, folders: Sequence[Path]) -> pd.DataFrame | None:
    files = [folder / "rows" / f"{name}.parquet" for folder in folders]
    frames = [pd.read_parquet(file) for file in files if file.exists()]
    if not frames:
        return None
    frame = pd.concat(frames, ignore_index=True)
    # As a store gives them back.
    order = {"runs": ["position"], "events": ["key", "number"]}.get(name)
    return frame if order is None else frame.sort_values(order, kind="stable", ignore_index=True)


def first_measures(folders: Sequence[Path]) -> pd.DataFrame | None:
    traces = together("traces", folders)
    return None if traces is None else traces.groupby("key").first()


FROM_EVENTS = ("fixed-", "ranking", "statistics", "maps", "queries")
FROM_SCENES = ("scenes.csv", "maps-strata.csv")
"""Of the scenes that the store keeps, which are no rows."""


def check_tables(folder: Path, *sources: Path) -> None:
    """Make all tables of a folder again from rows, and compare them letter by letter."""
    tables = all_tables(
        together("runs", sources),
        first_measures(sources),
        together("events", sources),
        simulations=together("simulations", sources),
        replans=together("replans", sources),
    )
    made = {f"{table.name}.csv": render(table, TableFormat.CSV) for table in tables}
    there = {file.name: file.read_text(encoding="utf-8") for file in folder.glob("*.csv")}
    there = {name: text for name, text in there.items() if name not in FROM_SCENES}
    if not all((source / "rows" / "traces.parquet").exists() for source in sources):
        # Its best costs of first populations come out of the traces.
        there.pop("paper-figures.csv", None)
    if not all((source / "rows" / "events.parquet").exists() for source in sources):
        # They are made from the events, which are megabytes that some studies leave out.
        there = {n: t for n, t in there.items() if not n.startswith(FROM_EVENTS)}
    assert there
    assert [name for name, text in there.items() if made.get(name) != text] == []


@pytest.mark.parametrize(
    "folder",
    [
        pytest.param(folder, marks=[] if folder.name in PAPER else pytest.mark.slow)
        for folder in CAMPAIGNS
    ],
    ids=lambda folder: folder.name,
)
def test_the_tables_of_a_campaign_come_out_of_its_rows(folder):
    check_tables(folder, folder)


@pytest.mark.slow
def test_the_tables_of_the_paper_come_out_of_the_rows_of_its_campaigns():
    check_tables(RESULTS / "paper", *(RESULTS / name for name in PAPER))


@pytest.mark.parametrize("folder", CAMPAIGNS, ids=lambda folder: folder.name)
def test_the_rows_of_a_campaign_come_from_one_clean_commit(folder):
    manifest = json.loads((folder / "manifest.json").read_text())
    commits = {session["git"]["commit"] for session in manifest["sessions"]}
    assert len(commits) == 1
    assert not any(session["git"]["dirty"] for session in manifest["sessions"])
    assert manifest["runs"] == len(together("runs", [folder]))


# The READMEs


@pytest.mark.parametrize("page", readme.PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_tables_and_figures_of_a_page_are_made_from_results(page):
    text = page.read_text(encoding="utf-8")
    # `python -m tests.readme` writes them.
    assert readme.rewritten(text) == text


@pytest.mark.parametrize("name", readme.TABLES)
def test_a_table_that_is_made_stands_on_a_page(name):
    assert readme.TABLES[name]() in readme.pages()


@pytest.mark.parametrize("name", readme.SENTENCES)
def test_a_sentence_that_is_made_stands_on_a_page(name):
    assert readme.SENTENCES[name]() in readme.folded(readme.pages())


def test_figures_are_put_in_where_the_words_stand_however_they_are_wrapped():
    told = readme.with_figures("in 2 of\n10 runs, not 3.1 %", "2,000 of 20 runs, not 4 %")
    assert told == "in 2,000 of\n20 runs, not 4 %"
    assert readme.with_figures("2 of 10 walks", "4 of 20 runs") == "2 of 10 walks"


@pytest.mark.parametrize("name", ["paper-static", "all-planners", "alignment", "paper-dynamic"])
def test_no_row_of_a_timed_planner_that_a_table_counts_was_contended(name):
    runs = together("runs", [RESULTS / name])
    timed = runs[runs["budget_wall_s"].notna()]
    counted = set(fair(runs)["key"])
    contended = timed[timed["contended"].fillna(value=False).astype(bool)]
    assert not counted & set(contended["key"])
    # So many may be left out and the tables still stand on what was asked for.
    assert len(contended) <= 0.1 * len(timed)


def test_the_exact_planners_rank_first_as_the_readme_says():
    ranks = pd.read_csv(RESULTS / "all-planners" / "ranking.csv")["planner"].tolist()
    assert {*ranks[:4]} == readme.EXACT | {"kbga-plus"}


def test_kbga_ranks_behind_those_of_ompl_that_the_readme_names():
    ranks = pd.read_csv(RESULTS / "all-planners" / "ranking.csv").set_index("planner")
    named = ["ompl-shortcut", "ompl-informedrrtstar-tuned", "ompl-rrtstar-tuned"]
    assert (ranks.loc[named, "rank by gap"] < ranks.loc["kbga", "rank by gap"]).all()


def test_the_ranks_tell_kbga_from_nobody():
    ranks = pd.read_csv(RESULTS / "all-planners" / "ranking.csv").set_index("planner")
    others = ranks.drop(index="kbga")
    for order in ("by gap", "by time"):
        assert (others[f"{order}, Nemenyi p"] > 0.05).all()
        assert (others[f"{order}, Wilcoxon-Holm p"] > 0.05).all()


def test_who_comes_within_1_percent_first_is_who_the_readme_says():
    rows = pd.read_csv(RESULTS / "all-planners" / "ranking-rows.csv")
    rows = rows[~rows["planner"].isin(readme.EXACT)]
    times = rows.pivot_table("time to 1 % median (ms)", index="scene", columns="planner")
    assert (times.idxmin(axis=1) == "kbga-plus").all()


def test_no_run_of_kbga_plus_on_scenes_and_twins_ends_off_the_optimum():
    for name in ("paper-static", "alignment", "kbga-plus"):
        runs = together("runs", [RESULTS / name])
        runs = runs[runs["variant"] == "kbga-plus"]
        assert (runs["cost"] <= runs["optimum"] * (1.0 + 5e-5)).all()


def test_on_turned_scenes_and_on_maps_those_are_sooner_that_the_pages_name():
    ranked = pd.read_csv(RESULTS / "rivals" / "ranking-rows.csv")
    ranked = ranked[~ranked["planner"].isin(readme.EXACT)]
    ranked["of"] = ranked["scene"].str.partition("@")[0]
    times = ranked.pivot_table(
        "time to 1 % median (ms)", index="of", columns="planner", aggfunc="median"
    )
    sooner = times.lt(times["kbga-plus"], axis=0)
    assert set(times.index[sooner.any(axis=1)]) == {"unstructured", "obstacles_20"}
    maps = pd.read_csv(RESULTS / "real-maps" / "maps-rows.csv")
    maps = maps[~maps["planner"].isin(readme.EXACT)]
    times = maps.pivot_table("to 1 % (ms)", index="scene", columns="planner", sort=False)
    sooner = times.lt(times["kbga-plus"], axis=0)
    assert set(times.index[sooner.any(axis=1)]) == {"arena", "tb3_sandbox"}


def test_no_robot_was_hit_and_one_did_not_arrive():
    fared = pd.read_csv(RESULTS / "paper-dynamic" / "simulations.csv")
    assert (fared["hit"] == 0).all()
    late = fared[fared["unhurt (%)"] < 100.0]
    assert late["planner"].tolist() == ["ompl-rrtconnect"]
    assert late["otherwise"].tolist() == ["exhausted 1"]


def test_the_experiment_of_the_paper_that_does_not_come_out_each_time_is_that_of_b():
    found = pd.read_csv(RESULTS / "paper-dynamic" / "paper-dynamic.csv")
    assert (found["runs"] == 10).all()
    (odd,) = found.loc[found["ours so"] < found["runs"], "what it shows"]
    assert odd.startswith("B is detected")


def test_without_repair_no_run_finds_a_path_where_the_pages_say_so():
    found = pd.read_csv(RESULTS / "ablation" / "study-ablation-rows.csv")
    found = found[(found["switched off"] == "repair") & (found["settings"] != "plain-ga")]
    assert (found.loc[found["scene"].isin(["maze", "unstructured"]), "feasible"] == 0).all()


def test_without_crossover_and_mutation_kbga_comes_through_the_maze_as_often():
    found = pd.read_csv(RESULTS / "ablation" / "study-ablation-rows.csv")
    found = found[(found["settings"] == "kbga") & (found["scene"] == "maze")]
    feasible = found.set_index("switched off")["feasible"]
    assert feasible["crossover, mutation"] >= feasible["nothing"]
