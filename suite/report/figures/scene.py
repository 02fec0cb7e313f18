"""Pictures of scenes, runs and results. Metres, x right, y up, one scale for both axes.

Colours are Okabe and Ito's, told apart by colour-blind readers; line style and width tell the same
lines apart in grey.
"""

import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import PIL.Image
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from numpy.typing import NDArray
from shapely.geometry import Polygon

from suite.errors import KbgaBenchError
from suite.report.kinds import FigureFormat
from suite.scenes.scene import Query, Scene

OBSTACLE = "#c8c8c8"
OBSTACLE_EDGE = "#707070"
OPTIMUM = "#000000"
POPULATION = "#56b4e9"
BEST = "#d55e00"
INVALID = "#cc79a7"

LINES = (
    ("#d55e00", "-"),
    ("#0072b2", "--"),
    ("#009e73", "-."),
    ("#cc79a7", (0, (3, 1, 1, 1, 1, 1))),
    ("#e69f00", (0, (5, 1))),
    ("#56b4e9", ":"),
    ("#8c510a", (0, (6, 2, 1, 2))),
    ("#666666", (0, (1, 1))),
    ("#3b0f8c", (0, (2, 2))),
)

WIDTH = 6.0
LEGEND_LINE = 0.19
AROUND = 0.8
"""Height of the title, the axis and its label, inches."""

ONE_COLUMN_FROM = 34
"""Characters of a legend's line of which two no longer stand side by side."""

RASTER_DPI = 130
RASTER_COLOURS = 96
"""Enough for lines, shades and their soft edges, in a third of the bytes of all colours."""


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
                colors=POPULATION,
                linewidths=0.6,
                alpha=0.55,
                label=f"first population ({len(first_population)} paths)",
            )
        )
    if path is not None:
        axes.plot(*path.T, color=BEST, linewidth=2.4, marker=".", markersize=7, label=path_label)
    if optimum is not None:
        axes.plot(*optimum.T, color=OPTIMUM, linewidth=1.3, linestyle="--", label=optimum_label)
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
        colour, style = LINES[i % len(LINES)]
        label = (labels or {}).get(planner, planner)
        if path is None:
            axes.plot([], [], linestyle="none", label=label)
        else:
            axes.plot(*path.T, color=colour, linestyle=style, linewidth=widths[i], label=label)
    _finish(figure, axes, query, scene.name)
    return figure


def check_figure_file(file: Path) -> None:
    """Refuse a file that a figure can't be written to, before anything is run for it.

    Raises
    ------
    KbgaBenchError
        If its kind is unknown or its folder is missing.
    """
    check_file(file, "figures", [kind.suffix for kind in FigureFormat])


def check_file(file: Path, what: str, suffixes: Sequence[str]) -> None:
    """Refuse a file of a kind that these things can't be, or in a folder that there is not.

    Raises
    ------
    KbgaBenchError
    """
    if file.suffix.lower() not in suffixes:
        raise KbgaBenchError(f"{file}: {what} are {', '.join(suffixes)}. Name such a file.")
    if not file.parent.is_dir():
        raise KbgaBenchError(f"{file}: there is no folder {file.parent}. Make it first.")


def save(figure: Figure, file: Path) -> None:
    """Write a figure and let go of it; the same figure gives the same bytes.

    Raises
    ------
    KbgaBenchError
        If the file can't be written.
    """
    dated = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}
    suffix = file.suffix.lower()
    try:
        if suffix == ".png":
            file.write_bytes(as_png(figure))
        else:
            with plt.rc_context({"svg.hashsalt": "kbga-bench"}):
                figure.savefig(file, metadata=dated.get(suffix))
    except OSError as error:
        raise KbgaBenchError(f"{file}: can't be written ({error.strerror}).") from error
    finally:
        plt.close(figure)


def as_png(figure: Figure) -> bytes:
    """Draw a figure and let go of it; the same figure gives the same bytes."""
    drawn, small = io.BytesIO(), io.BytesIO()
    try:
        figure.savefig(drawn, format="png", dpi=RASTER_DPI)
    finally:
        plt.close(figure)
    with PIL.Image.open(drawn) as image:
        image.convert("RGB").quantize(RASTER_COLOURS).save(small, format="png", optimize=True)
    return small.getvalue()


def _scene_figure(scene: Scene) -> tuple[Figure, Axes]:
    xmin, ymin, xmax, ymax = scene.bounds
    height = WIDTH * min(max((ymax - ymin) / (xmax - xmin), 0.3), 2.0) + AROUND
    figure, axes = plt.subplots(figsize=(WIDTH, height), layout="constrained")
    draw_room(axes, scene)
    draw_obstacles(axes, scene, 0.7)
    return figure, axes


def draw_obstacles(axes: Axes, scene: Scene, linewidth: float) -> None:
    """Draw all obstacles as they are drawn in the scene, wherever they move."""
    for obstacle in scene.obstacles:
        axes.add_patch(
            PathPatch(
                outline(obstacle.polygon),
                facecolor=OBSTACLE,
                edgecolor=OBSTACLE_EDGE,
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
            markerfacecolor="white",
            markeredgecolor="black",
            markeredgewidth=max(1.4 * scale, 0.8),
            linestyle="none",
            label=name,
            zorder=5,
            clip_on=False,
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
    figure.legend(
        loc="outside lower center", ncols=columns, handlelength=3.6, frameon=False, fontsize=9
    )
