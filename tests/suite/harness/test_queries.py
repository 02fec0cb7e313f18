"""Which queries a matrix runs, with what robot, and what becomes of those that can't be asked."""

import textwrap
from collections import Counter
from pathlib import Path

import pytest
import shapely

from suite.errors import MatrixError
from suite.harness import matrix as matrix_module
from suite.harness import run as harness_run
from suite.harness.cell import run_cell
from suite.harness.forecast import forecast_matrix
from suite.harness.fork_server import LONGEST, Warmth, _read
from suite.harness.matrix import load_matrix
from suite.harness.matrix_file import QuerySample, outline
from suite.harness.prepared import exact_optimum
from suite.harness.queries import chosen_queries
from suite.harness.run import run_matrix, to_run
from suite.harness.single import cell_for
from suite.planner import PlanStatus
from suite.scenes.catalogue import load_scene
from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene
from suite.store import record as record_module
from suite.store.read import read_runs
from suite.store.write import open_store

PLANNERS = '[[planner]]\nplanner = "visibility-graph"\n'
ROOM = shapely.box(0, 0, 10, 10)
WALL = shapely.box(4, 0, 6, 7)


@pytest.fixture
def matrix(tmp_path):
    boxes = shapely.MultiPolygon([shapely.box(0, 0, 2, 1), shapely.box(8, 8, 9, 9)])
    (tmp_path / "map.wkt").write_text(boxes.wkt)
    queries = {f"{i}-{j}": ((1 + i, 1), (9, 1 + j)) for i in range(2) for j in range(3)}
    strata = {name: name[0] for name in queries}
    scene = make_scene("hall", ROOM, [WALL], queries, strata=strata)
    write_scene(scene, tmp_path / "hall.geojson")

    def load(text, planners=PLANNERS):
        file = tmp_path / "m.toml"
        file.write_text(textwrap.dedent(text) + "seeds = 1\n" + planners)
        return load_matrix(file)

    return load


def asked(matrix):
    return [[query.name for query in queries] for queries in matrix.queries]


def test_all_queries_of_a_scene_are_run_unless_some_are_named(matrix):
    everything = ["0-0", "0-1", "0-2", "1-0", "1-1", "1-2"]
    assert asked(matrix('scenes = ["hall.geojson"]\n')) == [everything]
    assert asked(matrix('scenes = ["hall.geojson"]\nqueries = "all"\n')) == [everything]
    named = 'scenes = ["hall.geojson", { scene = "maze", queries = ["main", "10,20:45,80.5"] }]\n'
    assert asked(matrix(named + 'queries = ["1-2", "1,1:9,9"]\n')) == [
        ["1-2", "1,1:9,9"], ["main", "10,20:45,80.5"],
    ]  # fmt: skip


def test_a_sample_is_drawn_for_each_scene_and_is_the_same_again(matrix):
    text = """
    scenes = ["map.wkt", "maze", { scene = "hall.geojson", queries = { random = 2, seed = 1 } }]
    queries = { random = 30, seed = 1, min_distance = 4.0 }
    """
    found, again = matrix(text), matrix(text)
    assert asked(found) == asked(again)
    assert [len(queries) for queries in found.queries] == [30, 30, 2]
    cells = found.cells()
    assert len({cell.key for cell in cells}) == len(cells) == 62
    assert [c.scene_hash for c in cells] == [
        cell_for(c.scene_source, "visibility-graph", seed=0, query=c.query).scene_hash
        for c in cells
    ]


