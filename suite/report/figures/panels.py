"""A panel for each scene, side by side: what the pictures of several scenes share."""

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suite.report.figures.style import LABEL, SMALL, TITLE, heading, rules

COLUMNS = 4
"""Panels side by side."""

HEIGHT = 2.3
HIGHER = 3.2
"""Of a panel, inches; higher where one or two are wide."""

PANELS_AT_MOST = 16
"""A picture of more can't be read."""

PLANNERS_AT_MOST = 12
"""More lines can't be told apart."""


@dataclass(frozen=True, slots=True, eq=False)
class Panels:
    """A figure with a panel for each scene.

    figure : Figure
    axes : dict from scene to Axes, in the order of the scenes.
    """

    figure: Figure
    axes: dict[str, Axes]


def scene_panels(scenes: Sequence[str], *, share_x: bool = True) -> Panels:
    """Make a figure with a panel for each scene, of at most PANELS_AT_MOST.

    Parameters
    ----------
    scenes : sequence of str
    share_x : bool
        Whether all have the same horizontal axis.
    """
    shown = list(scenes)[:PANELS_AT_MOST]
    columns = min(COLUMNS, len(shown))
    rows = -(-len(shown) // columns)
    height = HEIGHT if columns > 2 else HIGHER
    figure, grid = plt.subplots(
        rows,
        columns,
        # A single panel must hold the title above it.
        figsize=(max(1.0 + 2.3 * columns, 6.4), 1.4 + height * rows),
        sharex=share_x,
        sharey=True,
        squeeze=False,
        layout="constrained",
    )
    axes = dict(zip(shown, grid.flat, strict=False))
    for place, panel in axes.items():
        panel.set_title(place, fontsize=TITLE)
        panel.tick_params(labelsize=SMALL)
        rules(panel)
    for empty in grid.flat[len(shown) :]:
        empty.set_visible(False)
    for panel in grid[-2:, :].flat:
        # Those above an empty place have the axis that it would have.
        panel.tick_params(labelbottom=True)
    return Panels(figure, axes)


def title(panels: Panels, text: str, label: str, scenes: int) -> None:
    """Write what a figure of gaps shows, and the labels of its axes.

    Parameters
    ----------
    panels : Panels
    text : str
    label : str
        Of the horizontal axes.
    scenes : int
        How many there are: those without a panel are counted.
    """
    left_out = scenes - len(panels.axes)
    more = f" ({left_out} more scenes are not drawn)" if left_out else ""
    heading(panels.figure, f"{text}{more}")
    shown = list(panels.axes.values())
    for axes in shown[-COLUMNS:]:
        axes.set_xlabel(label, fontsize=LABEL)
    for axes in shown[::COLUMNS]:
        axes.set_ylabel("gap to the optimum (%)", fontsize=LABEL)
