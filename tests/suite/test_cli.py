"""The command as users run it: real processes, a real store, planners of a stranger."""

import json
import os
import sqlite3
import sys
import time
import warnings
from contextlib import closing

import PIL.Image
import pytest
import shapely

from suite.cli import main
from suite.errors import KbgaBenchError
from suite.harness.single import cell_for
from suite.planner import PlanStatus
from suite.scenes.catalogue import aligned_names, load_scene
from suite.scenes.dynamics import Dynamics, constant_speed
from suite.scenes.geojson import read_scene, write_scene
from suite.scenes.scene import Obstacle, make_scene
from suite.store.read import read_runs
from tests.suite.commands import Done, in_own_process


@pytest.fixture
def kbga_bench(monkeypatch, capsys):
    """The command in this process, where everything is imported already."""

    def run(*arguments, code=0):
        monkeypatch.setattr(sys, "argv", ["kbga-bench", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught, warnings.catch_warnings():
            main()
        done = Done(int(caught.value.code or 0), *capsys.readouterr())
        assert done.code == code, done.err
        return done

    return run


@pytest.fixture
def error_of(kbga_bench):
    def run(*arguments):
        done = kbga_bench(*arguments, code=2)
        assert done.out == ""
        return done.err

    return run


@pytest.fixture(scope="module")
def filled(hostile_site, wall_file, tmp_path_factory):
    """A store with rows of two planners, made by the command itself."""
    folder = tmp_path_factory.mktemp("filled")
    (folder / "m.toml").write_text(
        f'scenes = ["{wall_file}"]\nseeds = 2\n[[planner]]\nplanner = "wanderer"\n'
        '[[planner]]\nplanner = "gives-up"\n'
    )
    env = {**os.environ, "PYTHONPATH": str(hostile_site)}
    in_own_process("run", folder / "m.toml", "--store", folder / "s.db", "--jobs", 2, env=env)
    return folder / "s.db"


def test_lists_are_json_for_programs(kbga_bench):
    scenes = json.loads(kbga_bench("list", "scenes", "--format", "json").out)
    zigzag = next(scene for scene in scenes if scene["name"] == "zigzag")
    assert zigzag["obstacles"] == 5
    assert {"path", "vertices", "parts", "optimum"} <= set(zigzag)
    scattered = next(scene for scene in scenes if scene["name"] == "scattered_300")
    assert (scattered["generated"], scattered["parts"], scattered["path"]) == (True, 300, None)
    assert set(scattered) == set(zigzag)
    dynamic = [scene["name"] for scene in scenes if scene["dynamic"] and not scene["control"]]
    assert dynamic == ["door", "unknown_obstacles", "moving-0"]
    assert [scene["name"] for scene in scenes if scene["control"]] == aligned_names()
    matrices = json.loads(kbga_bench("list", "matrices", "--format", "json").out)
    paper = next(matrix for matrix in matrices if matrix["name"] == "paper-static")
    assert paper["runs"] == 8 * 9 * 20


def test_a_plugin_that_cannot_be_imported_is_listed_with_the_reason(kbga_bench, hostile):
    planners = json.loads(kbga_bench("list", "planners", "--format", "json").out)
    broken = next(planner for planner in planners if planner["name"] == "broken")
    assert not broken["available"]
    assert "no_such_module" in broken["reason"]
    said = kbga_bench("list", "planners").out
    assert "wanderer" in said
    assert "unavailable: ModuleNotFoundError" in " ".join(said.split())
    assert "unavailable: unavailable" not in said


@pytest.mark.parametrize("what", ["scenes", "planners", "matrices"])
def test_lists_for_people_fit_a_page_and_name_no_path(what):
    # Other tests put plugins with long names into this process.
    lines = in_own_process("list", what).out.splitlines()
    assert max(map(len, lines)) <= 102
    assert not any("/suite/" in line for line in lines)
    known = {"scenes": "zigzag", "planners": "kbga", "matrices": "paper-static"}[what]
    assert known in {line.split()[0] for line in lines}


SIMULATE = ("simulate", "door", "--planner", "kbga", "--charge", "zero")


def test_a_simulation_says_how_the_robot_fared_as_json_and_in_words(kbga_bench):
    arguments = (*SIMULATE, "--seed", 3, "--speed", 5)
    done = json.loads(kbga_bench(*arguments, "--format", "json").out)
    assert (done["reached"], done["hits"], done["opening"]) == (True, [], "right")
    assert done["world"]["speed"] == 5.0
    first, *_, last = done["trajectory"]
    ends = load_scene("door").query()
    assert (first, last) == ([0.0, *ends.start], [done["time"], *ends.goal])
    assert {"time", "latency_s", "cost", "status"} <= set(done["replans"][0])
    assert done["waiting_time"] == 0.0
    said = kbga_bench(*arguments).out
    assert said.startswith("door / kbga / seed 3: reached\n  hit          never\n")
    assert "openings     right at" in said


def test_a_simulation_says_the_updates_at_which_something_happened_or_all(kbga_bench):
    arguments = (*SIMULATE, "--seed", 3)
    replans = json.loads(kbga_bench(*arguments, "--format", "json").out)["replans"]
    said = kbga_bench(*arguments).out
    # The door begins to move at once; at 20 s the right channel is shut.
    times = [float(line.split()[0]) for line in said.splitlines() if "optimum" in line]
    assert times == [0.0, 2.0, 20.0]
    assert f"and {len(replans) - 3} more at which nothing else happened" in said
    everything = kbga_bench(*arguments, "--updates").out
    assert everything.count("(optimum ") == len(replans)
    assert "nothing else" not in everything


@pytest.mark.parametrize(
    "press",
    [
        Obstacle("press", shapely.box(0, 6, 3, 9), Dynamics(constant_speed((0.0, -1.0), 0.0, 4.0))),
        Obstacle("press", shapely.box(0, 2, 3, 4), Dynamics(appears=3.0)),
    ],
    ids=["moves onto it", "appears on it"],
)
def test_an_obstacle_that_comes_upon_a_waiting_robot_is_reported(kbga_bench, tmp_path, press):
    file = tmp_path / "press.geojson"
    wall = shapely.box(4, 0, 6, 10)
    ends = ((1, 3), (9, 3))
    write_scene(make_scene("press", shapely.box(0, 0, 10, 10), [wall, press], ends), file)
    simulate = ("simulate", file, "--planner", "visibility-graph", "--time-limit", 9)
    done = json.loads(kbga_bench(*simulate, "--format", "json", code=1).out)
    (hit,) = done["hits"]
    assert (hit["obstacle"], hit["place"]) == ("press", [1.0, 3.0])
    assert hit["time"] == pytest.approx(3.0, abs=1e-5)
    assert "hit          by press at 3.00 s in (1.000, 3.000)" in kbga_bench(*simulate, code=1).out


@pytest.mark.parametrize(
    "scene",
    ["door", *(pytest.param(s, marks=pytest.mark.slow) for s in ("unknown_obstacles", "moving-3"))],
)
def test_two_processes_give_the_same_trajectory_bit_for_bit_when_planning_is_free(
    kbga_bench, scene
):
    wanted = ("simulate", scene, *SIMULATE[2:], "--seed", 3, "--format", "json")
    one, same = (json.loads(run(*wanted).out) for run in (kbga_bench, in_own_process))
    assert len(one["trajectory"]) > 3
    # JSON holds every bit of a float: repr is the shortest text that gives it back.
    assert json.dumps(one["trajectory"]) == json.dumps(same["trajectory"])
    assert [r["cost"] for r in one["replans"]] == [r["cost"] for r in same["replans"]]


def test_a_simulation_that_does_not_reach_its_goal_ends_with_code_1(kbga_bench):
    done = kbga_bench(*SIMULATE, "--time-limit", 3, "--format", "json", code=1)
    assert json.loads(done.out)["outcome"] == "out_of_time"


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("--speed", 0, "world: speed is 0.0. It must be a finite number, above 0."),
        ("--set", "colour=red", "kbga: no setting 'colour'."),
        ("--query", "home", "door: no query 'home'. It has: main."),
    ],
)
def test_a_simulation_that_cannot_be_run_says_why(error_of, option, value, message):
    assert message in error_of(*SIMULATE, option, value)