def test_a_robot_and_snapping_are_part_of_the_scene_and_its_name(matrix):
    text = """
    scenes = ["maze@turn=3", "map.wkt", { scene = "zigzag", radius = 0, snap = false }]
    queries = { random = 3 }
    radius = 0.25
    snap = true
    """
    found = matrix(text)
    names = ["maze@turn=3,radius=0.25,snap=yes", "map@radius=0.25,snap=yes", "zigzag@radius=0"]
    assert [scene.name for scene in found.scenes] == names
    assert found.sources[1].endswith("/map.wkt@radius=0.25,snap=yes")
    assert found.scenes[0].hash == load_scene("maze@turn=3,radius=0.25").hash


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("scenes = ['map.wkt']", "scenes: map: is a map without queries. Write queries = { random"),
        ("scenes = ['maze']\nqueries = ['mian']", "m.toml, queries: maze: no query 'mian'."),
        ("scenes = ['maze']\nqueries = ['main', 'main']", "the query main is named twice"),
        ("scenes = ['maze']\nqueries = 'al'", "queries is 'al'. Give \"all\", a list of names"),
        ("scenes = ['maze']\nqueries = {}", "queries: give either random = 100 or per_stratum = 2"),
        ("scenes = ['maze']\nqueries = { random = 0 }", "random is 0. Give a whole number, 1 to"),
        ("scenes = ['maze']\nqueries = { rnadom = 9 }", "unknown key 'rnadom'."),
        ("scenes = ['maze']\nqueries = { random = 1, per_stratum = 1 }", "give either random"),
        ("scenes = ['maze']\nqueries = { per_stratum = 1, connected = true }", "connected is for"),
        ("scenes = ['maze']\nqueries = { per_stratum = 2 }", "its queries have no strata."),
        (
            "scenes = [{ scene = 'maze', queries = { random = 2, min_distance = 900.0 } }]",
            "scenes 1, queries: maze: min_distance is 900 m, and free space is 141.421 m across.",
        ),
        ("scenes = ['maze']\nradius = -1", "radius is -1. Give the robot's radius in metres, of 0"),
        ("scenes = ['maze@radius=1']\nradius = 1", "radius comes twice. Give it once."),
        ("scenes = ['maze']\nradius = 60", "a robot of radius 60.0 m has no room in the"),
        (
            "scenes = ['door@turn=2']",
            "its obstacles move, hide or vanish. Give the matrix a [[world]], in which a robot "
            "drives through it, or name the scene as it is at a time, standing still: "
            "door@turn=2,at=0.",
        ),
    ],
)  # fmt: skip
def test_what_can_not_be_asked_is_refused_with_what_to_write(matrix, text, message):
    with pytest.raises(MatrixError) as caught:
        matrix(f"{text}\n")
    assert message in str(caught.value)


def test_of_the_strata_of_a_map_so_many_are_taken():
    strata = {f"{i}-{j}": str(i) for i in range(2) for j in range(3)}
    ends = {name: ((1, 1), (9, 1 + i / 10)) for i, name in enumerate(strata)}
    bucketed = make_scene("hall", ROOM, [WALL], ends, strata=strata)
    chosen = chosen_queries(bucketed, QuerySample(per_stratum=2, seed=3))
    assert [query.stratum for query in chosen] == ["0", "0", "1", "1"]


def test_a_frozen_scene_needs_no_world(matrix):
    [cell] = matrix('scenes = ["door@at=3"]\n').cells()
    assert run_cell(cell).status is PlanStatus.SOLVED


# Queries that can't be asked

BLOCKED = """
scenes = [{ scene = "maze", queries = ["10,20:45,80", "10,20:22.62,8.2", "-5,1:45,80"] }]
radius = 0.5
"""


def test_a_blocked_query_is_refused_for_every_planner_and_nothing_is_started_for_it(
    matrix, hostile, tmp_path, monkeypatch
):
    wanted = matrix(BLOCKED, PLANNERS + '[[planner]]\nplanner = "raises"\n')
    started = []
    own = harness_run.run_each

    def watched(cells, *rest):
        started.extend(cells)
        own(cells, *rest)

    monkeypatch.setattr(harness_run, "run_each", watched)
    told = forecast_matrix(
        wanted, tmp_path / "s.db", jobs=1, quick=False, which=harness_run.Which.MISSING
    )
    assert told.as_text().startswith("2 of 6 runs would be run; 4 need not be.")
    with open_store(tmp_path / "s.db") as store:
        end = run_matrix(wanted, store, jobs=1)
        again = run_matrix(wanted, store, jobs=1)
    assert {cell.query for cell in started} == {"10,20:45,80"}
    assert (end.done, end.failed, again.done - again.found) == (6, 1, 0)
    runs = read_runs(tmp_path / "s.db")
    refused = runs[runs["status"] == "refused"]
    assert len(refused) == 4
    assert refused["optimum"].isna().all()
    assert refused["reason"].str.contains("grown by the robot's radius|made smaller by").all()
    assert list(runs["query"]) == ["10,20:45,80"] * 2 + ["10,20:22.62,8.2"] * 2 + ["-5,1:45,80"] * 2


