"""Scenes and queries: where the robot may go, what is in its way, and from where to where.

Units are metres; x points right, y up. The robot is a point: its size and safety margin are
already in the obstacles (paper section II-A), or are added by ``inflate``.
"""

import hashlib
import json
import re
import warnings
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.affinity import translate
from shapely.geometry import MultiPolygon, Polygon

from suite.errors import SceneError
from suite.geometry.arrangement import Arrangement, arrange
from suite.geometry.coordinates import Coordinates, coordinates_of, printed
from suite.geometry.coverage import left_open
from suite.geometry.growth import grown, shrunk
from suite.geometry.kernels import PARTS, ObstacleArrays
from suite.geometry.mesh import Mesh, mesh_of
from suite.geometry.tolerances import LARGEST
from suite.scenes.dynamics import Dynamics, as_text
from suite.scenes.free_space import free_regions, nearest_free
from suite.scenes.polygons import as_polygon, check_polygon, check_width

DEFAULT_QUERY = "main"

COARSEST = 1e-6
"""Widest grid that a scene may have, as a share of the workspace's larger side: lengths of paths
are compared to this."""


MOST_NAMES = 12
"""Queries that are named in an error: a map may have thousands."""

_NUMBER = r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]{1,3})?)"
_TWO_POINTS = re.compile(rf"{_NUMBER},{_NUMBER}:{_NUMBER},{_NUMBER}")


class SceneWarning(UserWarning):
    """A scene was mended on loading, in a way that its author may want to know."""


@dataclass(frozen=True, slots=True, eq=False)
class Query:
    """One planning problem in a scene.

    name : str, unique in its scene.
    start, goal : (2,) float64, metres, read-only.
    blocked : why it can't be asked: an end that is not in free space; None if both are. No planner
        is run on it.
    stratum : the part of a set of queries that it belongs to, of a similar difficulty; or None.
    moved : metres by which start and goal were moved to free space.
    """

    name: str
    start: NDArray[np.float64]
    goal: NDArray[np.float64]
    blocked: str | None = None
    stratum: str | None = None
    moved: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True, eq=False)
class Obstacle:
    """An obstacle as its author drew it: a polygon, convex or concave, maybe with holes.

    dynamics : how it changes over time; None if it is static.
    """

    name: str
    polygon: Polygon
    dynamics: Dynamics | None = None

    @property
    def moves(self) -> bool:
        """Whether it is ever anywhere else than where it is drawn."""
        return self.dynamics is not None and self.dynamics.motion is not None


