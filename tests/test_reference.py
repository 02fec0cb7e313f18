"""The reference that `make docs` writes: pages with names, fields and tables in their places."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.reference import prepared, write_reference

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reference")
    modules = ("suite.planner", "suite.scenes.scene", "kbga")
    write_reference(folder, *modules)
    files = {name: folder / f"{name.replace('.', '/')}.html" for name in modules}
    return {name: file.read_text(encoding="utf-8") for name, file in files.items()}


@pytest.mark.parametrize("name", ["Planner", "Planner.plan", "Plan", "Plan.path", "Budget"])
def test_the_page_of_the_plugin_interface_has_what_a_plugin_needs(pages, name):
    assert f'id="{name}"' in pages["suite.planner"]


def test_each_field_of_the_plugin_interface_stands_with_what_it_means(pages):
    said = re.sub("<[^>]*>", " ", pages["suite.planner"].split('<div id="Budget.wall_s"')[1])
    assert "Seconds of wall time." in said[:400]


def test_fields_that_a_class_describes_are_a_list_and_parameters_are_numpys(pages):
    page = pages["suite.scenes.scene"]
    assert re.search("<li><strong>queries</strong>: .*tuple of", page)
    assert re.search("<h6 .*>Parameters</h6>", page)


def test_the_table_of_the_paper_is_a_table_with_links(pages):
    row = next(row for row in pages["kbga"].split("<tr>") if "population size 50" in row)
    assert 'href="#KBGASettings.population_size"' in row


def test_what_a_docstring_says_below_a_heading_is_left_to_pdoc():
    text = "One line.\n\nParameters\n----------\nscene : Scene\n    Of the room.\n"
    assert prepared(text) == text


@pytest.mark.slow
def test_there_is_a_page_for_every_module_of_the_suite(tmp_path):
    command = [sys.executable, "-m", "tests.reference", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    modules = [file for file in (ROOT / "suite").rglob("*.py") if file.name[0] != "_"]
    wanted = {file.relative_to(ROOT).with_suffix(".html").as_posix() for file in modules}
    made = {file.relative_to(tmp_path).as_posix() for file in tmp_path.rglob("*.html")}
    assert wanted <= made
    assert {"index.html", "kbga.html", "baselines/ompl.html"} <= made
