"""What a planner's file imports from beside it is its own, in every process, and in its version."""

import json
import subprocess
import sys

import pytest

from suite.errors import PluginError
from suite.planner import Budget, Recorder
from suite.plugins.code_hash import code_hash, files_beside
from suite.plugins.discovery import load_planner
from suite.plugins.from_file import VARIABLE, name_plugins, named_plugins
from suite.scenes.catalogue import load_scene
from suite.store.read import read_runs

PLANNER = """
import numpy as np
from suite.planner import Plan, Planner, PlanStatus
{imports}

class Kind(Planner):
    name = "{name}"

    def plan(self, scene, query, budget, rng, recorder):
        {lazy}
        told = {{"told": {told}}}
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]), details=told)
"""


@pytest.fixture(autouse=True)
def as_before(monkeypatch):
    monkeypatch.setenv(VARIABLE, "[]")
    monkeypatch.setattr(sys, "path", list(sys.path))


@pytest.fixture
def told(tmp_path):
    """What a planner of these imports says, with these modules beside it."""

    def run(told, imports="", lazy="pass", name="kind", folder="", **beside):
        place = tmp_path / folder
        for module, text in beside.items():
            file = place / f"{module.replace('__in__', '/')}.py"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        file = place / f"{name}.py"
        file.write_text(PLANNER.format(name=name, imports=imports, lazy=lazy, told=told))
        others = [p.reference for p in named_plugins() if p.name != name]
        name_plugins([*others, str(file)])
        return said(name)

    return run


def said(name):
    scene = load_scene("zigzag")
    planner = load_planner(name)()
    return planner.plan(scene, scene.query(), Budget(), None, Recorder()).details["told"]


def test_two_files_have_each_its_own_module_of_one_name_imported_early_or_late(told):
    words = {"imports": "import utils", "lazy": "import late", "told": "utils.WHO + late.WHO"}
    one = told(**words, name="one", folder="a", utils="WHO = 1", late="WHO = 10")
    two = told(**words, name="two", folder="b", utils="WHO = 2", late="WHO = 20")
    assert (one, two, said("one")) == (11, 22, 11)
    assert "utils" not in sys.modules
    assert "late" not in sys.modules


@pytest.mark.parametrize(
    "imports",
    [
        "from utils import WHO",
        "import utils; WHO = utils.WHO",
        "import utils as u; WHO = u.WHO",
        "from .utils import WHO",
        "import importlib; WHO = importlib.import_module('utils').WHO",
        "from importlib import import_module; WHO = import_module('utils').WHO",
        "WHO = __import__('utils').WHO",
    ],
)
def test_however_it_is_imported_it_is_the_one_beside_and_part_of_the_version(told, imports):
    assert told("WHO", imports, utils="WHO = 1") == 1
    (before,) = named_plugins()
    # As long as before, and in the same second: compiled code of before would be taken for it.
    assert told("WHO", imports, utils="WHO = 2") == 2
    assert named_plugins()[-1].version != before.version


def test_packages_beside_it_import_each_other_and_the_planners_own_file(told):
    assert (
        told(
            "answer()",
            "from parcel.deep.inner import answer",
            parcel__in____init__="",
            parcel__in__deep__in____init__="",
            parcel__in__deep__in__inner="from .. import near\nimport other\n"
            "def answer():\n    import kind\n"
            "    return near.X + other.X + (kind.Kind.name == 'kind')",
            parcel__in__near="X = 1",
            other="X = 10",
        )
        == 12
    )


def test_a_module_called_as_an_installed_one_is_the_planners_and_nobody_elses(told):
    assert told("json.WHO", "import json", json="WHO = 3") == 3
    assert sys.modules["json"] is json
    assert json.loads("1") == 1


def test_the_suites_own_packages_are_never_taken_from_beside(told):
    words = {"suite__in____init__": "raise SystemExit", "kbga__in____init__": "raise SystemExit"}
    assert told("1", "import kbga, suite.planner", **words) == 1


def test_a_folder_without_init_is_a_package_unless_there_is_one_to_be_had(told):
    assert told("box(0, 0, 1, 1).area", "from shapely import box", shapely__in__notes="") == 1
    assert told("plain.X", "import plain_folder.plain as plain", plain_folder__in__plain="X=4") == 4


def test_a_name_that_is_made_as_the_planner_runs_is_refused(told):
    with pytest.raises(PluginError, match=r"utils\.py is imported by a name that is made as the"):
        told("1", "import importlib; importlib.import_module('ut' + 'ils')", utils="")


def test_a_missing_module_is_named_as_its_author_writes_it(told):
    with pytest.raises(PluginError, match=r"No module named 'parcel\.missing'"):
        told("1", "import parcel.missing", parcel__in____init__="")


