"""The picture of how fast planners answered while their robots drove, and how good the ways were.

Shape and fill tell the statistics apart, not colour alone; times are logarithmic.
"""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suite.report.figures.style import LABEL, LINES, SMALL

READING = (
    "Left: wall time of one call, over all updates of all runs; a dot for the median, a bar for "
    "the middle 90 %, a cross for the worst. Right: length of the ways above that of a robot that "
    "follows the exact shortest path of each update; each ring is a run."
)

DOT, RING = LINES[1][0], LINES[0][0]
ROW = 0.24
"""Height of a planner's line, inches."""


def plot_replanning(runs: pd.DataFrame, replans: pd.DataFrame) -> Figure:
    """Draw latencies, and the lengths of the ways, of each planner in each world.

    Parameters
    ----------
    runs : DataFrame
        The simulated ones, as :func:`suite.store.read.read_runs` gives them.
    replans : DataFrame
        As :func:`suite.store.read.read_replans` gives them.

    Returns
    -------
    Figure
    """
    asked = runs[["key", "scene", "world", "variant"]].merge(replans, on="key")
    worlds = list(dict.fromkeys(zip(runs["scene"], runs["world"], strict=True)))
    planners = list(dict.fromkeys(runs["variant"]))
    height = len(worlds) * (len(planners) * ROW + 0.45) + 1.0
    figure, grid = plt.subplots(
        len(worlds), 2, figsize=(8.0, height), sharex="col", squeeze=False, layout="constrained"
    )
    for (left, right), (scene, world) in zip(grid, worlds, strict=True):
        here = (runs["scene"] == scene) & (runs["world"] == world)
        there = (asked["scene"] == scene) & (asked["world"] == world)
        _draw_latencies(left, asked[there], planners)
        _draw_lengths(right, runs[here], planners)
        left.set_title(f"{scene}, {world}", fontsize=LABEL, loc="left")
        for axes in (left, right):
            _arrange(axes, planners)
        right.tick_params(labelleft=False)
    grid[-1, 0].set_xlabel("latency of an update (ms)", fontsize=LABEL)
    grid[-1, 1].set_xlabel("way above the exact follower's (%)", fontsize=LABEL)
    figure.supxlabel(READING, fontsize=SMALL, wrap=True)
    return figure


def _draw_latencies(axes: Axes, asked: pd.DataFrame, planners: Sequence[str]) -> None:
    axes.set_xscale("log")
    for row, planner in enumerate(planners):
        latency = 1e3 * asked.loc[asked["variant"] == planner, "latency_s"].dropna()
        if latency.empty:
            continue
        low, middle, high = latency.quantile([0.05, 0.5, 0.95])
        axes.plot(
            [low, high], [row, row], color=DOT, linewidth=3.0, solid_capstyle="butt", alpha=0.45
        )
        axes.plot(middle, row, "o", color=DOT, markersize=5)
        axes.plot(latency.max(), row, "x", color="black", markersize=5)


def _draw_lengths(axes: Axes, runs: pd.DataFrame, planners: Sequence[str]) -> None:
    for row, planner in enumerate(planners):
        gaps = 100.0 * runs.loc[runs["variant"] == planner, "gap"].dropna()
        axes.plot(
            gaps, [row] * len(gaps), "o", markerfacecolor="none", markeredgecolor=RING, markersize=4
        )
    axes.set_xscale("symlog", linthresh=1.0)
    axes.axvline(0.0, color="black", linewidth=0.8)


def _arrange(axes: Axes, planners: Sequence[str]) -> None:
    axes.set_yticks(range(len(planners)), planners, fontsize=SMALL)
    axes.set_ylim(len(planners) - 0.5, -0.5)
    axes.tick_params(axis="x", labelsize=SMALL)
    axes.grid(axis="x", linewidth=0.4, color="#d0d0d0")
    axes.set_axisbelow(True)
