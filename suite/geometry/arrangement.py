"""From polygons to the arrays that the kernels read: node, label, triangulate, merge, index.

The outlines of workspace and obstacles are noded together on a fine grid, so that everything that
touches does so in common vertices. Each face of the arrangement is free or solid; solid faces are
cut into convex parts (constrained Delaunay, then Hertel and Mehlhorn 1983), and what two parts
share is a seam. All of it in coordinates relative to the workspace; the result, of vertices that
are float64 in the scene's coordinates too, is moved back without rounding. Metres, x right, y up.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import TypeVar

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from suite.geometry.coordinates import Coordinates, coordinates_of
from suite.geometry.kernels import YMAX, ObstacleArrays
from suite.geometry.predicates import orientation

Point = tuple[float, float]
Part = list[Point]
Array = TypeVar("Array", bound=np.ndarray)

FRAME_MARGIN = 0.25
"""Width of the frame around the workspace, as a share of the workspace's larger side."""


@dataclass(frozen=True, slots=True, eq=False)
class Arrangement:
    """The plane divided into free space, obstacle groups and the frame.

    solid : everything that is closed, frame included; its interior is what no path may meet.
    groups : the obstacle groups, each the union of obstacles that touch, without the frame.
    arrays : the same as convex parts, for the kernels.
    corners : (N, 6) float64, x, y of each corner where solid is convex, then x, y of the ends of
        the two boundary edges that bound its free side: counter-clockwise from the first to the
        second everything is free, over more than half a turn.
    corner_group : (N,) int64, the group of each corner's first boundary edge, in ascending order.
    free : the faces of free space; two may share an edge, where a sliver of solid was rounded away.
    """

    solid: MultiPolygon
    groups: tuple[MultiPolygon, ...]
    arrays: ObstacleArrays
    corners: NDArray[np.float64]
    corner_group: NDArray[np.int64]
    free: tuple[Polygon, ...]


def arrange(workspace: Polygon, obstacles: Sequence[Polygon]) -> Arrangement:
    """Divide a workspace into free space, obstacle groups and the frame around it.

    Parameters
    ----------
    workspace : Polygon
        Where the robot may be, valid, metres.
    obstacles : sequence of Polygon
        Valid, each inside the workspace; they may touch and overlap.

    Returns
    -------
    Arrangement
    """
    coordinates = coordinates_of(workspace.bounds)
    room, *drawn = (shapely.transform(p, coordinates.local) for p in (workspace, *obstacles))
    return _moved(_arrange(room, drawn, coordinates), coordinates)


def _arrange(
    workspace: Polygon, obstacles: Sequence[Polygon], coordinates: Coordinates
) -> Arrangement:
    """The same, of local coordinates to local coordinates."""
    faces, is_frame, free = _faces(workspace, obstacles, coordinates)
    parts, group_of, frame = _grouped_parts(faces, is_frame)
    order = sorted(range(len(parts)), key=lambda i: group_of[i])
    parts = [parts[i] for i in order]
    group_of = [group_of[i] for i in order]
    edges = _Edges(parts, group_of, workspace)
    sectors = _free_sectors(edges)
    corners, corner_group = _corners(sectors, edges)
    return Arrangement(
        solid=_as_multipolygon(shapely.union_all(faces)),
        groups=_group_polygons(parts, group_of, frame),
        arrays=_tables(parts, group_of, frame, edges, sectors, coordinates.grid),
        corners=corners,
        corner_group=corner_group,
        free=tuple(free),
    )


def _moved(arrangement: Arrangement, coordinates: Coordinates) -> Arrangement:
    """An arrangement of local coordinates in those of the scene."""
    if coordinates.origin == (0.0, 0.0):
        return arrangement
    arrays = arrangement.arrays
    return Arrangement(
        solid=shapely.transform(arrangement.solid, coordinates.world),
        groups=tuple(shapely.transform(g, coordinates.world) for g in arrangement.groups),
        arrays=ObstacleArrays(
            tree=_moved_rows(arrays.tree, YMAX + 1, coordinates),
            vertices=_moved_rows(arrays.vertices, 2, coordinates),
            groups=_moved_rows(arrays.groups, YMAX + 1, coordinates),
            boundary=_moved_rows(arrays.boundary, 4, coordinates),
            contacts=_moved_rows(arrays.contacts, 4, coordinates),
            pinches=_moved_rows(arrays.pinches, 2, coordinates),
            ways=arrays.ways,
        ),
        corners=_moved_rows(arrangement.corners, 6, coordinates),
        corner_group=arrangement.corner_group,
        free=tuple(shapely.transform(f, coordinates.world) for f in arrangement.free),
    )