@pytest.mark.slow
def test_a_simulation_is_drawn_in_snapshots_and_moving(kbga_bench, tmp_path):
    sheet, moving = tmp_path / "door.png", tmp_path / "door.gif"
    drawn = (*SIMULATE, "--time-limit", 0.5, "--plot", sheet, "--animate", moving)
    assert kbga_bench(*drawn, code=1).out.splitlines()[-2:] == [str(sheet), str(moving)]
    for file, kind in ((sheet, "PNG"), (moving, "GIF")):
        with PIL.Image.open(file) as image:
            assert image.format == kind


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ("--plot", "x.txt: figures are .png, .pdf, .svg. Name such a file."),
        ("--animate", "x.txt: animations are .gif, .mp4. Name such a file."),
    ],
)
def test_a_picture_of_a_simulation_is_refused_before_it_is_run(error_of, tmp_path, option, message):
    never = ("simulate", "door", "--planner", "no-such-planner")
    assert message in error_of(*never, option, tmp_path / "x.txt")


def test_a_planner_that_refuses_is_not_simulated(kbga_bench):
    wanted = ("simulate", "door", "--planner", "ompl-rrtstar", "--generations", 9)
    said = kbga_bench(*wanted, code=1).out
    assert "door / ompl-rrtstar / seed 0: refused" in said
    assert (
        "ompl-rrtstar keeps no budget of generations. "
        "Give one that it keeps: checks, cpu_s, wall_s." in said
    )


