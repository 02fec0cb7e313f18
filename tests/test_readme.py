"""What the README promises: its planner is a planner, its numbers are in results."""

import doctest
import re
from pathlib import Path

import numpy as np

from suite.planner import Budget, PlanStatus, Recorder
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")


def test_the_planner_of_the_readme_plans():
    (source,) = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
    names: dict = {"__name__": "readme"}
    exec(compile(source, "README.md", "exec"), names)
    planner = names["SmallPRM"]()
    scene = load_scene("obstacles_20")
    plan = planner.plan(
        scene, scene.query(), Budget(generations=4), np.random.default_rng(1), Recorder()
    )
    assert plan.status == PlanStatus.SOLVED
    assert judge(scene, scene.query(), plan.path).valid


def test_the_library_does_what_the_readme_shows():
    blocks = re.findall(r"```pycon\n(.*?)```", README, flags=re.DOTALL)
    parsed = doctest.DocTestParser().get_doctest("".join(blocks), {}, "README.md", None, 0)
    assert len(parsed.examples) >= 5
    told: list[str] = []
    doctest.DocTestRunner().run(parsed, out=told.append)
    assert told == []


def test_every_link_of_the_readme_leads_somewhere():
    links = re.findall(r"\]\((?!http)([^)#]+)\)", README)
    missing = [link for link in links if not (Path(__file__).parents[1] / link).exists()]
    assert missing == []
