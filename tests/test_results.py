"""Tables of results/ come out of the rows beside them; what the README says stands in results/."""

import json
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from suite.report.table import Format, render
from suite.report.tables import all_tables

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "results"
README = (ROOT / "README.md").read_text(encoding="utf-8")
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


def check_tables(folder: Path, *sources: Path) -> None:
    """Make all tables of a folder again from rows, and compare them letter by letter."""
    tables = all_tables(
        together("runs", sources),
        first_measures(sources),
        together("events", sources),
        simulations=together("simulations", sources),
        replans=together("replans", sources),
    )
    made = {f"{table.name}.csv": render(table, Format.CSV) for table in tables}
    there = {file.name: file.read_text(encoding="utf-8") for file in folder.glob("*.csv")}
    if not all((source / "rows" / "traces.parquet").exists() for source in sources):
        # Its best costs of first populations come out of the traces.
        there.pop("paper-figures.csv", None)
    assert there
    assert [name for name, text in there.items() if made.get(name) != text] == []


@pytest.mark.parametrize("folder", CAMPAIGNS, ids=lambda folder: folder.name)
def test_the_tables_of_a_campaign_come_out_of_its_rows(folder):
    check_tables(folder, folder)


def test_the_tables_of_the_paper_come_out_of_the_rows_of_its_campaigns():
    check_tables(RESULTS / "paper", *(RESULTS / name for name in PAPER))


@pytest.mark.parametrize("folder", CAMPAIGNS, ids=lambda folder: folder.name)
def test_the_rows_of_a_campaign_come_from_one_clean_commit(folder):
    manifest = json.loads((folder / "manifest.json").read_text())
    commits = {session["git"]["commit"] for session in manifest["sessions"]}
    assert len(commits) == 1
    assert not any(session["git"]["dirty"] for session in manifest["sessions"])
    assert manifest["runs"] == len(together("runs", [folder]))


# The README


def table_under(heading: str) -> list[list[str]]:
    """Cells of the first table after a text, without its ruler."""
    lines = README[README.index(heading) :].splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("|"))
    cells = []
    for line in lines[start:]:
        if not line.startswith("|"):
            break
        cells.append([cell.strip() for cell in line.strip("|").split("|")])
    return [cells[0], *cells[2:]]


def test_the_gaps_of_the_readme_are_those_of_the_summary():
    summary = pd.read_csv(RESULTS / "paper-static" / "summary.csv").set_index(["scene", "planner"])
    (_, _, *planners), *lines = table_under("## What came out")
    for scene, _, *cells in lines:
        for planner, cell in zip(planners, cells, strict=True):
            row = summary.loc[(scene, re.sub(r" \(.*", "", planner))]
            solved, runs = int(row["solved"]), int(row["runs"])
            some = "" if solved == runs else f", {solved} of {runs} runs"
            # Rounding may leave a zero with a sign.
            told = f"{round(row['gap mean (%)'], 2) + 0.0:.2f} %{some}"
            assert cell == (told if solved else f"no path in {runs} runs"), scene


EXACT = {"visibility-graph", "extremitypathfinder"}
NEARER_THAN_KBGA = {
    "unstructured": {
        "ompl-informedrrtstar", "ompl-sorrtstar", "ompl-rrtstar", "ompl-aorrtc", "cmaes",
    },
    "maze": set(),
    "zigzag": set(),
    "double_u": set(),
    "clustered": set(),
    "obstacles_20": {"ompl-informedrrtstar", "ompl-sorrtstar", "grid-astar", "cmaes"},
    "obstacles_30": {"ompl-informedrrtstar", "ompl-sorrtstar", "grid-astar"},
    "obstacles_40": {"ompl-informedrrtstar", "ompl-sorrtstar"},
}  # fmt: skip
"""As the README tells it."""


def test_what_the_readme_says_of_every_planner_is_so():
    folder = RESULTS / "all-planners"
    at = {"index": "scene", "columns": "planner"}
    summary = pd.read_csv(folder / "summary.csv")
    gaps = summary.pivot_table("gap median (%)", **at).drop(columns=sorted(EXACT))
    for scene, told in NEARER_THAN_KBGA.items():
        assert set(gaps.columns[gaps.loc[scene] < gaps.loc[scene, "kbga"]]) == told, scene
    for scene in ("unstructured", "obstacles_20"):
        assert gaps.loc[scene].idxmin() == "cmaes"
    solved = summary.pivot_table("solved", **at)["cmaes"]
    assert set(solved.index[solved == 0]) == {"maze", "zigzag", "clustered"}
    ranks = pd.read_csv(folder / "ranking.csv")["planner"].tolist()
    assert {*ranks[:2]} == EXACT
    assert ranks[2] == "kbga"
    times = pd.read_csv(folder / "ranking-rows.csv").pivot_table("time to 1 % median (ms)", **at)
    assert set(times.columns[np.isfinite(times).all()]) == {*EXACT, "kbga"}