def test_generate_keeps_a_scene_as_a_file_that_is_the_same_scene(kbga_bench, tmp_path):
    file = tmp_path / "kept.geojson"
    done = kbga_bench("generate", "scattered", "--obstacles", 20, "--seed", 7, "--output", file)
    assert done.out.strip() == str(file)
    by_file, by_name = (
        json.loads(kbga_bench("exact", scene, "--format", "json").out)
        for scene in (file, "scattered_20-7")
    )
    assert by_file == by_name
    assert by_file["scene"] == "scattered_20-7"


def test_generate_keeps_a_scene_of_moving_obstacles_too(kbga_bench, tmp_path):
    file = tmp_path / "kept.geojson"
    kbga_bench("generate", "moving", "--seed", 7, "--output", file)
    assert read_scene(file).hash == load_scene("moving-7").hash


def test_generate_takes_a_number_of_obstacles_if_and_only_if_they_are_scattered(error_of, tmp_path):
    output = ("--output", tmp_path / "s.geojson")
    assert "--obstacles" in error_of("generate", "scattered", *output)
    assert "--obstacles" in error_of("generate", "moving", "--obstacles", 5, *output)
    assert list(tmp_path.iterdir()) == []


def test_generate_says_what_it_can_not_write(error_of, tmp_path):
    generate = ("generate", "scattered", "--output")
    file = tmp_path / "s.geojson"
    assert "0 obstacles. Give 1 to 10000." in error_of(*generate, file, "--obstacles", 0)
    assert "10001 obstacles" in error_of(*generate, file, "--obstacles", 10001)
    assert "scene files are .geojson, .json" in error_of(
        *generate, tmp_path / "s.txt", "--obstacles", 5
    )
    assert "there is no folder" in error_of(*generate, tmp_path / "no" / "s.json", "--obstacles", 5)
    assert list(tmp_path.iterdir()) == []


