"""A store is all that reports need: moved to another folder, without the files of its scenes."""

import json
import shutil
import sqlite3
import sys
import warnings
from contextlib import closing
from pathlib import Path

import pytest
import shapely

from suite.cli import main
from suite.harness.fleet import stop_server
from suite.scenes.dynamics import Detection, Dynamics, constant_speed
from suite.scenes.geojson import write_scene
from suite.scenes.scene import Obstacle, make_scene
from suite.store.read import read_runs
from suite.store.scenes import KeptScenes
from tests.suite.commands import Done, in_own_process

PLANNERS = """
[[planner]]
planner = "kbga"
budget = { generations = 4 }

[[planner]]
planner = "visibility-graph"
"""

STANDING = (
    'name = "standing"\nscenes = ["wall.geojson", "wall.geojson@turn=20,radius=0.3"]\nseeds = 1\n'
)
MOVING = 'name = "moving"\nscenes = ["gate.geojson"]\nseeds = 1\n[[world]]\nname = "calm"\n'
ZERO = 'settings = { charge = "zero" }\n'


@pytest.fixture
def kbga_bench(monkeypatch, capsys):
    def run(*arguments, code=0):
        monkeypatch.setattr(sys, "argv", ["kbga-bench", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught, warnings.catch_warnings():
            main()
        done = Done(int(caught.value.code or 0), *capsys.readouterr())
        assert done.code == code, done.err + done.out
        return done

    return run


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with two matrices, their scenes, and a store that `run` filled."""
    folder = tmp_path_factory.mktemp("made")
    room = shapely.box(0, 0, 10, 10)
    ends = {"one": ((1, 3), (9, 3)), "two": ((1, 8), (9, 2))}
    wall = make_scene("wall", room, [shapely.box(4, 0, 6, 7)], ends)
    write_scene(wall, folder / "wall.geojson")
    door = Obstacle("door", shapely.box(4, 7, 6, 8), Dynamics(constant_speed((0, 0.5), 0, 4)))
    hidden = Obstacle("hidden", shapely.box(7, 1, 8, 4), Dynamics(detection=Detection(2.0)))
    gates = {"above": [[5.0, 7.0], [5.0, 10.0]]}
    gate = make_scene(
        "gate",
        room,
        [shapely.box(4, 0, 6, 7), door, hidden],
        ((1, 3), (9, 3)),
        properties={"gates": gates},
    )
    write_scene(gate, folder / "gate.geojson")
    (folder / "standing.toml").write_text(STANDING + PLANNERS)
    (folder / "moving.toml").write_text(MOVING + ZERO + PLANNERS)
    stop_server()  # one that other tests have warmed hands nothing on
    with pytest.MonkeyPatch.context() as patch:
        for name in ("standing", "moving"):
            words = ["run", folder / f"{name}.toml", "--store", folder / "s.db", "--snapshots", 1]
            patch.setattr(sys, "argv", ["kbga-bench", *map(str, words), "--jobs", "2"])
            with pytest.raises(SystemExit) as caught, warnings.catch_warnings():
                main()
            assert not caught.value.code
    return folder


@pytest.fixture
def moved(made, tmp_path):
    """A copy of the store elsewhere; the scenes are gone."""
    (tmp_path / "elsewhere").mkdir()
    store = tmp_path / "elsewhere" / "other.db"
    shutil.copy(made / "s.db", store)
    for file in made.glob("*.geojson"):
        file.rename(file.with_suffix(".away"))
    yield store
    for file in made.glob("*.away"):
        file.rename(file.with_suffix(".geojson"))


def test_its_report_shows_every_scene(moved, kbga_bench, tmp_path):
    page = tmp_path / "r.html"
    kbga_bench("report", moved, "-o", page)
    text = page.read_text()
    assert "can't be drawn" not in text
    for name in ("wall/one", "wall@turn=20,radius=0.3/two", "gate, calm"):
        assert name in text


def test_its_tables_and_rows_are_had(moved, kbga_bench, tmp_path):
    assert "visibility-graph" in kbga_bench("tables", moved, "--only", "summary").out
    exported = kbga_bench("export", moved, tmp_path / "rows", "--to", "csv").out
    assert "prepare_s" in Path(exported.split()[0]).read_text().splitlines()[0]
    scenes = kbga_bench("export", moved, tmp_path / "scenes", "--to", "scenes").out.split()
    assert "wall@turn=20,radius=0.3.geojson" in {Path(file).name for file in scenes}


@pytest.mark.slow
def test_its_folder_of_results_is_made(moved, kbga_bench, tmp_path):
    made = kbga_bench("results", moved, tmp_path / "r").out
    assert "wall-one.png" in made
    assert "gate-calm.png" in made
    kbga_bench("export", moved, tmp_path / "logs", "--to", "ompl-log")


@pytest.mark.parametrize(
    "row",
    [
        "wall/one/kbga/0",
        "wall@turn=20,radius=0.3/two/kbga/0",
        "wall@turn=20,radius=0.3/one/visibility-graph/0",
        "gate/calm/kbga/0",
    ],
)
def test_its_rows_run_again_bit_for_bit(moved, kbga_bench, row):
    told = kbga_bench("rerun", moved, row).out
    assert "the path is the same bit for bit" in told
    assert "is gone since 1 row ran on it; the store keeps it as it was" in told


def test_merged_into_another_it_takes_its_scenes_along(moved, kbga_bench, tmp_path):
    kbga_bench("merge", tmp_path / "all.db", moved)
    moved_on = tmp_path / "all.db"
    kept = KeptScenes(moved_on)
    assert all(kept.keeps(row) for row in read_runs(moved_on).to_dict("records"))
    assert "bit for bit" in kbga_bench("rerun", moved_on, "wall/two/kbga/0").out
    # And again: nothing comes twice.
    kbga_bench("merge", moved_on, moved)
    assert count(moved_on, "scenes") == count(moved, "scenes") == 3


def count(store, table):
    with closing(sqlite3.connect(store)) as connection:
        return connection.execute(f"SELECT count(*) FROM {table}").fetchone()[0]


def test_status_says_which_files_are_gone(moved, made, kbga_bench):
    told = kbga_bench("status", moved).out
    assert f"{made / 'gate.geojson'} is gone since 2 rows ran on it; the store keeps it" in told
    found = json.loads(kbga_bench("status", moved, "--format", "json").out)["scene_files"]
    assert {(Path(f["file"]).name, f["change"], f["rows"], f["kept"]) for f in found} == {
        ("wall.geojson", "gone", 8, 8),
        ("gate.geojson", "gone", 2, 2),
    }


def test_a_changed_file_is_told_and_rows_stay_those_of_the_scene_that_they_ran_on(
    made, kbga_bench, tmp_path
):
    store, file = tmp_path / "s.db", made / "wall.geojson"
    shutil.copy(made / "s.db", store)
    assert "has changed" not in kbga_bench("status", store).out
    text = file.read_text()
    file.write_text(text.replace("7.0]", "7.5]"))
    try:
        told = kbga_bench("status", store).out
        assert f"{file} has changed since 8 rows ran on it; the store keeps it" in told
        again = kbga_bench("rerun", store, "wall/one/kbga/0").out
        assert "the path is the same bit for bit" in again
        assert "has changed since 1 row ran on it; the store keeps it as it was" in again
        # The new one is run beside it, and is what counts from then on.
        words = ("run", made / "standing.toml", "--store", store, "--snapshots", 0)
        # Not in this process, whose runs come from a server that knows the scene as it was.
        assert "0 were there, 8 ran now, 0 of these failed" in in_own_process(*words).out
        exact = read_runs(store).query("variant == 'visibility-graph' and scene == 'wall'")
        costs = exact[exact["query"] == "one"].groupby("scene_hash")["cost"].unique()
        assert sorted(cost.item() for cost in costs) == [12.0, pytest.approx(2 + 117**0.5)]
        assert count(store, "scenes") == 5
        page = tmp_path / "r.html"
        kbga_bench("report", store, "-o", page)
        assert "can't be drawn" not in page.read_text()
    finally:
        file.write_text(text)


def test_a_file_that_was_written_anew_with_the_same_scene_is_no_change(made, kbga_bench, tmp_path):
    file = made / "wall.geojson"
    text = file.read_text()
    file.write_text(text + "\n\n")
    try:
        assert "has changed" not in kbga_bench("status", made / "s.db").out
    finally:
        file.write_text(text)


def test_a_store_of_before_scenes_were_kept_says_what_it_lacks_until_its_matrix_is_run_again(
    made, kbga_bench, tmp_path
):
    store, file = tmp_path / "old.db", made / "wall.geojson"
    shutil.copy(made / "s.db", store)
    with closing(sqlite3.connect(store)) as connection, connection:
        connection.executescript(
            "DROP TABLE queries; DROP TABLE scenes;"
            "ALTER TABLE runs DROP COLUMN prepare_s; ALTER TABLE runs DROP COLUMN exact_s;"
        )
    page = tmp_path / "r.html"
    kbga_bench("report", store, "-o", page)
    assert "can't be drawn" not in page.read_text()
    assert "bit for bit" in kbga_bench("rerun", store, "wall/one/kbga/0").out
    file.rename(file.with_suffix(".away"))
    try:
        told = kbga_bench("status", store).out
        assert "wall.geojson is gone since 8 rows ran on it; of 8 rows the store does not" in told
        why = kbga_bench("rerun", store, "wall/one/kbga/0", code=2).err
        assert "wall.geojson: can't be read" in why
        assert "did not keep scenes in the store" in why
        kbga_bench("report", store, "-o", page)
        assert "did not keep scenes in the store" in page.read_text().replace("&#39;", "'")
    finally:
        file.with_suffix(".away").rename(file)
    words = ("run", made / "standing.toml", "--store", store, "--snapshots", 0)
    assert "8 were there, 0 ran now" in kbga_bench(*words).out
    kept = KeptScenes(store)
    rows = read_runs(store).to_dict("records")
    assert {row["scene"] for row in rows if kept.keeps(row)} == {"wall", "wall@turn=20,radius=0.3"}


def test_each_row_says_what_preparing_its_scene_and_its_optimum_took(made):
    runs = read_runs(made / "s.db")
    assert (runs["prepare_s"] > 0.0).all()
    planned = runs[runs["world"].isna()]
    assert (planned["exact_s"] > 0.0).all()
    # Each scene and each optimum is made once, and by the process that all runs come from.
    assert (planned.groupby("scene")["prepare_s"].nunique() == 1).all()
    assert (planned.groupby(["scene", "query"])["exact_s"].nunique() == 1).all()
