"""The referee: whether a returned path is feasible, and how long it is, recomputed with shapely.

It trusts nobody: not the planner's claims, nor its arrays, nor the kernels and the exact solver
that the planners use themselves. Free space has the suite's one meaning: a path is feasible if it
is a limit of paths that keep a positive clearance. So touching an obstacle is free, entering it is
not, and a passage of zero width (a seam, a slit along the border, a pinch point) is closed.
Metres, x right, y up.

GEOS, under shapely, rounds the points in which lines cross: an entry as shallow as that rounding
(1e-16 m) may go unseen. The kernels, which are exact, never call free what the referee rejects.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from suite.geometry.coordinates import printed
from suite.scenes.scene import Query, Scene

INTERIORS_MEET = "T********"
"""DE-9IM pattern of "enters"; `intersects` would reject paths that only touch."""

NAMING_DISTANCE = 10.0
"""How near a place must lie to an obstacle to be named after it, in widths of the scene's grid: the
arrangement is snapped to it, what is drawn is not. Only the wording of a reason depends on it."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What the referee says of a path. Nothing is measured of a path that is not valid.

    valid : whether the path leads from start to goal through free space.
    reason : what is wrong and where; None if the path is valid.
    length : metres.
    clearance : smallest distance to anything closed, the border of the workspace included, metres.
    segments : number of segments that are longer than zero.
    turning : sum of the angles by which the path turns at its waypoints, radians.
    """

    valid: bool
    reason: str | None = None
    length: float | None = None
    clearance: float | None = None
    segments: int | None = None
    turning: float | None = None


class _Foul(Exception):  # noqa: N818 (not an error of the program)
    """Why a path is not valid."""


def judge(scene: Scene, query: Query, path: Any) -> Verdict:
    """Judge one path; for many paths in one scene, make one :class:`Referee`.

    Parameters
    ----------
    scene : Scene
    query : Query
        The path must start and end exactly at its start and goal.
    path : Any
        What a planner returned: (n, 2) float64, metres, if it kept the contract.

    Returns
    -------
    Verdict

    Examples
    --------
    >>> from suite.scenes.scene import make_scene
    >>> scene = make_scene(
    ...     "one box", shapely.box(0, 0, 10, 10), [shapely.box(4, 0, 6, 7)],
    ...     {"main": ((0, 3), (10, 3))},
    ... )
    >>> over_the_top = [[0, 3], [0, 7], [10, 7], [10, 3]]  # touching the box is free
    >>> judge(scene, scene.query(), over_the_top).length
    18.0
    >>> judge(scene, scene.query(), [[0, 3], [10, 3]]).reason
    'segment 1, from (0, 3) to (10, 3), enters obstacle 1 at (4, 3).'
    """
    return Referee(scene).judge(query, path)


def flaw_of_path(path: Any) -> str | None:
    """What is wrong with the form of a path, whatever the scene; None if nothing is.

    Examples
    --------
    >>> flaw_of_path([[0, 3, 1]])
    'not a path: an array of shape (1, 3), not (n, 2).'
    """
    try:
        _as_path(path)
    except _Foul as foul:
        return str(foul)
    return None


class Referee:
    """Judge of all paths of one scene; holds the scene's geometry prepared for it.

    Parameters
    ----------
    scene : Scene
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._near = NAMING_DISTANCE * scene.coordinates.grid
        self._solid = scene.arrangement.solid
        shapely.prepare(self._solid)
        self._edges = _edges(self._solid)
        self._pinches = _points_where_boundary_touches_itself(self._solid)
        self._pinch_tree = shapely.STRtree([shapely.Point(p) for p in self._pinches])
        self._sectors: dict[int, NDArray[np.object_]] = {}

    def judge(self, query: Query, path: Any) -> Verdict:
        """Say whether a path is valid, and measure it if it is.

        Parameters
        ----------
        query : Query
            Of this scene.
        path : Any
            What a planner returned.

        Returns
        -------
        Verdict
        """
        try:
            xy = _as_path(path)
            self._check_ends(query, xy)
            xy, numbers = _without_repeats(xy)
            self._check_box(xy, numbers)
            if len(xy) > 1:
                self._check_segments(xy, numbers)
                self._check_pinches(xy, numbers)
            elif shapely.relate_pattern(self._solid, shapely.Point(xy[0]), INTERIORS_MEET):
                raise _Foul(f"start and goal {printed(*xy[0])} are not in free space.")
        except _Foul as foul:
            return Verdict(False, str(foul))
        line = shapely.LineString(xy) if len(xy) > 1 else shapely.Point(xy[0])
        return Verdict(
            True,
            length=float(shapely.length(line)),
            clearance=float(shapely.distance(self._solid, line)),
            segments=len(xy) - 1,
            turning=_turning(xy),
        )

    def _check_ends(self, query: Query, xy: NDArray[np.float64]) -> None:
        for what, wanted, point in (("start", query.start, xy[0]), ("goal", query.goal, xy[-1])):
            if not np.array_equal(point, wanted):
                verb = "starts" if what == "start" else "ends"
                raise _Foul(
                    f"{verb} at {printed(*point)}, not at the {what} {printed(*wanted)}: "
                    f"they are {np.hypot(*(point - wanted)):.3g} m apart."
                )

    def _check_box(self, xy: NDArray[np.float64], numbers: NDArray[np.int64]) -> None:
        """Refuse points beyond the frame, where the arrangement knows nothing."""
        xmin, ymin, xmax, ymax = self._solid.bounds
        outside = np.any((xy < (xmin, ymin)) | (xy > (xmax, ymax)), axis=1)
        if outside.any():
            i = int(np.argmax(outside))
            raise _Foul(f"point {numbers[i] + 1}, {printed(*xy[i])}, lies outside the workspace.")

    def _check_segments(self, xy: NDArray[np.float64], numbers: NDArray[np.int64]) -> None:
        segments = _segments(xy)
        entering = shapely.relate_pattern(self._solid, segments, INTERIORS_MEET)
        if np.any(entering):
            i = int(np.argmax(entering))
            raise _Foul(f"{_segment(xy, numbers, i)}, {self._what_it_enters(segments[i])}.")

    def _check_pinches(self, xy: NDArray[np.float64], numbers: NDArray[np.int64]) -> None:
        """Refuse a path that changes the sector of free space in a point where solid touches."""
        visits = self._pinch_tree.query(_segments(xy), predicate="intersects").T
        for i, pinch in visits[np.lexsort(visits.T[::-1])].tolist():
            point = self._pinches[pinch]
            if np.array_equal(xy[i], point):
                continue  # the bend belongs to the segment that arrives; a start has none
            arrives_at_bend = np.array_equal(xy[i + 1], point)
            if arrives_at_bend and i + 2 == len(xy):
                continue
            onward = xy[i + 2] if arrives_at_bend else xy[i + 1]
            if self._sector(pinch, xy[i]) != self._sector(pinch, onward):
                raise _Foul(
                    f"{_segment(xy, numbers, i)}, slips through {printed(*point)}, "
                    f"a single point in which {self._neighbours(point)} touch."
                )

    def _sector(self, pinch: int, towards: NDArray[np.float64]) -> int:
        """Tell which free sector around a pinch point a straight way from it runs in, or along."""
        direction = towards - self._pinches[pinch]
        probe = shapely.Point(0.5 * direction / np.hypot(*direction))
        return int(np.argmin(shapely.distance(self._free_sectors(pinch), probe)))

    def _free_sectors(self, pinch: int) -> NDArray[np.object_]:
        """Cut the free parts of a small disc around a pinch point, scaled to the unit disc.

        The disc is so small that solid meets it in wedges only; two free parts have at most the
        pinch point itself in common.
        """
        if pinch not in self._sectors:
            point = self._pinches[pinch]
            incident = np.any(np.all(self._edges == point, axis=2), axis=1)
            others = shapely.linestrings(self._edges[~incident])
            radius = 0.5 * float(shapely.distance(others, shapely.Point(point)).min())
            local = shapely.transform(self._solid, lambda xy: (xy - point) / radius)
            disc = shapely.Point(0.0, 0.0).buffer(1.0)
            self._sectors[pinch] = shapely.get_parts(shapely.difference(disc, local))
        return self._sectors[pinch]

    def _what_it_enters(self, segment: shapely.LineString) -> str:
        """Say what a segment that is known to leave free space enters first, and where."""
        pieces = shapely.get_parts(shapely.intersection(segment, self._solid))
        pieces = pieces[
            shapely.get_dimensions(pieces) == 1
        ]  # a shallow entry is rounded to a point
        pieces = pieces[shapely.relate_pattern(self._solid, pieces, INTERIORS_MEET)]
        if len(pieces) == 0:  # or to the boundary
            pieces = np.array([segment])
        origin = shapely.get_point(segment, 0)
        first = pieces[np.argmin(shapely.distance(pieces, origin))]
        entry, probe = shapely.line_interpolate_point(first, (0.0, min(first.length / 2, 0.001)))
        names = self._named(probe, INTERIORS_MEET)
        if names:
            return f"enters {names[0]} at {printed(*_xy(entry))}"
        if not self._scene.workspace.covers(probe):
            return f"leaves the workspace at {printed(*_xy(entry))}"
        neighbours = self._neighbours(_xy(probe))
        return f"runs between {neighbours} from {printed(*_xy(entry))}, where they touch"

    def _neighbours(self, point: NDArray[np.float64]) -> str:
        place = shapely.Point(point)
        names = self._named(place)
        if shapely.dwithin(self._scene.workspace.boundary, place, self._near):
            names.append("the border of the workspace")
        return " and ".join(names) if len(names) > 1 else f"parts of {', '.join(names)}"

    def _named(self, place: shapely.Point, pattern: str | None = None) -> list[str]:
        """Names of the obstacles at a place, or only of those that match a DE-9IM pattern."""
        return [
            o.name
            for o in self._scene.obstacles
            if (
                shapely.dwithin(o.polygon, place, self._near)
                if pattern is None
                else shapely.relate_pattern(o.polygon, place, pattern)
            )
        ]