def test_a_generated_scene_runs_in_a_matrix_and_has_results(kbga_bench, tmp_path):
    matrix, store = tmp_path / "m.toml", tmp_path / "s.db"
    matrix.write_text(
        'scenes = ["scattered_20", "scattered_20-1"]\nseeds = 1\n'
        '[[planner]]\nplanner = "visibility-graph"\n'
    )
    kbga_bench("run", matrix, "--store", store, "--jobs", 2)
    runs = read_runs(store).set_index("scene")
    assert runs["status"].to_dict() == {"scattered_20": "solved", "scattered_20-1": "solved"}
    assert (runs["gap"].abs() < 1e-9).all()
    kbga_bench("results", store, tmp_path / "r", "--leave-out", "comparisons")
    assert (tmp_path / "r" / "scattered_20-1.png").exists()


def test_exact_says_the_optimum_or_that_there_is_none(kbga_bench, wall_file, closed_file):
    found = json.loads(kbga_bench("exact", wall_file, "--format", "json").out)
    assert found["status"] == "solved"
    assert found["optimum"] == pytest.approx(12.0)
    assert found["path"] == [[1, 3], [4, 7], [6, 7], [9, 3]]
    none = json.loads(kbga_bench("exact", closed_file, "--format", "json").out)
    assert (none["status"], none["optimum"], none["path"]) == ("infeasible", None, None)
    assert "there is no path" in kbga_bench("exact", closed_file).out


def test_plan_says_all_in_json(kbga_bench, hostile, wall_file):
    done = kbga_bench(
        "plan", wall_file, "--planner", "wanderer", "--seed", 3, "--set", "reach=0.5",
        "--generations", 5, "--format", "json",
    )  # fmt: skip
    found = json.loads(done.out)
    assert found["status"] == "solved"
    assert found["settings"] == {"reach": 0.5}
    assert found["budget"] == {"wall_s": None, "generations": 5, "checks": None}
    assert (found["collision_checks"], found["computed_checks"]) == (9, None)
    assert (found["generations"], found["generation_of_best"]) == (5, 3)
    assert [cost for _, cost in found["events"]] == [100.0, 50.0]
    assert found["time_to_best_s"] <= found["wall_s"]
    assert found["gap"] == pytest.approx(found["cost"] / found["optimum"] - 1)
    assert found["path"][0] == [1, 3]


def test_what_a_planner_prints_is_no_part_of_the_json(hostile, wall_file):
    planner = ("--planner", "takes-standard-output")
    done = in_own_process("plan", wall_file, *planner, "--format", "json")
    assert json.loads(done.out)["status"] == "solved"
    assert "iteration 1\niteration 2" in done.err


def test_plan_gives_the_same_path_in_two_processes(kbga_bench, hostile, wall_file):
    arguments = ("plan", wall_file, "--planner", "wanderer", "--seed", 7, "--format", "json")
    first, second = (json.loads(run(*arguments).out) for run in (kbga_bench, in_own_process))
    assert first["path"] == second["path"]


def test_plan_ends_with_1_if_there_is_no_path_of_value(kbga_bench, hostile, wall_file):
    done = kbga_bench("plan", wall_file, "--planner", "cheats", code=1)
    assert "invalid" in done.out
    assert "enters obstacle 1" in done.out


def test_plan_draws_the_run(kbga_bench, wall_file, tmp_path):
    picture = tmp_path / "run.png"
    plan = ("plan", wall_file, "--planner", "visibility-graph", "--plot", picture)
    assert kbga_bench(*plan).out.splitlines()[-1] == str(picture)
    done = kbga_bench(*plan, "--format", "json")
    assert json.loads(done.out)["status"] == "solved"
    assert done.err.strip() == str(picture)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_errors_are_one_line_and_come_first(error_of, hostile, wall_file, tmp_path):
    assert "Did you mean 'zigzag'?" in error_of("plan", "zigzga", "--planner", "kbga")
    assert "Did you mean 'wanderer'?" in error_of("plan", wall_file, "--planner", "wandrer")
    plan = ("plan", wall_file, "--planner", "wanderer")
    assert "no setting 'raech'" in error_of(*plan, "--set", "raech=1")
    assert "write it as key=value" in error_of(*plan, "--set", "reach")
    assert "wall_s is -1.0" in error_of(*plan, "--wall-s", -1)
    assert "no query 'x'" in error_of(*plan, "--query", "x")
    assert "figures are .png" in error_of(*plan, "--plot", tmp_path / "x.gif")
    assert "no such store" in error_of("tables", tmp_path / "none.db")
    for line in (error_of("exact", tmp_path / "none.geojson"),):
        assert line.startswith("kbga-bench: error: ")
        assert line.count("\n") == 1


