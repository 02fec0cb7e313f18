"""Scenes and paths as SVG outlines. A thousand units are the longer side; y points down there."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import Polygon

from suite.scenes.scene import Query, Scene

Bounds = tuple[float, float, float, float]
"""xmin, ymin, xmax, ymax."""

Place = tuple[int, int]
"""In the units of a picture."""

LONGER_SIDE = 1000.0
MARGIN = 25
"""Around the workspace, for the marks of start and goal."""


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A scene, to be put below paths.

    view_box : of the picture.
    room, obstacles : outlines, with holes by the even-odd rule.
    left, top, scale : what turns metres into these units.
    """

    view_box: str
    room: str
    obstacles: str
    left: float
    top: float
    scale: float

    def outline(self, path: NDArray[np.float64]) -> str:
        """A path as the attribute ``d`` of an SVG path.

        Parameters
        ----------
        path : (n, 2) float64, metres
        """
        return _outline(_units(path, self.left, self.top, self.scale))

    def ends(self, query: Query) -> tuple[Place, Place]:
        """Where the start and the goal of a query are."""
        points = np.array([query.start, query.goal])
        start, goal = _units(points, self.left, self.top, self.scale).tolist()
        return (start[0], start[1]), (goal[0], goal[1])

    def outlines(self, paths: Iterable[NDArray[np.float64]]) -> str:
        """Several paths as one."""
        return "".join(map(self.outline, paths))


def draw(scene: Scene, seen: Bounds | None = None) -> Drawing:
    """Draw a scene.

    Parameters
    ----------
    scene : Scene
    seen : Bounds, optional
        Of what fills the picture, metres; default: the workspace.
    """
    xmin, ymin, xmax, ymax = seen or scene.bounds
    scale = LONGER_SIDE / max(xmax - xmin, ymax - ymin)
    width, height = (round(scale * side) for side in (xmax - xmin, ymax - ymin))

    def closed(polygon: Polygon) -> str:
        rings = (polygon.exterior, *polygon.interiors)
        return "".join(
            _outline(_units(np.asarray(ring.coords)[:-1, :2], xmin, ymax, scale)) + "Z"
            for ring in rings
        )

    return Drawing(
        f"{-MARGIN} {-MARGIN} {width + 2 * MARGIN} {height + 2 * MARGIN}",
        closed(scene.workspace),
        "".join(closed(obstacle.polygon) for obstacle in scene.obstacles),
        xmin,
        ymax,
        scale,
    )


def _units(xy: NDArray[np.float64], left: float, top: float, scale: float) -> NDArray[np.int64]:
    units = np.column_stack([xy[:, 0] - left, top - xy[:, 1]]) * scale
    return units.round().astype(np.int64)


def _outline(units: NDArray[np.int64]) -> str:
    # Of a large map many corners come to lie on each other.
    moved = np.append(True, (units[1:] != units[:-1]).any(axis=1))
    return "M" + "L".join(f"{x} {y}" for x, y in units[moved].tolist())
