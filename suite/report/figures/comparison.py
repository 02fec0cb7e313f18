"""Pictures of how runs end: gaps as boxes, and gaps against times."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from suite.report.figures import style
from suite.report.figures.panels import PLANNERS_AT_MOST, Panels, scene_panels, title
from suite.report.statistics.anytime import Steps, final_gaps, groups_of, on_clock
from suite.report.statistics.clock import WALL, untimed_note
from suite.report.statistics.inference import Array
from suite.report.words import joined

EXACT = "visibility-graph"
"""The exact solver's plugin. Its time is the limit: who needs longer, needs a reason."""

MANY = 200
"""Runs of a planner in a panel from which they are drawn smaller."""

ABOVE = 6.0
"""How far the axis goes on above the largest gap, for runs without path; as far again for words."""

SHARE_TEXT: dict[str, Any] = {
    "ha": "center",
    "va": "top",
    "rotation": 90,
    "fontsize": style.SMALLEST,
}

BOXES_NOTE = (
    "Box: quartiles and median of the runs that found a path; whiskers: the farthest runs within "
    "1.5 boxes; circles: runs beyond. Above: how many of how many runs found a path, where not all "
    "did. One without path is in no box."
)
SCATTER_NOTE = (
    "A mark is a run: when it first had its final path, and how good that is. Above the line: runs "
    "without a path, and how long they tried."
)
LIMIT_NOTE = (
    " Dashed: the median time of the exact solver, which finds the shortest path: what is right of "
    "it takes longer and finds none that is shorter."
)


def comparison_figures(steps: Steps) -> dict[str, Figure]:
    """The figures that these runs can answer, by the name of the file.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    dict from str to Figure
        None without an accepted path in a scene with an optimum, or with too many planners.
    """
    planners = steps.runs["variant"].nunique()
    if planners > PLANNERS_AT_MOST or not (steps.optimum[steps.run] > 0.0).any():
        return {}
    figures = {"gap-boxes": plot_boxes(steps)}
    timed = on_clock(steps, WALL)
    if (timed.optimum[timed.run] > 0.0).any():
        figures["gap-time"] = plot_scatter(steps)
    return figures


def plot_boxes(steps: Steps) -> Figure:
    """Draw boxes of the gaps of each planner, scene by scene.

    Parameters
    ----------
    steps : Steps
        With an accepted path in a scene with an optimum.
    """
    gap = 100.0 * final_gaps(steps)
    groups = groups_of(steps, steps.optimum > 0.0)
    scenes = list(dict.fromkeys(scene for scene, _ in groups))
    planners = style.numbered(steps.runs["variant"])
    panels = scene_panels(scenes)
    for (scene, planner), rows in groups.items():
        if scene in panels.axes:
            _draw_box(panels.axes[scene], planners[planner], gap[rows])
    first = next(iter(panels.axes.values()))
    first.set_xlim(-0.7, len(planners) - 0.3)
    first.set_xticks([])
    style.logarithmic_gaps(first, gap)
    first.set_ylim(top=ABOVE**2 * first.get_ylim()[1])
    title(panels, "How near the optimum the runs end", "", len(scenes))
    style.legend(panels.figure, planners, BOXES_NOTE, only_markers=True)
    return panels.figure


def _draw_box(axes: Axes, i: int, gap: Array) -> None:
    """Draw the box of one planner's gaps, per cent, and its marker on the median."""
    lines = style.look(i)
    found = np.maximum(gap[np.isfinite(gap)], style.LEAST_GAP)
    if len(found) < len(gap):
        # Where the axis goes on above the largest gap, whatever that is.
        above = axes.get_xaxis_transform()
        axes.plot(
            i, 0.96, marker=lines["marker"], color=lines["color"], markersize=4, transform=above
        )
        share = f"{len(found)}/{len(gap)}"
        axes.text(i, 0.93, share, transform=above, **SHARE_TEXT)
    if not len(found):
        return
    thin = {"linewidth": 0.8}
    axes.boxplot(
        [found],
        positions=[i],
        widths=0.6,
        patch_artist=True,
        boxprops={"facecolor": lines["color"], "alpha": 0.35, **thin},
        medianprops={"color": "black", "linewidth": 1.4},
        whiskerprops=thin,
        capprops=thin,
        flierprops={"marker": "o", "markersize": 2.5, "markeredgewidth": 0.5},
        manage_ticks=False,
    )
    marker = {"color": lines["color"], "marker": lines["marker"]}
    axes.plot(i, np.median(found), markeredgecolor="black", markeredgewidth=0.5, zorder=4, **marker)