def test_a_bad_matrix_makes_no_store(error_of, tmp_path):
    (tmp_path / "bad.toml").write_text("seeds = 3")
    message = error_of("run", tmp_path / "bad.toml", "--store", tmp_path / "s.db")
    assert "bad.toml: 'planner' is missing: give at least one [[planner]]" in message
    assert not (tmp_path / "s.db").exists()


def test_run_keeps_rows_and_says_how_it_ended(kbga_bench, matrix_file, tmp_path):
    store = tmp_path / "s.db"
    done = kbga_bench("run", matrix_file("wanderer", "raises"), "--store", store, "--jobs", 2)
    assert "4 of 4 runs are in the store: 0 were there, 4 ran now, 2 of these failed." in (done.out)
    assert "error: RuntimeError: no luck today" in done.err
    again = kbga_bench("run", matrix_file("wanderer", "raises"), "--store", store)
    assert "4 were there, 2 of these failed; 0 ran now, 0 of these failed." in again.out
    assert "give --only-failed" in again.out
    assert len(read_runs(store)) == 4


@pytest.mark.parametrize("seed", [2**63, 2**64, -1])
def test_a_seed_that_no_row_can_have_is_refused_before_anything_is_run(
    kbga_bench, error_of, hostile, wall_file, tmp_path, seed
):
    matrix, store = tmp_path / "m.toml", tmp_path / "s.db"
    matrix.write_text(
        f'scenes = ["{wall_file}"]\nseeds = [{seed}]\n[[planner]]\nplanner = "wanderer"\n'
    )
    message = error_of("run", matrix, "--store", store)
    assert f"{seed}. Give whole numbers from 0 to 9223372036854775807." in message
    assert not store.exists()
    error_of("plan", wall_file, "--planner", "wanderer", f"--seed={seed}")
    with pytest.raises(KbgaBenchError, match=f"the seed is {seed}. Seeds are whole numbers from"):
        cell_for(str(wall_file), "wanderer", seed=seed)


def test_the_largest_seed_is_run_and_found_again(kbga_bench, hostile, wall_file, tmp_path):
    matrix, store = tmp_path / "m.toml", tmp_path / "s.db"
    matrix.write_text(
        f'scenes = ["{wall_file}"]\nseeds = [{2**63 - 1}]\n[[planner]]\nplanner = "wanderer"\n'
    )
    kbga_bench("run", matrix, "--store", store)
    assert list(read_runs(store)["seed"]) == [2**63 - 1]
    again = kbga_bench("rerun", store, f"wall/wanderer/{2**63 - 1}")
    assert "the same: solved" in again.out
    assert "no row is called" in kbga_bench("rerun", store, f"wall/wanderer/{2**63}", code=2).err


@pytest.fixture(scope="module")
def published(filled, tmp_path_factory):
    """The folder of results of the store, made in another process."""
    folder = tmp_path_factory.mktemp("published") / "r"
    in_own_process("results", filled, folder)
    return folder


def test_tables_in_every_format(kbga_bench, filled, tmp_path):
    text = kbga_bench("tables", filled).out
    assert "4 runs: 2 solved, 2 without path, of these 0 failed." in text
    assert "Median time (ms) to come within a gap of the optimum" in text
    assert "Median gap (%) after a fixed wall time" in text
    # The rows behind them are too many to be read.
    assert "What it takes to come" not in text
    assert "with --only or --format csv: summary-rows, ranking-rows, fixed-target-rows" in text
    csv = kbga_bench("tables", filled, "--format", "csv").out
    assert csv.startswith("scene,planner,runs,solved")
    assert "scene,planner,target (%),runs,reached,reached (%),time median (ms)" in csv
    assert "| wall" in kbga_bench("tables", filled, "--format", "markdown").out
    assert r"\begin{tabular}" in kbga_bench("tables", filled, "--format", "latex").out
    kbga_bench("tables", filled, "--format", "markdown", "--output", tmp_path / "t")
    assert (tmp_path / "t" / "summary.md").exists()
    assert not (tmp_path / "t" / "summary-rows.md").exists()
    kbga_bench("tables", filled, "--format", "csv", "--output", tmp_path / "t")
    assert (tmp_path / "t" / "summary-rows.csv").exists()


