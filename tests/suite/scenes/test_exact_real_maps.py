"""The exact solver finds the published optima of real maps."""

import numpy as np
import pytest
from shapely.affinity import affine_transform

from suite.geometry.kernels import first_collision
from suite.geometry.tolerances import OPTIMUM_RELATIVE
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene, make_scene
from tests.suite.scenes.real_maps import (
    MISSING,
    REASON,
    grid_queries,
    grid_scene,
    mesh_scene,
    queries,
)

pytestmark = pytest.mark.skipif(MISSING, reason=REASON)

IRON_HARVEST = "ironharvest_scene_mp_2p_01.mesh"
OCTILE_EXCESS = np.sqrt(4 - 2 * np.sqrt(2))  # 1.0824: octile over Euclidean length, at 22.5 degrees


def lengths(scene: Scene, rows: np.ndarray) -> np.ndarray:
    """Lengths of the shortest paths of queries (n, 5), each path seen to be free."""
    found = []
    for row in rows:
        exact = shortest_path(scene, Query("row", row[:2], row[2:4]))
        assert exact.path is not None
        assert first_collision(exact.path, scene.arrays) == -1
        found.append(exact.length)
    return np.array(found)


def test_all_2000_published_optima_of_iron_harvest_are_found():
    rows = queries(IRON_HARVEST)
    assert len(rows) == 2000
    np.testing.assert_allclose(
        lengths(mesh_scene(IRON_HARVEST), rows), rows[:, 4], rtol=OPTIMUM_RELATIVE, atol=1e-9
    )


@pytest.mark.parametrize(
    ("turn", "shift", "scale"), [(17.0, 5e6, 1.0), (200.0, -3e5, 1e-3), (90.0, 0.0, 1e4)]
)
def test_published_optima_are_found_wherever_the_map_lies_and_whatever_its_size(turn, shift, scale):
    drawn, rows = mesh_scene(IRON_HARVEST), queries(IRON_HARVEST)[::20]
    a, b = scale * np.cos(np.radians(turn)), scale * np.sin(np.radians(turn))
    matrix = (a, -b, b, a, shift, shift)
    room, *obstacles = (
        affine_transform(p, matrix)
        for p in (drawn.workspace, *(o.polygon.simplify(0.0) for o in drawn.obstacles))
    )
    ends = rows[:, :4].reshape(-1, 2) @ np.array([[a, b], [-b, a]]) + shift
    rows = np.column_stack([ends.reshape(-1, 4), scale * rows[:, 4]])
    scene = make_scene("moved", room, obstacles, (rows[0, :2], rows[0, 2:4]))
    np.testing.assert_allclose(lengths(scene, rows), rows[:, 4], rtol=OPTIMUM_RELATIVE, atol=1e-9)


@pytest.mark.parametrize(("name", "long"), [("arena.map", 20.0), ("Denver_1_256.map", 100.0)])
def test_lengths_on_grids_lie_below_octile_by_no_more_than_geometry_allows(name, long):
    rows = grid_queries(name)
    found, octile = lengths(grid_scene(name), rows), rows[:, 4]
    assert (found <= octile + 1e-4).all()
    far = octile > long
    assert far.sum() > 10
    # A path on the grid may not cut corners: it goes round them by up to a cell.
    assert (found[far] * OCTILE_EXCESS + 1.0 >= octile[far]).all()
