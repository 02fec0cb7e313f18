"""The critical-difference diagram: mean ranks of the planners, and which do not differ.

References
----------
Demsar (2006), Statistical comparisons of classifiers over multiple data sets, Figure 1.
"""

from collections.abc import Callable, Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suite.report.figures.style import LABEL, TITLE, heading, legend
from suite.report.statistics.anytime import Steps
from suite.report.statistics.inference import LEVEL
from suite.report.tables.ranking import Ranking, rankings, scene_scores

PLANNERS_AT_MOST = 30
"""More names can't be read."""

AXIS = 4.4
"""Length of the axis of ranks, inches, and for each rank if that is more:"""
RANK = 0.35

CHARACTER = 0.08
"""Width of a character of a name, inches."""

GAP = 0.2
"""Between the axis of ranks and the ends of the lines to the names, inches."""

LINE = 0.27
"""Height of a name, inches."""

ABOVE = 0.95
"""Height of the title and the bar of the critical difference, inches."""

HOW_TO_READ = (
    "Each planner stands at its mean rank over the scenes; farther left is better. By gap: success "
    "first, then the median gap; by time: the median time to come within 1 %. Thick lines join "
    "planners that these scenes do not tell apart at 5 %: black, mean ranks that differ by less "
    "than the critical difference (CD) of Nemenyi's test; grey, Wilcoxon's test of each pair, "
    "corrected by Holm."
)

NEMENYI, WILCOXON = "black", "#9a9a9a"
"""Colours of the lines that join planners."""

Bar = tuple[float, float, str]
"""Mean ranks between which there is no difference, and the colour of the test that says so."""


def rank_figures(steps: Steps) -> dict[str, Figure]:
    """The critical-difference diagram of the rankings, by the name of its file.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    dict from str to Figure
        None with fewer than three planners or two scenes: there is no test then.
    """
    found = [ranking for ranking in rankings(scene_scores(steps)) if _can_be_tested(ranking)]
    return {"critical-difference": plot_ranks(found)} if found else {}


def _can_be_tested(ranking: Ranking) -> bool:
    scenes, planners = ranking.ranks.shape
    return scenes >= 2 and 3 <= planners <= PLANNERS_AT_MOST


def plot_ranks(found: Sequence[Ranking]) -> Figure:
    """Draw a diagram for each ranking, one below the other.

    Parameters
    ----------
    found : sequence of Ranking
        Of three planners and two scenes at least.
    """
    bands = [_bars(ranking) for ranking in found]
    heights = [
        ABOVE + LINE * (_rows(len(r.mean)) + 0.4 * len(b))
        for r, b in zip(found, bands, strict=True)
    ]
    beside, length = _beside(found), _axis_length(found)
    figure, grid = plt.subplots(
        len(found),
        1,
        figsize=(2 * beside + length, 1.0 + sum(heights)),
        squeeze=False,
        layout="constrained",
        gridspec_kw={"height_ratios": heights},
    )
    for axes, ranking, bars in zip(grid.flat, found, bands, strict=True):
        _draw(axes, ranking, bars, beside / length)
    heading(figure, "Mean ranks, and the critical difference")
    legend(figure, {}, HOW_TO_READ)
    return figure


def joined(mean_ranks: Sequence[float], difference: float) -> list[tuple[int, int]]:
    """Largest groups of planners whose mean ranks all differ by no more than a difference.

    Parameters
    ----------
    mean_ranks : sequence of float
        Rising.
    difference : float

    Returns
    -------
    list of (int, int)
        First and last place of each group of two or more, none within another.

    Examples
    --------
    >>> joined([1.0, 1.5, 2.5, 4.0], 1.1)
    [(0, 1), (1, 2)]
    """
    groups: list[tuple[int, int]] = []
    for first, lowest in enumerate(mean_ranks):
        last = int(np.searchsorted(mean_ranks, lowest + difference, side="right")) - 1
        if last > first and (not groups or last > groups[-1][1]):
            groups.append((first, last))
    return groups


def _bars(ranking: Ranking) -> list[Bar]:
    """Lines that join planners, of both tests."""
    mean = ranking.mean.sort_values(kind="stable")
    ranks = mean.tolist()
    groups = joined(ranks, ranking.critical_difference)
    pairwise = not_told([str(name) for name in mean.index], ranking.wilcoxon)
    return [
        *((ranks[first], ranks[last], NEMENYI) for first, last in groups),
        *((ranks[first], ranks[last], WILCOXON) for first, last in pairwise),
    ]


