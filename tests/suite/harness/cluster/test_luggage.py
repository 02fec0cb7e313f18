import re
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest

from suite.errors import HarnessError
from suite.harness.cluster import worker
from suite.harness.cluster.executors import new_session
from suite.harness.cluster.luggage import Luggage, pack, unpack
from suite.harness.cluster.worker import Answer, describe, end_session, run_for
from suite.harness.fork_server import Warmth
from suite.harness.matrix import Limits
from suite.harness.single import cell_for
from suite.jit import cache_folder
from suite.planner import PlanStatus
from suite.plugins.discovery import load_planner
from suite.plugins.from_file import hand_on, name_plugins
from suite.scenes.catalogue import load_scene
from tests.suite.harness.cluster.dask_on_loopback import wait_until
from tests.suite.harness.cluster.user_folder import write_user_folder


@pytest.fixture
def user(tmp_path, monkeypatch):
    monkeypatch.setenv(
        "NUMBA_CACHE_DIR", str(cache_folder().parents[1])
    )  # kernels need not compile anew
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "there"))
    yield write_user_folder(tmp_path / "user", seeds=1)
    name_plugins([])


def test_scenes_of_the_catalogue_stay_at_home():
    luggage = pack(["zigzag", "zigzag@twin=3", "scattered_50-7"], [])
    assert not luggage
    assert unpack(luggage).source("zigzag@twin=3") == "zigzag@twin=3"


def test_a_scene_file_arrives_with_its_modifiers(user):
    source = f"{user / 'block.geojson'}@turn=17"
    unpacked = unpack(pack([source], []))
    (user / "block.geojson").unlink()
    assert load_scene(unpacked.source(source)).name == "block@turn=17"
    assert unpacked.warmth(Warmth(queries=((source, "main"),))).queries == (
        (unpacked.source(source), "main"),
    )


def test_a_changed_file_lies_in_another_folder_and_an_equal_one_in_the_same(user):
    file = user / "block.geojson"
    first = unpack(pack([str(file)], [])).source(str(file))
    again = unpack(pack([str(file)], [])).source(str(file))
    file.write_text(file.read_text() + "\n")
    changed = unpack(pack([str(file)], [])).source(str(file))
    assert first == again != changed


def test_a_planner_arrives_with_the_modules_that_it_imports(user):
    (plugin,) = name_plugins([str(user / "lucky.py")])
    unpacked = unpack(pack([], [plugin]))
    for file in user.glob("*.py"):
        file.unlink()
    hand_on(unpacked.plugins)
    assert load_planner("lucky").name == "lucky"
    assert unpacked.plugins[0].version == plugin.version


def test_the_data_that_a_planner_names_arrive_with_it(user):
    (user / "tables").mkdir()
    (user / "tables" / "one.txt").write_text("1")
    code = (user / "lucky.py").read_text()
    named = re.sub(r"(\n    name = .*)", r'\1\n    version_files = ("tables",)', code, count=1)
    assert named != code
    (user / "lucky.py").write_text(named)
    (plugin,) = name_plugins([str(user / "lucky.py")])
    (there,) = unpack(pack([], [plugin])).plugins
    assert (Path(there.folder) / "tables" / "one.txt").read_text() == "1"
    hand_on([there])
    assert load_planner("lucky").name == "lucky"
    assert there.version == plugin.version


def test_a_planner_of_a_package_arrives(user, monkeypatch):
    package = user / "mine" / "deep"
    package.mkdir(parents=True)
    (user / "mine" / "__init__.py").touch()
    (package / "__init__.py").touch()
    (user / "lucky.py").rename(package / "lucky.py")
    (user / "detours.py").rename(package / "detours.py")
    text = (package / "lucky.py").read_text().replace("from detours", "from .detours")
    (package / "lucky.py").write_text(text)
    monkeypatch.chdir(user)
    (plugin,) = name_plugins(["mine.deep.lucky:Lucky"])
    (packed,) = pack([], [plugin]).plugins
    assert [name for name, _ in packed.parcel.files] == [
        "mine/__init__.py",
        "mine/deep/__init__.py",
        "mine/deep/detours.py",
        "mine/deep/lucky.py",
    ]
    (arrived,) = unpack(Luggage(plugins=(packed,))).plugins
    assert arrived.reference == plugin.reference
    assert arrived.folder != plugin.folder


def test_a_file_that_is_gone_is_said_before_anything_runs(user):
    source = str(user / "block.geojson")
    (user / "block.geojson").unlink()
    with pytest.raises(HarnessError, match=r"block\.geojson: can't be read, to be sent"):
        pack([source], [])


def test_a_machine_without_room_says_where_it_lacks(user, tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    with pytest.raises(HarnessError, match=r"can't be kept in .*set XDG_CACHE_HOME"):
        unpack(pack([str(user / "block.geojson")], []))


@pytest.mark.slow
def test_a_worker_asks_for_luggage_once(user):
    source = str(user / "block.geojson")
    cell = cell_for(source, "visibility-graph", seed=0)
    luggage = pack([source], [])
    session = new_session(luggage)
    (user / "block.geojson").unlink()
    assert run_for(session, cell, Limits(), Warmth()) is Answer.SEND_LUGGAGE
    for given in (luggage, None):
        record = run_for(session, cell, Limits(), Warmth(), given)
        assert record.status is PlanStatus.SOLVED, record.reason
        assert record.cell is cell


def test_a_worker_does_not_mix_the_planners_of_two_matrices(hostile, user, wall_file):
    first, cell = new_session(), cell_for(str(wall_file), "hangs-in-c", seed=0)
    (plugin,) = name_plugins([str(user / "lucky.py")])
    luggage = pack([], [plugin])
    second, own = new_session(luggage), replace(cell, planner="lucky")
    hand_on([])
    with ThreadPoolExecutor(1) as pool:
        running = pool.submit(run_for, first, cell, Limits(), Warmth())
        try:
            wait_until(lambda: worker._desk.in_flight[first.key])
            with pytest.raises(HarnessError, match="runs another matrix, with other files"):
                run_for(second, own, Limits(), Warmth(), luggage)
        finally:
            while not running.done():
                end_session(first)
                time.sleep(0.05)
    assert running.result().status is PlanStatus.CRASHED
    assert describe(second)["unfit"] is None
