"""How a map is read, where the map itself does not say."""

from dataclasses import dataclass, fields
from enum import StrEnum


class Unknown(StrEnum):
    """What cells are taken for of which the map says that nothing is known."""

    OCCUPIED = "occupied"
    FREE = "free"


@dataclass(frozen=True, slots=True)
class MapOptions:
    """How a map is read; what is None, the map says, or the format's own default.

    unknown : what cells are of which nothing is known.
    resolution : metres of a pixel.
    threshold : share of black, 0 to 1, from which a pixel is occupied.
    simplify : metres by which an outline may be off to have fewer vertices; an obstacle only grows.
    """

    unknown: Unknown | None = None
    resolution: float | None = None
    threshold: float | None = None
    simplify: float | None = None


OPTIONS = tuple(field.name for field in fields(MapOptions))
"""Their names."""