def test_of_the_tables_those_asked_for_are_printed_also_the_long_ones(kbga_bench, filled):
    text = kbga_bench("tables", filled, "--only", "summary-rows", "--only", "summary").out
    assert text.startswith("All measures per scene and planner")
    assert "Results per scene and planner" in text
    assert "Median" not in text


def test_what_to_compare_with_and_which_tables_can_be_chosen_only_of_what_is_there(
    kbga_bench, error_of, filled, tmp_path
):
    only = ("--only", "statistics")
    text = kbga_bench("tables", filled, *only, "--reference", "gives-up").out
    assert "probability that gives-up is better" in text
    assert "no table 'x' of this store. Take one of: summary" in error_of(
        "tables", filled, "--only", "x"
    )
    for command in (("tables", filled), ("report", filled, "-o", tmp_path / "r.html")):
        message = error_of(*command, "--reference", "x")
        assert "no planner 'x' in the store. Take one of: wanderer" in message


def test_results_hold_tables_rows_figures_and_the_manifest(published):
    names = {p.relative_to(published).as_posix() for p in published.rglob("*.*")}
    assert {
        "summary.md",
        "summary.csv",
        "wall.png",
        "fixed-target.md",
        "fixed-budget-rows.csv",
        "ranking.csv",
        "statistics.md",
        "convergence-time.png",
        "ecdf.png",
        "gap-boxes.png",
        "gap-time.png",
        "manifest.json",
        "rows/runs.parquet",
        "rows/paths.parquet",
    } <= names
    manifest = json.loads((published / "manifest.json").read_text())
    assert manifest["runs"] == 4
    assert manifest["by_status"] == {"solved": 2, "exhausted": 2}


def test_rows_that_are_too_many_are_left_out_and_the_manifest_says_so(kbga_bench, filled, tmp_path):
    kbga_bench("results", filled, tmp_path / "r", "--leave-out", "traces", "--leave-out", "events")
    assert {p.name for p in (tmp_path / "r" / "rows").iterdir()} == {
        "runs.parquet",
        "paths.parquet",
    }
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_text())
    assert manifest["made_by"][-1] == (
        "kbga-bench results STORE r --leave-out events --leave-out traces"
    )
    assert not any("traces" in file for file in manifest["sha256"])
    # The tables are of the runs.
    kbga_bench("results", filled, tmp_path / "r", "--leave-out", "runs", code=2)


def test_pictures_of_how_planners_compare_are_left_out_where_there_are_others(
    kbga_bench, filled, tmp_path
):
    kbga_bench("results", filled, tmp_path / "r", "--leave-out", "comparisons")
    assert [picture.name for picture in (tmp_path / "r").glob("*.png")] == ["wall.png"]


def test_pictures_like_the_papers_are_left_out_where_they_stand_elsewhere(kbga_bench, tmp_path):
    (tmp_path / "m.toml").write_text(
        'scenes = ["zigzag"]\nseeds = 1\n[[planner]]\nplanner = "kbga"\n'
    )
    kbga_bench("run", tmp_path / "m.toml", "--store", tmp_path / "s.db")
    few = ("--leave-out", "comparisons")
    for folder, options in (("all", few), ("some", (*few, "--leave-out", "paper-pictures"))):
        kbga_bench("results", tmp_path / "s.db", tmp_path / folder, *options)
    more, less = ({p.name for p in (tmp_path / f).glob("*.png")} for f in ("all", "some"))
    assert more - less == {"paper-fig-8-zigzag.png"}


