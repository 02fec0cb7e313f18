"""All planners on all scenes at a glance: how near the optimum, and how soon."""

from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from suite.report.figures import style
from suite.report.statistics.anytime import Steps
from suite.report.statistics.clock import untimed_note
from suite.report.tables.ranking import rankings, scene_scores
from suite.report.words import joined

PLANNERS_AT_MOST = 40
SCENES_AT_MOST = 16
"""More can't be read."""

CELL = (0.62, 0.27)
"""Width and height of a cell, inches."""

CHARACTER = 0.085
"""Width of a character of a planner's name, inches."""

AROUND = 2.3
"""Height of titles, names of scenes and the sentences below, inches."""

HOW_TO_READ = (
    "Left: median gap to the exact optimum of the paths found, per cent; below 100 % success, the "
    "share of runs that found one. Right: median time until the best path is within 1 % of the "
    "optimum, ms, over all runs; -: half of them or more never were. Darker is worse. Planners in "
    "the order of their mean rank by gap."
)


@dataclass(frozen=True, slots=True, eq=False)
class _Map:
    """Numbers of all planners (rows) and scenes (columns), and what is written into the cells.

    least : what is less has the colour of this.
    """

    title: str
    numbers: pd.DataFrame
    texts: pd.DataFrame
    least: float


def overview_figures(steps: Steps) -> dict[str, Figure]:
    """The overview, by the name of its file.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    dict from str to Figure
        None with fewer than two planners or two scenes, or without a path or an optimum.
    """
    scores = scene_scores(steps)
    planners, scenes = scores["planner"].nunique(), scores["scene"].nunique()
    readable = 2 <= planners <= PLANNERS_AT_MOST and 2 <= scenes <= SCENES_AT_MOST
    if not readable or scores["gap median (%)"].isna().all():
        return {}
    return {"overview": plot_overview(scores, untimed_note(steps.runs))}


def plot_overview(scores: pd.DataFrame, left_out: str = "") -> Figure:
    """Draw the planners' gaps and times on all scenes as two maps of coloured numbers.

    Parameters
    ----------
    scores : DataFrame
        Of :func:`suite.report.tables.ranking.scene_scores`, with a gap.
    left_out : str
        What times leave out, in a sentence.
    """
    order = rankings(scores)[0].mean.sort_values(kind="stable").index
    maps = _gaps(scores), _times(scores)
    scenes = scores["scene"].nunique()
    names = CHARACTER * max(map(len, order))
    size = (names + 2 * (scenes * CELL[0] + 0.3), AROUND + CELL[1] * len(order))
    figure, panels = plt.subplots(1, 2, figsize=size, sharey=True, layout="constrained")
    for axes, drawn in zip(panels, maps, strict=True):
        _draw(axes, drawn, list(order))
    style.heading(figure, "Planners and scenes: how near the optimum, and how soon")
    style.legend(figure, {}, joined(HOW_TO_READ, left_out))
    return figure


def _gaps(scores: pd.DataFrame) -> _Map:
    gap, success = scores["gap median (%)"], scores["success (%)"]
    texts = [_gap_text(g, s) for g, s in zip(gap, success, strict=True)]
    return _map("median gap (%)", scores, gap.where(np.isfinite(gap)), texts, style.LEAST_GAP)


def _times(scores: pd.DataFrame) -> _Map:
    time = scores["time to 1 % median (ms)"]
    texts = ["-" if np.isinf(ms) else "" if np.isnan(ms) else _three(ms) for ms in time]
    finite = time.where(np.isfinite(time))
    least = finite.min() if finite.notna().any() else 1.0
    return _map("median time to within 1 % (ms)", scores, finite, texts, least)


def _map(
    title: str, scores: pd.DataFrame, numbers: "pd.Series[Any]", texts: list[str], least: float
) -> _Map:
    """Spread a column of the scores over planners and scenes."""
    shown = scores[["planner", "scene"]].assign(number=numbers, text=texts)
    return _Map(title, _spread(shown, "number"), _spread(shown, "text"), least)


def _spread(shown: pd.DataFrame, column: str) -> pd.DataFrame:
    wide = shown.pivot(index="planner", columns="scene", values=column)  # noqa: PD010
    return wide[list(dict.fromkeys(shown["scene"]))]


def _gap_text(gap: float, success: float) -> str:
    if np.isnan(gap):
        return "no path" if success == 0 else ""
    text = f"{gap:.2f}" if gap < 9.995 else f"{gap:.0f}"
    return text if success == 100 else f"{text}, {success:.0f} %"


def _three(value: float) -> str:
    """A number with three digits at most."""
    return style.plain_number(float(f"{value:.2g}" if value < 100 else f"{value:.0f}"))


def _draw(axes: Axes, drawn: _Map, planners: list[str]) -> None:
    """Draw one map: its cells, their numbers, the names around them."""
    values = drawn.numbers.loc[planners].to_numpy()
    texts = drawn.texts.loc[planners].to_numpy()
    colours, norm = style.colouring(values, drawn.least)
    shades = np.ma.masked_invalid(np.maximum(values, drawn.least))
    axes.imshow(shades, cmap=colours, norm=norm, aspect="auto")
    for (row, column), text in np.ndenumerate(texts):
        colour = _letters(norm, shades[row, column])
        letters: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": style.SMALLEST}
        axes.text(column, row, text, color=colour, **letters)
    axes.set_title(drawn.title, fontsize=style.TITLE)
    axes.set_xticks(
        range(len(drawn.numbers.columns)), drawn.numbers.columns, rotation=35, ha="right"
    )
    axes.set_yticks(range(len(planners)), planners)
    axes.tick_params(labelsize=style.SMALL)
    style.separate_cells(axes, *values.shape, width=0.8)
    axes.spines[:].set_visible(False)


def _letters(norm: LogNorm, shade: Any) -> str:
    """Black or white, whichever is read on the colour of a cell."""
    return "black" if np.ma.is_masked(shade) or norm(shade) < style.DARK_FROM else "white"
