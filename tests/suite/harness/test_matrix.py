import sys
import textwrap
import tomllib

import pytest

from suite.errors import MatrixError
from suite.harness.matrix import Limits, load_matrix
from suite.harness.matrix_file import FOLDER, matrix_names, outline
from suite.planner import Budget
from suite.plugins.discovery import available_planners
from suite.plugins.from_file import name_plugins, named_plugins
from suite.scenes.catalogue import scene_names

GOOD = """
name = "walls"
description = "for tests"
scenes = ["zigzag"]
seeds = 3

[limits]
grace_s = 2

[[planner]]
planner = "visibility-graph"

[[planner]]
name = "again"
planner = "visibility-graph"
budget = { generations = 10, wall_s = 1 }
"""


@pytest.fixture
def written(tmp_path):
    def write(text):
        file = tmp_path / "walls.toml"
        file.write_text(textwrap.dedent(text))
        return file

    return write


def refused(file):
    with pytest.raises(MatrixError) as caught:
        load_matrix(file)
    return str(caught.value)


def test_a_matrix_expands_scene_by_scene_variant_by_variant_seed_by_seed(written):
    matrix = load_matrix(written(GOOD))
    cells = matrix.cells()
    assert [(c.variant, c.seed) for c in cells] == [
        (variant, seed) for variant in ("visibility-graph", "again") for seed in range(3)
    ]
    assert [c.position for c in cells] == list(range(6))
    assert cells[3].budget == Budget(wall_s=1.0, generations=10)
    assert cells[0].distribution == "kbga-bench"
    assert len({c.key for c in cells}) == 6
    assert matrix.limits == Limits(grace_s=2)
    assert matrix.limits.plan_s(cells[3].budget) == 1.5 * 1 + 2


def test_quick_takes_the_first_two_seeds_of_the_same_cells(written):
    matrix = load_matrix(written(GOOD))
    quick = matrix.cells(quick=True)
    assert [c.seed for c in quick] == [0, 1, 0, 1]
    assert {c.key for c in quick} < {c.key for c in matrix.cells()}


def test_scenes_may_be_files_beside_the_matrix(written, wall_file, tmp_path):
    (tmp_path / "my.geojson").write_text(wall_file.read_text())
    matrix = load_matrix(written(GOOD.replace('"zigzag"', '"my.geojson", "maze"')))
    assert [s.name for s in matrix.scenes] == ["wall", "maze"]
    assert matrix.sources == (str(tmp_path / "my.geojson"), "maze")


def test_a_scene_may_be_modified_and_a_range_of_twins_stands_for_each(written, wall_file, tmp_path):
    (tmp_path / "my.geojson").write_text(wall_file.read_text())
    scenes = '"my.geojson@turn=5", "zigzag@twin=1..2"'
    matrix = load_matrix(written(GOOD.replace('"zigzag"', scenes)))
    assert [s.name for s in matrix.scenes] == ["wall@turn=5", "zigzag@twin=1", "zigzag@twin=2"]
    assert matrix.sources[0] == f"{tmp_path / 'my.geojson'}@turn=5"
    assert matrix.sources[1:] == ("zigzag@twin=1", "zigzag@twin=2")


def test_a_file_whose_name_holds_the_mark_is_a_file(written, wall_file, tmp_path):
    (tmp_path / "zigzag@turn=5").write_text(wall_file.read_text())
    matrix = load_matrix(written(GOOD.replace('"zigzag"', '"./zigzag@turn=5"')))
    assert [s.name for s in matrix.scenes] == ["wall"]


def test_a_scene_may_have_seeds_of_its_own(written):
    own = '"maze", { scene = "zigzag@twin=1..2", seeds = [7] }'
    matrix = load_matrix(written(GOOD.replace('"zigzag"', own)))
    cells = [cell for cell in matrix.cells() if cell.variant == "again"]
    assert [(c.scene, c.seed) for c in cells] == [
        ("maze", 0), ("maze", 1), ("maze", 2), ("zigzag@twin=1", 7), ("zigzag@twin=2", 7),
    ]  # fmt: skip
    quick = [cell for cell in matrix.cells(quick=True) if cell.variant == "again"]
    assert [cell.seed for cell in quick] == [0, 1, 7, 7]
    assert {c.key for c in quick} < {c.key for c in cells}


