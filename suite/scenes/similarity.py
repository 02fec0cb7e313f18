"""A scene turned, scaled and shifted as a whole, in which all that was closed stays closed.

What touches must go on touching, though the moved vertices are rounded: a vertex that lay on the
edge of a border at the grid's precision would lie a grid's width beside it, and leave a slit. So
first each outline gets a vertex wherever another one touches it. Then what touches does so in
common vertices, and those are moved and rounded alike. Metres.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely
from msgspec import structs
from numpy.typing import NDArray
from shapely.geometry import LineString, Point, Polygon

from suite.errors import SceneError
from suite.geometry.coordinates import Coordinates, coordinates_of
from suite.scenes.dynamics import Dynamics, Removal, make_motion
from suite.scenes.modifiers import MARK, Modifiers
from suite.scenes.scene import Obstacle, Scene, make_scene

Points = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Similarity:
    """The map p -> centre + linear (p - centre) + shift of the plane.

    linear : (2, 2) float64, a rotation times a scale.
    centre, shift : (2,) float64, metres.
    coordinates : of the scene that is moved, where it comes to lie.
    """

    linear: Points
    centre: Points
    shift: Points
    coordinates: Coordinates

    def points(self, xy: Points) -> Points:
        """Move points (n, 2), metres, onto the grid of the moved scene."""
        moved = _moved(xy, self.linear, self.centre, self.shift)
        return self.coordinates.snapped(moved)

    def vectors(self, xy: Points) -> Points:
        """Turn and scale vectors (n, 2), metres."""
        return np.round(xy @ self.linear.T, self.coordinates.decimals) + 0.0


def _moved(xy: Points, linear: Points, centre: Points, shift: Points) -> Points:
    return (xy - centre) @ linear.T + centre + shift


def make_similarity(modifiers: Modifiers, room: Polygon) -> Similarity:
    """The map that modifiers stand for, about the centre of a workspace, metres."""
    xmin, ymin, xmax, ymax = room.bounds
    centre = np.array([(xmin + xmax) / 2.0, (ymin + ymax) / 2.0])
    angle = np.radians(modifiers.turn)
    cos, sin = np.cos(angle), np.sin(angle)
    linear = modifiers.scale * np.array([[cos, -sin], [sin, cos]])
    shift = np.array(modifiers.shift)
    corners = _moved(shapely.get_coordinates(room), linear, centre, shift)
    (x0, y0), (x1, y1) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return Similarity(linear, centre, shift, coordinates_of((x0, y0, x1, y1)))


def modified(scene: Scene, modifiers: Modifiers, *, inflate: float = 0.0) -> Scene:
    """A scene with its workspace, obstacles, starts and goals moved as one.

    Parameters
    ----------
    scene : Scene
        Not yet inflated.
    modifiers : Modifiers
    inflate : float
        Radius of the robot, metres; it is not scaled. See :func:`suite.scenes.scene.make_scene`.

    Returns
    -------
    Scene
        Named as the scene with its modifiers behind it. Of its properties the optima are left out,
        for they were computed of other coordinates; if it is scaled, the paper's best cost too.

    Raises
    ------
    SceneError
        If it can't be moved: its coordinates get too large or too fine, or it is dynamic and would
        be scaled.

    Examples
    --------
    >>> from suite.scenes.modifiers import parse_modifiers
    >>> box = make_scene("box", shapely.box(0, 0, 8, 4), [], ((1, 1), (7, 1)))
    >>> turned = modified(box, parse_modifiers("turn=90", "box"))
    >>> turned.name, turned.bounds, turned.query().goal.tolist()
    ('box@turn=90', (2.0, -2.0, 6.0, 6.0), [5.0, 5.0])
    """
    name = f"{scene.name}{MARK}{modifiers.text}"
    if scene.is_dynamic and modifiers.scale != 1.0:
        raise SceneError(
            f"{name}: a dynamic scene can't be scaled, for speeds and ranges would have to be too. "
            "Take turn, shift and twin."
        )
    move = make_similarity(modifiers, scene.workspace)
    room, *polygons = (shapely.transform(polygon, move.points) for polygon in _with_contacts(scene))
    return make_scene(
        name,
        room,
        [
            Obstacle(o.name, polygon, _moved_dynamics(o.dynamics, move))
            for o, polygon in zip(scene.obstacles, polygons, strict=True)
        ],
        {q.name: (move.points(q.start), move.points(q.goal)) for q in scene.queries},
        properties=_moved_properties(scene, modifiers, move),
        path=scene.path,
        inflate=inflate,
        strata={q.name: q.stratum for q in scene.queries if q.stratum is not None},
        keep_blocked=any(query.blocked is not None for query in scene.queries),
    )


def _with_contacts(scene: Scene) -> list[Polygon]:
    """Workspace and obstacles on the grid, with vertices where others or ends touch them."""
    polygons = [scene.workspace, *(o.polygon for o in scene.obstacles)]
    drawn = [shapely.transform(polygon, scene.coordinates.snapped) for polygon in polygons]
    ends = [point for query in scene.queries for point in (query.start, query.goal)]
    places = np.unique(np.vstack([shapely.get_coordinates(drawn), *ends]), axis=0)
    tree = shapely.STRtree([Point(place) for place in places])
    return [
        Polygon(
            _with_vertices(polygon, polygon.exterior, places, tree, scene.coordinates.grid),
            [
                _with_vertices(polygon, hole, places, tree, scene.coordinates.grid)
                for hole in polygon.interiors
            ],
        )
        for polygon in drawn
    ]


def _with_vertices(
    polygon: Polygon, ring: shapely.LinearRing, places: Points, tree: shapely.STRtree, grid: float
) -> Points:
    """A ring of a polygon with those places as vertices that lie on its edges."""
    corners = shapely.get_coordinates(ring)
    edges = [LineString(corners[i : i + 2]) for i in range(len(corners) - 1)]
    found = tree.query(edges, predicate="dwithin", distance=grid).T.tolist()
    own = {tuple(corner) for corner in shapely.get_coordinates(polygon).tolist()}
    between: list[list[Points]] = [[] for _ in edges]
    for edge, place in found:
        # Its own would fold a ring that comes so near to itself.
        if tuple(places[place].tolist()) not in own and _is_between(
            places[place], edges[edge], grid
        ):
            between[edge].append(places[place])
    rows: list[Points] = []
    for corner, inner in zip(corners[:-1], between, strict=True):
        rows += [corner, *_by_distance(corner, inner)]
    return np.array(rows)


def _is_between(place: Points, edge: LineString, grid: float) -> bool:
    """Whether a place on an edge is none of its ends, nor so near that it would fold the ring."""
    return all(np.hypot(*(place - end)) > grid for end in shapely.get_coordinates(edge))


def _by_distance(origin: Points, points: Sequence[Points]) -> list[Points]:
    return sorted(points, key=lambda point: float(np.hypot(*(point - origin))))


def _moved_dynamics(dynamics: Dynamics | None, move: Similarity) -> Dynamics | None:
    if dynamics is None:
        return None
    motion, removal = dynamics.motion, dynamics.removal
    if motion is not None:
        motion = make_motion(np.column_stack([motion.times, move.vectors(motion.offsets)]))
    return replace(dynamics, motion=motion, removal=_moved_removal(removal, move))


def _moved_removal(removal: Removal | None, move: Similarity) -> Removal | None:
    if removal is None or removal.place is None:
        return removal
    x, y = move.points(np.array(removal.place)).tolist()
    return structs.replace(removal, place=(x, y))


def _moved_properties(scene: Scene, modifiers: Modifiers, move: Similarity) -> dict[str, Any]:
    left_out = {"optimum"} if modifiers.scale == 1.0 else {"optimum", "paper_best"}
    kept = {key: value for key, value in scene.properties.items() if key not in left_out}
    if "gates" in kept:
        kept["gates"] = {
            name: move.points(np.array(gate, dtype=np.float64)).tolist()
            for name, gate in kept["gates"].items()
        }
    return kept | {"modified": modifiers.text}
