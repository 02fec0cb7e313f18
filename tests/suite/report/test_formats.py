import pandas as pd
import pytest

from suite.errors import KbgaBenchError
from suite.report.formats import as_texts, render
from suite.report.kinds import TableFormat
from suite.report.table import Kind, Table, named


@pytest.fixture
def table():
    frame = pd.DataFrame(
        {"planner": ["a_b", "c"], "cost mean": [1.0, float("nan")], "runs": [20, 3]}
    )
    return Table("costs", "Costs & more", frame, "A note with 5 %.")


def test_text_and_markdown_round_and_leave_gaps_where_nothing_is_known(table):
    for style in (TableFormat.TABLE, TableFormat.MARKDOWN):
        text = render(table, style)
        assert "Costs & more" in text
        assert "1.00" in text
        assert "nan" not in text
        assert text.endswith("A note with 5 %.\n")


def test_csv_holds_the_numbers_as_they_are(table):
    assert render(table, TableFormat.CSV) == "planner,cost mean,runs\na_b,1.0,20\nc,,3\n"


def test_latex_is_escaped_and_has_caption_and_label(table):
    text = render(table, TableFormat.LATEX)
    assert r"\caption{Costs \& more. A note with 5 \%.}" in text
    assert r"\label{tab:costs}" in text
    assert r"a\_b" in text
    assert r"\begin{tabular}{lrr}" in text


def test_a_heading_takes_no_more_room_than_its_longest_word():
    frame = pd.DataFrame({"gap": [1.0], "planner": ["a"], "cost mean (%)": [100.0]})
    text = render(Table("t", "T", frame), TableFormat.TABLE)
    assert text == (
        "T\n\n                 cost\n                 mean\n gap  planner     (%)\n"
        "----  -------  ------\n1.00  a        100.00\n"
    )


def test_a_table_without_rows_has_its_headings():
    frame = pd.DataFrame(columns=["scene", "planner"])
    assert "scene  planner\n-----  -------" in render(Table("t", "T", frame), TableFormat.TABLE)


def test_in_latex_what_is_too_wide_is_scaled_and_what_is_too_long_goes_on(table):
    text = render(table, TableFormat.LATEX)
    assert r"\resizebox{\ifdim\width>\linewidth\linewidth\else\width\fi}{!}{%" in text
    assert r"\shortstack{cost\\mean}" in text
    frame = pd.concat([table.frame] * 30)
    text = render(Table("long", "Costs", frame, "A note."), TableFormat.LATEX)
    assert r"\begin{longtable}{lrr}" in text
    assert text.count("A note.") == 1
    assert r"\caption[]{Costs, continued}" in text
    assert text.count("{") == text.count("}")


def test_an_infinite_number_is_printed_in_words():
    frame = pd.DataFrame({"time (ms)": [1.0, float("inf")]})
    table = Table("t", "T", frame, infinite="never")
    assert "never" in render(table, TableFormat.TABLE)
    assert render(table, TableFormat.CSV) == "time (ms)\n1.0\ninf\n"


def test_latex_has_a_less_than_sign_in_every_font():
    table = Table("t", "T", pd.DataFrame({"better": ["0.90 (<0.001)"]}), "p < 0.001")
    text = render(table, TableFormat.LATEX)
    assert "0.90 ($<$0.001)" in text
    assert "p $<$ 0.001" in text


def test_a_column_has_the_digits_of_what_it_is_said_to_be_or_of_its_unit():
    frame = pd.DataFrame(7.00123, [0], ["p", "x", "gen", "t (ms)", "paper", "ours"])
    kinds = {
        "p": Kind.P_VALUE,
        "gen": Kind.COUNT,
        "paper": Kind.PRINTED,
        "ours": Kind.MIXED,
    }
    (cells,) = as_texts(Table("t", "T", frame, kinds=kinds)).to_numpy().tolist()
    assert cells == ["7.0012", "7.00", "7.0", "7.001", "7.00", "7.00"]
    small = as_texts(Table("t", "T", frame / 10_000, kinds=kinds | {"x": Kind.MIXED}))
    assert small["p"].tolist() == ["0.0007"]
    assert small["x"].tolist() == ["0.000700"]


def test_tables_are_chosen_by_name_and_an_unknown_name_is_refused(table):
    other = Table("other", "Other", table.frame)
    assert named([table, other], []) == [table, other]
    assert named([table, other], ["other", "costs", "other"]) == [other, table]
    with pytest.raises(KbgaBenchError, match=r"no table 'cost' .* Take one of: costs, other"):
        named([table, other], ["cost"])
