"""Changed code is another planner, however its author calls the version."""

from importlib.metadata import EntryPoint

import pytest

from suite.plugins.code_hash import code_hash, files_beside, files_of_entry_point, files_of_package
from suite.plugins.discovery import planner_version


@pytest.fixture
def write(tmp_path):
    def made(**sources):
        for name, text in sources.items():
            file = tmp_path / f"{name.replace('__in__', '/')}.py"
            file.parent.mkdir(exist_ok=True)
            file.write_text(text)
        return tmp_path

    return made


def names(files):
    return {file.name for file in files}


def test_what_a_file_imports_from_beside_it_belongs_to_it_directly_or_not(write):
    folder = write(
        mine="import numpy\nfrom first import f",
        first="def f():\n    import second.part",
        second__in__part="from . import other",
        second__in__other="",
        stranger="",
    )
    wanted = {"mine.py", "first.py", "part.py", "other.py"}
    assert names(files_beside(folder / "mine.py")) == wanted


def test_modules_that_import_each_other_come_to_an_end(write):
    folder = write(mine="import first", first="import mine")
    assert names(files_beside(folder / "mine.py")) == {"mine.py", "first.py"}


def test_the_suite_is_nobodys_code_though_it_lies_beside(write):
    folder = write(mine="from suite.planner import Planner\nimport kbga", suite__in__planner="")
    assert names(files_beside(folder / "mine.py")) == {"mine.py"}


def test_the_hash_is_of_names_and_contents_and_not_of_places(write, tmp_path):
    folder = write(
        a="x = 1", b="x = 2", there__in__a="x = 1", there__in__b="x = 2", swapped__in__a="x = 2"
    )
    here = code_hash([folder / "a.py", folder / "b.py"])
    assert code_hash([folder / "there" / "b.py", folder / "there" / "a.py"]) == here
    assert code_hash([folder / "swapped" / "a.py", folder / "b.py"]) != here
    assert code_hash([folder / "a.py"]) != here


def test_a_package_is_all_of_its_code_and_nothing_of_it_is_imported(write, monkeypatch):
    folder = write(parcel__in____init__="raise SystemExit", parcel__in__deep="")
    monkeypatch.syspath_prepend(folder)
    assert names(files_of_package("parcel.deep")) == {"__init__.py", "deep.py"}


@pytest.mark.parametrize("module", ["no_such_package", "no_such_package.part", "sys", ""])
def test_what_is_not_there_has_no_code(module):
    assert files_of_entry_point(EntryPoint("x", f"{module}:X", "g")) == set()


def test_our_own_planners_have_the_version_of_the_distribution():
    assert "sha256" not in planner_version("kbga")