def test_a_scene_with_more_planners_than_can_be_told_apart_has_no_picture(
    kbga_bench, wall_file, tmp_path
):
    for count in (9, 10):
        matrix, store = tmp_path / f"{count}.toml", tmp_path / f"{count}.db"
        matrix.write_text(
            f'scenes = ["{wall_file}"]\nseeds = 1\n'
            + "".join(
                f'[[planner]]\nname = "v{i}"\nplanner = "visibility-graph"\n' for i in range(count)
            )
        )
        kbga_bench("run", matrix, "--store", store, "--jobs", 2)
        kbga_bench("results", store, tmp_path / str(count), "--leave-out", "comparisons")
        assert (tmp_path / str(count) / "wall.png").exists() == (count == 9)


def test_the_same_store_gives_the_same_bytes(kbga_bench, filled, published, tmp_path):
    kbga_bench("results", filled, tmp_path / "r")
    files = {file.relative_to(published) for file in published.rglob("*.*")}
    assert {file.relative_to(tmp_path / "r") for file in (tmp_path / "r").rglob("*.*")} == files
    for file in files:
        assert (published / file).read_bytes() == (tmp_path / "r" / file).read_bytes(), file


@pytest.mark.parametrize("kind", [pytest.param("pdf", marks=pytest.mark.slow), "svg"])
def test_figures_of_results_are_vectors_if_asked_for_and_the_same_bytes_each_time(
    kbga_bench, filled, tmp_path, kind
):
    few = ("--leave-out", "comparisons", "--figures", kind)
    for name in "ab":
        kbga_bench("results", filled, tmp_path / name / "r", *few)
    first = tmp_path / "a" / "r" / f"wall.{kind}"
    assert first.read_bytes() == (tmp_path / "b" / "r" / f"wall.{kind}").read_bytes()
    assert not list((tmp_path / "a" / "r").glob("*.png"))


def test_export_writes_a_file_for_each_kind_of_row(kbga_bench, filled, tmp_path):
    kbga_bench("export", filled, tmp_path, "--to", "csv")
    assert {p.name for p in tmp_path.glob("*.csv")} == {
        "runs.csv",
        "events.csv",
        "traces.csv",
        "paths.csv",
    }


# Growing, merging, looking at and repeating what is in a store


def test_a_dry_run_says_what_would_run_and_runs_nothing(kbga_bench, matrix_file, tmp_path):
    said = kbga_bench("run", matrix_file("wanderer"), "--store", tmp_path / "s.db", "--dry-run").out
    assert "2 of 2 runs would be run" in said
    assert not (tmp_path / "s.db").exists()


def test_rows_are_forced_to_be_run_again_or_only_those_that_failed(
    kbga_bench, matrix_file, tmp_path
):
    run = ("run", matrix_file("wanderer", "raises"), "--store", tmp_path / "s.db")
    kbga_bench(*run)
    assert "2 were there, 2 ran now, 2 of these failed" in kbga_bench(*run, "--only-failed").out
    assert "0 were there, 4 ran now" in kbga_bench(*run, "--force").out
    kbga_bench(*run, "--force", "--only-failed", code=2)


def test_the_help_of_run_says_what_failed_means(kbga_bench, monkeypatch):
    monkeypatch.setenv("COLUMNS", "300")
    said = kbga_bench("run", "--help").out
    (line,) = [line for line in said.splitlines() if "rows that failed" in line]
    failed, others = line.split("Not those")
    for status in PlanStatus:
        if status is not PlanStatus.SOLVED:
            assert str(status) in (failed if status in PlanStatus.FAILURES else others), status