def test_a_matrix_of_blocked_queries_alone_ends_well(matrix, tmp_path):
    wanted = matrix(BLOCKED.replace('"10,20:45,80", ', ""))
    with open_store(tmp_path / "s.db") as store:
        end = run_matrix(wanted, store, jobs=1)
    assert (end.wanted, end.done, end.failed, end.contended) == (2, 2, 0, 0)


def test_a_blocked_query_is_refused_wherever_it_is_run(hostile):
    cell = cell_for("maze", "raises", seed=0, query="22,9.5:500,1")
    record = run_cell(cell)
    assert (record.status, record.optimum, record.wall_s) == (PlanStatus.REFUSED, None, None)
    assert record.reason.startswith("maze, goal of query '22,9.5:500,1': (500, 1) lies outside")
    assert exact_optimum("maze", "22,9.5:500,1") is None


# Thousands


def test_of_thousands_of_queries_each_is_hashed_once_and_each_cell(matrix, monkeypatch):
    planners = "".join(f'[[planner]]\nname = "p{i}"\nplanner = "kbga"\n' for i in range(8))
    wanted = matrix('scenes = ["maze"]\nqueries = { random = 2000 }\n', planners)
    calls = Counter()

    def counted(module, name):
        own = getattr(module, name)

        def count(*arguments):
            calls[name] += 1
            return own(*arguments)

        monkeypatch.setattr(module, name, count)

    counted(matrix_module, "scene_fingerprint")
    counted(record_module, "short_hash")
    cells = wanted.cells()
    missing = to_run(cells, {}, harness_run.Which.MISSING)
    harness_run.Progress.at_first(cells, missing, {})
    assert len({cell.key for cell in cells}) == 16_000
    assert calls == {"scene_fingerprint": 2000, "short_hash": 16_000}


def test_a_fork_server_hears_of_thousands_of_queries_in_variables_that_a_system_takes(monkeypatch):
    queries = tuple(("a_map_with_a_long_name.yaml", f"{i}.125,{i}.5:1,2") for i in range(9000))
    warmth = Warmth(planners=(("kbga", "{}"),), queries=queries)
    told = warmth.environment()
    assert max(len(text) for text in told.values()) <= LONGEST
    for name, text in told.items():
        monkeypatch.setenv(name, text)
    read = _read()
    assert read["queries"] == {queries[0][0]: [name for _, name in queries]}
    assert read["planners"] == [["kbga", "{}"]]
    assert _read() is None


def test_an_outline_counts_queries_where_the_file_does(tmp_path, monkeypatch):
    from suite.harness import matrix_file

    file = tmp_path / "m.toml"
    file.write_text('scenes = ["a", "b"]\nseeds = 3\nqueries = { random = 50 }\n' + PLANNERS)
    monkeypatch.setattr(matrix_file, "matrix_file", lambda _: file)
    assert outline("m")["runs"] == 2 * 3 * 50


def test_the_matrix_of_the_readme_has_ten_lines_and_asks_for_a_hundred_queries(matrix):
    readme = (Path(harness_run.__file__).parent / "README.md").read_text()
    [text] = [block for block in readme.split("```toml\n")[1:] if "random = 100" in block]
    lines = text.partition("```")[0].splitlines()
    assert len(lines) <= 10
    shown = "\n".join(lines).replace("tb3_sandbox.yaml", "maze").replace("seeds = 1\n", "")
    found = matrix(shown + "\n", planners="")
    assert [scene.name for scene in found.scenes] == ["maze@radius=0.2"]
    assert (len(found.queries[0]), len(found.cells())) == (100, 400)