def test_the_version_is_of_what_is_run_and_of_nothing_else(tmp_path):
    for name in ("mine", "utils", "parcel/__init__", "parcel/utils", "parcel/a"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / f"{name}.py").write_text("")
    (tmp_path / "mine.py").write_text("import parcel.a, fast")
    (tmp_path / "parcel" / "a.py").write_text("from . import utils")
    (tmp_path / "fast.abi3.so").write_bytes(b"")
    found = {str(file.relative_to(tmp_path)) for file in files_beside(tmp_path / "mine.py")}
    inside = {"parcel/__init__.py", "parcel/utils.py", "parcel/a.py"}
    assert found == {"mine.py", "fast.abi3.so", *inside}


def test_modules_that_change_places_are_other_code(tmp_path):
    files = [tmp_path / folder / "same.py" for folder in ("a", "b")]
    for number, file in enumerate(files):
        file.parent.mkdir()
        file.write_text(f"x = {number}")
    before = code_hash(files)
    for number, file in enumerate(reversed(files)):
        file.write_text(f"x = {number}")
    assert code_hash(files) != before


POOLS = """
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
from numbers_of_mine import Number
from suite.geometry.kernels import first_collision
from suite.planner import Abilities, Plan, Planner, PlanStatus

def squared(number):
    return Number(number.value ** 2)

@dataclass(frozen=True)
class PoolsSettings:
    methods: tuple[str, ...] = ()
    kinds: tuple[str, ...] = ("pool", "executor")
    scene: str = ""

class Pools(Planner):
    name = "pools"
    Settings = PoolsSettings
    abilities = Abilities(deterministic=True)

    def plan(self, scene, query, budget, rng, recorder):
        total = 0
        for method in self.settings.methods if scene.name == self.settings.scene else ():
            context = multiprocessing.get_context(method)
            executor = partial(ProcessPoolExecutor, mp_context=context)
            makers = {"pool": context.Pool, "executor": executor}
            for kind in self.settings.kinds:
                with makers[kind](1) as pool:
                    total += sum(n.value for n in pool.map(squared, [Number(2), Number(3)]))
        path = np.array([query.start, query.goal])
        if first_collision(path, scene.arrays) >= 0:
            return Plan(PlanStatus.EXHAUSTED, details={"total": total})
        return Plan(PlanStatus.SOLVED, path, details={"total": total})
"""


@pytest.fixture(scope="module")
def pools(tmp_path_factory):
    file = tmp_path_factory.mktemp("pools") / "pools.py"
    file.write_text(POOLS)
    file.with_name("numbers_of_mine.py").write_text(
        "class Number:\n    def __init__(self, value):\n        self.value = value\n"
    )
    return file


def kbga_bench(*arguments, code):
    done = subprocess.run(
        [sys.executable, "-m", "suite", *map(str, arguments)], capture_output=True, text=True
    )
    assert done.returncode == code, done.stderr
    return done.stdout


def all_and(ordinary):
    """Two of the six ways to start a pool; all of them in the long tests."""
    ways = ["fork pool", "fork executor", "spawn pool", "spawn executor"]
    ways += ["forkserver pool", "forkserver executor"]
    marks = [() if way == ordinary else pytest.mark.slow for way in ways]
    return [pytest.param(*w.split(), marks=m, id=w) for w, m in zip(ways, marks, strict=True)]


@pytest.mark.parametrize(("method", "kind"), all_and("spawn pool"))
def test_its_pools_find_what_they_are_sent_in_plan(pools, wall_file, method, kind):
    words = ("--set", f"methods={method}", "--set", f"kinds={kind}", "--set", "scene=wall")
    told = kbga_bench("plan", wall_file, "--planner", "pools", "--plugin", pools, *words, code=1)
    assert ": exhausted\n" in told


@pytest.mark.parametrize(("method", "kind"), all_and("forkserver executor"))
def test_its_pools_find_what_they_are_sent_in_a_matrix(pools, wall_file, tmp_path, method, kind):
    matrix, store = tmp_path / "m.toml", tmp_path / "s.db"
    matrix.write_text(
        f'scenes = ["{wall_file}"]\nseeds = 1\n[[planner]]\nplanner = "pools"\n'
        f'settings = {{ methods = ["{method}"], kinds = ["{kind}"], scene = "wall" }}\n'
    )
    kbga_bench("run", matrix, "--store", store, "--plugin", pools, code=0)
    (row,) = read_runs(store).to_dict("records")
    assert (row["status"], row["reason"]) == ("exhausted", None)
    assert json.loads(row["details"])["total"] == 13


@pytest.mark.parametrize(("method", "kind"), all_and("spawn executor"))
def test_its_pools_find_what_they_are_sent_in_check(pools, method, kind):
    words = ("--set", f"methods={method}", "--set", f"kinds={kind}", "--set", "scene=seam")
    told = kbga_bench("check", "pools", "--plugin", pools, *words, code=0)
    assert "kept      runs-end-without-an-exception\n" in told
    assert "kept      same-path-in-another-process\n" in told