def test_table_1_of_the_readme_is_that_of_the_results():
    lines = table_under("The paper's Table 1")
    text = (RESULTS / "paper-static" / "paper-table-1.md").read_text()
    for cells in lines[1:]:
        pattern = r"\s*\|\s*".join(map(re.escape, cells))
        assert re.search(rf"\|\s*{pattern}\s*\|", text), cells


def test_the_dynamic_table_of_the_readme_is_that_of_the_results():
    folder = RESULTS / "paper-dynamic"
    answered, fared = (
        pd.read_csv(folder / f"{name}.csv") for name in ("replanning", "simulations")
    )
    both = answered.merge(fared, on=["scene", "world", "planner"]).set_index(["world", "planner"])
    for planner, *cells in table_under("### While the robot moves")[2:]:
        told = []
        for world in ("Fig. 11", "section III-E"):
            row = both.loc[(world, planner)]
            above = round(row["above exact (%)"], 1) + 0.0
            told += [
                f"{row['latency median (ms)']:.2f} ms",
                f"{row['latency worst (ms)']:.0f} ms",
                f"{above:+.1f} %" if above else "0.0 %",
            ]
        assert cells == told, planner
    assert f"In all {fared['runs'].sum()} runs of all planners" in README
    assert (fared["unhurt (%)"] == 100.0).all()


def test_the_times_of_the_readme_are_those_of_the_performance():
    times = pd.read_csv(RESULTS / "performance" / "time_to_1_percent.csv")
    kbga = times[times["planner"] == "kbga"].set_index("scene")["time to 1 % (ms)"]
    for scene, ours, best, factor, _ in table_under("### How fast")[1:]:
        assert ours == f"{kbga[scene]:.2g} ms", scene
        others = times[(times["scene"] == scene) & times["planner"].str.startswith("ompl-")]
        fastest = others.sort_values("time to 1 % (ms)").iloc[0]
        ratio = float(f"{fastest['over kbga']:.2g}")
        if best.startswith("none"):
            assert factor == f"over {ratio:.0f}", scene
        else:
            time = float(f"{fastest['time to 1 % (ms)']:.2g}")
            assert best == f"{fastest['planner'].removeprefix('ompl-')}: {time:g} ms", scene
            assert float(factor) == ratio, scene


STUDIES = [
    ("obstacles", "ratio total", "scattered_300", "scene", "{:.1f} times among 300"),
    ("obstacles", "ratio total", "scattered_3000", "scene", "{:.0f} among\n  3,000"),
    ("obstacles", "gap mean (%)", "scattered_3000", "scene", "at a gap of {:.2f} %"),
]


@pytest.mark.parametrize(("study", "column", "value", "key", "words"), STUDIES)
def test_figures_in_the_prose_of_the_readme_are_those_of_the_studies(
    study, column, value, key, words
):
    frame = pd.read_csv(RESULTS / study / f"study-{study}.csv").set_index(key)
    assert words.format(frame.loc[value, column]) in README


def test_the_ratios_of_the_readme_are_those_of_the_studies():
    obstacles = pd.read_csv(RESULTS / "obstacles" / "study-obstacles.csv")["ratio total"][:3]
    rows = pd.read_csv(RESULTS / "resolution" / "study-resolution-rows.csv")
    resolutions = rows[rows["scene"] == "unstructured"]["ratio total"]
    for ratios in (obstacles, resolutions):
        assert "1 : " + " : ".join(f"{ratio:.2f}" for ratio in ratios.iloc[1:]) in README


def test_the_share_of_python_in_the_readme_is_that_of_the_rows():
    runs = together("runs", [RESULTS / "paper-static"])
    for planner, words in (("ompl-rrtstar", "of RRT*'s time"), ("ompl-prmstar", "of PRM*'s")):
        details = runs.loc[runs["planner"] == planner, "details"].map(json.loads)
        low, high = pd.Series([d["callback_share"] for d in details]).quantile([0.05, 0.95])
        assert f"{low:.2f} to {high:.2f} {words}" in README


def test_the_verdicts_are_counted_in_the_changelog_as_they_are():
    words = pd.read_csv(RESULTS / "paper" / "paper-figures.csv")["verdict"].value_counts()
    told = f"({words.sum()}: {words['agrees']} agree, {words['better']} are better, "
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert told + f"{words['not comparable']} can't be compared)" in changelog