def test_stores_are_merged_and_conflicts_are_named(kbga_bench, matrix_file, tmp_path):
    one, two = tmp_path / "one.db", tmp_path / "two.db"
    kbga_bench("run", matrix_file("wanderer"), "--store", one)
    kbga_bench("run", matrix_file("raises"), "--store", two)
    said = kbga_bench("run", matrix_file("raises"), "--store", one, "--merge", two).out
    assert "two.db: 2 rows added, 0 were there with the same outcome, 0 with another one." in said
    assert "2 were there, 2 of these failed; 0 ran now" in said
    with closing(sqlite3.connect(two)) as connection, connection:
        connection.execute("UPDATE runs SET status = 'solved' WHERE seed = 0")
    said = kbga_bench("merge", one, two, code=1).out
    assert "0 rows added, 1 were there with the same outcome, 1 with another one." in said
    assert "1 row should be the same bit for bit" in said
    with closing(sqlite3.connect(one)) as first, closing(sqlite3.connect(two)) as second:
        for connection in (first, second):
            with connection:
                connection.execute("UPDATE runs SET budget_wall_s = 1.0")
    assert "as is to be expected where time counts: raises 1." in kbga_bench("merge", one, two).out


def test_status_is_told_in_words_and_as_json(kbga_bench, filled):
    found = json.loads(kbga_bench("status", filled, "--format", "json").out)
    assert {name: found[name] for name in ("wanted", "done", "missing")} == {
        "wanted": 4, "done": 4, "missing": 0,
    }  # fmt: skip
    assert found["by_status"] == {"exhausted": 2, "solved": 2}
    assert "4 of 4 runs done (100 %)" in kbga_bench("status", filled).out


def test_a_row_is_repeated_from_its_own_record(kbga_bench, filled, hostile):
    key = read_runs(filled)["key"].iloc[0]
    found = json.loads(kbga_bench("rerun", filled, key[:8], "--format", "json").out)
    assert (found["key"], found["same"], found["distance"]) == (key, True, 0.0)
    assert "the path is the same bit for bit" in kbga_bench("rerun", filled, key).out
    assert "the same bit for bit" in kbga_bench("rerun", filled, "wall/wanderer/1").out


def test_a_row_that_is_not_there_cannot_be_repeated(error_of, filled):
    assert "no row has a key that begins with 'ffffffff00'" in error_of(
        "rerun", filled, "ffffffff00"
    )


# A machine that is busy


def test_a_plan_may_have_a_budget_of_cpu_time(
    kbga_bench, hostile, wall_file, tmp_path, monkeypatch
):
    # Awake, drowsy sets the clock of its process, which is this one: it is put back afterwards.
    monkeypatch.setattr(time, "process_time", time.process_time)
    drowsy = ("--planner", "drowsy", "--set", f"folder={tmp_path}", "--cpu-s", 2)
    found = json.loads(kbga_bench("plan", wall_file, *drowsy, "--format", "json").out)
    assert found["budget"] == {"wall_s": None, "generations": None, "checks": None, "cpu_s": 2.0}
    assert (found["collision_checks"], found["computed_checks"]) == (7, 3)
    assert found["contended"]
    assert (
        "7, 3 of them computed, the rest from memory" in kbga_bench("plan", wall_file, *drowsy).out
    )


def test_who_keeps_no_cpu_time_says_so(kbga_bench, hostile, wall_file):
    done = kbga_bench("plan", wall_file, "--planner", "wanderer", "--cpu-s", 2, code=1)
    assert "wanderer keeps no budget of cpu_s. Give one that it keeps: generations" in done.out


def test_run_tries_contended_rows_again_while_it_has_patience(
    kbga_bench, matrix_file, tmp_path, monkeypatch
):
    monkeypatch.setattr("suite.harness.patience.OthersLoad", lambda: lambda: 0.0)
    run = ("run", matrix_file("drowsy"), "--store", tmp_path / "s.db")
    folder = matrix_file("drowsy")
    folder.write_text(f'{folder.read_text()}settings = {{folder = "{tmp_path}"}}\n')
    assert "2 rows had no core to run on" in kbga_bench(*run).out
    assert "2 rows had no core for themselves" in kbga_bench("status", tmp_path / "s.db").out
    said = kbga_bench(*run, "--patience", 600).out
    assert "2 were there, 0 ran now" in said
    assert "2 rows had no core and ran again; none still are contended." in said
