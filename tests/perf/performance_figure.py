"""The picture of the times to 1 %: a row per scene, a mark per planner, readable in grey.

A planner of OMPL's has one mark: its own settings or the tuned ones, whichever come sooner.
"""

from collections.abc import Mapping
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

MARKS = {
    "kbga": ("o", "#000000", True),
    "kbga-plus": ("o", "#000000", False),
    "ompl-shortcut": ("*", "#d55e00", False),
    "ompl-aorrtc": ("^", "#d55e00", True),
    "ompl-sorrtstar": ("s", "#0072b2", True),
    "ompl-informedrrtstar": ("D", "#009e73", False),
    "ompl-rrtstar": ("v", "#e69f00", False),
    "ompl-bitstar": ("P", "#cc79a7", True),
    "ompl-prmstar": ("X", "#56b4e9", True),
}
"""Marker, colour (Okabe and Ito) and whether it is filled."""

SPREAD = 0.74
"""Share of a scene's row over which its planners are laid out."""


def draw(
    times: Mapping[tuple[str, str], tuple[list[float | None], float, float]],
    exact_s: Mapping[str, float],
    file: Path,
) -> None:
    """Draw medians and quartiles on a logarithmic axis; an arrow where most runs came too late.

    Parameters
    ----------
    times : mapping from (planner, scene) to (times in seconds, their median, the limit)
    exact_s : mapping from a scene to the exact solver's time, seconds
    file : Path
        A .png file.
    """
    scenes = list(dict.fromkeys(scene for _, scene in times))
    figure, axes = plt.subplots(figsize=(7.5, 0.8 * len(scenes) + 1.6), layout="constrained")
    for row, scene in enumerate(scenes):
        if row % 2:
            axes.axhspan(row - 0.5, row + 0.5, color="#f0f0f0", zorder=0)
        if scene in exact_s:
            x = 1e3 * exact_s[scene]
            axes.plot([x, x], [row - 0.4, row + 0.4], color="#000000", linewidth=1.5)
    for place, (planner, (marker, colour, is_filled)) in enumerate(MARKS.items()):
        offset = SPREAD * (place / (len(MARKS) - 1) - 0.5)
        for row, scene in enumerate(scenes):
            if (planner, scene) in times:
                _draw_series(axes, *times[planner, scene], row + offset, marker, colour, is_filled)
        axes.plot(
            [], [], marker, color=colour, label=planner, markeredgecolor=colour,
            markerfacecolor=colour if is_filled else "white",
        )  # fmt: skip
    axes.plot([], [], "|", color="#000000", markersize=12, label="exact solver, whole")
    axes.plot([], [], ">", color="#707070", markersize=4, label="median later than this")
    axes.set(
        xscale="log",
        xlabel="time to 1 % of the optimum: median and quartiles (ms)",
        yticks=range(len(scenes)),
        yticklabels=scenes,
        ylim=(len(scenes) - 0.5, -0.5),
    )
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid(axis="x", color="#d0d0d0", linewidth=0.6)
    axes.set_axisbelow(True)
    figure.legend(loc="outside lower center", ncols=3, frameon=False)
    figure.savefig(file, dpi=130)
    plt.close(figure)


def _draw_series(axes, near_s, median_s, limit_s, y, marker, colour, is_filled) -> None:
    is_late = np.isinf(median_s)
    x = 1e3 * (limit_s if is_late else median_s)
    face = colour if is_filled else "white"
    if is_late:
        axes.plot([x * 1.35], [y], ">", color="#707070", markersize=4)
    else:
        # Runs that did not come there count as later than any time.
        seconds = [np.inf if s is None else s for s in near_s]
        low, high = np.quantile(seconds, (0.25, 0.75), method="nearest")
        axes.plot([1e3 * low, 1e3 * min(high, limit_s)], [y, y], color=colour, linewidth=1.2)
    axes.plot([x], [y], marker, color=colour, markerfacecolor=face, markeredgecolor=colour)
