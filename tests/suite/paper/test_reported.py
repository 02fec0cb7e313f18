import re
from pathlib import Path

import pytest

from suite.paper.reported import KBGA, PLAIN_GA, UNITS, find, reported

PAPER = next(iter(sorted((Path(__file__).parents[4] / "shared" / "paper").glob("*.txt"))), None)
"""The paper's LaTeX text, which is not ours to ship: it is looked for beside the checkout."""

needs_paper = pytest.mark.skipif(PAPER is None, reason="the paper's text is not in ../shared/paper")


def test_every_figure_has_a_place_and_is_stated_once():
    seen = [(r.source, r.scene, r.planner, r.quantity, r.statistic) for r in reported()]
    assert len(seen) == len(set(seen))
    assert all(re.match(r"section |Table 1", r.source) for r in reported())
    assert len(reported()) >= 60


def test_statistics_and_quantities_are_of_the_known_words():
    assert {r.statistic for r in reported()} == {
        "mean", "sd", "single", "best", "initial", "setting",
    }  # fmt: skip
    measured = {r.quantity for r in reported() if r.statistic != "setting"}
    assert measured == set(UNITS)


@pytest.mark.parametrize(
    ("quantity", "values"),
    [("cost", [1.99, 0.47]), ("generations", [12, 13]), ("time_s", [1.37, 0.77])],
)
def test_the_papers_contradictions_are_both_there(quantity, values):
    found = find(scene="zigzag", planner=KBGA, quantity=quantity, statistic="sd")
    assert [r.value for r in found] == values


def test_table_1_is_complete():
    rows = find(source="Table 1")
    values = {(r.planner, r.quantity, r.statistic): r.value for r in rows}
    assert len(values) == 12
    assert values[PLAIN_GA, "cost", "mean"] == 352.35
    assert values[KBGA, "time_s", "sd"] == 0.77
    assert {r.runs for r in rows} == {20}


@needs_paper
def test_every_figure_stands_in_the_paper():
    text = PAPER.read_text(errors="replace")
    numbers = {float(n) for n in re.findall(r"\d+(?:\.\d+)?", text)}
    for figure in reported():
        if figure.quantity != "success":
            assert figure.value in numbers, figure


@needs_paper
def test_every_decimal_of_its_results_is_among_the_figures():
    text = PAPER.read_text(errors="replace")
    results = text[
        text.index(r"\section{Simulation Results}") : text.index(r"\section{CONCLUSION}")
    ]
    results = re.sub(r"\\includegraphics\[[^]]*\]|p\{[^}]*\}|\\vspace\{[^}]*\}", "", results)
    known = {r.value for r in reported()}
    missing = {n for n in re.findall(r"\d+\.\d+", results) if float(n) not in known}
    assert not missing