@dataclass(frozen=True, eq=False)
class Scene:
    """A workspace, its obstacles and its queries. Built by :func:`make_scene`, then immutable.

    Whoever asks for its geometry sees obstacles as they are drawn: all known, none moving. What a
    dynamic scene is like at a time, :func:`scene_at` says.

    name : str
    workspace : Polygon without holes, metres.
    obstacles : tuple of Obstacle, inside the workspace, but for those that move, whose drawing may
        stick out; they may touch and overlap.
    queries : tuple of Query; none in a map that says nothing of where to go.
    properties : read-only mapping, what the scene file says about itself.
    path : the file that the scene came from, or None.
    radius : of the robot that the obstacles were grown by, metres.
    snaps : whether ends of queries that are not free are moved to the nearest place that is.
    """

    name: str
    workspace: Polygon
    obstacles: tuple[Obstacle, ...]
    queries: tuple[Query, ...]
    properties: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    path: Path | None = None
    radius: float = 0.0
    snaps: bool = False

    def __getstate__(self) -> dict[str, Any]:
        """All but what is made of it: arrays would come back writable, another type to numba."""
        made = ("arrangement", "at_first", "regions", "mesh")
        state = {k: v for k, v in self.__dict__.items() if k not in made}
        return state | {"properties": dict(self.properties)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, properties=MappingProxyType(state["properties"]))
        for query in self.queries:  # a pickle forgets that arrays are read-only
            query.start.setflags(write=False)
            query.goal.setflags(write=False)

    @cached_property
    def coordinates(self) -> Coordinates:
        """Where its coordinates lie, and the grid on which they are told apart."""
        return coordinates_of(self.workspace.bounds)

    @cached_property
    def arrangement(self) -> Arrangement:
        """The plane divided into free space, obstacle groups and the frame."""
        return arrange(self.workspace, [p for o in self.obstacles for p in self.closed_by(o)])

    @cached_property
    def mesh(self) -> Mesh | None:
        """Free space as triangles, for the exact solver; None if it can't be cut into any."""
        return mesh_of(self.arrangement.free, self.coordinates)

    def closed_by(self, obstacle: Obstacle) -> list[Polygon]:
        """What an obstacle closes of the workspace; one that moves is cut at the border."""
        return _inside(self.workspace, obstacle.polygon, obstacle.moves, self.coordinates)

    @cached_property
    def at_first(self) -> "Scene":
        """The static scene that it is at time 0: itself, if it is static."""
        return scene_at(self, 0.0) if self.is_dynamic else self

    @cached_property
    def regions(self) -> MultiPolygon:
        """The parts of free space: between two of them there is no path."""
        return free_regions(self.arrangement.solid)

    @property
    def arrays(self) -> ObstacleArrays:
        """The obstacles as convex parts, for the kernels."""
        return self.arrangement.arrays

    @cached_property
    def hash(self) -> str:
        """Hash of workspace and obstacles: what a result depends on, whatever the name says."""
        content = [self.workspace.wkb_hex, *(o.polygon.wkb_hex for o in self.obstacles)]
        dynamics = [(i, o.dynamics) for i, o in enumerate(self.obstacles)]
        content += [f"{i} {as_text(changes)}" for i, changes in dynamics if changes is not None]
        return hashlib.sha256("\n".join(content).encode()).hexdigest()[:16]

    @property
    def is_dynamic(self) -> bool:
        """Whether any of its obstacles is not static."""
        return any(o.dynamics is not None for o in self.obstacles)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """xmin, ymin, xmax, ymax of the workspace, metres."""
        return self.workspace.bounds

    @property
    def vertex_count(self) -> int:
        """Number of vertices that the obstacles were drawn with."""
        return sum(_vertex_count(o.polygon) for o in self.obstacles)

    @property
    def part_count(self) -> int:
        """Number of convex parts of all obstacles (the frame does not count)."""
        return int(self.arrays.groups[:-1, PARTS].sum())

    def query(self, name: str | None = None) -> Query:
        """The query of that name, or the first one.

        Parameters
        ----------
        name : str, optional
            Of one of its queries, or any two points as ``x,y:x,y`` (start, goal, metres).

        Raises
        ------
        SceneError
            If there is none.

        Examples
        --------
        >>> make_scene("hall", shapely.box(0, 0, 9, 9), [], {}).query("1,1:8,2.5").goal.tolist()
        [8.0, 2.5]
        """
        for query in self.queries if name is not None else self.queries[:1]:
            if query.name == name or name is None:
                return query
        found = None if name is None else _TWO_POINTS.fullmatch(name)
        if name is not None and found is not None:
            x, y, to_x, to_y = (float(number) for number in found.groups())
            query = _as_query(self.name, name, ((x, y), (to_x, to_y)), self.coordinates)
            return _asked(self.name, self, query)
        names = ", ".join(q.name for q in self.queries[:MOST_NAMES])
        more = len(self.queries) - MOST_NAMES
        raise SceneError(
            f"{self.name}: no query{f' {name!r}' if name else ''}. "
            + (f"It has: {names}{f' and {more} more' if more > 0 else ''}. " if names else "")
            + "Any two points are one: x,y:x,y for start and goal, in metres."
        )

    def stored_optimum(self, query: Query) -> float | None:
        """The exact optimum that the scene file states for a query, metres; None if it has none."""
        optima = self.properties.get("optimum", {})
        value = optima.get(query.name) if isinstance(optima, Mapping) else None
        return None if value is None else float(value)


