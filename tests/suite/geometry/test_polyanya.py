"""The interval search: its queue, and the nodes that it returns."""

import numpy as np
from shapely.geometry import Polygon, box

from suite.geometry.arrangement import arrange
from suite.geometry.coordinates import coordinates_of
from suite.geometry.mesh import Mesh, mesh_of
from suite.geometry.polyanya import LEAST, _larger, _pop, _push, nodes_of_shortest_path

ROOM = box(0, 0, 10, 10)


def mesh_in(room: Polygon, obstacles: list[Polygon]) -> Mesh:
    mesh = mesh_of(arrange(room, obstacles).free, coordinates_of(room.bounds))
    assert mesh is not None
    return mesh


def places(mesh: Mesh, start, goal) -> list:
    """Where the shortest path leads."""
    nodes, _ = nodes_of_shortest_path(*map(float, start), *map(float, goal), mesh)
    return np.vstack([mesh.vertices, start, goal])[nodes].tolist()


def test_the_queue_gives_back_its_rows_from_the_least_on():
    rng = np.random.default_rng(1)
    queue, size, seen = np.empty((300, 5)), 0, []
    for least in rng.integers(0, 50, 300).tolist():
        size = _push(queue, size, float(least), least + 1, 2, 3, 4)
    while size > 0:
        np.testing.assert_array_equal(queue[0], [queue[0, LEAST], queue[0, LEAST] + 1, 2, 3, 4])
        seen.append(queue[0, LEAST])
        size = _pop(queue, size)
    assert len(seen) == 300
    assert seen == sorted(seen)


def test_nodes_are_vertices_then_start_then_goal():
    mesh = mesh_in(ROOM, [box(4, 0, 6, 7)])
    nodes, looked_into = nodes_of_shortest_path(0.0, 3.0, 10.0, 3.0, mesh)
    count = len(mesh.vertices)
    assert (nodes[0], nodes[-1]) == (count, count + 1)
    assert mesh.vertices[nodes[1:-1]].tolist() == [[4, 7], [6, 7]]
    assert looked_into > 0


def test_without_a_path_there_are_no_nodes():
    assert places(mesh_in(ROOM, [box(4, 0, 6, 10)]), (1, 1), (9, 9)) == []


def test_a_longer_queue_has_the_rows_of_the_shorter():
    queue = np.arange(35.0).reshape(7, 5)
    longer = _larger(queue, 6)
    assert longer.shape == (14, 5)
    np.testing.assert_array_equal(longer[:6], queue[:6])


def test_no_free_space_holds_no_path():
    mesh = mesh_in(ROOM, [ROOM])
    assert places(mesh, (1, 1), (9, 9)) == []
