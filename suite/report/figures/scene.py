"""Pictures of scenes, runs and results. Metres, x right, y up, one scale for both axes.

Line style and width tell lines apart in grey.
"""

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from numpy.typing import NDArray
from shapely.geometry import Polygon

from suite.report.figures import style
from suite.scenes.scene import Query, Scene

WIDTH = 6.0
LEGEND_LINE = 0.19
AROUND = 0.8
"""Height of the title, the axis and its label, inches."""

ONE_COLUMN_FROM = 34
"""Characters of a legend's line of which two no longer stand side by side."""


def plot_run(
    scene: Scene,
    query: Query,
    path: NDArray[np.float64] | None,
    *,
    path_label: str,
    first_population: Sequence[NDArray[np.float64]] = (),
    optimum: NDArray[np.float64] | None = None,
    optimum_label: str = "optimum",
) -> Figure:
    """Draw one run.

    Parameters
    ----------
    scene : Scene
    query : Query
    path : (n, 2) float64, metres
        The best path; None if there is none.
    path_label : str
        For the legend.
    first_population : sequence of (n, 2) float64
        Drawn thin.
    optimum : (n, 2) float64, optional
        The exact shortest path, dashed.
    optimum_label : str

    Returns
    -------
    Figure
    """
    figure, axes = _scene_figure(scene)
    if len(first_population):
        axes.add_collection(
            LineCollection(
                list(first_population),
                colors=style.POPULATION,
                linewidths=0.6,
                alpha=0.55,
                label=f"first population ({len(first_population)} paths)",
            )
        )
    if path is not None:
        axes.plot(
            *path.T, color=style.BEST, linewidth=2.4, marker=".", markersize=7, label=path_label
        )
    if optimum is not None:
        axes.plot(
            *optimum.T, color=style.OPTIMUM, linewidth=1.3, linestyle="--", label=optimum_label
        )
    _finish(figure, axes, query, scene.name)
    return figure


def plot_scene_results(
    scene: Scene,
    query: Query,
    best: Mapping[str, NDArray[np.float64] | None],
    *,
    labels: Mapping[str, str] | None = None,
) -> Figure:
    """Draw the best path of each planner in one scene.

    Parameters
    ----------
    scene : Scene
    query : Query
    best : mapping from planner to path (n, 2), metres
        Later ones are drawn above earlier ones, and thinner. A planner without a path has None,
        and a line in the legend.
    labels : mapping from planner to its text in the legend, optional

    Returns
    -------
    Figure
    """
    figure, axes = _scene_figure(scene)
    widths = np.linspace(5.0, 1.2, max(len(best), 2))
    for i, (planner, path) in enumerate(best.items()):
        colour, line = style.LINES[i % len(style.LINES)]
        label = (labels or {}).get(planner, planner)
        if path is None:
            axes.plot([], [], linestyle="none", label=label)
        else:
            axes.plot(*path.T, color=colour, linestyle=line, linewidth=widths[i], label=label)
    _finish(figure, axes, query, scene.name)
    return figure


def _scene_figure(scene: Scene) -> tuple[Figure, Axes]:
    size = (WIDTH, style.height_for(scene, WIDTH) + AROUND)
    figure, axes = plt.subplots(figsize=size, layout="constrained")
    draw_room(axes, scene)
    draw_obstacles(axes, scene, 0.7)
    return figure, axes


def draw_obstacles(axes: Axes, scene: Scene, linewidth: float) -> None:
    """Draw all obstacles as they are drawn in the scene, wherever they move."""
    for obstacle in scene.obstacles:
        axes.add_patch(
            PathPatch(
                outline(obstacle.polygon),
                facecolor=style.OBSTACLE,
                edgecolor=style.OBSTACLE_EDGE,
                linewidth=linewidth,
            )
        )


def draw_room(axes: Axes, scene: Scene) -> PathPatch:
    """Draw the workspace, and set the limits and the scale by it."""
    xmin, ymin, xmax, ymax = scene.bounds
    # The workspace has an outline of its own.
    axes.spines[:].set_visible(False)
    room = PathPatch(outline(scene.workspace), facecolor="white", edgecolor="black", linewidth=1.2)
    axes.add_patch(room)
    margin = 0.02 * max(xmax - xmin, ymax - ymin)
    axes.set_xlim(xmin - margin, xmax + margin)
    axes.set_ylim(ymin - margin, ymax + margin)
    axes.set_aspect("equal")
    return room


def outline(polygon: Polygon) -> Outline:
    """Draw a polygon and its holes as one outline."""
    rings = [np.asarray(ring.coords)[:, :2] for ring in (polygon.exterior, *polygon.interiors)]
    return Outline.make_compound_path(*(Outline(ring, closed=True) for ring in rings))


def draw_ends(axes: Axes, query: Query, scale: float = 1.0) -> None:
    """Mark start and goal, so many times as large as in a picture of WIDTH."""
    for point, name, marker in ((query.start, "start", "o"), (query.goal, "goal", "*")):
        axes.plot(
            *point,
            marker=marker,
            markersize=scale * (9 if marker == "o" else 14),
            markeredgewidth=max(1.4 * scale, 0.8),
            label=name,
            zorder=5,
            clip_on=False,
            **style.ENDS,
        )


def _finish(figure: Figure, axes: Axes, query: Query, title: str) -> None:
    draw_ends(axes, query)
    axes.set_title(title)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    labels = axes.get_legend_handles_labels()[1]
    columns = 1 if max(map(len, labels)) >= ONE_COLUMN_FROM else 2
    width, height = figure.get_size_inches()
    figure.set_size_inches(width, height + LEGEND_LINE * -(-len(labels) // columns))
    style.legend_below(figure, ncols=columns, handlelength=3.6)
