"""What a query can reach agrees with the exact solver."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from suite.scenes.exact import shortest_path
from suite.scenes.reach import no_way, reachable_bounds
from suite.scenes.scene import make_scene
from tests.kbga.laboratory import random_scene
from tests.suite.geometry.lattice import counts


@settings(max_examples=counts(300, 60))
@given(st.integers(0, 2**32))
def test_there_is_no_way_exactly_where_the_exact_solver_finds_none(seed):
    scene = random_scene(np.random.default_rng(seed))
    query = scene.query()
    reason, exact = no_way(scene, query), shortest_path(scene, query)
    assert (reason is not None) == math.isinf(exact.length)
    if reason is None:
        xmin, ymin, xmax, ymax = reachable_bounds(scene, query)
        assert (exact.path >= (xmin - 1e-9, ymin - 1e-9)).all()
        assert (exact.path <= (xmax + 1e-9, ymax + 1e-9)).all()


@pytest.mark.parametrize(("name", "what"), [("5,5:1,1", "start"), ("1,1:5,5", "goal")])
def test_an_end_in_an_obstacle_lies_in_no_free_space(name, what):
    room = make_scene("room", shapely.box(0, 0, 10, 10), [shapely.box(4, 4, 6, 6)], {})
    assert no_way(room, room.query(name)) == f"no way: the {what} (5, 5) lies in no free space."


def test_the_part_that_is_told_is_the_one_that_holds_the_start():
    ring = shapely.box(6, 6, 10, 10).difference(shapely.box(7, 7, 9, 9))
    for ends, area in ((((1, 1), (8, 8)), 84), (((8, 8), (1, 1)), 4)):
        scene = make_scene("closed", shapely.box(0, 0, 10, 10), [ring], ends)
        assert f" of {area} m2, which" in no_way(scene, scene.query())


def test_the_bounds_of_a_map_that_is_mostly_unknown_are_those_of_the_room_around_the_query():
    walls = [shapely.box(0, 3, 30, 30), shapely.box(3, 0, 30, 3)]
    scene = make_scene("corner", shapely.box(0, 0, 30, 30), walls, ((1, 1), (2, 2)))
    assert reachable_bounds(scene, scene.query()) == (0.0, 0.0, 3.0, 3.0)
