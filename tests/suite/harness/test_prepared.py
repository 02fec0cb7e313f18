"""What is measured by: the optimum of the geometry that is there, whatever the file states."""

from pathlib import Path

import pytest
import shapely

from suite.harness.cell import run_cell
from suite.harness.prepared import exact_optimum
from suite.harness.single import cell_for
from suite.planner import PlanStatus
from suite.scenes.exact import shortest_path
from suite.scenes.geojson import read_scene, write_scene
from suite.scenes.scene import SceneWarning, make_scene

ROOM = shapely.box(0, 0, 10, 10)
ENDS = ((1, 3), (9, 3))


@pytest.fixture
def edited(tmp_path):
    """A file that states the optimum of a room with one wall, and holds these obstacles."""
    before = make_scene("walls", ROOM, [shapely.box(4, 0, 6, 7)], ENDS)
    stated = {"optimum": {"main": shortest_path(before, before.query()).length}}

    def write(*obstacles, properties=stated):
        file = tmp_path / "walls.geojson"
        write_scene(make_scene("walls", ROOM, obstacles, ENDS, properties=properties), file)
        return str(file)

    return write


def test_the_optimum_of_an_edited_scene_is_that_of_its_geometry(edited):
    file = edited()
    with pytest.warns(SceneWarning, match=r"states an optimum of 12 m; it is 8 m, which counts"):
        record = run_cell(cell_for(file, "visibility-graph", seed=0))
    assert (record.cost, record.optimum, record.gap) == (8.0, 8.0, 0.0)


def test_the_right_proof_that_there_is_no_path_is_accepted_whatever_the_file_states(edited):
    file = edited(shapely.box(4, 0, 6, 10))
    with pytest.warns(SceneWarning, match=r"12 m; it is none, there is no path"):
        record = run_cell(cell_for(file, "visibility-graph", seed=0))
    assert (record.status, record.optimum) == (PlanStatus.INFEASIBLE, None)


def test_a_wrong_claim_that_there_is_no_path_is_invalid_whatever_the_file_states(hostile, edited):
    record = run_cell(
        cell_for(edited(properties={"optimum": {"main": None}}), "claims-infeasible", seed=0)
    )
    assert (record.status, record.optimum) == (PlanStatus.INVALID, 8.0)


def test_what_a_file_states_rightly_is_no_matter_for_a_warning(edited):
    file = edited(shapely.box(4, 0, 6, 7))
    assert read_scene(Path(file)).properties["optimum"] == {"main": 12.0}
    assert exact_optimum(file, "main") == 12.0  # a warning is an error here