def not_told(names: Sequence[str], p_value: Callable[[str, str], float]) -> list[tuple[int, int]]:
    """Largest groups of neighbours of which no two are told apart at 5 %.

    Parameters
    ----------
    names : sequence of str
        In the order of their mean ranks.
    p_value : callable
        Of two names.

    Returns
    -------
    list of (int, int)
        First and last place of each group of two or more, none within another.

    Examples
    --------
    >>> not_told("abc", lambda one, other: 0.01 if {one, other} == {"a", "c"} else 1.0)
    [(0, 1), (1, 2)]
    """
    groups: list[tuple[int, int]] = []
    for first in range(len(names)):
        last = first
        while last + 1 < len(names) and all(
            p_value(names[i], names[last + 1]) >= 1.0 - LEVEL for i in range(first, last + 1)
        ):
            last += 1
        if last > first and (not groups or last > groups[-1][1]):
            groups.append((first, last))
    return groups


def _beside(found: Sequence[Ranking]) -> float:
    """Room for the names on each side of the axis of ranks, inches."""
    longest = max(len(str(planner)) for ranking in found for planner in ranking.ranks.columns)
    return CHARACTER * (longest + 6) + 2 * GAP


def _axis_length(found: Sequence[Ranking]) -> float:
    return max(AXIS, RANK * max(len(ranking.ranks.columns) - 1 for ranking in found))


def _rows(planners: int) -> int:
    return -(-planners // 2)


def _draw(axes: Axes, ranking: Ranking, bars: Sequence[Bar], beside: float) -> None:
    """Draw one diagram, with so much room on each side of its axis, in lengths of that.

    y counts rows of names downwards from the axis.
    """
    mean = ranking.mean.sort_values(kind="stable")
    count = len(mean)
    depth = 0.5 + 0.4 * len(bars)
    room = beside * (count - 1)
    gap = 0.04 * (count - 1)
    axes.set_xlim(1.0 - room, count + room)
    axes.set_ylim(depth + _rows(count), -2.0)
    axes.axis("off")
    axes.set_title(f"{ranking.name} ({len(ranking.ranks)} scenes)", fontsize=TITLE)
    _draw_axis(axes, count)
    _draw_difference(axes, ranking.critical_difference, count)
    for i, (low, high, colour) in enumerate(bars):
        y = 0.4 + 0.4 * i
        axes.plot([low - 0.2 * gap, high + 0.2 * gap], [y, y], color=colour, linewidth=4)
    _draw_names(axes, mean, depth, gap)


def _draw_axis(axes: Axes, count: int) -> None:
    axes.plot([1, count], [0, 0], color="black", linewidth=1.0)
    for rank in range(1, count + 1):
        axes.plot([rank, rank], [0, -0.2], color="black", linewidth=1.0)
        axes.text(rank, -0.3, str(rank), ha="center", va="bottom", fontsize=LABEL)


def _draw_difference(axes: Axes, difference: float, count: int) -> None:
    # A difference that is longer than the axis says that there are too few scenes: it is written.
    end = 1.0 + min(difference, count - 1.0)
    axes.plot([1.0, end], [-1.25, -1.25], color="black", linewidth=1.6, marker="|", markersize=7)
    text = f"CD = {difference:.2f}"
    axes.text((1.0 + end) / 2, -1.4, text, ha="center", va="bottom", fontsize=LABEL)


def _draw_names(axes: Axes, mean: "pd.Series[Any]", depth: float, gap: float) -> None:
    """Write the better half on the left, and the other on the right; the outer ones are highest."""
    count = len(mean)
    half = _rows(count)
    for i, (planner, rank) in enumerate(mean.items()):
        is_left = i < half
        y = depth + (i if is_left else count - 1 - i) + 0.3
        edge = 1.0 - gap if is_left else count + gap
        axes.plot([rank, rank, edge], [0, y, y], color="#606060", linewidth=0.9)
        name = f"{planner}  {rank:.2f}" if is_left else f"{rank:.2f}  {planner}"
        side = "right" if is_left else "left"
        axes.text(
            edge + (-0.4 * gap if is_left else 0.4 * gap),
            y,
            name,
            ha=side,
            va="center",
            fontsize=LABEL,
            in_layout=False,
        )
