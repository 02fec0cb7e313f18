from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from suite.geometry.kernels import first_collision
from suite.scenes.catalogue import load_scene, scene_names
from suite.scenes.exact import shortest_path
from suite.scenes.homotopy import reduced, route_optima, routes_of
from suite.scenes.scene import Scene, make_scene


def room(*obstacles, start=(0, 5), goal=(20, 5)) -> Scene:
    return make_scene("room", shapely.box(0, 0, 20, 10), obstacles, {"main": (start, goal)})


def lengths(scene: Scene, limit_ratio: float) -> list[float]:
    return [r.length for r in route_optima(scene, scene.query(), limit_ratio=limit_ratio)]


def test_an_empty_room_has_one_route():
    assert lengths(room(), 10.0) == [20.0]


def test_one_box_has_a_route_on_each_side():
    scene = room(shapely.box(8, 2, 12, 6))
    above = 2 * np.hypot(8, 1) + 4
    below = 2 * np.hypot(8, 3) + 4
    assert lengths(scene, 1.2) == pytest.approx([above, below], abs=1e-12)


def test_a_route_may_wind_around_a_box():
    scene = room(shapely.box(8, 4, 12, 6))
    found = route_optima(scene, scene.query(), limit_ratio=2.0)
    straight = 2 * np.hypot(8, 1) + 4
    assert [r.word for r in found] == [(), (1,), (-1,), (1, 1)]
    around = straight + 12  # once around a box of perimeter 12
    assert [r.length for r in found] == pytest.approx([straight] * 2 + [around] * 2, abs=1e-12)


def test_two_boxes_in_a_row_have_four_routes():
    scene = room(shapely.box(5, 3, 7, 6), shapely.box(13, 4, 15, 7))
    found = {r.word: r.length for r in route_optima(scene, scene.query(), limit_ratio=1.2)}
    over, under = np.hypot(5, 1) + 2, np.hypot(5, 2) + 2  # from the start past the first box
    assert found == pytest.approx(
        {
            (): under + np.hypot(8, 1) + np.hypot(5, 1),
            (1,): over + np.hypot(6, 2) + 2 + np.hypot(5, 1),
            (2,): under + np.hypot(6, 4) + 2 + np.hypot(5, 2),
            (1, 2): np.hypot(5, 1) + np.hypot(8, 1) + 2 + np.hypot(5, 2),
        },
        abs=1e-12,
    )


def test_boxes_joined_to_the_border_leave_one_route():
    scene = room(shapely.box(5, 0, 7, 6), shapely.box(13, 4, 15, 10))
    assert len(lengths(scene, 3.0)) == 1


def test_boxes_that_touch_are_one_obstacle():
    scene = room(shapely.box(8, 2, 10, 5), shapely.box(10, 5, 12, 8))
    found = route_optima(scene, scene.query(), limit_ratio=1.3)
    assert len(found) == 2


def test_a_room_in_two_halves_has_no_route():
    assert lengths(room(shapely.box(8, 0, 12, 10)), 2.0) == []


def test_most_stops_early():
    scene = room(shapely.box(8, 2, 12, 6))
    assert len(route_optima(scene, scene.query(), limit_ratio=1.2, most=1)) == 1


@pytest.mark.parametrize("ratio", [0.99, np.inf, np.nan])
def test_a_limit_that_bounds_nothing_is_refused(ratio):
    with pytest.raises(ValueError, match="limit_ratio"):
        route_optima(room(), room().query(), limit_ratio=ratio)


@pytest.mark.parametrize("name", scene_names())
def test_the_best_route_is_the_exact_optimum_and_all_are_feasible(name):
    scene = load_scene(name)
    query = scene.query()
    found = route_optima(scene, query, limit_ratio=1.03, most=20)
    assert found[0].length == pytest.approx(shortest_path(scene, query).length, abs=1e-9)
    assert [r.length for r in found] == sorted(r.length for r in found)
    assert len({r.word for r in found}) == len(found)
    for route in found:
        assert first_collision(route.path, scene.arrays) == -1
        assert np.hypot(*np.diff(route.path, axis=0).T).sum() == pytest.approx(route.length)


@pytest.mark.parametrize("seed", range(20))
def test_a_mirror_image_has_the_same_routes(seed):
    # The rays go up in both: in the mirror image they cut the scene in another way.
    rng = np.random.default_rng(seed)
    corners = rng.integers((2, 0), (17, 19), (7, 2))  # on a lattice: some touch or overlap
    boxes = [shapely.box(x, y / 2, x + 1, y / 2 + 1) for x, y in corners]
    upside_down = [shapely.box(x, 9 - y / 2, x + 1, 10 - y / 2) for x, y in corners]
    found = lengths(room(*boxes), 1.15)
    assert lengths(room(*upside_down), 1.15) == pytest.approx(found, abs=1e-9)


def test_turning_a_scene_keeps_its_routes():
    scene = load_scene("obstacles_20")
    turned = make_scene(
        "turned",
        scene.workspace,
        [shapely.transform(o.polygon, lambda xy: xy[:, ::-1]) for o in scene.obstacles],
        {"main": (scene.query().start[::-1], scene.query().goal[::-1])},
    )
    assert lengths(turned, 1.07) == pytest.approx(lengths(scene, 1.07), abs=1e-9)


def test_a_letter_and_its_inverse_cancel():
    assert reduced((1, 2, 3), (-3, -2, 4)) == (1, 4)
    assert reduced((1,), (-1,)) == ()
    assert reduced((), (1, 1)) == (1, 1)


corners = st.tuples(st.integers(0, 8), st.integers(0, 8))


@given(st.lists(corners, min_size=1, max_size=6), corners)
def test_two_paths_are_on_one_route_past_a_post_if_and_only_if_they_do_not_wind_around_it(
    between, corner
):
    # So thin that no path between whole corners meets it: none comes as near as 4e-4 to its middle.
    place = np.array([corner[0] + 0.373, corner[1] + 0.419])
    post = shapely.Point(place).buffer(1e-4, quad_segs=2)
    scene = make_scene("post", shapely.box(-2, -2, 10, 10), [post], {"main": ((-1, 4), (9, 4))})
    path = np.array([(-1, 4), *between, (9, 4)], dtype=float)
    straight = np.array([(-1.0, 4.0), (9.0, 4.0)])
    loop = np.vstack([path, straight[::-1]]) - place
    # Corners may lie so far apart that an angle turns by half: follow the way in small steps.
    fine = np.vstack([np.linspace(a, b, 200) for a, b in pairwise(loop)])
    angles = np.unwrap(np.arctan2(fine[:, 1], fine[:, 0]))
    winding = round((angles[-1] - angles[0]) / (2 * np.pi))
    one, other = routes_of(scene, [path, straight])
    assert (one == other) == (winding == 0)