def _vertex_count(polygon: Polygon) -> int:
    return int(shapely.get_num_coordinates(polygon)) - 1 - len(polygon.interiors)


def make_scene(
    name: str,
    workspace: Polygon | ArrayLike,
    obstacles: Iterable[Polygon | Obstacle | ArrayLike],
    queries: Mapping[str, tuple[ArrayLike, ArrayLike]] | tuple[ArrayLike, ArrayLike],
    *,
    properties: Mapping[str, Any] | None = None,
    path: Path | None = None,
    inflate: float = 0.0,
    strata: Mapping[str, str] | None = None,
    keep_blocked: bool = False,
    grown_by: float = 0.0,
) -> Scene:
    """Check and normalise the pieces of a scene, and put them together.

    Parameters
    ----------
    name : str
        Of the scene; part of the random stream of its runs.
    workspace : Polygon, or its vertices (n, 2)
        Where the robot may be, metres. Its holes become obstacles.
    obstacles : iterable of Polygon, Obstacle, or vertices (n, 2)
        What sticks out of the workspace is cut off, with a :class:`SceneWarning`. Vertices are
        listed in order, either way round; the last is joined to the first.
    queries : mapping from name to (start, goal), or one such pair
        Points (2,), metres. A pair alone is the query ``main``; none are none.
    properties : mapping, optional
        Kept with the scene as they are, but for the optima, which hold for a robot of no size.
    path : Path, optional
        The file that the pieces came from; named in errors.
    inflate : float
        Radius of the robot, metres: obstacles grow by it and the workspace shrinks by it. Queries
        whose ends are not free then are kept, and blocked.
    strata : mapping from name of a query to name of its stratum, optional
    keep_blocked : bool
        Keep queries whose ends are not free at time 0, blocked, whatever the radius.
    grown_by : float
        Radius of the robot by which the pieces have grown already, metres.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        If a polygon is not valid, or a start or goal is not in free space at time 0.

    Examples
    --------
    >>> scene = make_scene(
    ...     "one box", shapely.box(0, 0, 10, 10), [shapely.box(4, 0, 6, 8)],
    ...     {"main": ((1, 1), (9, 1))},
    ... )
    >>> scene.part_count, scene.query().goal.tolist()
    (1, [9.0, 1.0])

    The same from arrays of vertices:

    >>> room = np.array([(0, 0), (10, 0), (10, 10), (0, 10)])
    >>> wall = np.array([(4, 0), (6, 0), (6, 8), (4, 8)])
    >>> make_scene("one box", room, [wall], ((1, 1), (9, 1))).query().goal.tolist()
    [9.0, 1.0]
    """
    where = path.name if path is not None else name
    room = as_polygon(where, "workspace", workspace)
    named = [
        Obstacle(o.name, as_polygon(where, o.name, o.polygon), o.dynamics)
        if isinstance(o, Obstacle)
        else Obstacle(f"obstacle {i}", as_polygon(where, f"obstacle {i}", o))
        for i, o in enumerate(obstacles, 1)
    ]
    check_polygon(where, "workspace", room)
    coordinates = _coordinates(where, room)
    check_width(where, "workspace", room, coordinates)
    for obstacle in named:
        check_polygon(where, obstacle.name, obstacle.polygon)
        check_width(where, obstacle.name, obstacle.polygon, coordinates)
    _check_unique(where, "obstacles", [o.name for o in named])
    if not np.isfinite(inflate) or inflate < 0.0:
        raise SceneError(f"{where}: inflate is {inflate}. Give a radius of 0 m or more.")
    room, named = _normalise(where, room, named, inflate)
    coordinates = coordinates_of(room.bounds)
    ends = queries if isinstance(queries, Mapping) else {DEFAULT_QUERY: queries}
    strata = strata or {}
    scene = Scene(
        name=name,
        workspace=room,
        obstacles=tuple(named),
        queries=tuple(
            replace(_as_query(where, key, pair, coordinates), stratum=strata.get(key))
            for key, pair in ends.items()
        ),
        properties=MappingProxyType(_still_true(properties or {}, inflate)),
        path=path,
        radius=grown_by + inflate,
    )
    _check_closed(where, scene)
    asked = tuple(_asked(where, scene, query) for query in scene.queries)
    for query in asked:
        if query.blocked is not None and not (keep_blocked or scene.radius > 0.0):
            raise SceneError(query.blocked)
    # Not a copy: the arrangement, which is kept with the scene, took its time.
    object.__setattr__(scene, "queries", asked)
    return scene


