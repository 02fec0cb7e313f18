"""From polygons to the arrays that the kernels read: node, label, triangulate, merge, index.

The outlines of workspace and obstacles are noded together on a fine grid, so that everything that
touches does so in common vertices. Each face of the arrangement is free or solid; solid faces are
cut into convex parts (constrained Delaunay, then Hertel and Mehlhorn 1983), and what two parts
share is a seam. All of it in coordinates relative to the workspace; the result, of vertices that
are float64 in the scene's coordinates too, is moved back without rounding. Metres, x right, y up.
"""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import TypeVar

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.geometry import MultiPolygon, Polygon

from suite.geometry.coordinates import Coordinates, coordinates_of
from suite.geometry.kernels import YMAX, ObstacleArrays
from suite.geometry.parts import Part, Places, convex_parts, sides

Point = tuple[float, float]
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
    places = Places(faces)
    group_of_face, frame = _groups(faces, is_frame, places)
    parts, group_of = convex_parts(faces, group_of_face, places)
    order = sorted(range(len(parts)), key=lambda i: group_of[i])
    parts = [parts[i] for i in order]
    group_of = [group_of[i] for i in order]
    edges = _Edges(parts, group_of, places, workspace)
    sectors = _free_sectors(edges)
    corners, corner_group = _corners(sectors, edges)
    return Arrangement(
        solid=_as_multipolygon(shapely.coverage_union_all(faces)),
        groups=_group_polygons(faces, group_of_face, frame),
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


def _groups(
    faces: Sequence[Polygon], is_frame: Sequence[bool], places: Places
) -> tuple[list[int], int]:
    """The group of each solid face, and the number of the frame's group.

    Faces of obstacles that have a vertex in common are one group; the frame is a group of its own,
    the last, because the paper's escape distance asks where a group is joined to the border.
    """
    drawn = [i for i, out in enumerate(is_frame) if not out]
    numbers = _join_by_vertices([faces[i] for i in drawn], places)
    frame = len(set(numbers))
    group_of = [frame] * len(faces)
    for i, number in zip(drawn, numbers, strict=True):
        group_of[i] = number
    return group_of, frame


def _join_by_vertices(faces: Sequence[Polygon], places: Places) -> list[int]:
    """Number the connected components of faces that share vertices, in order of appearance."""
    parent = list(range(len(faces)))

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    xy, index = shapely.get_coordinates(np.array(faces, dtype=np.object_), return_index=True)
    pairs = np.unique(np.stack([places.numbers(xy), index], axis=1), axis=0)
    same = pairs[1:, 0] == pairs[:-1, 0]
    for i, j in zip(pairs[:-1, 1][same].tolist(), pairs[1:, 1][same].tolist(), strict=True):
        parent[root(j)] = root(i)
    numbers: dict[int, int] = {}
    return [numbers.setdefault(root(i), len(numbers)) for i in range(len(faces))]


class _Edges:
    """Directed edges of all parts (solid on the left), in order, and what is on their other side.

    tail, head : (E,) numbers of the places between which they run.
    part, group : (E,) to which they belong.
    other : (E,) the group on the other side; -1 if that is free, or outside.
    is_outer : (E,) whether they lie on the outside of the frame, where no path can come.
    first : (P,) the first edge of each part.
    """

    def __init__(
        self,
        parts: Sequence[Part],
        group_of: Sequence[int],
        places: Places,
        workspace: Polygon,
    ) -> None:
        self.places = places
        lengths = np.array([len(part) for part in parts])
        self.first = np.cumsum(lengths) - lengths
        self.tail = np.array([v for part in parts for v in part])
        self.head = np.roll(self.tail, -1)
        self.head[self.first + lengths - 1] = self.tail[self.first]
        self.part = np.repeat(np.arange(len(parts)), lengths)
        self.group = np.array(group_of)[self.part]
        there = self.tail * len(places.xy) + self.head
        back = self.head * len(places.xy) + self.tail
        order = np.argsort(there)
        at = order[np.minimum(np.searchsorted(there, back, sorter=order), len(order) - 1)]
        self.other = np.where(there[at] == back, self.group[at], -1)
        xmin, ymin, xmax, ymax = workspace.bounds
        margin = 0.5 * FRAME_MARGIN * max(xmax - xmin, ymax - ymin)
        low, high = (xmin - margin, ymin - margin), (xmax + margin, ymax + margin)
        is_inner = np.all((places.xy > low) & (places.xy < high), axis=1)
        self.is_outer = ~(is_inner[self.tail] & is_inner[self.head])

    @property
    def bounding_free_space(self) -> NDArray[np.int64]:
        """Numbers of the edges that have free space on their other side."""
        return np.flatnonzero((self.other < 0) & ~self.is_outer)


def _free_sectors(edges: _Edges) -> NDArray[np.int64]:
    """The free sectors at each vertex of the boundary of free space.

    (S, 4): a vertex, the two neighbours that bound the sector, counter-clockwise, and the number of
    the edge that arrives from the first of them.
    """
    boundary = edges.bounding_free_space
    tail, head = edges.tail[boundary], edges.head[boundary]
    count = np.bincount(head, minlength=len(edges.places.xy))
    leaving = np.empty(len(count), dtype=np.int64)
    leaving[tail] = head
    alone = count[head] == 1
    simple = np.stack([head, tail, leaving[head], boundary], axis=1)[alone]
    arrives: dict[int, list[tuple[int, int]]] = defaultdict(list)
    leaves: dict[int, list[int]] = defaultdict(list)
    for v, m, edge in zip(
        head[~alone].tolist(), tail[~alone].tolist(), boundary[~alone].tolist(), strict=True
    ):
        arrives[v].append((m, edge))
    crowded = count[tail] > 1
    for v, n in zip(tail[crowded].tolist(), head[crowded].tolist(), strict=True):
        leaves[v].append(n)
    sectors: list[tuple[int, int, int, int]] = []
    for v, sources in arrives.items():
        ways = [(_angle(edges.places, v, m), m, edge) for m, edge in sources]
        ways += [(_angle(edges.places, v, n), n, -1) for n in leaves[v]]
        ways.sort(key=lambda way: way[0])
        for (_, m, edge), (_, n, _) in pairwise([*ways, ways[0]]):
            if edge >= 0:
                sectors.append((v, m, n, edge))
    return np.concatenate([simple, np.array(sectors, dtype=np.int64).reshape(-1, 4)])


def _angle(places: Places, origin: int, target: int) -> float:
    (ax, ay), (bx, by) = places.points[origin], places.points[target]
    return float(np.arctan2(by - ay, bx - ax))


def _corners(
    sectors: NDArray[np.int64], edges: _Edges
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Free sectors of more than half a turn, by group and place, and the group of each."""
    xy = edges.places.xy
    found = sectors[sides(xy[sectors[:, 0]], xy[sectors[:, 1]], xy[sectors[:, 2]]) < 0]
    v, m, n, edge = found.T
    groups = edges.group[edge]
    order = np.lexsort((n, m, v, groups))
    return _frozen(xy[found[order, :3]].reshape(-1, 6)), _frozen(groups[order])


def _group_polygons(
    faces: Sequence[Polygon], group_of: Sequence[int], frame: int
) -> tuple[MultiPolygon, ...]:
    members: list[list[Polygon]] = [[] for _ in range(frame + 1)]
    for face, group in zip(faces, group_of, strict=True):
        members[group].append(face)
    return tuple(
        MultiPolygon(m) if len(m) == 1 else _as_multipolygon(shapely.coverage_union_all(m))
        for m in members[:frame]
    )


def _tables(
    parts: Sequence[Part],
    group_of: Sequence[int],
    frame: int,
    edges: _Edges,
    sectors: NDArray[np.int64],
    grid: float,
) -> ObstacleArrays:
    """Everything in the layout of the kernels; ``parts`` are sorted by group."""
    xy = edges.places.xy
    boundary = np.flatnonzero((edges.other != edges.group) & ~edges.is_outer)
    contacts = _contacts(frame, edges, grid)
    pinches, ways = _pinches(parts, edges, sectors)
    boxes = _boxes_of_parts(edges)
    tree, after = _tree(boxes, [len(p) for p in parts], group_of, frame)
    count = np.bincount(group_of, minlength=frame + 1)
    edge_count = np.bincount(edges.group[boundary], minlength=frame + 1)
    starts = np.cumsum(count) - count
    return ObstacleArrays(
        tree=_table(tree, 8),
        vertices=_frozen(np.column_stack([xy[edges.tail], (edges.other >= 0).astype(np.float64)])),
        groups=_frozen(
            np.column_stack(
                [
                    np.minimum.reduceat(boxes[:, :2], starts),
                    np.maximum.reduceat(boxes[:, 2:], starts),
                    count,
                    after,
                    _spans(edge_count),
                    _spans([len(c) for c in contacts]),
                ]
            ).astype(np.float64)
        ),
        boundary=_frozen(np.hstack([xy[edges.tail[boundary]], xy[edges.head[boundary]]])),
        contacts=_table([(*a, *b) for group in contacts for a, b in group], 4),
        pinches=_frozen(np.hstack([xy[pinches], _spans([len(w) for w in ways])])),
        ways=_table([way for around in ways for way in around], 2),
    )


Box = tuple[float, float, float, float]


def _boxes_of_parts(edges: _Edges) -> NDArray[np.float64]:
    """(P, 4) the box of each part."""
    xy = edges.places.xy[edges.tail]
    low, high = np.minimum.reduceat(xy, edges.first), np.maximum.reduceat(xy, edges.first)
    return np.hstack([low, high])


def _tree(
    boxes: NDArray[np.float64], lengths: Sequence[int], group_of: Sequence[int], frame: int
) -> tuple[list[tuple[float, ...]], list[int]]:
    """Rows of the tree of boxes, and for each group the row after it.

    Sets of groups are halved until they are single, then sets of their parts: each time along the
    longer side of their box, at the median of their centres.
    """
    rows: list[tuple[float, ...]] = []
    after = [0] * (frame + 1)
    leaves: list[list[tuple[Box, int, int]]] = [[] for _ in range(frame + 1)]
    ends = list(accumulate(lengths, initial=0))
    for (xmin, ymin, xmax, ymax), group, span in zip(
        boxes.tolist(), group_of, pairwise(ends), strict=True
    ):
        leaves[group].append(((xmin, ymin, xmax, ymax), *span))
    hulls = [_hull([box for box, _, _ in leaf]) for leaf in leaves]

    def add_parts(members: list[tuple[Box, int, int]], group: int) -> None:
        if len(members) == 1:
            box, first, last = members[0]
            rows.append((*box, len(rows) + 1, group, first, last))
            return
        at = len(rows)
        rows.append(())
        boxes = [box for box, _, _ in members]
        hull = _hull(boxes)
        for half in _halves(boxes, hull):
            add_parts([members[i] for i in half], group)
        rows[at] = (*hull, len(rows), group, -1, -1)

    def add_groups(members: list[int]) -> None:
        if len(members) == 1:
            add_parts(leaves[members[0]], members[0])
            after[members[0]] = len(rows)
            return
        at = len(rows)
        rows.append(())
        boxes = [hulls[group] for group in members]
        hull = _hull(boxes)
        for half in _halves(boxes, hull):
            add_groups([members[i] for i in half])
        rows[at] = (*hull, len(rows), -1, -1, -1)

    add_groups(list(range(frame + 1)))
    return rows, after


def _hull(boxes: Sequence[Box]) -> Box:
    """The box around boxes."""
    xmin, ymin, xmax, ymax = zip(*boxes, strict=True)
    return min(xmin), min(ymin), max(xmax), max(ymax)


def _halves(boxes: Sequence[Box], hull: Box) -> tuple[list[int], list[int]]:
    """Indices of boxes, halved at the median of their centres along the longer side of all."""
    xmin, ymin, xmax, ymax = hull
    axis = 0 if xmax - xmin >= ymax - ymin else 1
    twice_centre = [box[axis] + box[axis + 2] for box in boxes]
    order = sorted(range(len(boxes)), key=twice_centre.__getitem__)
    middle = len(order) // 2
    return order[:middle], order[middle:]


Stretch = tuple[Point, Point]


def _contacts(frame: int, edges: _Edges, grid: float) -> list[list[Stretch]]:
    """For each group, where it touches the frame."""
    points = edges.places.points
    shared: list[list[Stretch]] = [[] for _ in range(frame + 1)]
    along: list[set[int]] = [set() for _ in range(frame + 1)]
    for edge in np.flatnonzero((edges.other == frame) & (edges.group != frame)).tolist():
        a, b, group = int(edges.tail[edge]), int(edges.head[edge]), int(edges.group[edge])
        shared[group].append((points[a], points[b]))
        along[group] |= {a, b}
    single: list[list[Stretch]] = [[] for _ in range(frame + 1)]
    of_frame = np.zeros(len(points), dtype=np.bool_)
    of_frame[edges.tail[edges.group == frame]] = True
    touching = np.flatnonzero(of_frame[edges.tail] & (edges.group != frame)).tolist()
    for v, group in dict.fromkeys((int(edges.tail[i]), int(edges.group[i])) for i in touching):
        if v not in along[group]:
            single[group].append((points[v], points[v]))
    return [_whole_stretches(s, grid) + p for s, p in zip(shared, single, strict=True)]


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
    parts: Sequence[Part], edges: _Edges, sectors: NDArray[np.int64]
) -> tuple[NDArray[np.int64], list[list[Point]]]:
    """Vertices with more than one free sector, and a direction into each part that meets them."""
    pinches = np.flatnonzero(np.bincount(sectors[:, 0]) > 1)
    ways: dict[int, list[Point]] = {v: [] for v in pinches.tolist()}
    for edge in np.flatnonzero(np.isin(edges.tail, pinches)).tolist():
        v = int(edges.tail[edge])
        ways[v].append(_way_into(parts[edges.part[edge]], v, edges.places))
    return pinches, list(ways.values())


def _way_into(part: Part, v: int, places: Places) -> Point:
    """A direction from vertex v to the inside of a convex part: to the mean of its vertices."""
    x, y = np.mean([places.points[w] for w in part], axis=0).tolist()
    return x - places.points[v][0], y - places.points[v][1]


def _spans(lengths: ArrayLike) -> NDArray[np.int64]:
    """(n, 2) rows "from" and "to" of consecutive runs of these lengths."""
    counts = np.asarray(lengths, dtype=np.int64)
    ends = np.cumsum(counts)
    return np.stack([ends - counts, ends], axis=1)


def _table(rows: Sequence[tuple[float, ...]], width: int) -> NDArray[np.float64]:
    return _frozen(np.array(rows, dtype=np.float64).reshape(-1, width))


def _frozen(array: Array) -> Array:
    array.setflags(write=False)
    return array
