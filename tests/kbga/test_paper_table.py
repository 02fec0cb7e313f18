"""The package's table from the paper's sentences to our functions names what there is."""

import importlib
import pkgutil
from collections import defaultdict
from dataclasses import dataclass, field, fields
from functools import cache
from typing import Any

import pytest

import kbga
from kbga import KBGA, KBGAPlusSettings, KBGASettings
from kbga import operators as operators_package
from tests.kbga.laboratory import scene_of

SECTIONS = ["II-A", "II-B", "II-C", "II-D", "III", "V"]
CHOICES = {"silent", "kbga", "plus"}
"""Rows that are not the paper's: of both planners, of the paper's as we read it, and of ours."""


@dataclass
class Row:
    """A sentence of the paper, or a choice of ours, and the names that carry it out."""

    section: str
    text: str = ""
    names: list[str] = field(default_factory=list)


def rows() -> list[Row]:
    """The table of the package's docstring. A row without a section goes on with the last one."""
    lines = (kbga.__doc__ or "").splitlines()
    first, head, last = (i for i, line in enumerate(lines) if line.startswith("====="))
    assert head == first + 2
    starts = [0, *(i + 2 for i, c in enumerate(lines[first]) if lines[first][i : i + 2] == "  ")]
    found: list[Row] = []
    for line in lines[head + 1 : last]:
        cells = [line[a:b].strip() for a, b in zip(starts, [*starts[1:], None], strict=True)]
        if cells[0]:
            found.append(Row(cells[0]))
        found[-1].text += f" {cells[1]}"
        found[-1].names += [cells[2]] if cells[2] else []
    return found


NAMES = sorted({name for row in rows() for name in row.names})


@cache
def an_instance() -> KBGA:
    return KBGA(scene_of(), settings=KBGASettings(population_size=2, resolution=2), rng=0)


def resolve(name: str) -> Any:
    """What a name of the table stands for: a module, something in one, or a part of KBGA."""
    head, *rest = name.split(".")
    if head == "KBGA":  # some of its attributes are there only once it is made
        found: Any = an_instance()
    elif head == "KBGASettings":
        found = KBGASettings()
    elif head == "KBGAPlusSettings":
        found = KBGAPlusSettings()
    else:
        depth = len(rest)
        while True:
            try:
                found = importlib.import_module(".".join([head, *rest[:depth]]))
                break
            except ModuleNotFoundError:
                depth -= 1
                if depth < 0:
                    raise
        rest = rest[depth:]
    for part in rest:
        found = getattr(found, part)
    return found


@pytest.mark.parametrize("name", NAMES)
def test_a_name_in_the_table_is_there(name):
    assert resolve(name) is not None


def test_a_name_that_is_not_there_would_be_noticed():
    for wrong in ("kbga.evaluation.no", "kbga.no", "KBGASettings.no", "KBGA.no", "nobody.no"):
        with pytest.raises((AttributeError, ModuleNotFoundError)):
            resolve(wrong)


def test_every_row_says_something_and_names_who_does_it():
    assert [row for row in rows() if not (row.text.strip() and row.names)] == []


def test_the_sections_come_in_the_papers_order_and_a_choice_follows_its_sentence():
    sections = [row.section for row in rows()]
    assert set(sections) == {*SECTIONS, *CHOICES}
    papers = [SECTIONS.index(s) for s in sections if s not in CHOICES]
    assert papers == sorted(papers)
    assert sections[0] in SECTIONS


@pytest.mark.parametrize("what", ["Eq. (1)", "Eq. (2)", *(f"Fig. 3({c})" for c in "abcd")])
def test_equations_and_the_cases_of_figure_3_have_a_row(what):
    assert any(what in row.text for row in rows())


@pytest.mark.parametrize("name", [f.name for f in fields(KBGASettings)])
def test_every_setting_is_named(name):
    assert f"KBGASettings.{name}" in NAMES


def test_a_setting_that_is_called_a_reading_has_a_row_that_is_no_sentence_of_the_paper():
    # One line of the class's docstring is one setting, with "reading" in it or in its next lines.
    called: dict[str, str] = defaultdict(str)
    setting = ""
    for line in (KBGASettings.__doc__ or "").splitlines():
        head, colon, _ = line.strip().partition(" : ")
        setting = head if colon and hasattr(KBGASettings, head) else setting
        called[setting] += line
    readings = {name for name, text in called.items() if "reading" in text and name}
    choices = {name for row in rows() if row.section in CHOICES for name in row.names}
    assert {f"KBGASettings.{name}" for name in readings} <= choices


def test_what_kbga_plus_differs_in_has_a_row_that_is_its_own():
    own = {name for row in rows() if row.section == "plus" for name in row.names}
    plus, paper = KBGAPlusSettings(), KBGASettings()
    differs = [f.name for f in fields(paper) if getattr(plus, f.name) != getattr(paper, f.name)]
    for name in differs:
        assert {f"KBGASettings.{name}", f"KBGAPlusSettings.{name}"} & own, name


@pytest.mark.parametrize(
    "module", [m.name for m in pkgutil.iter_modules(operators_package.__path__)]
)
def test_every_operator_is_named(module):
    whole = f"kbga.operators.{module}"
    assert any(name == whole or name.startswith(f"{whole}.") for name in NAMES)
