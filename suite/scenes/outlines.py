"""Random outlines of obstacles: the shapes that the paper's environments are drawn with.

Convex polygons, polygons with dents (darts, stars), bent bars (L, V, U, Z) and crossed bars (T, X).
An outline has no place and no size yet: its convex hull has the centroid (0, 0) and the area 1.
"""

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiLineString, Polygon

LEAST_ARC = 0.6
"""Of the arc between two vertices, as a share of the even one: shorter sides look like slips."""

FLATTEST = 0.6
"""Width of a convex polygon across its length, at least: thinner ones look like splinters."""

DENT = (0.3, 0.5)
"""How far a dented side reaches towards the middle: shallow dents don't show, deep ones leave
spikes."""

ARM = (0.85, 1.15)
"""Length of an arm of a bar."""

BAR_WIDTH = (0.35, 0.55)
"""Below the shortest arm: an arm must stick out where it meets another one."""


def convex_outline(rng: np.random.Generator) -> Polygon:
    """Draw a convex polygon of three to eight vertices.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    Polygon
    """
    return _standard(Polygon(_on_ellipse(int(rng.integers(3, 9)), rng)), rng)


def concave_outline(rng: np.random.Generator) -> Polygon:
    """Draw a concave polygon without holes: a dented one, a bent bar or crossed bars.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    Polygon
    """
    kinds = (_dented, _bent_bar, _crossed_bars)
    return _standard(kinds[rng.integers(len(kinds))](rng), rng)


def _on_ellipse(vertices: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Vertices (n, 2) of a strictly convex polygon: each turns clearly, so none is lost later."""
    even = LEAST_ARC * 2.0 * np.pi / vertices
    spare = (1.0 - LEAST_ARC) * 2.0 * np.pi
    angles = np.cumsum(even + spare * rng.dirichlet(np.full(vertices, 2.0)))
    return np.column_stack([np.cos(angles), rng.uniform(FLATTEST, 1.0) * np.sin(angles)])


def _dented(rng: np.random.Generator) -> Polygon:
    """A convex polygon with dents in one or more of its sides; with one in each, a star."""
    corners = _on_ellipse(int(rng.integers(3, 6)), rng)
    sides = 0.5 * (corners + np.roll(corners, -1, axis=0))
    depths = rng.uniform(*DENT, (len(sides), 1))
    dents = sides + depths * (corners.mean(axis=0) - sides)
    dented = rng.permutation(len(sides)) < rng.integers(1, len(sides) + 1)
    ring = np.stack([corners, dents], axis=1).reshape(-1, 2)
    return Polygon(ring[np.column_stack([np.ones_like(dented), dented]).ravel()])


def _bent_bar(rng: np.random.Generator) -> Polygon:
    """A bar with one or two bends: an L or V, or a U or Z."""
    if rng.random() < 0.5:
        bends = np.radians([rng.uniform(60.0, 125.0)])
    else:
        bends = np.radians(rng.uniform(60.0, 90.0, 2)) * (1.0, rng.choice([-1.0, 1.0]))
    headings = np.concatenate([[0.0], np.cumsum(bends)])
    arms = rng.uniform(*ARM, (headings.size, 1)) * _directions(headings)
    spine = np.vstack([np.zeros(2), np.cumsum(arms, axis=0)])
    return _bars([spine], rng.uniform(*BAR_WIDTH))


def _crossed_bars(rng: np.random.Generator) -> Polygon:
    """Two bars that cross, or of which one ends on the other: an X or a T, maybe leaning."""
    along, across = _directions(np.array([0.0, np.radians(rng.uniform(65.0, 115.0))]))
    ahead, behind, up, down = rng.uniform(*ARM, 4)
    width = rng.uniform(*BAR_WIDTH)
    down *= rng.choice([0.0, 1.0])
    straight = np.array([-behind * along, ahead * along])
    crossing = np.array([-down * across, up * across])
    return _bars([straight, crossing], width)


def _directions(headings: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.column_stack([np.cos(headings), np.sin(headings)])


def _bars(spines: Sequence[NDArray[np.float64]], width: float) -> Polygon:
    """All that lies within half the width of the spines (n, 2), square at their ends."""
    lines = MultiLineString([spine.tolist() for spine in spines])
    return lines.buffer(0.5 * width, cap_style="flat", join_style="mitre")


def _standard(outline: Polygon, rng: np.random.Generator) -> Polygon:
    """The outline turned at random, its hull of area 1 around the origin."""
    hull = outline.convex_hull
    along, across = _directions(rng.uniform(0.0, 2.0 * np.pi) + np.array([0.0, 0.5 * np.pi]))
    centre = shapely.get_coordinates(hull.centroid)
    turn = np.vstack([along, across]) / np.sqrt(hull.area)
    return shapely.transform(outline, lambda xy: (xy - centre) @ turn)
