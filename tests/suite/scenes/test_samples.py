"""Random queries are uniform over free space, are what their names say, and are the same again."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.affinity import translate

from suite.errors import SceneError
from suite.geometry.coordinates import coordinates_of
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.samples import _text, random_queries, stratified_queries
from suite.scenes.scene import Scene, make_scene

ROOM = shapely.box(0, 0, 10, 10)
WALL = shapely.box(4, 0, 6, 10)


def names(queries):
    return [query.name for query in queries]


def two_rooms(at=(0.0, 0.0), unit=1.0) -> Scene:
    shapes = [
        shapely.transform(translate(shape, *at), lambda xy: unit * xy) for shape in (ROOM, WALL)
    ]
    return make_scene("two rooms", shapes[0], shapes[1:], {})


def test_the_first_of_many_are_those_of_few():
    scene = load_scene("maze@radius=0.5")
    many = names(random_queries(scene, 60, seed=3, min_distance=20.0))
    assert names(random_queries(scene, 20, seed=3, min_distance=20.0)) == many[:20]
    assert len(set(many)) == 60
    assert set(names(random_queries(scene, 20, seed=4))).isdisjoint(many)


def test_another_scene_has_another_stream():
    one, other = load_scene("maze"), load_scene("maze@turn=0.001")
    assert names(random_queries(one, 5)) != names(random_queries(other, 5))


@pytest.mark.parametrize("name", ["maze@radius=0.5", "scattered_100@shift=691608:5334765"])
def test_each_is_free_far_enough_joined_by_a_path_and_what_its_name_says(name):
    scene = load_scene(name)
    for query in random_queries(scene, 25, min_distance=30.0):
        assert query.blocked is None
        start, goal = (list(map(float, end.split(","))) for end in query.name.split(":"))
        assert [query.start.tolist(), query.goal.tolist()] == [start, goal]
        assert scene.query(query.name).start.tolist() == start
        assert np.hypot(*(query.goal - query.start)) >= 30.0
        assert shortest_path(scene, query).path is not None


@given(st.floats(-9e5, 9e6), st.floats(0, 99.999), st.integers(3, 5))
def test_a_place_of_a_map_is_read_from_its_name_as_it_was_drawn(origin, offset, decimals):
    coordinates = coordinates_of((origin, origin, origin + 100.0, origin + 100.0))
    drawn = np.round(origin + offset, decimals)
    text = _text(drawn, decimals)
    assert float(text) == drawn
    assert coordinates.snapped([drawn, drawn]).tolist() == [drawn, drawn]
    assert len(text.partition(".")[2]) <= decimals


@pytest.mark.parametrize("unit", [1e-3, 1.0, 100.0])
def test_places_are_spread_over_free_space_as_its_area_is(unit):
    queries = random_queries(two_rooms(unit=unit), 500, connected=False)
    ends = np.vstack([(query.start, query.goal) for query in queries]) / unit
    counts, _, _ = np.histogram2d(*ends.T, bins=[[0, 2, 4, 6, 8, 10], [0, 5, 10]])
    assert (counts[2] == 0).all()
    free = counts[[0, 1, 3, 4]].ravel()
    assert free.sum() == 1000
    # Chi-squared of 7 degrees of freedom: a fair stream exceeds 24.3 once in a thousand.
    assert ((free - 125.0) ** 2 / 125.0).sum() < 24.3


def test_pairs_without_a_path_are_left_out_unless_they_are_asked_for():
    scene = two_rooms()

    def crossing(queries):
        return sum((query.start[0] < 5) != (query.goal[0] < 5) for query in queries)

    assert crossing(random_queries(scene, 100)) == 0
    assert 20 < crossing(random_queries(scene, 100, connected=False)) < 80


@pytest.mark.parametrize(
    ("scene", "options", "message"),
    [
        (two_rooms(), {"min_distance": 15.0}, "min_distance is 15 m, and free space is 14.1421 m"),
        (two_rooms(), {"min_distance": 10.8}, "only 0 of 5 queries can be drawn: of the last "),
        (make_scene("full", ROOM, [ROOM], {}), {}, "full: no place is free, to draw queries from."),
    ],
)
def test_what_can_not_be_drawn_is_an_error_that_says_why(scene, options, message):
    with pytest.raises(SceneError) as caught:
        random_queries(scene, 5, **options)
    assert message in str(caught.value)


def bucketed(sizes) -> Scene:
    ends = {f"{s}-{i}": ((1, 1), (2, 3 + i / 100)) for s, n in sizes.items() for i in range(n)}
    strata = {name: name.split("-")[0] for name in ends}
    return make_scene("bucketed", ROOM, [WALL], ends, strata=strata)


@settings(max_examples=20)
@given(st.integers(1, 6), st.integers(0, 5))
def test_of_each_stratum_there_are_so_many_and_of_a_small_one_all(count, seed):
    scene = bucketed({"near": 10, "far": 3})
    chosen = stratified_queries(scene, count, seed=seed)
    strata = [query.stratum for query in chosen]
    assert (strata.count("near"), strata.count("far")) == (count, min(count, 3))
    order = names(scene.queries)
    assert [order.index(name) for name in names(chosen)] == sorted(map(order.index, names(chosen)))
    assert set(names(chosen)) <= set(names(stratified_queries(scene, count + 1, seed=seed)))


def test_a_scene_without_strata_says_what_to_ask_for_instead():
    with pytest.raises(SceneError, match=r"no strata\. Draw some with random = 100, or name them"):
        stratified_queries(load_scene("maze"), 2)