def plot_scatter(steps: Steps) -> Figure:
    """Draw gap against time of each run, scene by scene, with the exact solver's time as the limit.

    Parameters
    ----------
    steps : Steps
        With an accepted path in a scene with an optimum, of a run that had a core for itself.
    """
    planners, left_out = style.numbered(steps.runs["variant"]), untimed_note(steps.runs)
    steps = on_clock(steps, WALL)
    runs = steps.runs
    gap = 100.0 * final_gaps(steps)
    time = 1e3 * runs["time_to_best_s"].fillna(runs["wall_s"]).to_numpy()
    groups = groups_of(steps, steps.optimum > 0.0)
    scenes = list(dict.fromkeys(scene for scene, _ in groups))
    panels = scene_panels(scenes)
    first = next(iter(panels.axes.values()))
    style.logarithmic_gaps(first, gap)
    edge = first.get_ylim()[1]
    first.set_ylim(top=ABOVE * edge)
    measured = time[np.isfinite(time) & (time > 0.0)]
    style.logarithmic_time(first, 0.7 * float(measured.min()), 1.5 * float(measured.max()))
    no_path = mark_no_path(first, edge)
    for axes in panels.axes.values():
        axes.axhline(edge, color="#808080", linewidth=0.8)
    for (scene, planner), rows in groups.items():
        if scene in panels.axes:
            height = np.where(
                np.isfinite(gap[rows]), np.maximum(gap[rows], style.LEAST_GAP), no_path
            )
            _draw_runs(panels.axes[scene], planners[planner], time[rows], height)
    limit = _draw_limits(panels, runs, time)
    title(panels, "Time and gap of the runs", "wall time to the final path (ms)", len(scenes))
    note = joined(SCATTER_NOTE + limit, left_out)
    style.legend(panels.figure, planners, note, only_markers=True)
    return panels.figure


def mark_no_path(axes: Axes, edge: float) -> float:
    """Make a tick above the gaps for the runs without a path; where it is."""
    place = edge * ABOVE**0.5
    ticks = [tick for tick in axes.get_yticks() if tick <= edge]
    axes.yaxis.set_major_locator(FixedLocator([*ticks, place]))
    axes.yaxis.set_major_formatter(lambda gap, _: "no path" if gap > edge else style.gap_text(gap))
    return place


def _draw_runs(axes: Axes, i: int, time: Array, height: Array) -> None:
    lines = style.look(i)
    axes.plot(
        time,
        height,
        linestyle="none",
        color=lines["color"],
        marker=lines["marker"],
        # Shades of very many marks would take the colours that a picture of 256 has room for.
        markersize=4.5 if len(time) < MANY else 2.0,
        markeredgewidth=0,
        alpha=0.6 if len(time) < MANY else 1.0,
        # Points of hundreds of thousands of runs would make a vector file that nothing opens.
        rasterized=len(time) >= MANY,
    )


def _draw_limits(panels: Panels, runs: pd.DataFrame, time: Array) -> str:
    """Draw the exact solver's median time in each scene; what is to be said of it."""
    exact = (runs["planner"] == EXACT).to_numpy() & np.isfinite(time)
    for scene, axes in panels.axes.items():
        mine = time[exact & (runs["place"] == scene).to_numpy()]
        if len(mine):
            axes.axvline(float(np.median(mine)), color="black", linestyle="--", linewidth=1.0)
    return LIMIT_NOTE if exact.any() else ""
