"""How large the free space around a query is."""

import pytest
import shapely

from baselines.units import free_side, longer_side
from suite.scenes.catalogue import load_scene
from suite.scenes.samples import random_queries
from suite.scenes.scene import make_scene
from tests.suite.scenes.real_maps import FOLDER, MISSING, REASON

ROOM = shapely.box(0, 0, 30, 10)
WALL = shapely.Polygon([(8, 0), (9, 0), (13, 10), (12, 10)])  # slanted; from side to side
LARGE, SMALL = 21.0, 12.0


@pytest.mark.parametrize(
    ("query", "side"),
    [
        ("1,1:2,9", SMALL),
        ("20,1:29,9", LARGE),
        ("0,0:0,10", SMALL),  # in corners of the room
        ("8,0:10,5", SMALL),  # on the wall, on both of its ends and between
        ("9,0:11,5", LARGE),
    ],
)
def test_it_is_the_longer_side_of_the_box_around_the_part_that_the_query_lies_in(query, side):
    scene = make_scene("two halls", ROOM, [WALL], {})
    assert free_side(scene, scene.query(query)) == pytest.approx(side, rel=1e-12)


def test_a_query_that_touches_no_free_space_has_the_side_of_the_room():
    scene = make_scene("full", shapely.box(0, 0, 9, 6), [shapely.box(0, 0, 9, 6)], {})
    assert free_side(scene, scene.query("1,1:2,2")) == 9.0


@pytest.mark.skipif(MISSING, reason=REASON)
@pytest.mark.parametrize("name", ["tb3_sandbox.yaml@radius=0.2", "Denver_1_256.map"])
def test_on_real_maps_it_is_that_of_the_region_that_holds_both_ends(name):
    scene = load_scene(f"{FOLDER}/{name}")
    for query in random_queries(scene, 20):
        ends = [shapely.Point(query.start), shapely.Point(query.goal)]
        (region,) = [part for part in scene.regions.geoms if all(map(part.intersects, ends))]
        xmin, ymin, xmax, ymax = region.bounds
        assert free_side(scene, query) == pytest.approx(max(xmax - xmin, ymax - ymin), rel=1e-9)
    assert free_side(scene, query) <= longer_side(scene)