def test_the_matrix_of_alignment_has_every_scene_as_drawn_and_ten_twins_of_each():
    with (FOLDER / "alignment.toml").open("rb") as file:
        entries = tomllib.load(file)["scenes"]
    drawn = [*scene_names(), "maze_aligned", "zigzag_aligned", "double_u_aligned"]
    twins = [{"scene": f"{name}@twin=1..10", "seeds": 5} for name in drawn]
    assert entries == drawn + twins


def test_a_list_of_seeds_is_taken_as_it_is(written):
    matrix = load_matrix(written(GOOD.replace("seeds = 3", "seeds = [5, 2]")))
    assert matrix.seeds == (5, 2)


OF_A_FOLDER = ("real-maps", "real-maps-tuning", "kbga-plus-maps")
"""Matrices whose scenes are the user's maps."""

OF_MANY_SCENES = ("obstacles", "alignment")
"""Matrices that take seconds to be read."""


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow if name in OF_MANY_SCENES else [])
        for name in matrix_names()
        if name not in OF_A_FOLDER
    ],
)
def test_the_outline_of_a_matrix_counts_what_would_be_run(name):
    matrix = load_matrix(name)
    assert outline(name) == {
        "description": matrix.description,
        "scenes": len(matrix.scenes),
        "planners": len(matrix.variants),
        "seeds": len(matrix.seeds),
        "runs": len(matrix.cells()),
    }


def test_settings_are_completed_with_defaults_so_that_keys_do_not_depend_on_how_they_are_written(
    written, hostile
):
    text = GOOD.replace('"visibility-graph"', '"wanderer"', 1)
    implicit = load_matrix(written(text)).cells()[0]
    explicit = load_matrix(
        written(text.replace('"wanderer"', '"wanderer"\nsettings = {reach = 1}'))
    ).cells()[0]
    assert implicit.settings == {"reach": 1.0}
    assert implicit.key == explicit.key


def test_a_plugin_that_cannot_be_imported_is_no_reason_to_refuse_the_matrix(written, hostile):
    matrix = load_matrix(written(GOOD.replace('"visibility-graph"', '"broken"', 1)))
    assert not matrix.variants[0].plugin.available


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("seeds = 3", "seeds = ", "walls.toml: not TOML"),
        ("seeds = 3", "seeds = 0", "seeds is 0. Give a number of seeds, 1 to 1000000, or a list"),
        ("seeds = 3", "seeds = true", "seeds is True"),
        ("seeds = 3", f"seeds = {10**13}", "a number of seeds, 1 to 1000000, or a list"),
        ("seeds = 3", f"seeds = [{2**63}]", "seeds 1: seeds is 9223372036854775808. Give whole"),
        ("seeds = 3", "seeds = []", "seeds is []. Give a number of seeds, 1 to 1000000, or a list"),
        (
            "seeds = 3",
            "seeds = [1, -1]",
            "seeds is -1. Give whole numbers from 0 to 9223372036854775807.",
        ),
        ("seeds = 3", "seeds = [1, 1]", "two seeds are named '1'"),
        ("seeds = 3", "", "'seeds' is missing"),
        ("seeds = 3", "sedes = 3", "unknown key 'sedes'"),
        ('planner = "visibility-graph"', "", "'planner' is missing: give the name of a planner"),
        (
            '"visibility-graph"',
            '"mine"',
            "its file with --plugin, or in the `plugins` of a matrix.",
        ),
        ("seeds = 3", 'seeds = 3\nplugins = "a.py"', "plugins is 'a.py'. Give a list of planners'"),
        ("seeds = 3", 'seeds = 3\nplugins = ["a.py"]', "plugins 1: a.py: there is no file /"),
        ("seeds = 3", 'seeds = 3\nplugins = ["a"]', "plugins 1: a: neither a .py file nor a class"),
        ("seeds = 3", "seeds = 3\nseedz = 3", "Did you mean 'seeds'?"),
        (
            '["zigzag"]',
            "[]",
            "walls.toml, scenes: it names none. Name some, or a folder of maps with --maps.",
        ),
        ('["zigzag"]', '["zigzga"]', "Did you mean 'zigzag'?"),
        ('["zigzag"]', '["zigzag", "zigzag"]', "two scenes are named 'zigzag'"),
        (
            '["zigzag"]',
            '"zigzag"',
            "scenes is 'zigzag'. Give a list of names, files, folders of maps, or tables",
        ),
        ('["zigzag"]', "[3]", "scenes 1: scenes is 3. Give the name or the file of a scene"),
        ('["zigzag"]', '["zigzag@twin=3..1"]', "scenes: zigzag@twin=3..1: its twins go from 3"),
        ('["zigzag"]', '["zigzag@trun=3"]', "no modifier 'trun'"),
        ('["zigzag"]', '[{ scen = "maze" }]', "scenes 1: unknown key 'scen'"),
        ('["zigzag"]', "[{ seeds = 3 }]", "scenes 1: 'scene' is missing"),
        (
            '["zigzag"]',
            '[{ scene = "maze", seeds = 0 }]',
            "scenes 1: seeds is 0. Give a number",
        ),
        ('["zigzag"]', '["nowhere.geojson"]', "nowhere.geojson: can't be read"),
        ("grace_s = 2", "grace_s = 0", "walls.toml, limits: grace_s is 0.0. It must be above 0."),
        ("grace_s = 2", 'grace_s = "2"', "grace_s is '2'. Give a number."),
        ("grace_s = 2", "grace = 2", "Did you mean 'grace_s'?"),
        ('"visibility-graph"', '"visibility-grap"', "Did you mean 'visibility-graph'?"),
        ('"visibility-graph"', '""', "planner 1: planner is ''"),
        ('name = "again"', "", "two planners are named 'visibility-graph'"),
        ('name = "again"', 'nam = "again"', "Did you mean 'name'?"),
        (
            "generations = 10",
            "generations = 0",
            "planner 'again', budget: generations is 0",
        ),
        ("generations = 10", "generations = 1.5", "generations is 1.5. Give a whole number."),
        ("generations = 10", "genertions = 10", "Did you mean 'generations'?"),
        (
            "budget = {",
            "settings = { x = 1 }\nbudget = {",
            "planner 'again', settings: visibility-graph: no setting 'x'",
        ),
        ("[[planner]]", "[planner]", "not TOML"),
    ],
)
def test_a_bad_matrix_is_refused_with_what_where_and_how_to_mend(written, old, new, message):
    assert old in GOOD
    assert message in refused(written(GOOD.replace(old, new, 1)))


