"""A robot with a radius: no accepted path comes nearer to anything that is drawn than that."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.affinity import rotate, translate
from shapely.geometry import Polygon

from suite.errors import SceneError
from suite.referee.path import Referee, judge
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.geojson import write_scene
from suite.scenes.maps.formats import FORMATS
from suite.scenes.samples import random_queries
from suite.scenes.scene import Scene, make_scene
from tests.strategies import SIDE, lattice_boxes, lattice_polygons
from tests.suite.scenes.real_maps import FOLDER, MISSING, REASON

ROOM = shapely.box(0, 0, SIDE, SIDE)
PLACES = np.stack(np.meshgrid(*[np.arange(SIDE) + 0.5] * 2), axis=-1).reshape(-1, 2)


@st.composite
def rooms_for_a_disc(draw: st.DrawFn) -> tuple[list[Polygon], np.ndarray, float]:
    """Obstacles, two places where the disc has room, and its radius."""
    polygons = draw(st.lists(lattice_boxes() | lattice_polygons(), min_size=1, max_size=4))
    radius = draw(st.floats(0.02, 0.45))
    free = PLACES[shapely.distance(shapely.union_all(polygons), shapely.points(PLACES)) > radius]
    assume(len(free) > 1)
    ends = draw(st.permutations(range(len(free))))[:2]
    return polygons, free[ends], radius


def keeps_away(scene: Scene, room: Polygon, drawn: list[Polygon], radius: float) -> None:
    path = shortest_path(scene, scene.query()).path
    assume(path is not None)
    assert judge(scene, scene.query(), path).valid
    assert clearance(scene, path, room, drawn) >= radius - 1e-9


def clearance(scene: Scene, path: np.ndarray, room: Polygon, drawn: list[Polygon]) -> float:
    """Distance of a path to what was drawn, metres; reckoned near zero, where float64 are fine."""
    origin = np.array(scene.coordinates.origin)
    way = shapely.LineString(path - origin)
    closed = [room.exterior, *drawn]
    return min(way.distance(shapely.transform(one, lambda xy: xy - origin)) for one in closed)


@settings(max_examples=60)
@given(rooms_for_a_disc())
def test_the_shortest_path_of_a_disc_keeps_its_radius_away_from_everything_drawn(drawn):
    polygons, ends, radius = drawn
    keeps_away(
        make_scene("disc", ROOM, polygons, tuple(ends), inflate=radius), ROOM, polygons, radius
    )


@settings(max_examples=20)
@given(rooms_for_a_disc(), st.floats(0.0, 360.0))
def test_so_it_does_at_the_coordinates_of_a_map(drawn, angle):
    polygons, ends, radius = drawn
    room, *moved = (
        translate(rotate(p, angle, origin=(0, 0)), 691608.2, 5334765.7) for p in (ROOM, *polygons)
    )
    at = [
        shapely.get_coordinates(
            translate(rotate(shapely.Point(end), angle, origin=(0, 0)), 691608.2, 5334765.7)
        )[0]
        for end in ends
    ]
    keeps_away(make_scene("disc", room, moved, tuple(at), inflate=radius), room, moved, radius)


@pytest.mark.parametrize("radius", [0.3, 1.0, 2.5])
def test_rounding_a_corner_costs_hardly_more_than_the_circle(radius):
    wall = shapely.box(8, -20, 12, 5)
    scene = make_scene(
        "wall", shapely.box(-20, -30, 40, 30), [wall], ((0, 0), (20, 0)), inflate=radius
    )
    found = shortest_path(scene, scene.query()).length
    # From (0, 0) a tangent to the circle around (8, 5), its arc, the top, and the same again.
    tangent = np.sqrt(8.0**2 + 5.0**2 - radius**2)
    heading = np.arctan2(5.0, 8.0) + np.arcsin(radius / np.hypot(8.0, 5.0))
    exact = 2.0 * (tangent + radius * heading) + 4.0
    assert exact <= found <= exact * 1.0001


@pytest.mark.parametrize("start_angle", [1.0, 37.0])
def test_nor_does_a_way_that_is_nothing_but_the_circle(start_angle):
    """Around a pillar as slim as a scene may have it, hugging it all the way."""
    radius, slim = 2.0, 1e-6
    pillar = shapely.box(-slim, -slim, slim, slim)
    angles = np.radians([start_angle, start_angle + 178.0])
    ends = 1.0003 * radius * np.column_stack([np.cos(angles), np.sin(angles)])
    scene = make_scene("pillar", shapely.box(-9, -9, 9, 9), [pillar], tuple(ends), inflate=radius)
    found = shortest_path(scene, scene.query()).length
    round_the_circle = radius * np.radians(178.0)  # nobody who keeps the radius goes less far
    assert round_the_circle <= found
    tangents = 2.0 * radius * np.sqrt(1.0003**2 - 1.0)
    arc = radius * (np.radians(178.0) - 2.0 * np.arccos(1.0 / 1.0003))
    assert found <= (tangents + arc) * 1.0001 + 8.0 * slim


@settings(max_examples=25)
@given(rooms_for_a_disc(), st.integers(0, 10**6))
def test_no_path_that_is_accepted_comes_nearer_whoever_found_it(drawn, seed):
    polygons, ends, radius = drawn
    scene = make_scene("disc", ROOM, polygons, tuple(ends), inflate=radius)
    assume(scene.query().blocked is None)
    rng = np.random.default_rng(seed)
    corners = scene.arrangement.corners[:, :2]
    places = np.vstack([corners, rng.uniform(0, SIDE, (20, 2))])
    referee = Referee(scene)
    start, goal = scene.query().start, scene.query().goal
    for _ in range(40):
        middle = places[rng.integers(len(places), size=rng.integers(0, 3))]
        path = np.vstack([start, middle, goal])
        if referee.judge(scene.query(), path).valid:
            assert clearance(scene, path, ROOM, polygons) >= radius - 1e-9


@pytest.mark.skipif(MISSING or ".yaml" not in FORMATS, reason=REASON)
def test_in_a_scanned_room_no_shortest_path_comes_nearer_to_a_cell_that_is_occupied():
    radius, name = 0.2, str(FOLDER / "tb3_sandbox.yaml")
    drawn, scene = load_scene(name), load_scene(f"{name}@radius={radius}")
    occupied = [obstacle.polygon for obstacle in drawn.obstacles]
    for query in random_queries(scene, 25, seed=1, min_distance=1.0):
        path = shortest_path(scene, query).path
        assert path is not None
        assert clearance(scene, path, drawn.workspace, occupied) >= radius - 1e-9


def test_a_scene_file_may_say_how_large_the_robot_is(tmp_path):
    wall, ends = shapely.box(4, 0, 6, 7), ((1, 1), (9, 1))
    room = shapely.box(0, 0, 10, 10)
    file, plain = tmp_path / "hall.geojson", make_scene("hall", room, [wall], ends)
    write_scene(replace(plain, properties={"radius": 0.5}), file)
    grown = make_scene("hall", room, [wall], ends, inflate=0.5)
    read = load_scene(file)
    assert (read.hash, read.radius, dict(read.properties)) == (grown.hash, 0.5, {})
    assert load_scene(str(file), inflate=0.25).radius == 0.25
    assert load_scene(f"{file}@radius=0.25").radius == 0.25
    turned = load_scene(f"{file}@turn=90")
    assert turned.radius == 0.5
    assert shortest_path(turned, turned.query()).length == pytest.approx(
        shortest_path(grown, grown.query()).length
    )
    write_scene(read, file)  # what has grown is not grown again
    assert (load_scene(file).hash, load_scene(file).radius) == (grown.hash, 0.5)


@pytest.mark.parametrize("radius", ["wide", -1, [1]])
def test_a_radius_of_a_file_that_is_none_is_refused(tmp_path, radius):
    file = tmp_path / "hall.geojson"
    scene = make_scene("hall", shapely.box(0, 0, 10, 10), [], {})
    write_scene(replace(scene, properties={"radius": radius}), file)
    with pytest.raises(SceneError, match=r"its property 'radius' is .*\. Give the robot's"):
        load_scene(file)