def _as_path(path: Any) -> NDArray[np.float64]:
    """Copy what a planner returned into a finite array (n, 2), n >= 2, or say why it is none."""
    if path is None:
        raise _Foul("there is no path.")
    try:
        given = np.array(path)
    except Exception as error:  # anything may raise here: __array__ and __len__ are the planner's
        raise _Foul(f"not a path: {type(error).__name__}: {error}") from error
    if given.dtype.kind not in "fiu":
        raise _Foul(f"not a path: an array of {given.dtype}, not of float64.")
    if given.ndim != 2 or given.shape[1] != 2:
        raise _Foul(f"not a path: an array of shape {given.shape}, not (n, 2).")
    if len(given) < 2:
        raise _Foul(f"not a path: {len(given)} points. It needs a start and a goal.")
    xy = given.astype(np.float64)
    unfit = ~np.isfinite(xy).all(axis=1)
    if unfit.any():
        i = int(np.argmax(unfit))
        raise _Foul(f"point {i + 1} is {printed(*xy[i])}. Coordinates must be finite numbers.")
    return xy


def _without_repeats(
    xy: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Drop points that repeat the one before; also return the numbers of those that stay."""
    stays = np.concatenate([[True], np.any(xy[1:] != xy[:-1], axis=1)])
    return xy[stays], np.flatnonzero(stays)


def _segments(xy: NDArray[np.float64]) -> NDArray[np.object_]:
    return np.asarray(shapely.linestrings(np.stack([xy[:-1], xy[1:]], axis=1)))


def _rings(solid: shapely.MultiPolygon) -> list[NDArray[np.float64]]:
    """Coordinates of all rings, each closed: its first vertex is its last."""
    return [
        shapely.get_coordinates(ring)
        for polygon in solid.geoms
        for ring in (polygon.exterior, *polygon.interiors)
    ]


def _edges(solid: shapely.MultiPolygon) -> NDArray[np.float64]:
    """(E, 2, 2), the two ends of each edge of the boundary."""
    return np.concatenate([np.stack([xy[:-1], xy[1:]], axis=1) for xy in _rings(solid)])


def _points_where_boundary_touches_itself(solid: shapely.MultiPolygon) -> NDArray[np.float64]:
    """(K, 2), the vertices that occur more than once over all rings."""
    vertices = np.concatenate([xy[:-1] for xy in _rings(solid)])
    places, counts = np.unique(vertices, axis=0, return_counts=True)
    return places[counts > 1]


def _turning(xy: NDArray[np.float64]) -> float:
    """Sum of the absolute angles between consecutive segments, radians."""
    headings = np.arctan2(*np.diff(xy, axis=0).T[::-1])
    turns = np.diff(headings)
    return float(np.abs((turns + np.pi) % (2.0 * np.pi) - np.pi).sum())


def _segment(xy: NDArray[np.float64], numbers: NDArray[np.int64], i: int) -> str:
    # Numbered from 1, and as the planner returned the path, repeats included.
    return f"segment {numbers[i + 1]}, from {printed(*xy[i])} to {printed(*xy[i + 1])}"


def _xy(point: shapely.Point) -> NDArray[np.float64]:
    return shapely.get_coordinates(point)[0]