def test_a_matrix_without_planners_is_refused(written):
    text = GOOD[: GOOD.index("[[planner]]")]
    assert "'planner' is missing: give at least one [[planner]]." in refused(written(text))
    one = '[planner]\nplanner = "kbga"\n'
    assert "Give at least one [[planner]]." in refused(written(text + one))


def test_the_matrix_of_all_planners_leaves_none_of_ours_out():
    ours = {p.name for p in available_planners() if p.distribution == "kbga-bench"}
    matrix = load_matrix("all-planners")
    assert {variant.plugin.name for variant in matrix.variants} == ours
    assert len(matrix.cells()) == len(matrix.variants) * 8 * 10


def test_an_unknown_matrix_is_refused_with_the_names_that_there_are():
    with pytest.raises(MatrixError, match=r"no matrix 'nonsense'.*paper-static"):
        load_matrix("nonsense")


# Planners of its own

PLANNER = """
from suite.planner import Abilities, Plan, Planner, PlanStatus
class Straight(Planner):
    name = "{name}"
    abilities = Abilities()
    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.SOLVED, [query.start, query.goal])
"""


@pytest.fixture
def planner_files(tmp_path):
    """A planner's file beside the matrix, one in a folder beside it, and no planner known yet."""
    (tmp_path / "more").mkdir()
    (tmp_path / "straight.py").write_text(PLANNER.format(name="straight"))
    (tmp_path / "more" / "other_one.py").write_text(PLANNER.format(name="other"))
    name_plugins([])
    yield tmp_path
    name_plugins([])


def with_plugins(*plugins, planner="straight"):
    text = GOOD.replace('"visibility-graph"', f'"{planner}"', 1)
    return f"plugins = {list(plugins)}\n{text}"


@pytest.mark.parametrize("reference", ["straight.py", "straight.py:Straight", "straight:Straight"])
def test_a_matrix_names_planners_by_their_files_beside_it(
    written, planner_files, reference, monkeypatch
):
    monkeypatch.setattr(sys, "path", list(sys.path))
    cell = load_matrix(written(with_plugins(reference))).cells()[0]
    assert (cell.planner, cell.distribution.removesuffix(".py")) == ("straight", "straight")
    assert cell.version == named_plugins()[0].version


def test_planners_of_a_matrix_and_of_the_command_add_up_each_once(written, planner_files):
    given = planner_files / "more" / ".." / "straight.py"
    name_plugins([str(given), str(planner_files / "more" / "other_one.py")])
    load_matrix(written(with_plugins("straight.py", planner="other")))
    assert sorted(p.name for p in named_plugins()) == ["other", "straight"]


