"""What the READMEs promise: links lead somewhere, commands can be given, examples do as told."""

import doctest
import json
import re
import shlex
import subprocess
from dataclasses import fields

import numpy as np
import pytest
import typer

from kbga.settings import KBGAPlusSettings, KBGASettings
from suite.cli import app
from suite.planner import Budget, PlanStatus, Recorder
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene
from suite.scenes.geojson import read_scene
from tests import readme
from tests.readme import ROOT

PAGES = {str(page.relative_to(ROOT)): page for page in (*readme.PAGES, ROOT / "CONTRIBUTING.md")}
TEXTS = {name: page.read_text(encoding="utf-8") for name, page in PAGES.items()}
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", flags=re.DOTALL | re.MULTILINE)


def blocks(page: str, language: str) -> list[str]:
    return [text for found, text in BLOCK.findall(TEXTS[page]) if found == language]


def lines_of(command: str) -> list[str]:
    """The lines of the blocks of all pages that begin with a command."""
    lines = {line for page in PAGES for text in blocks(page, "") for line in text.splitlines()}
    return sorted(line for line in lines if line.startswith(f"{command} "))


def mentions_of(command: str) -> list[str]:
    """What stands between backticks in the prose of all pages, and begins with a command."""
    prose = (BLOCK.sub("", text) for text in TEXTS.values())
    found = {readme.folded(code) for text in prose for code in re.findall(r"`([^`]+)`", text)}
    return sorted(code for code in found if code.startswith(f"{command} "))


def headings(text: str) -> set[str]:
    """The anchors of a page, as GitHub makes them."""
    titles = re.findall(r"^#+ (.*)$", BLOCK.sub("", text), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("name", PAGES)
def test_every_link_leads_somewhere(name):
    missing = []
    for link in re.findall(r"\]\((?!http)([^)]+)\)", TEXTS[name]):
        path, _, anchor = link.partition("#")
        target = (PAGES[name].parent / path).resolve() if path else PAGES[name]
        if not target.exists() or (
            anchor and anchor not in headings(target.read_text(encoding="utf-8"))
        ):
            missing.append(link)
    assert missing == []


def test_the_first_page_is_an_entrance():
    assert len(TEXTS["README.md"].splitlines()) <= 200
    doors = ("results", "suite/scenes", "suite/plugins", "suite/harness", "suite/report", "kbga")
    assert [d for d in (*doors, "baselines") if f"({d}/README.md)" not in TEXTS["README.md"]] == []


@pytest.mark.parametrize("folder", ["kbga", "baselines", "suite/scenes", "suite/plugins"])
def test_the_readme_of_a_folder_names_every_file_in_it(folder):
    files = {file.name for file in (ROOT / folder).glob("*.py")} - {"__init__.py"}
    assert {file for file in files if f"]({file})" not in TEXTS[f"{folder}/README.md"]} == set()


COMMANDS = typer.main.get_command(app)
ABOVE = typer.Context(COMMANDS, info_name="kbga-bench")


@pytest.mark.parametrize("line", lines_of("kbga-bench"))
def test_every_command_of_the_pages_can_be_given(line):
    given = shlex.split(line, comments=True)[1:]
    name, command, arguments = COMMANDS.resolve_command(ABOVE, given)
    command.make_context(name, arguments, parent=ABOVE)


@pytest.mark.parametrize("code", mentions_of("kbga-bench"))
def test_every_command_that_the_prose_mentions_is_there_with_its_options(code):
    name, *rest = shlex.split(code)[1:]
    command = COMMANDS if name == "--help" else COMMANDS.commands[name]
    options = {option for parameter in command.params for option in parameter.opts} | {"--help"}
    assert {word for word in rest if word.startswith("-")} <= options


@pytest.mark.parametrize("line", sorted({*lines_of("make"), *mentions_of("make")}))
def test_every_make_of_the_pages_has_a_rule(line):
    command = shlex.split(line.replace("NAME", "plus"), comments=True)
    ended = subprocess.run([*command, "--dry-run"], capture_output=True, text=True, cwd=ROOT)
    assert ended.returncode == 0, ended.stderr


# suite/plugins/README.md


def test_the_planner_that_is_shown_plans():
    (source,) = blocks("suite/plugins/README.md", "python")
    names: dict = {"__name__": "lucky"}
    exec(compile(source, "lucky.py", "exec"), names)
    scene = load_scene("obstacles_20")
    plan = names["Lucky"]().plan(
        scene, scene.query(), Budget(generations=1000), np.random.default_rng(1), Recorder()
    )
    assert plan.status == PlanStatus.SOLVED
    assert judge(scene, scene.query(), plan.path).valid


# kbga/README.md


def test_the_library_does_what_is_shown():
    shown = "".join(blocks("kbga/README.md", "pycon"))
    parsed = doctest.DocTestParser().get_doctest(shown, {}, "kbga/README.md", None, 0)
    assert len(parsed.examples) >= 5
    told: list[str] = []
    doctest.DocTestRunner().run(parsed, out=told.append)
    assert told == []


def test_every_setting_is_of_one_kind_and_those_of_kbga_plus_are_named():
    text = TEXTS["kbga/README.md"].split("## Settings")[1].split("\n## ")[0]
    table, told = text.split("`kbga-plus` sets")
    operators = ("crossover", "mutation", "repair", "deletion", "improvement")
    theirs = {f"{operator}_probability" for operator in operators}
    named = re.findall(r"`(\w+)`", table.split("|---|---|")[1])
    assert sorted(named) == sorted({field.name for field in fields(KBGASettings)} - theirs)
    ours, plus = KBGASettings(), KBGAPlusSettings()
    differ = {f.name for f in fields(ours) if getattr(ours, f.name) != getattr(plus, f.name)}
    assert set(re.findall(r"`(\w+)`", told)) == differ


# suite/scenes/README.md


def test_the_scene_that_is_shown_can_be_read(tmp_path):
    (text,) = blocks("suite/scenes/README.md", "json")
    (tmp_path / "gate.geojson").write_text(text, encoding="utf-8")
    scene = read_scene(tmp_path / "gate.geojson")
    assert (scene.name, len(scene.obstacles), scene.is_dynamic) == ("gate", 2, True)
    assert json.loads(text)["type"] == "FeatureCollection"
