"""Pictures of maps, scenes of many queries: the hardest queries on the map, and all as marks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import shapely
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator
from numpy.typing import NDArray

from suite.report.figures import style
from suite.report.figures.comparison import ABOVE, mark_no_path
from suite.report.figures.panels import PLANNERS_AT_MOST, scene_panels, title
from suite.report.figures.scene import draw_obstacles, draw_room
from suite.report.statistics.over_queries import HARDEST_RULE
from suite.scenes.scene import Query, Scene

WIDTH = 7.6
AROUND = 1.5
"""Height of the title, the axis, the legend and the sentence below, inches."""

SEEN_AROUND = 0.02
"""Of the larger side of what is seen of a map, around it."""

MANY = 300
"""Marks of a planner in a panel from which they are drawn smaller."""

LOGARITHMIC_FROM = 20.0
"""Of the longest query over the shortest, from which the axis of lengths is logarithmic."""

MAP_NOTE = (
    "{shown} of {queries} queries, the hardest: {rule}. Ring: start, with the query's number; "
    "diamond: goal. The cheapest path of each planner over all seeds."
)
SCATTER_NOTE = (
    "A mark is a query of a planner: the mean gap of its seeds over the length of the shortest "
    "path. Above the line: queries without a path."
)


@dataclass(frozen=True, slots=True, eq=False)
class HardQuery:
    """One of the hardest queries of a map, and the best path of each planner; None without one."""

    query: Query
    paths: Mapping[str, NDArray[np.float64] | None]


def plot_map(
    scene: Scene, hard: Sequence[HardQuery], planners: Mapping[str, int], queries: int
) -> Figure:
    """Draw a map with its hardest queries.

    Parameters
    ----------
    scene : Scene
    hard : sequence of HardQuery
        The hardest first.
    planners : mapping from name to number
        See :func:`suite.report.figures.style.numbered`.
    queries : int
        Of the map, in all.
    """
    xmin, ymin, xmax, ymax = seen_bounds(scene, [one.query for one in hard])
    height = WIDTH * min(max((ymax - ymin) / (xmax - xmin), 0.3), 2.0)
    figure, axes = plt.subplots(figsize=(WIDTH, height + AROUND), layout="constrained")
    draw_room(axes, scene)
    axes.set_xlim(xmin, xmax)
    axes.set_ylim(ymin, ymax)
    draw_obstacles(axes, scene, 0.4)
    widths = dict(zip(planners, np.linspace(3.6, 1.0, max(len(planners), 2)), strict=False))
    for number, one in enumerate(hard, 1):
        for planner, path in one.paths.items():
            if path is not None:
                look = style.look(planners[planner]) | {"marker": "none"}
                axes.plot(*path.T, linewidth=widths[planner], **look)
        _draw_ends(axes, one.query, number)
    axes.set_xlabel("x (m)", fontsize=style.LABEL)
    axes.set_ylabel("y (m)", fontsize=style.LABEL)
    style.heading(figure, scene.name)
    note = MAP_NOTE.format(shown=len(hard), queries=queries, rule=HARDEST_RULE)
    style.legend(figure, planners, note, only_lines=True)
    return figure


def seen_bounds(scene: Scene, queries: Sequence[Query]) -> tuple[float, float, float, float]:
    """Bounds of the parts of free space that queries lie in, with a margin; metres.

    Most of a map that a robot has drawn may be unknown, or outside.

    Parameters
    ----------
    scene : Scene
    queries : sequence of Query
    """
    ends = shapely.MultiPoint([end for query in queries for end in (query.start, query.goal)])
    parts = [part for part in scene.regions.geoms if part.dwithin(ends, scene.coordinates.grid)]
    seen = shapely.MultiPolygon(parts).bounds if parts else scene.bounds
    margin = SEEN_AROUND * max(seen[2] - seen[0], seen[3] - seen[1])
    return seen[0] - margin, seen[1] - margin, seen[2] + margin, seen[3] + margin


def _draw_ends(axes: Axes, query: Query, number: int) -> None:
    axes.plot(*query.goal, marker="D", markersize=6, zorder=5, clip_on=False, **style.ENDS)
    axes.plot(*query.start, marker="o", markersize=11, zorder=6, clip_on=False, **style.ENDS)
    letters: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": style.SMALLEST}
    axes.text(query.start[0], query.start[1], str(number), zorder=7, clip_on=False, **letters)


def map_figures(measures: pd.DataFrame, planners: Mapping[str, int]) -> dict[str, Figure]:
    """The scatter of all queries, by the name of its file.

    Parameters
    ----------
    measures : DataFrame
        Of :func:`suite.report.statistics.over_queries.query_measures`.
    planners : mapping from name to number

    Returns
    -------
    dict from str to Figure
        None without a path for a query with an optimum, or with too many planners.
    """
    known = measures[measures["optimum"] > 0.0]
    if len(planners) > PLANNERS_AT_MOST or not known["gap"].notna().any():
        return {}
    return {"queries": plot_queries(known, planners)}


def plot_queries(measures: pd.DataFrame, planners: Mapping[str, int]) -> Figure:
    """Draw the gap of each query over the length of its optimum, map by map.

    Parameters
    ----------
    measures : DataFrame
        Of :func:`suite.report.statistics.over_queries.query_measures`, with an optimum above 0
        everywhere, and a gap somewhere.
    planners : mapping from name to number
    """
    places = list(dict.fromkeys(measures["place"]))
    panels = scene_panels(places, share_x=False)
    gap = 100.0 * measures["gap"].to_numpy(dtype=np.float64)
    first = next(iter(panels.axes.values()))
    style.logarithmic_gaps(first, gap)
    edge = first.get_ylim()[1]
    first.set_ylim(top=ABOVE * edge)
    no_path = mark_no_path(first, edge)
    height = np.where(np.isfinite(gap), np.maximum(gap, style.LEAST_GAP), no_path)
    for place, axes in panels.axes.items():
        axes.axhline(edge, color="#808080", linewidth=0.8)
        here = (measures["place"] == place).to_numpy()
        for planner, i in planners.items():
            mine = here & (measures["variant"] == planner).to_numpy()
            _draw_marks(axes, measures["optimum"].to_numpy()[mine], height[mine], i)
        _arrange(axes, measures["optimum"].to_numpy()[here])
    title(panels, "Gap of each query", "length of the shortest path (m)", len(places))
    style.legend(panels.figure, planners, SCATTER_NOTE, only_markers=True)
    return panels.figure


def _draw_marks(axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], i: int) -> None:
    look = style.look(i) | {"linestyle": "none"}
    few = len(x) < MANY
    # As in the scatter of runs: shades of very many marks take too many colours and bytes.
    axes.plot(
        x, y, markersize=4.0 if few else 2.0, markeredgewidth=0, alpha=0.6 if few else 1.0,
        rasterized=not few, **look,
    )  # fmt: skip


def _arrange(axes: Axes, lengths: NDArray[np.float64]) -> None:
    low, high = float(lengths.min()), float(lengths.max())
    if high > LOGARITHMIC_FROM * low:
        style.logarithmic_time(axes, 0.8 * low, 1.25 * high)
    elif high == low:
        axes.xaxis.set_major_locator(FixedLocator([low]))
