"""The solver of the optima as a planner: a navigation mesh, then interval search over it. Metres.

The search is Polyanya (Cui, Harabor and Grastien 2017), see :mod:`suite.geometry.polyanya`; the
mesh is a constrained Delaunay triangulation of free space, see :mod:`suite.geometry.mesh`.
"""

from typing import ClassVar

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from baselines.visibility_graph import tiny_scene
from suite.geometry.coordinates import printed
from suite.geometry.mesh import ORIGIN, WAY, Mesh, mesh_of
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.exact import path_length, path_over
from suite.scenes.scene import Query, Scene
from suite.scenes.visibility import tangent_path


class PolyanyaPlanner(Planner):
    """A mesh of the scene, made anew for each query, and the shortest path over it.

    Its time is that of both. Planners get the scene's arrangement ready made, and a mesh is no part
    of that; the one that the harness makes for the optimum is kept with the scene, but is not used
    here: a row's time would depend on who asked before. What each took is a detail of the row,
    ``mesh_cpu_s`` and ``search_cpu_s``, CPU seconds: who asks many queries of one map makes the
    mesh once and pays the second only.

    It asks no question about segments, so its rows have no checks: ``looked_into`` are the
    triangles that it looked into, each as often as it did, of ``triangles``. Where free space can't
    be cut into triangles there are 0, and the path is that of the visibility search.

    It needs no budget: it ends with the shortest path, or with the proof that there is none.
    """

    name: ClassVar[str] = "polyanya"
    abilities: ClassVar[Abilities] = Abilities(deterministic=True, exact=True)

    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,  # noqa: ARG002 (the search ends by itself, sooner than any sensible limit)
        rng: np.random.Generator,  # noqa: ARG002
        recorder: Recorder,
    ) -> Plan:
        """Make the mesh, and find the shortest path or say why there is none."""
        begun = recorder.cpu_s()
        mesh = mesh_of(scene.arrangement.free, scene.coordinates)
        made = recorder.cpu_s()
        path, looks = tangent_path(scene, query) if mesh is None else path_over(mesh, query)
        ended = recorder.cpu_s()
        details = {
            "triangles": 0 if mesh is None else len(mesh.boxes),
            "looked_into": 0 if mesh is None else looks,
            "mesh_cpu_s": made - begun,
            "search_cpu_s": ended - made,
        }
        if path is None:
            reason = None if mesh is None else no_way(mesh, query)
            return Plan(PlanStatus.INFEASIBLE, details=details, reason=reason)
        length = path_length(path)
        recorder.improved(length)
        return Plan(PlanStatus.SOLVED, path, claimed_cost=length, details=details)

    def warm_up(self) -> None:
        """Compile the mesh and the search."""
        scene = tiny_scene()
        self.plan(scene, scene.query(), Budget(), np.random.default_rng(0), Recorder())


def no_way(mesh: Mesh, query: Query) -> str:
    """Why no path leads from start to goal, in a sentence that anybody can check on the mesh.

    Parameters
    ----------
    mesh : Mesh
    query : Query
        Without a path.

    Examples
    --------
    >>> from suite.scenes.scene import make_scene
    >>> wall = shapely.box(4, 0, 6, 10)
    >>> scene = make_scene("two rooms", shapely.box(0, 0, 10, 10), [wall], ((1, 1), (9, 9)))
    >>> no_way(scene.mesh, scene.query()).partition(" of its mesh; ")[0]
    'no way: the start lies in a part of free space of 40 m2, 2 of the 4 triangles'
    """
    triangles = mesh.vertices[mesh.half_edges[:, ORIGIN]].reshape(-1, 3, 2)
    start, goal = (_holding(mesh, triangles, end) for end in (query.start, query.goal))
    for what, end, inside in (("start", query.start, start), ("goal", query.goal, goal)):
        if not inside.size:
            return f"no way: the {what} {printed(*end)} lies in no free space."
    parts = _parts(mesh)
    reached = np.isin(parts, parts[start])
    return (
        f"no way: the start lies in a part of free space of {_area(triangles[reached]):.6g} m2, "
        f"{reached.sum()} of the {len(parts)} triangles of its mesh; none of these has a side in "
        "common with any other triangle, and the goal lies in none of them."
    )


def _holding(
    mesh: Mesh, triangles: NDArray[np.float64], point: NDArray[np.float64]
) -> NDArray[np.intp]:
    """Numbers of the triangles (T, 3, 2) that hold a point, borders included."""
    low, high = mesh.boxes[:, :2], mesh.boxes[:, 2:]
    near = np.flatnonzero(((low <= point) & (point <= high)).all(axis=1))
    return near[shapely.intersects(shapely.polygons(triangles[near]), shapely.Point(point))]


def _parts(mesh: Mesh) -> NDArray[np.int32]:
    """The connected part that each triangle belongs to: a number (T,)."""
    way = mesh.half_edges[:, WAY]
    twin = np.where(way < -1, -2 - way, way)
    sides = np.flatnonzero(twin >= 0)
    count = len(mesh.boxes)
    pairs = sides // 3, twin[sides] // 3
    return connected_components(coo_array((np.ones(len(sides)), pairs), (count, count)))[1]


def _area(triangles: NDArray[np.float64]) -> float:
    a, b = (triangles[:, i] - triangles[:, 0] for i in (1, 2))
    return 0.5 * float(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