def _still_true(properties: Mapping[str, Any], inflate: float) -> dict[str, Any]:
    """The properties without what holds for a point only, if the robot is none."""
    of_a_point = ("optimum", "published", "published_as")
    return {k: v for k, v in properties.items() if inflate == 0.0 or k not in of_a_point}


def _check_unique(where: str, what: str, names: Sequence[str]) -> None:
    for name, count in Counter(names).items():
        if count > 1:
            raise SceneError(
                f"{where}: two {what} are named '{name}'. Give each a name of its own."
            )


def _coordinates(where: str, room: Polygon) -> Coordinates:
    """The coordinates of a room, if they can tell its places apart."""
    coordinates = coordinates_of(room.bounds)
    xmin, ymin, xmax, ymax = room.bounds
    side = max(xmax - xmin, ymax - ymin)
    if coordinates.grid > COARSEST * side:
        raise SceneError(
            f"{where}, workspace: {side:g} m wide, at {printed(xmin, ymin)}, where coordinates "
            f"are told apart to {coordinates.grid:g} m. Shift the scene towards (0, 0)."
        )
    return coordinates


def _normalise(
    where: str, workspace: Polygon, obstacles: Sequence[Obstacle], inflate: float
) -> tuple[Polygon, list[Obstacle]]:
    """Make holes of the workspace obstacles, grow by the robot, and cut at the workspace."""
    coordinates = coordinates_of(workspace.bounds)
    room = Polygon(workspace.exterior)
    holes = [
        Obstacle(f"hole {i} of the workspace", Polygon(h))
        for i, h in enumerate(workspace.interiors, 1)
    ]
    if inflate > 0.0:
        left = shapely.transform(
            shrunk(shapely.transform(room, coordinates.local), inflate, coordinates.grid),
            coordinates.world,
        )
        if not isinstance(left, Polygon) or left.is_empty:
            raise SceneError(
                f"{where}: a robot of radius {inflate} m has no room in the workspace."
            )
        room = left
    # A vertex computed on a slanted border lies 1e-16 beside it: that does not stick out.
    within = shapely.transform(room, coordinates.local).buffer(coordinates.grid, join_style="mitre")
    shapely.prepare(within)
    kept: list[Obstacle] = []
    for obstacle in (*obstacles, *holes):
        local, polygon = shapely.transform(obstacle.polygon, coordinates.local), obstacle.polygon
        if inflate > 0.0:
            local = grown(local, inflate, coordinates.grid)
            polygon = shapely.transform(local, coordinates.world)
        if obstacle.moves or within.covers(local):
            kept.append(Obstacle(obstacle.name, polygon, obstacle.dynamics))
            continue
        pieces = _inside(room, polygon, True, coordinates)
        if inflate == 0.0:
            warnings.warn(
                f"{where}, {obstacle.name}: sticks out of the workspace and was cut at its border"
                + ("." if pieces else "; nothing of it is left."),
                SceneWarning,
                stacklevel=4,
            )
        for i, piece in enumerate(pieces, 1):
            suffix = f" ({i})" if len(pieces) > 1 else ""
            kept.append(Obstacle(obstacle.name + suffix, piece, obstacle.dynamics))
    return room, kept


