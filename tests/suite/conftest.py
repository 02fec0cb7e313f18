"""Scenes, and a distribution of planners that is installed like anyone's."""

import os
from pathlib import Path

import pytest
import shapely

from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene
from tests.suite.harness.hostile_site import make_site, write_wall


@pytest.fixture(scope="session")
def hostile_site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the hostile planners and their metadata, as an installer would leave it."""
    return make_site(tmp_path_factory.mktemp("site"))


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
    write_wall(file)
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
