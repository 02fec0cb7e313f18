"""The exact solver finds the published optima of real maps."""

from collections.abc import Sequence

import numpy as np
import pytest
import shapely
from PIL import Image
from scipy import ndimage

from suite.geometry.kernels import first_collision
from suite.geometry.tolerances import OPTIMUM_RELATIVE
from suite.referee.path import Referee
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene
from tests.suite.scenes.real_maps import FOLDER, MISSING, REASON

pytestmark = pytest.mark.skipif(MISSING, reason=REASON)

IRON_HARVEST = "ironharvest_scene_mp_2p_01.mesh"
OCTILE_EXCESS = np.sqrt(4 - 2 * np.sqrt(2))  # 1.0824: octile over Euclidean length, at 22.5 degrees


def lengths(scene: Scene, queries: Sequence[Query]) -> np.ndarray:
    """Lengths of the shortest paths of queries, each path seen to be free."""
    found = []
    for query in queries:
        exact = shortest_path(scene, query)
        assert exact.path is not None
        assert first_collision(exact.path, scene.arrays) == -1
        found.append(exact.length)
    return np.array(found)


def test_all_2000_published_optima_of_iron_harvest_are_found():
    scene = load_scene(FOLDER / IRON_HARVEST)
    assert len(scene.queries) == 2000
    published = [scene.properties["published"][query.name] for query in scene.queries]
    np.testing.assert_allclose(
        lengths(scene, scene.queries), published, rtol=OPTIMUM_RELATIVE, atol=1e-9
    )


@pytest.mark.parametrize(
    ("turn", "shift", "scale"), [(17.0, 5e6, 1.0), (200.0, -3e5, 1e-3), (90.0, 0.0, 1e4)]
)
def test_published_optima_are_found_wherever_the_map_lies_and_whatever_its_size(turn, shift, scale):
    published = load_scene(FOLDER / IRON_HARVEST).properties["published"]
    moved = load_scene(f"{FOLDER / IRON_HARVEST}@turn={turn},shift={shift}:{shift},scale={scale}")
    queries = moved.queries[::20]
    wanted = [scale * published[query.name] for query in queries]
    np.testing.assert_allclose(lengths(moved, queries), wanted, rtol=OPTIMUM_RELATIVE, atol=1e-9)


@pytest.mark.parametrize(
    ("name", "long", "count"), [("arena.map", 20.0, 160), ("Denver_1_256.map", 100.0, 830)]
)
def test_lengths_on_grids_lie_below_octile_by_no_more_than_geometry_allows(name, long, count):
    scene = load_scene(str(FOLDER / name))
    assert [query.blocked for query in scene.queries] == [None] * count
    published = scene.properties["published"]
    octile = np.array([published[query.name] for query in scene.queries])
    found = lengths(scene, scene.queries)
    assert (found <= octile + 1e-4).all()
    far = octile > long
    assert far.sum() > 10
    # A path on the grid may not cut corners: it goes round them by up to a cell.
    assert (found[far] * OCTILE_EXCESS + 1.0 >= octile[far]).all()


def occupied_cells() -> shapely.STRtree:
    """Squares of tb3_sandbox that are not free, read anew: those beside free ones, no others."""
    with Image.open(FOLDER / "tb3_sandbox.pgm") as image:
        free = np.asarray(image)[::-1] > 0.804 * 255.0  # its darkness is below 0.196
    beside = ndimage.binary_dilation(free, np.ones((3, 3))) & ~free
    y, x = np.nonzero(beside)
    low = np.column_stack([x, y]) * 0.05 - 10.0
    return shapely.STRtree(shapely.box(*low.T, *(low + 0.05).T))


def test_a_robot_in_the_sandbox_keeps_its_radius_away_from_every_occupied_cell():
    scene = load_scene(f"{FOLDER / 'tb3_sandbox.yaml'}@radius=0.2")
    cells, referee = occupied_cells(), Referee(scene)
    ends = np.random.default_rng(14).uniform(-2.5, 2.5, (150, 4)).round(3)
    asked = [scene.query("{},{}:{},{}".format(*row)) for row in ends.tolist()]
    nearest = []
    for query in asked:
        path = shortest_path(scene, query).path if query.blocked is None else None
        if path is not None:
            assert referee.judge(query, path).valid
            way = shapely.LineString(path)
            nearest.append(way.distance(cells.geometries[cells.nearest(way)]))
    assert len(nearest) > 30
    assert min(nearest) >= 0.2 - 1e-9
    # They go as near as they may: paths that keep further away would prove nothing.
    assert min(nearest) < 0.2 + 1e-3
