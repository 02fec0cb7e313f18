"""Populations are kept beside the rows of measured runs, of which they are the true course."""

import numpy as np
import pytest

from suite.harness.matrix import load_matrix
from suite.harness.run import Which, run_matrix
from suite.harness.snapshots import MOST_GENERATIONS, chosen_generations, keep_snapshots
from suite.store.read import read_paths, read_runs, read_snapshots
from suite.store.write import open_store

TEXT = """
scenes = ["zigzag", "double_u"]
seeds = [4, 2]

[[planner]]
planner = "visibility-graph"

[[planner]]
planner = "kbga"
settings = {{ population_size = 60 }}
budget = {{ {budget} }}
"""


@pytest.fixture(scope="module", params=["generations = 12", "cpu_s = 0.02"])
def ran(request, tmp_path_factory):
    """A store after its matrix was run and populations were kept twice, and what that said."""
    folder = tmp_path_factory.mktemp("snapshots")
    (folder / "m.toml").write_text(TEXT.format(budget=request.param))
    matrix = load_matrix(folder / "m.toml")
    with open_store(folder / "s.db") as store:
        run_matrix(matrix, store, jobs=2)
        before = read_runs(folder / "s.db")
        kept = [keep_snapshots(matrix, store, most=most) for most in (1, 40, 40)]
    return folder / "s.db", before, kept


def test_the_first_seed_of_each_scene_is_kept_of_planners_that_show_a_population(ran):
    file, before, _ = ran
    mine = before[before["key"].isin(list(read_snapshots(file)))]
    assert mine["scene"].tolist() == ["zigzag", "double_u"]
    assert set(mine["planner"]) == {"kbga"}
    assert set(mine["seed"]) == {4}


def test_it_is_bounded_and_what_is_there_is_not_made_again(ran):
    assert [(kept.runs, kept.differ) for kept in ran[2]] == [(1, 0), (1, 0), (0, 0)]
    assert ran[2][-1].summary() == ""


def test_the_measured_rows_stay_as_they_were(ran):
    file, before, _ = ran
    assert read_runs(file).equals(before)


def test_the_last_snapshot_has_the_path_of_the_row_also_if_the_clock_ended_it(ran):
    file, before, _ = ran
    paths = read_paths(file)
    for key, snapshots in read_snapshots(file).items():
        np.testing.assert_allclose(snapshots[-1].best, paths[key], atol=1e-6)
        row = before.set_index("key").loc[key]
        shown = [snapshot.generation for snapshot in snapshots]
        assert (shown[0], shown[-1]) == (0, row["generations"])
        assert row["generation_of_best"] in shown
        assert all(len(snapshot.paths) == 50 for snapshot in snapshots), "60 are thinned"


def test_a_row_that_is_replaced_loses_its_populations(tmp_path):
    (tmp_path / "m.toml").write_text(TEXT.format(budget="generations = 2"))
    matrix = load_matrix(tmp_path / "m.toml")
    with open_store(tmp_path / "s.db") as store:
        run_matrix(matrix, store, jobs=2, quick=True)
        keep_snapshots(matrix, store)
        assert len(read_snapshots(tmp_path / "s.db")) == 2
        run_matrix(matrix, store, jobs=2, quick=True, which=Which.ALL)
        assert read_snapshots(tmp_path / "s.db") == {}


@pytest.mark.parametrize(("last", "best"), [(0, None), (3, 1), (59, 0), (60, 7), (500, 499)])
def test_few_generations_are_shown_whole_and_of_many_no_more_than_can_be_looked_at(last, best):
    chosen = chosen_generations(last, best)
    assert {0, last} <= chosen <= set(range(last + 1))
    assert best is None or best in chosen
    assert len(chosen) == min(last + 1, MOST_GENERATIONS)
