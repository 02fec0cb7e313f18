import subprocess
import sys
from dataclasses import FrozenInstanceError, dataclass
from pathlib import Path
from typing import Literal

import pytest

from suite.errors import PluginError
from suite.planner import Plan, Planner, PlanStatus
from suite.plugins.discovery import available_planners, load_planner, planner_names, planner_version
from suite.plugins.settings import make_settings
from suite.typed import plain

GOOD = """
from dataclasses import dataclass
from suite.planner import Abilities, Plan, Planner, PlanStatus

class Walk(Planner):
    name = "walk"
    abilities = Abilities(anytime=True)

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.EXHAUSTED)

class Renamed(Walk):
    name = "another-name"

class Unfinished(Planner):
    name = "unfinished"

class Short(Walk):
    name = "short"

    def plan(self, scene, query):
        return Plan(PlanStatus.EXHAUSTED)

class Newer(Walk):
    name = "newer"
    interface = 2

class Loose(Walk):
    name = "loose"
    Settings = dict

class Needy(Walk):
    name = "needy"

    @dataclass(frozen=True)
    class Settings:
        step: float

class Boastful(Walk):
    name = "boastful"
    abilities = {"anytime": True}

nothing = 42
"""


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Put a real distribution on the path: a module, and metadata that declares planners."""
    monkeypatch.syspath_prepend(tmp_path)
    modules = set(sys.modules)

    def put(name: str, entries: dict[str, str], code: str = "") -> Path:
        module = name.replace("-", "_")
        (tmp_path / f"{module}.py").write_text(code)
        info = tmp_path / f"{module}-1.2.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.2\n")
        lines = [f"{key} = {value}" for key, value in entries.items()]
        text = "\n".join(["[kbga_bench.planners]", *lines, ""])
        (info / "entry_points.txt").write_text(text)
        return tmp_path

    yield put
    for added in set(sys.modules) - modules:
        if str(getattr(sys.modules[added], "__file__", "")).startswith(str(tmp_path)):
            del sys.modules[added]


def row(name: str):
    return next(info for info in available_planners() if info.name == name)


# Discovery


def test_the_planners_of_this_project_are_declared():
    ompl = (
        "rrtstar", "informedrrtstar", "sorrtstar", "bitstar", "aorrtc", "prm", "prmstar", "rrt",
        "rrtconnect", "fmt", "bfmt",
    )  # fmt: skip
    others = ("cmaes", "extremitypathfinder", "grid-astar")
    ours = ("kbga", "plain-ga", "visibility-graph")
    declared = {*ours, *others, *(f"ompl-{name}" for name in ompl)}
    assert declared <= set(planner_names())


def test_listing_names_imports_nothing():
    program = (
        "import sys; from suite.plugins.discovery import planner_names; planner_names();"
        "print([m for m in sys.modules if m.split('.')[0] in ('ompl', 'kbga', 'baselines')])"
    )
    root = Path(__file__).parents[3]
    found = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=root
    )
    assert found.stdout.strip() == "[]"


def test_a_third_party_planner_is_found_and_loaded(install):
    install("walkers", {"walk": "walkers:Walk"}, GOOD)
    assert "walk" in planner_names()
    assert load_planner("walk").name == "walk"
    info = row("walk")
    assert (info.distribution, info.available) == ("walkers", True)
    assert info.version.startswith("1.2 sha256-")
    assert info.reason is None
    assert info.abilities.anytime


@pytest.mark.parametrize("value", [":Walk", "walkers:", "", "no such thing"])
def test_an_entry_point_to_nothing_is_a_row_and_stops_nothing(install, value):
    install("walkers", {"walk": value}, GOOD)
    assert not row("walk").available
    assert row("kbga").available


def test_a_third_party_planner_whose_code_changed_has_another_version(install):
    folder = install("walkers", {"walk": "walkers:Walk"}, GOOD)
    before = planner_version("walk")
    (folder / "walkers.py").write_text(GOOD + "\n# tuned\n")
    assert planner_version("walk") != before
    (folder / "walkers.py").write_text(GOOD)
    assert planner_version("walk") == before


def test_a_misspelt_name_is_answered_with_the_nearest():
    with pytest.raises(PluginError, match=r"no planner 'rrtstar'\. Installed: .*kbga") as error:
        load_planner("rrtstar")
    assert str(error.value).endswith("Did you mean 'ompl-rrtstar'?")


def test_a_name_like_no_other_gets_no_suggestion():
    with pytest.raises(PluginError) as error:
        load_planner("xyzzy")
    assert "Did you mean" not in str(error.value)


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("import no_such_module", "ModuleNotFoundError: No module named 'no_such_module'"),
        ("raise ValueError('not today')", "ValueError: not today"),
        ("import sys; sys.exit(3)", "SystemExit: 3"),
        ("def broken(:", "SyntaxError"),
        ("", "AttributeError"),
    ],
)
def test_a_plugin_that_fails_to_import_is_a_row_and_stops_nothing(install, code, reason):
    install("broken-plugin", {"broken": "broken_plugin:Broken"}, code)
    info = row("broken")
    assert not info.available
    assert info.reason.startswith("unavailable: ")
    assert reason in info.reason
    assert info.distribution == "broken-plugin"
    assert row("visibility-graph").available
    with pytest.raises(PluginError, match="planner 'broken' is unavailable: ") as error:
        load_planner("broken")
    assert reason in str(error.value)


def test_a_plugin_that_says_itself_why_it_is_unavailable_is_quoted(install):
    code = (
        "from suite.errors import PluginError\n"
        "raise PluginError('it needs boots. Install them with: pip install boots')"
    )
    install("walkers", {"walk": "walkers:Walk"}, code)
    said = "unavailable: it needs boots. Install them with: pip install boots"
    assert row("walk").reason == said
    with pytest.raises(PluginError) as error:
        load_planner("walk")
    assert str(error.value) == f"planner 'walk' is {said}"


@pytest.mark.parametrize(
    ("name", "attribute", "reason"),
    [
        ("nothing", "nothing", "is not a subclass of suite.planner.Planner"),
        ("walker", "Renamed", "calls itself 'another-name'"),
        ("unfinished", "Unfinished", "does not define plan"),
        ("short", "Short", "has plan(self, scene, query). It must be plan(self, scene, query, bu"),
        ("newer", "Newer", "is written for version 2 of the plugin interface; this kbga-bench has"),
        ("loose", "Loose", "has Settings that are not a dataclass"),
        ("needy", "Needy", "has Settings that can't be made without arguments (TypeError: "),
        ("boastful", "Boastful", "has abilities of the type dict"),
    ],
)
def test_what_is_no_planner_of_that_name_is_unavailable(install, name, attribute, reason):
    install("walkers", {name: f"walkers:{attribute}"}, GOOD)
    assert reason in row(name).reason
    with pytest.raises(PluginError, match=f"planner '{name}' is unavailable"):
        load_planner(name)


def test_two_plugins_of_one_name_are_ambiguous_and_both_are_named(install):
    install("walkers", {"walk": "walkers:Walk"}, GOOD)
    install("hikers", {"walk": "hikers:Walk"}, GOOD)
    info = row("walk")
    assert not info.available
    assert "walkers" in info.reason
    assert "hikers" in info.reason
    with pytest.raises(PluginError, match="both declare it"):
        load_planner("walk")


# Settings


@dataclass(frozen=True)
class SomeSettings:
    population: int = 50
    rate: float = 0.2
    elitist: bool = True
    label: str = "plain"
    limit: int | None = None
    kind: Literal["grid", "free"] = "grid"
    weights: tuple[float, ...] = (1.0,)

    def __post_init__(self) -> None:
        if self.population < 2:
            raise ValueError(f"population is {self.population}. Two or more are needed.")


class Some(Planner):
    name = "some"
    Settings = SomeSettings

    def plan(self, scene, query, budget, rng, recorder):  # noqa: ARG002
        return Plan(PlanStatus.EXHAUSTED)


@pytest.mark.parametrize(
    ("key", "written", "value"),
    [
        ("population", 40, 40),
        ("population", "40", 40),
        ("rate", 0.5, 0.5),
        ("rate", 1, 1.0),
        ("rate", "1e-3", 0.001),
        ("elitist", False, False),
        ("elitist", "false", False),
        ("elitist", "Yes", True),
        ("label", "40", "40"),
        ("limit", "none", None),
        ("limit", "7", 7),
        ("limit", 7, 7),
        ("kind", "free", "free"),
        ("weights", [1, 2], (1.0, 2.0)),
        ("weights", "1, 2.5", (1.0, 2.5)),
    ],
)
def test_values_take_the_type_that_the_field_declares(key, written, value):
    got = getattr(make_settings(Some, {key: written}), key)
    assert got == value
    assert type(got) is type(value)


def test_no_values_give_the_defaults():
    assert make_settings(Some, {}) == SomeSettings()


def test_made_settings_are_frozen():
    with pytest.raises(FrozenInstanceError):
        make_settings(Some, {}).population = 3


@pytest.mark.parametrize(
    ("key", "written", "wanted"),
    [
        ("population", "forty", "a whole number"),
        ("population", 4.5, "a whole number"),
        ("population", True, "a whole number"),
        ("rate", "fast", "a number"),
        ("elitist", "maybe", "true or false"),
        ("elitist", 1, "true or false"),
        ("label", 3, "a string"),
        ("limit", "few", "a whole number or none"),
        ("kind", "loose", "one of 'free', 'grid'"),
        ("weights", "1, x", "a list (a number, ...)"),
    ],
)
def test_a_value_of_the_wrong_type_names_field_value_and_type(key, written, wanted):
    with pytest.raises(PluginError) as error:
        make_settings(Some, {key: written})
    assert str(error.value) == f"some: {key} is {written!r}. It must be {wanted}."


def test_an_unknown_setting_is_answered_with_the_fields_and_the_nearest():
    with pytest.raises(PluginError) as error:
        make_settings(Some, {"populaton": 40})
    assert str(error.value) == (
        "some: no setting 'populaton'. It has: population, rate, elitist, label, limit, kind, "
        "weights. Did you mean 'population'?"
    )


def test_what_the_settings_refuse_keeps_its_message():
    with pytest.raises(PluginError, match=r"some: population is 1\. Two or more are needed\."):
        make_settings(Some, {"population": "1"})


def test_settings_read_back_as_what_makes_them():
    made = make_settings(Some, {"weights": [1, 2], "limit": 3})
    told = plain(made)
    assert list(told) == ["population", "rate", "elitist", "label", "limit", "kind", "weights"]
    assert told["weights"] == [1.0, 2.0]
    assert make_settings(Some, told) == made