def _moved_rows(
    rows: NDArray[np.float64], width: int, coordinates: Coordinates
) -> NDArray[np.float64]:
    """A table whose first columns are places x, y, x, y ..., moved."""
    moved = rows.copy()
    places = coordinates.world(rows[:, :width].reshape(len(rows), width // 2, 2))
    moved[:, :width] = places.reshape(len(rows), width)
    return _frozen(moved)


def _as_multipolygon(geometry: shapely.Geometry) -> MultiPolygon:
    polygons = [g for g in shapely.get_parts(geometry) if isinstance(g, Polygon)]
    return MultiPolygon(polygons)


def _faces(
    workspace: Polygon, obstacles: Sequence[Polygon], coordinates: Coordinates
) -> tuple[list[Polygon], list[bool], list[Polygon]]:
    """Solid faces of the arrangement, which of them belong to the frame, and its free faces."""
    xmin, ymin, xmax, ymax = workspace.bounds
    margin = FRAME_MARGIN * max(xmax - xmin, ymax - ymin)
    outer = shapely.box(xmin - margin, ymin - margin, xmax + margin, ymax + margin)
    outlines = [outer.boundary, workspace.boundary, *(o.boundary for o in obstacles)]
    noded = shapely.union_all(outlines, grid_size=coordinates.grid)
    if coordinates.origin != (0.0, 0.0):
        # A vertex is where float64 can say it in the coordinates of the scene.
        noded = shapely.transform(noded, lambda xy: coordinates.local(coordinates.world(xy)))
    faces = [f for f in shapely.get_parts(shapely.polygonize([noded])) if f.area > 0.0]
    inside = shapely.STRtree([f.representative_point() for f in faces])
    in_workspace = set(inside.query(workspace, predicate="contains").tolist())
    drawn = np.array(obstacles, dtype=np.object_)  # a list would lose its type when it is empty
    in_obstacle = set(inside.query(drawn, predicate="contains")[1].tolist())
    solid = [i for i in range(len(faces)) if i not in in_workspace or i in in_obstacle]
    free = sorted(in_workspace - in_obstacle)
    return (
        [faces[i] for i in solid],
        [i not in in_workspace for i in solid],
        [faces[i] for i in free],
    )


def _grouped_parts(
    faces: Sequence[Polygon], is_frame: Sequence[bool]
) -> tuple[list[Part], list[int], int]:
    """Convex parts of all faces, the group of each, and the number of the frame's group.

    Faces of obstacles that have a vertex in common are one group; the frame is a group of its own,
    the last, because the paper's escape distance asks where a group is joined to the border.
    """
    group_of_face = _join_by_vertices(
        [f for f, out in zip(faces, is_frame, strict=True) if not out]
    )
    frame = len(set(group_of_face))
    labels = iter(group_of_face)
    triangles: list[Part] = []
    group_of: list[int] = []
    for face, out in zip(faces, is_frame, strict=True):
        group = frame if out else next(labels)
        for triangle in _triangles(face):
            triangles.append(triangle)
            group_of.append(group)
    return *_merge_convex(triangles, group_of), frame


def _join_by_vertices(faces: Sequence[Polygon]) -> list[int]:
    """Number the connected components of faces that share vertices, in order of appearance."""
    parent = list(range(len(faces)))

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    owner: dict[Point, int] = {}
    for i, face in enumerate(faces):
        for point in map(tuple, shapely.get_coordinates(face).tolist()):
            parent[root(i)] = root(owner.setdefault(point, i))
    numbers: dict[int, int] = {}
    return [numbers.setdefault(root(i), len(numbers)) for i in range(len(faces))]


def _triangles(face: Polygon) -> Iterable[Part]:
    """Constrained Delaunay triangles of a face, each counter-clockwise."""
    for triangle in shapely.get_parts(shapely.constrained_delaunay_triangles(face)):
        a, b, c = (tuple(p) for p in shapely.get_coordinates(triangle)[:3].tolist())
        side = orientation(*a, *b, *c)
        if side != 0:
            yield [a, b, c] if side > 0 else [a, c, b]


def _merge_convex(
    triangles: Sequence[Part], group_of: Sequence[int]
) -> tuple[list[Part], list[int]]:
    """Remove shared edges of a group's parts while the result stays convex (Hertel, Mehlhorn)."""
    parts: dict[int, Part] = dict(enumerate(triangles))
    owner = {edge: i for i, part in parts.items() for edge in _edges_of(part)}
    for a, b in list(owner):
        i, j = owner.get((a, b)), owner.get((b, a))
        if i is None or j is None or i == j or group_of[i] != group_of[j]:
            continue
        merged = _merged(parts[i], parts[j], a, b)
        if merged is None:
            continue
        for edge in (*_edges_of(parts[i]), *_edges_of(parts[j])):
            del owner[edge]
        del parts[j]
        parts[i] = merged
        owner.update(dict.fromkeys(_edges_of(merged), i))
    return list(parts.values()), [group_of[i] for i in parts]


def _edges_of(part: Part) -> Iterable[tuple[Point, Point]]:
    return pairwise([*part, part[0]])


def _merged(first: Part, second: Part, a: Point, b: Point) -> Part | None:
    """Union of two convex parts over their common edge a -> b of the first, if it is convex."""
    i = first.index(a)
    j = second.index(b)
    head = first[i + 1 :] + first[: i + 1]  # b ... a
    tail = second[j + 1 :] + second[: j + 1]  # a ... b
    # A vertex inside the common side would be left over as a spike: the side goes as a whole.
    while head[1] == tail[-2]:
        head, tail = head[1:], tail[:-1]
    while head[-2] == tail[1]:
        head, tail = head[:-1], tail[1:]
    a, b = tail[0], head[0]
    convex_at_a = orientation(*head[-2], *a, *tail[1]) >= 0
    convex_at_b = orientation(*tail[-2], *b, *head[1]) >= 0
    return head + tail[1:-1] if convex_at_a and convex_at_b else None


class _Edges:
    """Directed edges of all parts (solid on the left), and what lies on their other side."""

    def __init__(self, parts: Sequence[Part], group_of: Sequence[int], workspace: Polygon) -> None:
        self.group: dict[tuple[Point, Point], int] = {}
        self.parts_at: dict[Point, list[int]] = defaultdict(list)
        for i, part in enumerate(parts):
            for edge in _edges_of(part):
                self.group[edge] = group_of[i]
                self.parts_at[edge[0]].append(i)
        xmin, ymin, xmax, ymax = workspace.bounds
        margin = 0.5 * FRAME_MARGIN * max(xmax - xmin, ymax - ymin)
        self._limits = (xmin - margin, ymin - margin, xmax + margin, ymax + margin)

    def is_seam(self, edge: tuple[Point, Point]) -> bool:
        return edge[::-1] in self.group

    def is_outer(self, edge: tuple[Point, Point]) -> bool:
        """Whether an edge lies on the outside of the frame, where no path can come."""
        xmin, ymin, xmax, ymax = self._limits
        return not all(xmin < x < xmax and ymin < y < ymax for x, y in edge)

    def bounding_free_space(self) -> list[tuple[Point, Point]]:
        return [e for e in self.group if not self.is_seam(e) and not self.is_outer(e)]


Sector = tuple[Point, Point, Point]
"""A vertex, then the two neighbours that bound a free sector, counter-clockwise."""


def _free_sectors(edges: _Edges) -> list[Sector]:
    """The free sectors at each vertex of the boundary of free space."""
    arriving: dict[Point, list[Point]] = defaultdict(list)
    leaving: dict[Point, list[Point]] = defaultdict(list)
    for a, b in edges.bounding_free_space():
        leaving[a].append(b)
        arriving[b].append(a)
    sectors: list[Sector] = []
    for v, sources in arriving.items():
        if len(sources) == 1:
            sectors.append((v, sources[0], leaving[v][0]))
            continue
        ways = [(_angle(v, m), m, True) for m in sources]
        ways += [(_angle(v, n), n, False) for n in leaving[v]]
        ways.sort(key=lambda way: way[0])
        for (_, m, arrives), (_, n, _) in pairwise([*ways, ways[0]]):
            if arrives:
                sectors.append((v, m, n))
    return sectors


def _angle(origin: Point, target: Point) -> float:
    return float(np.arctan2(target[1] - origin[1], target[0] - origin[0]))


def _corners(
    sectors: Sequence[Sector], edges: _Edges
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Free sectors of more than half a turn, by group and place, and the group of each."""
    found = sorted(
        ((v, m, n) for v, m, n in sectors if orientation(*v, *m, *n) < 0),
        key=lambda sector: (edges.group[sector[1], sector[0]], sector),
    )
    rows = np.array(found, dtype=np.float64).reshape(-1, 6)
    groups = np.array([edges.group[(m, v)] for v, m, _ in found], dtype=np.int64)
    return _frozen(rows), _frozen(groups)


def _group_polygons(
    parts: Sequence[Part], group_of: Sequence[int], frame: int
) -> tuple[MultiPolygon, ...]:
    members: list[list[Polygon]] = [[] for _ in range(frame)]
    for part, group in zip(parts, group_of, strict=True):
        if group != frame:
            members[group].append(Polygon(part))
    return tuple(_as_multipolygon(shapely.union_all(m)) for m in members)


def _tables(
    parts: Sequence[Part],
    group_of: Sequence[int],
    frame: int,
    edges: _Edges,
    sectors: Sequence[Sector],
    grid: float,
) -> ObstacleArrays:
    """Everything in the layout of the kernels; ``parts`` are sorted by group."""
    boundary, contacts = _boundaries_and_contacts(group_of, frame, edges, grid)
    pinches, ways = _pinches(parts, edges, sectors)
    tree, after = _tree(parts, group_of, frame)
    groups = [
        (*_box([p for part in members for p in part]), len(members), end, *edge_rows, *contact_rows)
        for members, end, edge_rows, contact_rows in zip(
            _by_group(parts, group_of, frame),
            after,
            _spans([len(b) for b in boundary]),
            _spans([len(c) for c in contacts]),
            strict=True,
        )
    ]
    return ObstacleArrays(
        tree=_table(tree, 8),
        vertices=_table([(*e[0], edges.is_seam(e)) for part in parts for e in _edges_of(part)], 3),
        groups=_table(groups, 10),
        boundary=_table([(*a, *b) for group in boundary for a, b in group], 4),
        contacts=_table([(*a, *b) for group in contacts for a, b in group], 4),
        pinches=_table(
            [(*v, *rows) for v, rows in zip(pinches, _spans([len(w) for w in ways]), strict=True)],
            4,
        ),
        ways=_table([way for around in ways for way in around], 2),
    )


def _by_group(parts: Sequence[Part], group_of: Sequence[int], frame: int) -> list[list[Part]]:
    members: list[list[Part]] = [[] for _ in range(frame + 1)]
    for part, group in zip(parts, group_of, strict=True):
        members[group].append(part)
    return members


Box = tuple[float, float, float, float]


def _tree(
    parts: Sequence[Part], group_of: Sequence[int], frame: int
) -> tuple[list[tuple[float, ...]], list[int]]:
    """Rows of the tree of boxes, and for each group the row after it.

    Sets of groups are halved until they are single, then sets of their parts: each time along the
    longer side of their box, at the median of their centres.
    """
    rows: list[tuple[float, ...]] = []
    after = [0] * (frame + 1)
    leaves: list[list[tuple[Box, int, int]]] = [[] for _ in range(frame + 1)]
    for part, group, span in zip(parts, group_of, _spans([len(p) for p in parts]), strict=True):
        leaves[group].append((_box(part), *span))

    def add_parts(members: list[tuple[Box, int, int]], group: int) -> None:
        if len(members) == 1:
            box, first, last = members[0]
            rows.append((*box, len(rows) + 1, group, first, last))
            return
        at = len(rows)
        rows.append(())
        boxes = [box for box, _, _ in members]
        for half in _halves(boxes):
            add_parts([members[i] for i in half], group)
        rows[at] = (*_hull(boxes), len(rows), group, -1, -1)

    def add_groups(members: list[int]) -> None:
        if len(members) == 1:
            add_parts(leaves[members[0]], members[0])
            after[members[0]] = len(rows)
            return
        at = len(rows)
        rows.append(())
        boxes = [_hull([box for box, _, _ in leaves[group]]) for group in members]
        for half in _halves(boxes):
            add_groups([members[i] for i in half])
        rows[at] = (*_hull(boxes), len(rows), -1, -1, -1)

    add_groups(list(range(frame + 1)))
    return rows, after


def _hull(boxes: Sequence[Box]) -> Box:
    """The box around boxes."""
    xmin, ymin, xmax, ymax = zip(*boxes, strict=True)
    return min(xmin), min(ymin), max(xmax), max(ymax)


def _halves(boxes: Sequence[Box]) -> tuple[list[int], list[int]]:
    """Indices of boxes, halved at the median of their centres along the longer side of all."""
    xmin, ymin, xmax, ymax = _hull(boxes)
    axis = 0 if xmax - xmin >= ymax - ymin else 1
    order = sorted(range(len(boxes)), key=lambda i: boxes[i][axis] + boxes[i][axis + 2])
    middle = len(order) // 2
    return order[:middle], order[middle:]


Stretch = tuple[Point, Point]


def _boundaries_and_contacts(
    group_of: Sequence[int], frame: int, edges: _Edges, grid: float
) -> tuple[list[list[Stretch]], list[list[Stretch]]]:
    """For each group its edges towards anything else, and where it touches the frame."""
    boundary: list[list[Stretch]] = [[] for _ in range(frame + 1)]
    shared: list[list[Stretch]] = [[] for _ in range(frame + 1)]
    points: list[list[Stretch]] = [[] for _ in range(frame + 1)]
    for edge, group in edges.group.items():
        other = edges.group.get(edge[::-1])
        if other != group and not edges.is_outer(edge):
            boundary[group].append(edge)
        if other == frame and group != frame:
            shared[group].append(edge)
    along = [{v for edge in stretches for v in edge} for stretches in shared]
    for v, incident in edges.parts_at.items():
        groups = {group_of[i] for i in incident}
        if frame in groups:
            for group in groups - {frame}:
                if v not in along[group]:
                    points[group].append((v, v))
    contacts = [_whole_stretches(s, grid) + p for s, p in zip(shared, points, strict=True)]
    return boundary, contacts


def _whole_stretches(shared: Sequence[Stretch], grid: float) -> list[Stretch]:
    """Edges in a row, straight but for the rounding of their vertices, joined to one stretch.

    However an obstacle's side along the border is cut up, it is one contact.
    """
    leaving = Counter(a for a, _ in shared)
    forks = [edge for edge in shared if leaving[edge[0]] > 1]
    end = {a: b for a, b in shared if leaving[a] == 1}
    for a in list(end):
        while a in end and end[a] in end and _is_straight(a, end[a], end[end[a]], grid):
            end[a] = end.pop(end[a])
    return [*forks, *end.items()]


def _is_straight(a: Point, b: Point, c: Point, grid: float) -> bool:
    """Whether b lies between a and c, or as far beside as snapping to the grid may move it."""
    (ux, uy), (wx, wy) = (b[0] - a[0], b[1] - a[1]), (c[0] - a[0], c[1] - a[1])
    length = float(np.hypot(wx, wy))
    beside, along = abs(ux * wy - uy * wx), ux * wx + uy * wy
    return beside <= 2.0 * grid * length and 0.0 < along < length**2


def _pinches(
    parts: Sequence[Part], edges: _Edges, sectors: Sequence[Sector]
) -> tuple[list[Point], list[list[Point]]]:
    """Vertices with more than one free sector, and a direction into each part that meets them."""
    count: dict[Point, int] = defaultdict(int)
    for v, _, _ in sectors:
        count[v] += 1
    pinches = sorted(v for v, n in count.items() if n > 1)
    return pinches, [[_way_into(parts[i], v) for i in edges.parts_at[v]] for v in pinches]


def _way_into(part: Part, v: Point) -> Point:
    """A direction from vertex v to the inside of a convex part: to the mean of its vertices."""
    x, y = np.mean(part, axis=0).tolist()
    return x - v[0], y - v[1]


def _box(points: Sequence[Point]) -> tuple[float, float, float, float]:
    xs, ys = zip(*points, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def _spans(lengths: Sequence[int]) -> list[tuple[int, int]]:
    """Rows "from" and "to" of consecutive runs of these lengths."""
    ends = list(accumulate(lengths, initial=0))
    return list(pairwise(ends))


def _table(rows: Sequence[tuple[float, ...]], width: int) -> NDArray[np.float64]:
    return _frozen(np.array(rows, dtype=np.float64).reshape(-1, width))


def _frozen(array: Array) -> Array:
    array.setflags(write=False)
    return array
