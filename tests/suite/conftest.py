"""Scenes, and a distribution of planners that is installed like anyone's."""

import importlib
import inspect
import os
import shutil
import sys
from pathlib import Path

import pytest
import shapely

from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene

HOSTILE = Path(__file__).parent / "harness" / "hostile_planners.py"


@pytest.fixture(scope="session")
def hostile_site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the hostile planners and their metadata, as an installer would leave it."""
    site = tmp_path_factory.mktemp("site")
    shutil.copy(HOSTILE, site / "hostile_planners.py")
    (site / "broken_planner.py").write_text("import no_such_module\n")
    info = site / "hostile-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: hostile\nVersion: 1.0\n")
    sys.path.insert(0, str(site))
    try:
        module = importlib.import_module("hostile_planners")
    finally:
        sys.path.remove(str(site))
    planners = {
        found.name: kind
        for kind, found in inspect.getmembers(module, inspect.isclass)
        if found.__module__ == "hostile_planners" and hasattr(found, "name")
    }
    lines = [f"{name} = hostile_planners:{kind}" for name, kind in planners.items()]
    lines.append("broken = broken_planner:Broken")
    (info / "entry_points.txt").write_text("[kbga_bench.planners]\n" + "\n".join(lines) + "\n")
    return site


@pytest.fixture
def hostile(hostile_site: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The hostile planners, installed for this process and those that it starts."""
    monkeypatch.syspath_prepend(str(hostile_site))
    before = os.environ.get("PYTHONPATH")
    paths = [str(hostile_site), *([before] if before else [])]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))
    return hostile_site


@pytest.fixture(scope="session")
def wall_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scene with a wall between start and goal."""
    file = tmp_path_factory.mktemp("scenes") / "wall.geojson"
    scene = make_scene(
        "wall",
        shapely.box(0, 0, 10, 10),
        [shapely.box(4, 0, 6, 7)],
        {"main": ((1, 3), (9, 3))},
    )
    write_scene(scene, file)
    return file


@pytest.fixture(scope="session")
def closed_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scene whose goal can't be reached."""
    file = tmp_path_factory.mktemp("scenes") / "closed.geojson"
    scene = make_scene(
        "closed",
        shapely.box(0, 0, 10, 10),
        [shapely.box(4, 0, 6, 10)],
        {"main": ((1, 3), (9, 3))},
    )
    write_scene(scene, file)
    return file


@pytest.fixture
def matrix_file(hostile, wall_file, tmp_path):
    """Write a matrix of these planners in a scene with a wall.

    Whoever ends by itself has the time that it needs on a busy machine; a short limit is for those
    that never end.
    """

    def make(*planners, seeds=2, limit_s=600.0):
        file = tmp_path / "matrix.toml"
        text = f'scenes = ["{wall_file}"]\nseeds = {seeds}\n[limits]\nwall_s = {limit_s}\n'
        text += "".join(f'[[planner]]\nplanner = "{planner}"\n' for planner in planners)
        file.write_text(text)
        return file

    return make
