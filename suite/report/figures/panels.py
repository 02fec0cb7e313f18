"""A panel for each scene, side by side: what the pictures of several scenes share.

Colour, line style and marker say the same thing three times, for readers in grey and readers who
do not tell the colours apart.
"""

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter, NullLocator

from suite.report.figures.scene import LINES
from suite.report.figures.studies import MARKERS

COLUMNS = 4
"""Panels side by side."""

HEIGHT = 2.3
HIGHER = 3.2
"""Of a panel, inches; higher where one or two are wide."""

PANELS_AT_MOST = 16
"""A picture of more can't be read."""

PLANNERS_AT_MOST = 12
"""More lines can't be told apart."""

LEAST_GAP = 0.01
"""Per cent. What is closer to the optimum is drawn here: a logarithmic axis has no 0."""

SMALL = 8
"""Font size of what stands in many panels, and of the sentence below."""

SMALL_CHARACTERS_PER_INCH = 14.5
CHARACTERS_PER_INCH = 12.0
HANDLE = 9
"""Characters that fit beside each other, in a sentence and in a legend of size 9, and how many the
line before a name takes."""

RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True, slots=True, eq=False)
class Panels:
    """A figure with a panel for each scene.

    figure : Figure
    axes : dict from scene to Axes, in the order of the scenes.
    """

    figure: Figure
    axes: dict[str, Axes]


def numbered(planners: Iterable[str]) -> dict[str, int]:
    """Numbers of planners, in the order in which they first come: see :func:`look`."""
    return {planner: i for i, planner in enumerate(dict.fromkeys(planners))}


def look(i: int) -> dict[str, Any]:
    """Colour, line style and marker of the planner of number i."""
    # Planners that share a colour differ in style and marker.
    again = i // len(LINES)
    return {
        "color": LINES[i % len(LINES)][0],
        "linestyle": LINES[(i + again) % len(LINES)][1],
        "marker": MARKERS[i % len(MARKERS)],
    }


def scene_panels(scenes: Sequence[str]) -> Panels:
    """Make a figure with a panel for each scene, of at most PANELS_AT_MOST.

    Parameters
    ----------
    scenes : sequence of str
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
        sharex=True,
        sharey=True,
        squeeze=False,
        layout="constrained",
    )
    axes = dict(zip(shown, grid.flat, strict=False))
    for place, panel in axes.items():
        panel.set_title(place, fontsize=10)
        panel.tick_params(labelsize=SMALL)
        panel.grid(alpha=0.3, linewidth=0.5)
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
    panels.figure.suptitle(f"{text}{more}", fontsize=11)
    shown = list(panels.axes.values())
    for axes in shown[-COLUMNS:]:
        axes.set_xlabel(label, fontsize=9)
    for axes in shown[::COLUMNS]:
        axes.set_ylabel("gap to the optimum (%)", fontsize=9)


def legend(
    figure: Figure, planners: Mapping[str, int], how_to_read: str, *, only_markers: bool = False
) -> None:
    """Say below a figure how to read it, and name the planners, as :func:`look` draws them.

    Parameters
    ----------
    figure : Figure
    planners : mapping from name to number
        See :func:`numbered`. Empty, if the figure names them itself.
    how_to_read : str
        Is broken into lines.
    only_markers : bool
        Whether the figure has no lines.
    """
    line = {"linestyle": "none"} if only_markers else {}
    longest = max(map(len, planners), default=0)
    columns = int(figure.get_figwidth() * CHARACTERS_PER_INCH / (longest + HANDLE))
    figure.legend(
        handles=[
            Line2D([], [], label=planner, markersize=5, linewidth=1.5, **look(i) | line)
            for planner, i in planners.items()
        ],
        title=wrapped(how_to_read, figure),
        title_fontsize=SMALL,
        loc="outside lower center",
        ncols=min(max(columns, 1), 4),
        frameon=False,
        fontsize=9,
        handlelength=3.6,
        alignment="center",
    )


def wrapped(text: str, figure: Figure) -> str:
    """Break a sentence into lines of the width of a figure."""
    width = int(figure.get_figwidth() * SMALL_CHARACTERS_PER_INCH)
    return textwrap.fill(text, width, break_on_hyphens=False)


def logarithmic_gaps(axes: Axes, gaps_per_cent: "np.ndarray[Any, np.dtype[np.float64]]") -> None:
    """Make the vertical axis one of gaps in per cent, from LEAST_GAP to the largest that is finite.

    Parameters
    ----------
    axes : Axes
    gaps_per_cent : (...) float64
    """
    finite = gaps_per_cent[np.isfinite(gaps_per_cent)]
    highest = max(float(finite.max(initial=0.0)), 10.0)
    decades = 10.0 ** np.arange(-2, np.ceil(np.log10(highest)) + 1)
    axes.set_yscale("log")
    axes.set_ylim(0.7 * LEAST_GAP, 1.5 * highest)
    axes.yaxis.set_major_locator(FixedLocator([d for d in decades if d <= 1.5 * highest]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(gap_text)


def gap_text(value: float, _: object = None) -> str:
    """A tick of an axis of gaps."""
    return f"≤ {value:g}" if value <= LEAST_GAP else f"{value:g}"


def logarithmic_time(axes: Axes, low: float, high: float) -> None:
    """Make the horizontal axis logarithmic between limits, with plain numbers at its decades."""
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    # Within two decades there may be a single power of ten.
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 100 * low else (1.0,)))
    axes.xaxis.set_major_formatter(plain_number)
    axes.xaxis.set_minor_formatter(NullFormatter())


def plain_number(value: float, _: object = None) -> str:
    """A tick of a logarithmic axis.

    Examples
    --------
    >>> plain_number(0.1), plain_number(1000.0), plain_number(1e5), plain_number(2e4)
    ('0.1', '1000', '10⁵', '2·10⁴')
    """
    if value < 1e4:
        return f"{value:g}"
    exponent = int(np.floor(np.log10(value) + 1e-9))
    power = "10" + str(exponent).translate(RAISED)
    factor = round(value / 10.0**exponent)
    return power if factor == 1 else f"{factor}·{power}"