def test_changed_code_of_a_matrix_is_another_planner(written, planner_files):
    file = written(with_plugins("straight.py"))
    before = load_matrix(file).cells()[0]
    code = planner_files / "straight.py"
    code.write_text(code.read_text() + "# changed\n")
    after = load_matrix(file).cells()[0]
    assert before.version != after.version
    assert before.key != after.key


# Worlds

SIMULATED = """
scenes = ["door", "unknown_obstacles"]
seeds = 2

[[world]]
name = "own"

[[world]]
name = "fast"
scenes = ["door"]
settings = { speed = 5.0 }

[[planner]]
planner = "kbga"

[[planner]]
name = "kbga-cold"
planner = "kbga"
cold = true
"""


def test_every_scene_is_driven_through_in_each_of_its_worlds(written):
    cells = load_matrix(written(SIMULATED)).cells()
    assert list(dict.fromkeys((c.scene, c.world.name) for c in cells)) == [
        ("door", "own"), ("door", "fast"), ("unknown_obstacles", "own"),
    ]  # fmt: skip
    assert len(cells) == 3 * 2 * 2
    assert len({c.key for c in cells}) == len(cells)
    assert {(c.variant, c.world.cold) for c in cells} == {("kbga", False), ("kbga-cold", True)}
    speeds = {(c.scene, c.world.name): c.world.settings["speed"] for c in cells}
    assert speeds == {
        ("door", "own"): 2.0,
        ("door", "fast"): 5.0,
        ("unknown_obstacles", "own"): 2.0,
    }


def test_a_simulated_run_is_not_killed_after_the_time_of_one_plan(written):
    text = SIMULATED + "budget = { wall_s = 0.1 }\n"
    matrix = load_matrix(written(text))
    assert matrix.limits.run_s(matrix.cells()[-1]) == matrix.limits.wall_s


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('["door"]', '["dor"]', "'dor' is no scene of this matrix. Did you mean 'door'?"),
        ("speed = 5.0", "speed = 0", "settings: world: speed is 0.0."),
        ("speed = 5.0", "sped = 5.0", "world: unknown key 'sped'. It may have: speed, interval"),
        ("speed = 5.0", "charge = 'none'", "charge is 'none'. Give one of 'measured', 'zero'."),
        ('name = "own"', 'name = "fast"', "two worlds are named 'fast'"),
        ('name = "own"', 'name = "own"\nscenes = ["door"]', "'unknown_obstacles' is in none"),
        ("cold = true", "cold = 1", "planner 'kbga-cold': cold is 1. Give true or false."),
    ],
)  # fmt: skip
def test_a_world_that_cannot_be_is_refused(written, old, new, message):
    assert message in refused(written(SIMULATED.replace(old, new)))


def test_only_simulated_runs_can_be_cold(written):
    said = refused(written(GOOD + "cold = true\n"))
    assert "planner 'again': cold is for simulated runs. Leave it out" in said


def test_a_budget_may_be_of_cpu_time(written):
    matrix = load_matrix(written(GOOD.replace("wall_s = 1 }", "cpu_s = 2 }")))
    assert matrix.variants[1].budget == Budget(generations=10, cpu_s=2)


def test_a_run_of_so_much_cpu_time_has_much_more_wall_time_before_it_is_killed():
    limits = Limits(grace_s=10.0)
    assert limits.plan_s(Budget(cpu_s=2.0)) == limits.cpu_stretch * 2.0 + 10.0
    assert limits.plan_s(Budget(cpu_s=2.0)) > 4 * limits.plan_s(Budget(wall_s=2.0)) - 10.0
    assert limits.plan_s(Budget(wall_s=1.0, cpu_s=9.0)) == limits.plan_s(Budget(wall_s=1.0))


@pytest.mark.parametrize("text", ["seeds = " + "1" * 5000, "seeds = " + "[" * 50_000])
def test_a_number_too_long_and_lists_too_deep_are_refused(written, text):
    assert "can't be read as TOML" in refused(written(text))


def test_a_byte_order_mark_is_skipped(tmp_path):
    file = tmp_path / "walls.toml"
    file.write_bytes(b"\xef\xbb\xbf" + GOOD.encode())
    assert load_matrix(file).name == "walls"


@pytest.mark.parametrize("seeds", [10**7, 2**63, [2**63]])
def test_seeds_that_no_memory_or_store_holds_are_refused(written, seeds):
    assert "seeds is" in refused(written(GOOD.replace("seeds = 3", f"seeds = {seeds}")))
