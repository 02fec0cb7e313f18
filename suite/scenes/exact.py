"""The exact shortest path of a query: interval search over a navigation mesh of the scene. Metres.

The search is :mod:`suite.geometry.polyanya`, the mesh :mod:`suite.geometry.mesh`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from suite.geometry.mesh import Mesh
from suite.geometry.polyanya import nodes_of_shortest_path
from suite.scenes.scene import Query, Scene
from suite.scenes.visibility import tangent_path, without_straight_bends


@dataclass(frozen=True, slots=True, eq=False)
class ExactPath:
    """The shortest path of a query, or the proof that there is none.

    path : (n, 2) float64, metres, start to goal; None if the goal can't be reached.
    length : float, metres; infinite if the goal can't be reached.
    checks : questions that the search asked: triangles that it looked into, each as often as it
        did; or segments, in a scene without a mesh.
    """

    path: NDArray[np.float64] | None
    length: float
    checks: int


def prepare(scene: Scene) -> Mesh | None:
    """Make what the solver needs of a scene beside its arrangement; kept with the scene.

    The first query does it by itself. Whoever measures queries, or preparing, calls this before.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Mesh or None
        None if free space can't be cut into triangles: the solver then asks about segments.
    """
    return scene.mesh


def shortest_path(scene: Scene, query: Query) -> ExactPath:
    """Shortest feasible path from start to goal.

    Parameters
    ----------
    scene : Scene
    query : Query
        One of the scene's own, or any other. There is no path where an end is not in free space.

    Returns
    -------
    ExactPath

    Examples
    --------
    >>> import shapely
    >>> from suite.scenes.scene import make_scene
    >>> scene = make_scene(
    ...     "one box", shapely.box(0, 0, 10, 10), [shapely.box(4, 0, 6, 7)],
    ...     {"main": ((0, 3), (10, 3))},
    ... )
    >>> found = shortest_path(scene, scene.query())
    >>> found.path.tolist()
    [[0.0, 3.0], [4.0, 7.0], [6.0, 7.0], [10.0, 3.0]]
    """
    path, checks = _path(scene, query)
    return ExactPath(path, np.inf if path is None else path_length(path), checks)


def _path(scene: Scene, query: Query) -> tuple[NDArray[np.float64] | None, int]:
    mesh = prepare(scene)
    if mesh is None:
        return tangent_path(scene, query)
    return path_over(mesh, query)


def path_over(mesh: Mesh, query: Query) -> tuple[NDArray[np.float64] | None, int]:
    """Shortest path over a mesh, and how many triangles the search looked into.

    Parameters
    ----------
    mesh : Mesh
        Of the scene's free space.
    query : Query

    Returns
    -------
    path : (n, 2) float64, metres, or None if there is none
    checks : int
        Each triangle as often as it was looked into.
    """
    (sx, sy), (gx, gy) = query.start, query.goal
    order, checks = nodes_of_shortest_path(sx, sy, gx, gy, mesh)
    if order.size == 0:
        return None, int(checks)
    path = np.vstack([query.start, mesh.vertices[order[1:-1]], query.goal])
    return without_straight_bends(path), int(checks)


def path_length(path: NDArray[np.float64]) -> float:
    """Length of a path (n, 2), metres."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())
