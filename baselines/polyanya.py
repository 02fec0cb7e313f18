"""The solver of the optima as a planner: a navigation mesh, then interval search over it. Metres.

The search is Polyanya (Cui, Harabor and Grastien 2017), see :mod:`suite.geometry.polyanya`; the
mesh is a constrained Delaunay triangulation of free space, see :mod:`suite.geometry.mesh`.
"""

from typing import ClassVar

import numpy as np

from baselines.visibility_graph import tiny_scene
from suite.geometry.mesh import mesh_of
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.exact import path_length, path_over
from suite.scenes.reach import no_way
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
            reason = no_way(scene, query)
            return Plan(PlanStatus.INFEASIBLE, details=details, reason=reason)
        length = path_length(path)
        recorder.improved(length)
        return Plan(PlanStatus.SOLVED, path, claimed_cost=length, details=details)

    def warm_up(self) -> None:
        """Compile the mesh and the search."""
        scene = tiny_scene()
        self.plan(scene, scene.query(), Budget(), np.random.default_rng(0), Recorder())
