"""The exact planner of the package extremitypathfinder: another implementation of one's yardstick.

It searches a visibility graph that it has prepared for the whole scene, after Vinther, Vinther and
Afshani, "Pathfinding in Two-dimensional Worlds" (2015). Metres; the package itself is given the
scene scaled into the unit square, its corner in the origin.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.geometry import LineString, Point, Polygon
from shapely.geometry.polygon import orient

from baselines.ends import ends_are_free
from baselines.limits import time_is_over
from baselines.units import longer_side, unit_above
from baselines.visibility_graph import tiny_scene
from suite.errors import PluginError
from suite.geometry.coordinates import printed
from suite.geometry.kernels import first_collision
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder
from suite.scenes.exact import path_length
from suite.scenes.scene import Query, Scene

try:
    from extremitypathfinder import PolygonEnvironment
    from extremitypathfinder.helper_classes import DirectedHeuristicGraph
except ModuleNotFoundError as error:
    raise PluginError(
        "it needs the package extremitypathfinder. "
        'Install it with: pip install "kbga-bench[extremitypathfinder]"'
    ) from error


FINEST = 1e-7
"""Narrowest passage, as a share of the room, that the package is trusted with. It tells directions
apart by their sines: near the axes by 1.5e-8 at best. Of passages in 10 m it gets all right down to
1e-7 m and every second one wrong, or no answer at all, at 1e-8 m."""


class OutOfTimeError(Exception):
    """The budget ended while the package was at work."""


class DistinctGraph(DirectedHeuristicGraph):  # type: ignore[misc]
    """The package's visibility graph, in which every vertex stays a node of its own."""

    def join_identical(self) -> None:
        """Join nothing: no two vertices of a region are one.

        The package would join what numpy calls close: corners within a hundred thousandth of their
        coordinates, so that it goes through one and turns at the other.
        """


class TimedEnvironment(PolygonEnvironment):  # type: ignore[misc]
    """The package's environment, which ends with an exception when the time is over.

    It looks at the clock whenever the package asks whether a vertex lies in the region, and when
    it turns to the next one.
    """

    def __init__(self, time_is_over: Callable[[], bool]) -> None:
        self._time_is_over = time_is_over
        self._graph = DistinctGraph()

    @property
    def graph(self) -> DistinctGraph:
        """The visibility graph."""
        return self._graph

    @graph.setter
    def graph(self, begun: DirectedHeuristicGraph) -> None:
        """Take the nodes of the one that the package begins with."""
        self._graph = DistinctGraph(begun.all_nodes)

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
    slip through; passages and walls finer than it can tell; a start or goal on an edge, from which
    it does not see all that it should; and more vertices than it prepares in sensible time. A robot
    on its way asks all the same: it is never given a path that is not free, but it may be a longer
    one, or none.

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
            if any(region.boundary.distance(Point(end)) <= width_of(scene) for region in regions):
                return (
                    f"{self.name} does not see all that it should from an edge, and the {what} "
                    f"{printed(*end)} lies on one. Move it into the open."
                )
        points = [point for region in regions for point in pinches(region)]
        if points:
            return (
                f"{self.name} would slip through the point {printed(*points[0])}, in which "
                "obstacles meet. Let them overlap or keep them apart."
            )
        width = FINEST * longer_side(scene)
        points = [point for region in regions for point in finer_places(region, width)]
        if not points:
            return None
        return (
            f"{self.name} can't tell apart what lies within {width:.1g} m in a room of this size, "
            f"as at {printed(*points[0])}. Close such passages, or widen them."
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
        except np.linalg.LinAlgError:
            # While a robot drives, nobody asks whether the planner refuses: two directions that the
            # package takes for one have no point of intersection.
            return Plan(PlanStatus.EXHAUSTED)
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
    local, world = scene.coordinates.local, scene.coordinates.world
    solid = shapely.transform(scene.arrangement.solid, local)
    free = shapely.get_parts(shapely.transform(shapely.box(*solid.bounds).difference(solid), world))
    ends, width = [Point(query.start), Point(query.goal)], width_of(scene)
    return [orient(p) for p in free if all(p.distance(end) <= width for end in ends)]


def width_of(scene: Scene) -> float:
    """Metres within which an end lies on an edge: as the package sees it, or as it was snapped."""
    return max(FINEST * longer_side(scene), scene.coordinates.grid)


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


def finer_places(region: Polygon, width: float) -> list[tuple[float, float]]:
    """The vertices of a region that lie within a width (metres) of an edge of others.

    Examples
    --------
    >>> room, boxes = shapely.box(0, 0, 9, 9), [shapely.box(2, 2, 4, 4), shapely.box(4.5, 2, 8, 8)]
    >>> region = room.difference(shapely.union_all(boxes))
    >>> finer_places(region, 0.1), finer_places(region, 0.6)
    ([], [(4.0, 2.0), (4.0, 4.0), (4.5, 2.0)])
    """
    rings = [shapely.get_coordinates(ring) for ring in (region.exterior, *region.interiors)]
    vertices = np.concatenate([ring[:-1] for ring in rings])
    edges = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])
    tree = shapely.STRtree([LineString(edge) for edge in edges])
    near = tree.query(shapely.points(vertices), predicate="dwithin", distance=width).T
    is_own = (edges[near[:, 1]] == vertices[near[:, 0], None]).all(axis=2).any(axis=1)
    return [(x, y) for x, y in vertices[np.unique(near[~is_own, 0])].tolist()]


def _path_in(
    region: Polygon, query: Query, time_is_over: Callable[[], bool]
) -> NDArray[np.float64]:
    """Shortest path (n, 2) in a region that holds both ends; no rows if the package finds none."""
    frame = _Frame(region)
    environment = TimedEnvironment(time_is_over)
    environment.store(
        frame.points(region.exterior.coords[:-1]),
        [frame.points(hole.coords[:-1]) for hole in region.interiors],
    )
    start, goal = frame.points([query.start, query.goal])
    # Ends on an outline are free, but do not always pass for points of the region.
    points, _ = environment.find_shortest_path(start, goal, verify=False)
    return frame.metres(points)


class _Frame:
    """The coordinates that the package is given: a region in the unit square.

    Its tolerances are shares of the coordinates, and meant for such. Points come back as those that
    went in, to the last bit: a path bends in nothing else.

    Parameters
    ----------
    region : Polygon
    """

    def __init__(self, region: Polygon) -> None:
        xmin, ymin, xmax, ymax = region.bounds
        self._corner = np.array([xmin, ymin])
        self._unit = unit_above(max(xmax - xmin, ymax - ymin))
        self._drawn: dict[tuple[float, float], tuple[float, float]] = {}

    def points(self, xy: ArrayLike) -> list[tuple[float, float]]:
        """Points (n, 2), metres, in the unit square."""
        drawn = np.asarray(xy, dtype=np.float64)
        unit = [(x, y) for x, y in ((drawn - self._corner) / self._unit).tolist()]
        self._drawn.update(zip(unit, ((x, y) for x, y in drawn.tolist()), strict=True))
        return unit

    def metres(self, points: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
        """Points of the package, (n, 2), as they were drawn."""
        drawn = [self._drawn[float(x), float(y)] for x, y in points]
        return np.array(drawn, dtype=np.float64).reshape(-1, 2)
