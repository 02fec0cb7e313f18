"""What is read from a map: the pieces of a scene, not yet checked."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from shapely.geometry import Polygon

Point = tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A map's workspace and obstacles, metres, y up, and the queries that came with it.

    workspace : where the robot may be; its holes are obstacles.
    obstacles : may touch and overlap.
    queries : from name to (start, goal).
    strata : from name of a query to name of its stratum.
    properties : what the scene says of itself; ``published`` is from name of a query to the length
        that came with it, metres, and ``published_as`` says what that is.
    """

    workspace: Polygon
    obstacles: tuple[Polygon, ...]
    queries: Mapping[str, tuple[Point, Point]] = field(default_factory=dict)
    strata: Mapping[str, str] = field(default_factory=dict)
    properties: Mapping[str, Any] = field(default_factory=dict)
