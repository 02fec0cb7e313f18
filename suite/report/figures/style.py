"""How figures look: colours, lines, markers, sizes, legends, and the numbers on axes.

Colours are Okabe and Ito's, told apart by colour-blind readers. Colour, line style and marker say
the same thing three times, for readers in grey and readers who do not tell the colours apart.
"""

import textwrap
from collections.abc import Iterable, Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import Colormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter, NullLocator
from numpy.typing import NDArray

from suite.scenes.scene import Scene

OBSTACLE = "#c8c8c8"
OBSTACLE_EDGE = "#707070"
OPTIMUM = "#000000"
POPULATION = "#56b4e9"
BEST = "#d55e00"

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

MARKERS = ("o", "s", "^", "D", "v", "P", "<", "*")

ENDS: dict[str, Any] = {
    "markerfacecolor": "white",
    "markeredgecolor": "black",
    "linestyle": "none",
}
"""Start and goal, a ring and a star."""

HEADING, TITLE, LABEL, SMALL, SMALLEST = 11, 10, 9, 8, 7
"""Font sizes: of a figure's title, of a panel's, of axes and legends, of what stands in many panels
and of the sentence below, of what stands within them."""

RASTER_DPI = 130
RASTER_COLOURS = 96
"""Enough for lines, shades and their soft edges, in a third of the bytes of all colours."""

NOTHING = "#e4e4e4"
"""Colour of a cell without a number: no path, or never so near."""

DARK_FROM = 0.6
"""Share of the colour map from which on white letters are read more easily."""

LEAST_GAP = 0.01
"""Per cent. What is closer to the optimum is drawn here: a logarithmic axis has no 0."""

SMALL_CHARACTERS_PER_INCH = 14.5
CHARACTERS_PER_INCH = 12.0
HANDLE = 9
"""Characters that fit beside each other, in a sentence and in a legend of size 9, and how many the
line before a name takes."""

RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


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


def heading(figure: Figure, text: str) -> None:
    """Write what a figure shows above it."""
    figure.suptitle(text, fontsize=HEADING)


def rules(axes: Axes) -> None:
    """Draw thin lines behind what is drawn, at the ticks."""
    axes.grid(alpha=0.3, linewidth=0.5)


def height_for(scene: Scene, width: float) -> float:
    """Height of a picture of a scene, unless that would be very flat or very high; inches."""
    xmin, ymin, xmax, ymax = scene.bounds
    return width * min(max((ymax - ymin) / (xmax - xmin), 0.3), 2.0)


def label_metres(axes: Axes) -> None:
    """Name the axes of one of several pictures of a scene, in small letters, on the outer sides."""
    axes.tick_params(labelsize=SMALLEST)
    axes.set_xlabel("x (m)", fontsize=SMALL)
    axes.set_ylabel("y (m)", fontsize=SMALL)
    axes.label_outer(remove_inner_ticks=True)


def legend_below(figure: Figure, **options: Any) -> None:
    """Set a legend below a figure, without a frame."""
    figure.legend(loc="outside lower center", frameon=False, fontsize=LABEL, **options)


def legend(
    figure: Figure,
    planners: Mapping[str, int],
    how_to_read: str,
    *,
    only_markers: bool = False,
    only_lines: bool = False,
) -> None:
    """Say below a figure how to read it, and name the planners, as :func:`look` draws them.

    Parameters
    ----------
    figure : Figure
    planners : mapping from name to number
        See :func:`numbered`. Empty, if the figure names them itself.
    how_to_read : str
        Is broken into lines.
    only_markers, only_lines : bool
        Whether the figure has no lines, or no markers.
    """
    line = {"linestyle": "none"} if only_markers else {"marker": "none"} if only_lines else {}
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


def logarithmic_gaps(axes: Axes, gaps_per_cent: NDArray[np.float64]) -> None:
    """Make the vertical axis one of gaps in per cent, from LEAST_GAP to the largest that is finite.

    Parameters
    ----------
    axes : Axes
    gaps_per_cent : (...) float64
    """
    ends, ticks = gap_scale(gaps_per_cent)
    axes.set_yscale("log")
    axes.set_ylim(ends)
    ticks_at(axes.yaxis, ticks)
    axes.yaxis.set_major_formatter(gap_text)


def gap_scale(gaps_per_cent: NDArray[np.float64]) -> tuple[tuple[float, float], list[float]]:
    """Ends of a logarithmic axis of gaps in per cent, and the decades between them.

    Parameters
    ----------
    gaps_per_cent : (...) float64
        Those that are infinite have no place on it.
    """
    finite = gaps_per_cent[np.isfinite(gaps_per_cent)]
    highest = 1.5 * max(float(finite.max(initial=0.0)), 10.0)
    decades = LEAST_GAP * 10.0 ** np.arange(np.log10(highest / LEAST_GAP))
    return (0.7 * LEAST_GAP, highest), decades.tolist()


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


def ticks_at(axis: Axis, places: Iterable[float]) -> None:
    """Make ticks at these places and nowhere else, with plain numbers."""
    axis.set_major_locator(FixedLocator(list(places)))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(lambda value, _: f"{value:g}")


def separate_cells(axes: Axes, rows: int, columns: int, width: float) -> None:
    """Draw white lines between the cells of a map, in place of ticks."""
    axes.set_xticks(np.arange(0.5, columns - 1), minor=True)
    axes.set_yticks(np.arange(0.5, rows - 1), minor=True)
    axes.grid(which="minor", color="white", linewidth=width)
    axes.tick_params(which="both", length=0)


def colouring(values: NDArray[np.float64], least: float) -> tuple[Colormap, LogNorm]:
    """The colours of numbers and their scale, logarithmic: darker is higher.

    Parameters
    ----------
    values : float64 of any shape
        nan where there is none.
    least : float
        The scale begins here.
    """
    highest = np.nanmax(values) if np.isfinite(values).any() else least
    colours = plt.get_cmap("viridis_r").with_extremes(bad=NOTHING)
    return colours, LogNorm(least, max(highest, 10.0 * least))