def _inside(room: Polygon, polygon: Polygon, cut: bool, coordinates: Coordinates) -> list[Polygon]:
    """The pieces of a polygon within a workspace; the polygon itself if it need not be cut."""
    if not cut:
        return [polygon]
    local, within = (shapely.transform(p, coordinates.local) for p in (polygon, room))
    pieces = shapely.get_parts(shapely.transform(within.intersection(local), coordinates.world))
    return [p for p in pieces if isinstance(p, Polygon) and p.area > 0.0]


def _as_query(
    where: str, name: str, ends: tuple[ArrayLike, ArrayLike], coordinates: Coordinates
) -> Query:
    try:
        start, goal = ends
    except (TypeError, ValueError) as error:
        raise SceneError(
            f"{where}, query '{name}': {ends!r} is no pair of points. Give (start, goal)."
        ) from error
    return Query(
        name,
        _as_point(where, f"start of query '{name}'", start, coordinates),
        _as_point(where, f"goal of query '{name}'", goal, coordinates),
    )


def _as_point(
    where: str, what: str, point: ArrayLike, coordinates: Coordinates
) -> NDArray[np.float64]:
    try:
        xy = np.array(point, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise SceneError(f"{where}, {what}: {point!r} is not a point. Give [x, y].") from error
    if xy.shape != (2,):
        raise SceneError(f"{where}, {what}: {point!r} is not a point. Give [x, y].")
    if not (np.abs(xy) <= LARGEST).all():
        raise SceneError(
            f"{where}, {what}: ({xy[0]}, {xy[1]}). "
            f"Coordinates must be finite numbers, in metres, up to {LARGEST:g}."
        )
    # On the grid of the obstacles, so that a start on a vertex or a border stays there.
    xy = coordinates.snapped(xy)
    xy.setflags(write=False)
    return xy


def _check_closed(where: str, scene: Scene) -> None:
    """Refuse a scene of which something that was drawn would not be closed."""
    drawn = [(o, piece) for o in scene.obstacles for piece in scene.closed_by(o)]
    solid = scene.arrangement.solid
    for i in left_open(solid, [piece for _, piece in drawn], scene.coordinates):
        raise SceneError(
            f"{where}, {drawn[i][0].name}: rounding would leave a part of it open. "
            "Draw it with fewer vertices that are nearly the same."
        )


def _asked(where: str, scene: Scene, query: Query) -> Query:
    """A query with what blocks it at time 0, if anything does.

    What comes upon an end later is what dynamic scenes are for: a hit, or a goal to wait for.
    """
    now = scene.at_first
    if scene.snaps:
        query = _moved_to_free_space(now, query)
    ends = (("start", query.start), ("goal", query.goal))
    found = (_not_free(now, point) for _, point in ends)
    whys = [
        f"{where}, {role} of query '{query.name}': {printed(*point)} {why}"
        for (role, point), why in zip(ends, found, strict=True)
        if why is not None
    ]
    return replace(query, blocked=whys[0] if whys else None)


def _moved_to_free_space(scene: Scene, query: Query) -> Query:
    """A query whose ends are free, each where it was, or in the nearest place that is."""
    ends = [
        point
        if _not_free(scene, point) is None
        else nearest_free(point, scene.regions, scene.arrangement.solid, scene.coordinates)
        for point in (query.start, query.goal)
    ]
    by = [
        float(np.hypot(*(new - old)))
        for new, old in zip(ends, (query.start, query.goal), strict=True)
    ]
    return replace(query, start=ends[0], goal=ends[1], moved=(by[0], by[1]))


def with_snapped_ends(scene: Scene, name: str) -> Scene:
    """The same scene of another name, in which ends that are not free are moved to where it is.

    Parameters
    ----------
    scene : Scene
        Its queries may be blocked.
    name : str
        Of the new one. Its queries keep their names, and say by how much they were moved.
    """
    snapping = _with_same_geometry(scene, name=name, snaps=True)
    asked = tuple(_asked(name, snapping, query) for query in scene.queries)
    return _with_same_geometry(snapping, queries=asked)


def renamed(scene: Scene, name: str, properties: Mapping[str, Any] | None = None) -> Scene:
    """The same scene of another name and other properties, with all that was computed of it."""
    told = scene.properties if properties is None else MappingProxyType(dict(properties))
    return _with_same_geometry(scene, name=name, properties=told)


def _with_same_geometry(scene: Scene, **changes: Any) -> Scene:
    """A copy that keeps the arrangement, which took its time."""
    copy = replace(scene, **changes)
    kept = ("arrangement", "mesh", "regions", "hash", "coordinates")
    copy.__dict__.update({key: scene.__dict__[key] for key in kept if key in scene.__dict__})
    return copy


def _not_free(scene: Scene, point: NDArray[np.float64]) -> str | None:
    """Why a point is not in the free space of a static scene; None if it is."""
    place, grid = shapely.Point(point), scene.coordinates.grid
    grown_by = f", grown by the robot's radius of {scene.radius:g} m" if scene.radius else ""
    # Asked of thousands of queries: prepared, which is kept with the geometry.
    shapely.prepare([scene.workspace, scene.arrangement.solid])
    if not shapely.dwithin(scene.workspace, place, grid):
        smaller = f", made smaller by the robot's radius of {scene.radius:g} m"
        return (
            f"lies outside the workspace, {printed(*scene.bounds[:2])} to "
            f"{printed(*scene.bounds[2:])}{smaller if scene.radius else ''}. Move it inside."
        )
    if scene.arrangement.solid.contains(place):
        names = [o.name for o in scene.obstacles if o.polygon.distance(place) <= grid]
        names = names or ["the border of the workspace"]
        return f"lies inside {' and '.join(names)}{grown_by}. Move it to free space."
    return None


def scene_at(scene: Scene, time: float, without: Collection[str] = ()) -> Scene:
    """The static scene that a dynamic one is at a time.

    Parameters
    ----------
    scene : Scene
    time : float
        Seconds. Obstacles are where they are then; those that are not there then are left out.
    without : names of obstacles
        To be left out too: what is not known yet, or what the robot's coming has removed.

    Returns
    -------
    Scene
        Its queries are those of the scene; their ends may lie in an obstacle at that time.

    Examples
    --------
    >>> from suite.scenes.dynamics import Dynamics, constant_speed
    >>> door = Obstacle("door", shapely.box(0, 4, 2, 5), Dynamics(constant_speed((1, 0), 0, 5)))
    >>> scene = make_scene("hall", shapely.box(0, 0, 9, 9), [door], ((1, 1), (1, 8)))
    >>> scene_at(scene, 3.0).obstacles[0].polygon.bounds
    (3.0, 4.0, 5.0, 5.0)
    """
    obstacles = [
        at_time
        for o in scene.obstacles
        if o.name not in without
        for at_time in _obstacle_at(scene, o, time)
    ]
    return replace(scene, obstacles=tuple(obstacles))


def _obstacle_at(scene: Scene, obstacle: Obstacle, time: float) -> list[Obstacle]:
    """An obstacle as it is at a time: in pieces where the border cuts it, or not there at all."""
    dynamics = obstacle.dynamics
    if dynamics is None:
        return [obstacle]
    if not dynamics.is_there(time):
        return []
    polygon = translate(obstacle.polygon, *dynamics.offset(time))
    cut = obstacle.moves and not scene.workspace.covers(polygon)
    pieces = _inside(scene.workspace, polygon, cut, scene.coordinates)
    names = [obstacle.name] if len(pieces) == 1 else _numbered(obstacle.name, len(pieces))
    return [Obstacle(name, piece) for name, piece in zip(names, pieces, strict=True)]


def _numbered(name: str, count: int) -> list[str]:
    return [f"{name} ({i})" for i in range(1, count + 1)]


def scene_fingerprint(scene: Scene, query: Query) -> str:
    """Hash of a scene's geometry and one query: the key under which results are kept."""
    ends = json.dumps([query.start.tolist(), query.goal.tolist()])
    return hashlib.sha256(f"{scene.hash}\n{ends}".encode()).hexdigest()[:16]
