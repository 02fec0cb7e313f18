"""The exact planner of the package extremitypathfinder: another implementation of one's yardstick.

It searches a visibility graph that it has prepared for the whole scene, after Vinther, Vinther and
Afshani, "Pathfinding in Two-dimensional Worlds" (2015). Metres.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Point, Polygon
from shapely.geometry.polygon import orient

from baselines.ends import ends_are_free
from baselines.limits import time_is_over
from baselines.visibility_graph import tiny_scene
from suite.errors import PluginError
from suite.geometry.kernels import first_collision
from suite.geometry.tolerances import GRID
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.exact import path_length
from suite.scenes.scene import Query, Scene

try:
    from extremitypathfinder import PolygonEnvironment
except ModuleNotFoundError as error:
    raise PluginError(
        "it needs the package extremitypathfinder. "
        'Install it with: pip install "kbga-bench[extremitypathfinder]"'
    ) from error


class OutOfTimeError(Exception):
    """The budget ended while the package was at work."""


class TimedEnvironment(PolygonEnvironment):  # type: ignore[misc]
    """The package's environment, which ends with an exception when the time is over.

    It looks at the clock whenever the package asks whether a vertex lies in the region, and when
    it turns to the next one.
    """

    def __init__(self, time_is_over: Callable[[], bool]) -> None:
        self._time_is_over = time_is_over

    def within_map(self, coords: tuple[float, float]) -> bool:
        """Whether a point lies in the region, if there is time left."""
        self._look()
        return bool(super().within_map(coords))

    def translate(self, new_origin: Any) -> None:
        """Move the origin to a vertex, if there is time left."""
        self._look()
        super().translate(new_origin)

    def _look(self) -> None:
        if self._time_is_over():
            raise OutOfTimeError


@dataclass(frozen=True, slots=True)
class ExtremitySettings:
    """Settings of extremitypathfinder.

    most_vertices : scenes with more are refused. The package prepares 400 in 3 s and 800 in 13 s;
        the default, which is ours, is some 20 s.
    """

    most_vertices: int = 1000

    def __post_init__(self) -> None:
        if self.most_vertices < 1:
            raise ValueError(f"most_vertices is {self.most_vertices}. It must be 1 or more.")


class ExtremityPlanner(Planner[ExtremitySettings]):
    """The package extremitypathfinder, given the free region that holds start and goal.

    Its polygons may neither touch nor overlap. So it is not given the obstacles, but the connected
    pieces of free space between them, each an outline with holes: what touches or overlaps has
    become one hole, and what touches the border a dent in the outline. If no piece holds both
    ends, there is no path.

    What it can't do is refused: a piece whose outline and holes meet in a point, which it would
    slip through; a start or goal on an edge, from which it does not see all that it should; and
    more vertices than it prepares in sensible time. A robot on its way asks all the same: it is
    never given a path that is not free, but from an edge it may be a longer one.

    The package keeps its vertices in sets, ordered by where they lie in memory: of several paths
    that are equally short, it may return another one the next time.
    """

    name: ClassVar[str] = "extremitypathfinder"
    Settings = ExtremitySettings
    abilities: ClassVar[Abilities] = Abilities(
        deterministic=True, exact=True, budgets=frozenset({"wall_s", "cpu_s"})
    )

    def refuse(self, scene: Scene, query: Query, budget: Budget) -> str | None:  # noqa: ARG002
        """Refuse large scenes, ends on an edge, and obstacles that meet in a point in the way."""
        regions = regions_of(scene, query)
        vertices, most = (
            int(shapely.get_num_coordinates(regions).sum()),
            self.settings.most_vertices,
        )
        if vertices > most:
            return (
                f"{self.name} would prepare {vertices} vertices, which takes it long; "
                f"most_vertices is {most}. Raise it if you have the time."
            )
        for what, end in (("start", query.start), ("goal", query.goal)):
            if any(region.boundary.distance(Point(end)) <= GRID for region in regions):
                return (
                    f"{self.name} does not see all that it should from an edge, and the {what} "
                    f"({end[0]:g}, {end[1]:g}) lies on one. Move it into the open."
                )
        points = [point for region in regions for point in pinches(region)]
        if not points:
            return None
        x, y = points[0]
        return (
            f"{self.name} would slip through the point ({x:g}, {y:g}), in which obstacles meet. "
            "Let them overlap or keep them apart."
        )

    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,
        rng: np.random.Generator,  # noqa: ARG002
        recorder: Recorder,
    ) -> Plan:
        """Prepare the scene and find the shortest path, or say that there is none."""
        regions = regions_of(scene, query) if ends_are_free(scene, query) else []
        if not regions:
            return Plan(PlanStatus.INFEASIBLE)
        is_over = time_is_over(budget, recorder)
        try:
            paths = [_path_in(region, query, is_over) for region in regions]
        except OutOfTimeError:
            return Plan(PlanStatus.EXHAUSTED)
        # While a robot drives, nobody asks whether the planner refuses.
        paths = [p for p in paths if len(p) > 0 and first_collision(p, scene.arrays) < 0]
        if not paths:
            return Plan(PlanStatus.EXHAUSTED)
        path = min(paths, key=path_length)
        recorder.improved(path_length(path))
        return Plan(PlanStatus.SOLVED, path, claimed_cost=path_length(path))

    def warm_up(self) -> None:
        """Compile the collision check."""
        scene = tiny_scene()
        self.plan(scene, scene.query(), Budget(), np.random.default_rng(0), Recorder())


def regions_of(scene: Scene, query: Query) -> list[Polygon]:
    """The connected pieces of free space that hold both start and goal: none, one or seldom two.

    Outlines run counter-clockwise and holes clockwise.
    """
    solid = scene.arrangement.solid
    free = shapely.get_parts(shapely.box(*solid.bounds).difference(solid))
    ends = [Point(query.start), Point(query.goal)]
    return [orient(p) for p in free if all(p.distance(end) <= GRID for end in ends)]


def pinches(region: Polygon) -> list[tuple[float, float]]:
    """The points in which the outline and the holes of a region meet each other, metres.

    Examples
    --------
    >>> room, boxes = shapely.box(0, 0, 9, 9), [shapely.box(2, 2, 4, 4), shapely.box(4, 4, 6, 6)]
    >>> pinches(room.difference(shapely.union_all(boxes)))
    [(4.0, 4.0)]
    """
    rings = (region.exterior, *region.interiors)
    times = Counter(point for ring in rings for point in ring.coords[:-1])
    return [(x, y) for (x, y), n in times.items() if n > 1]


def _path_in(
    region: Polygon, query: Query, time_is_over: Callable[[], bool]
) -> NDArray[np.float64]:
    """Shortest path (n, 2) in a region that holds both ends; no rows if the package finds none."""
    environment = TimedEnvironment(time_is_over)
    environment.store(region.exterior.coords[:-1], [hole.coords[:-1] for hole in region.interiors])
    # Ends on an outline are free, but do not always pass for points of the region.
    points, _ = environment.find_shortest_path(tuple(query.start), tuple(query.goal), verify=False)
    return np.array(points, dtype=np.float64).reshape(-1, 2)
