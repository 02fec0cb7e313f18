"""What goes wrong is contained, and the table would say if it were not."""

from dataclasses import replace

import pandas as pd
import pytest

from tests.perf.faults.all_faults import FAULTS
from tests.perf.faults.fault import Fault, Outcome, suffer
from tests.perf.faults.stage import Found, Said, first_rows
from tests.perf.faults.table import line_of, table, write
from tests.suite.harness.hostile_site import make_site

SAMPLE = "a segmentation fault"

ROWS = {"a": ("0.1", b"path", "solved", ""), "b": ("0.2", None, "crashed", "SIGSEGV")}
PLANNERS = {"a": "wanderer", "b": "segfaults"}
WHOLE = Found(whole=True, rows=ROWS, planners=PLANNERS)
BEFORE = Found(whole=True, rows={"a": ROWS["a"]}, planners={"a": "wanderer"})
SEGFAULT = Fault("a segfault", "a read at 0", planner="segfaults", status=("crashed",),
                 says="SIGSEGV")  # fmt: skip
DONE = Said(0, "2 of 2 runs are in the store", 1.0)
CONTAINED = Outcome(SEGFAULT, 2, BEFORE, DONE, 0, WHOLE, DONE, WHOLE)


def found(**rows):
    return Found(whole=True, rows={**ROWS, **rows}, planners=PLANNERS)


def test_a_fault_is_contained_if_nothing_is_wrong(tmp_path):
    assert CONTAINED.flaws() == []
    line = line_of(SEGFAULT, CONTAINED, None, tmp_path)
    assert line.verdict == "contained"
    assert line.row == "crashed x 1 (SIGSEGV)"
    assert line.matrix == "all 2 rows"
    assert line.store == "whole; 1 of 1 earlier rows as they were"


SOME = Found(whole=True, rows={"a": ROWS["a"]}, planners={"a": "wanderer"})
EMPTY = Found(whole=True)


@pytest.mark.parametrize(
    ("change", "flaw"),
    [
        ({"said": Said(None, "", 180.0)}, "the command hangs"),
        ({"said": Said(1, "SIGSEGV", 1.0)}, "exit code 1"),
        ({"said": Said(0, "Traceback (most recent call last):", 1.0)}, "a traceback"),
        ({"fault": replace(SEGFAULT, says="no such word")}, "no word of 'no such word'"),
        ({"found": SOME}, "rows are missing and the exit code is 0"),
        ({"found": replace(WHOLE, whole=False)}, "the store is not whole"),
        ({"found": EMPTY}, "rows from before are lost or changed"),
        (
            {"found": found(a=("0.3", b"path", "solved", ""))},
            "rows from before are lost or changed",
        ),
        ({"end": found(b=("0.3", None, "crashed", "SIGSEGV"))}, "rows are lost or changed later"),
        ({"again": Said(2, "", 1.0)}, "the same command does not do the rest"),
        ({"end": SOME}, "the same command does not do the rest"),
        ({"end": found(a=("0.1", None, "crashed", ""))}, "the planner beside it is struck"),
        ({"end": found(b=("0.2", None, "solved", ""))}, "its rows are solved x 1"),
        ({"left": 2}, "2 processes are left"),
    ],
)
def test_whatever_is_wrong_is_said(change, flaw, tmp_path):
    outcome = replace(CONTAINED, **change)
    assert flaw in outcome.flaws()
    assert line_of(outcome.fault, outcome, None, tmp_path).verdict.startswith("NOT contained: ")


def test_the_table_counts_what_was_not_tried_and_names_no_folder_and_no_machine(tmp_path):
    text = f"{tmp_path}/store.db: another process (process 71 on here, matrix, since noon) writes"
    told = replace(CONTAINED, said=Said(2, text, 1.0))
    lines = [
        line_of(SEGFAULT, CONTAINED, None, tmp_path),
        line_of(SEGFAULT, told, None, tmp_path),
        line_of(SEGFAULT, None, "not tried: no right to mount", tmp_path),
    ]
    assert table(lines).title == "Faults: 1 of 2 contained, 1 not tried"
    assert "no right to mount" in write(lines[2:], tmp_path, [SEGFAULT.name])
    write(lines[1:2], tmp_path, [SEGFAULT.name])
    written = (tmp_path / "faults.csv").read_text()
    assert "FOLDER/store.db: another process (process N on HOST, matrix) writes" in written


def test_a_fault_that_is_not_tried_now_keeps_its_line(tmp_path):
    other = replace(SEGFAULT, name="another")
    order = ["another", "gone", SEGFAULT.name]
    write([line_of(other, None, "not tried: no root", tmp_path)], tmp_path, order)
    write([line_of(SEGFAULT, CONTAINED, None, tmp_path)], tmp_path, order)
    frame = pd.read_csv(tmp_path / "faults.csv", keep_default_na=False)
    assert frame["fault"].tolist() == ["another", SEGFAULT.name]
    assert frame["verdict"].tolist() == ["not tried: no root", "contained"]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return make_site(tmp_path_factory.mktemp("site"))


@pytest.fixture(scope="module")
def rows(site, tmp_path_factory):
    return first_rows(tmp_path_factory.mktemp("first"), site)


@pytest.mark.parametrize(
    "fault",
    [
        pytest.param(fault, id=fault.name, marks=[] if fault.name == SAMPLE else pytest.mark.slow)
        for fault in FAULTS
    ],
)
def test_a_fault_is_contained(fault, site, rows, tmp_path):
    missing = fault.needs()
    if missing is not None:
        pytest.skip(missing)
    outcome = suffer(fault, tmp_path, site, rows)
    assert outcome.flaws() == [], outcome.said


def test_each_fault_has_a_name_of_its_own():
    assert len({fault.name for fault in FAULTS}) == len(FAULTS)
