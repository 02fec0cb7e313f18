"""The house: imports go downstairs only, and nothing of the builder's machine is left in it."""

import ast
import re
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("suite", "kbga", "baselines")
FLOORS = (
    {"errors", "jit", "typed", "geometry", "processes", "paper"},
    {"scenes"},
    {"planner"},
    {"plugins", "referee"},
    {"simulation", "store"},
    {"conformance"},
    {"harness", "report"},
    {"commands"},
    {"cli"},
)
LONGEST_FILE = 700

FILES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
    for package in PACKAGES
    for path in sorted((ROOT / package).rglob("*.py"))
}
TREES = {module: ast.parse(path.read_text(encoding="utf-8")) for module, path in FILES.items()}


def imported(module: str, tree: ast.AST | None = None) -> set[str]:
    """The modules of the house that a module imports, wherever in it."""
    names: set[str] = set()
    for node in ast.walk(tree or TREES[module]):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module} imports relatively"
            below = {f"{node.module}.{alias.name}" for alias in node.names}
            names |= (below & FILES.keys()) or {node.module or ""}
    return {name for name in names if name.split(".")[0] in PACKAGES}


def floor(module: str) -> int:
    """The floor of a module of suite; the package's face is on the ground."""
    room = module.split(".")[1] if "." in module else "errors"
    return next((n for n, rooms in enumerate(FLOORS) if room in rooms), len(FLOORS))


SUITE = [module for module in FILES if module.split(".")[0] == "suite"]


def test_every_room_of_suite_has_a_floor():
    rooms = {module.split(".")[1] for module in SUITE if "." in module}
    assert rooms - set().union(*FLOORS) == set()


@pytest.mark.parametrize("module", SUITE)
def test_suite_imports_from_its_own_floor_and_below(module):
    others = {name for name in imported(module) if not name.startswith("suite")}
    assert others == set(), "planners come in by entry point"
    assert {name for name in imported(module) if floor(name) > floor(module)} == set()


@pytest.mark.parametrize("module", [m for m in FILES if m.startswith("kbga")])
def test_kbga_stands_on_the_two_lowest_floors_but_for_its_plugin(module):
    names = imported(module)
    assert not any(name.startswith("baselines") for name in names)
    highest = max((floor(n) for n in names if n.startswith("suite")), default=0)
    assert highest <= (2 if module == "kbga.plugin" else 1)


@pytest.mark.parametrize("module", [m for m in FILES if m.startswith("baselines")])
def test_of_the_baselines_only_the_plain_ga_imports_kbga(module):
    names = imported(module)
    if module != "baselines.plain_ga":
        assert not any(name.startswith("kbga") for name in names)
    assert max((floor(n) for n in names if n.startswith("suite")), default=0) <= 2


def test_there_is_no_import_cycle():
    graph = {module: imported(module) - {module} for module in FILES}
    while free := [module for module, names in graph.items() if not names & graph.keys()]:
        for module in free:
            del graph[module]
    assert graph == {}


def test_imports_name_the_file_and_not_the_face_of_a_package():
    faces = {module for module, path in FILES.items() if path.name == "__init__.py"}
    assert {(module, name) for module in FILES for name in imported(module) & faces} == set()


def test_only_the_command_line_imports_inside_functions():
    # It loads what the command at hand needs; elsewhere a hidden import dodges a cycle.
    hidden = {
        module
        for module, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and imported(module, node)
    }
    assert {module for module in hidden if not module.startswith("suite.commands.")} == set()


@pytest.mark.parametrize("module", FILES)
def test_files_stay_readable(module):
    assert len(FILES[module].read_text(encoding="utf-8").splitlines()) < LONGEST_FILE


def test_the_wheel_holds_the_three_packages_and_nothing_else():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    find = project["tool"]["setuptools"]["packages"]["find"]
    folders = {path.name for path in ROOT.iterdir() if path.is_dir() and path.name.isidentifier()}
    shipped = {
        name
        for name in folders
        if any(fnmatch(name, p) for p in find["include"])
        and not any(fnmatch(name, p) for p in find["exclude"])
    }
    assert shipped == set(PACKAGES)


def test_every_folder_with_code_is_a_package():
    folders = {path.parent for path in FILES.values()}
    assert [f for f in folders if not (f / "__init__.py").exists()] == []


def texts() -> list[Path]:
    """What people read and machines run: code, settings and prose, without what is made of it."""
    suffixes = {".py", ".toml", ".md", ".cff", ".yaml", ".yml", ".cfg", ".geojson", ""}
    made = re.compile(r"\.(?!ci|git(ignore|hub)|pre-commit)|out$|build$|dist$|.*\.egg-info$")
    tops = [path for path in ROOT.iterdir() if not made.match(path.name)]
    files = [f for top in tops for f in (top.rglob("*") if top.is_dir() else [top])]
    return [f for f in files if f.is_file() and f.suffix in suffixes]


MACHINE = re.compile(
    "|".join(
        (
            "(?<![a-z.])/(work|home|root|Users|mnt|scratch)" + "/",
            r"https?://[\w.-]*(artifactory|nexus|registry|mirror|proxy)",
            "index" + "-url",
            "trusted" + "-host",
            r"https?://(\d+\.){3}\d+",
        )
    )
)


def test_no_file_names_a_path_of_a_machine_or_a_registry():
    named = {
        f"{path.relative_to(ROOT)}: {found.group()}"
        for path in texts()
        if path != Path(__file__).resolve()
        for found in [MACHINE.search(path.read_text(encoding="utf-8", errors="replace"))]
        if found
    }
    assert named == set()
