"""Pictures of how long it takes to come near the optimum: runtime ECDF and performance profile.

References
----------
Hansen, Auger, Ros, Mersmann, Tusar and Brockhoff (2021), COCO: a platform for comparing continuous
optimizers. Dolan and More (2002), Benchmarking optimization software with performance profiles.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suite.report.figures.panels import PLANNERS_AT_MOST
from suite.report.figures.style import heading, legend, logarithmic_time, look, numbered, rules
from suite.report.statistics.anytime import Steps, first_within, on_clock, only
from suite.report.statistics.clock import untimed_note
from suite.report.statistics.inference import Array
from suite.report.tables.ranking import scene_scores
from suite.report.words import counted, joined

TARGETS = 10.0 ** np.linspace(0.0, -3.0, 31)
"""Gaps from 100 % to 0.1 %, ten to a decade."""

POINTS = 600
"""Places on the horizontal axis: the picture has hardly more."""

CLOCKS = {"wall_s": ("wall time (ms)", 1e3), "checks": ("collision checks", 1.0)}

ECDF_NOTE = (
    "Each run and target is a problem: the share that is solved by then, over {scenes} and "
    "{targets} targets, gaps of 100 % to 0.1 %, evenly spaced on their logarithm. Higher and "
    "farther left is better; what is missing to 1 was never reached. Who does not count checks has "
    "no line on the right."
)
PROFILE_NOTE = (
    "Share of {scenes} on which a planner's median time to come within 1 % of the optimum is at "
    "most so many times the shortest of all planners. At 1: how often it is the fastest. Far "
    "right: on how many scenes more than half of its runs came so near."
)


def runtime_figures(steps: Steps) -> dict[str, Figure]:
    """The figures that these runs can answer, by the name of the file.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    dict from str to Figure
        The profile needs two planners that ran the same scene.
    """
    planners = steps.runs["variant"].nunique()
    if planners > PLANNERS_AT_MOST or np.isnan(steps.optimum[steps.run]).all():
        return {}
    figures = {"ecdf": plot_ecdf(steps)}
    scores = scene_scores(steps)
    if planners > 1 and np.isfinite(scores["time to 1 % median (ms)"]).any():
        figures["performance-profile"] = plot_profile(scores)
    return figures


def plot_ecdf(steps: Steps) -> Figure:
    """Draw the share of runs and targets that are reached, over time and over collision checks.

    Parameters
    ----------
    steps : Steps
        With an accepted path in a scene with an optimum.
    """
    planners = numbered(steps.runs["variant"])
    figure, panels = plt.subplots(1, 2, figsize=(9.4, 4.8), sharey=True, layout="constrained")
    with_optimum = only(steps, ~np.isnan(steps.optimum))
    for axes, (clock, (label, unit)) in zip(panels, CLOCKS.items(), strict=True):
        known = on_clock(with_optimum, clock)
        variants = known.runs["variant"].to_numpy()
        reached = unit * np.array([first_within(known, clock, target) for target in TARGETS])
        # Runs without path alone, of a planner that does not count: as if it reached nothing.
        silent = set(variants[known.run[np.isnan(known.clocks[clock])]])
        named = {planner: i for planner, i in planners.items() if planner not in silent}
        _draw_ecdf(axes, reached, variants, named)
        axes.set_xlabel(label)
    panels[0].set_ylabel("share of runs and targets reached")
    heading(figure, "How soon runs come near the optimum")
    scenes = counted(with_optimum.runs["place"].nunique(), "scene")
    note = ECDF_NOTE.format(scenes=scenes, targets=len(TARGETS))
    legend(figure, planners, joined(note, untimed_note(with_optimum.runs)))
    return figure


def _draw_ecdf(axes: Axes, reached: Array, variants: Array, planners: dict[str, int]) -> None:
    """Draw the share that is reached over a clock; (targets, runs) float64, infinite if never."""
    finite = reached[np.isfinite(reached) & (reached > 0.0)]
    low, high = (finite.min(), finite.max()) if len(finite) else (1.0, 10.0)
    ends = 0.8 * low, max(1.25 * high, 10.0 * low)
    x = np.geomspace(*ends, POINTS)
    for planner, i in planners.items():
        mine = np.sort(reached[:, variants == planner].ravel())
        if not len(mine):
            continue
        share = np.searchsorted(mine, x, side="right") / len(mine)
        # Markers at even heights: most curves are steep in one place and flat in another.
        heights = share[-1] * (0.1 + 0.2 * np.arange(5) + 0.015 * i)
        marks = np.searchsorted(share, heights[heights < share[-1]])
        axes.plot(x, share, markevery=marks.tolist(), markersize=5, linewidth=1.5, **look(i))
    _logarithmic(axes, *ends)
    axes.set_ylim(0.0, 1.02)


def plot_profile(scores: pd.DataFrame) -> Figure:
    """Draw the performance profile of the median times to come within 1 % of the optimum.

    Parameters
    ----------
    scores : DataFrame
        Of :func:`suite.report.tables.ranking.scene_scores`, with a time that is finite.
    """
    known = scores[scores["time to 1 % median (ms)"].notna()]
    times = "time to 1 % median (ms)"
    table = known.pivot(index="planner", columns="scene", values=times)  # noqa: PD010
    best = table.min()
    # Where no planner came so near, none did as well as the best.
    ratios = table / best.where(np.isfinite(best))
    planners = numbered(scores["planner"])
    finite = ratios.to_numpy()[np.isfinite(ratios.to_numpy())]
    end = max(1.5 * finite.max(), 10.0)
    figure, axes = plt.subplots(figsize=(7.6, 5.0), layout="constrained")
    for planner, i in planners.items():
        if planner not in ratios.index:  # no run of it had a core for itself
            continue
        mine = np.sort(ratios.loc[planner].dropna().to_numpy())
        mine = mine[np.isfinite(mine)]
        share = np.arange(len(mine) + 1) / ratios.shape[1]
        axes.step(
            np.concatenate([[1.0], mine, [end]]),
            np.append(share, share[-1]),
            where="post",
            markevery=slice(1, -1),
            markersize=5,
            linewidth=1.5,
            **look(i),
        )
    _logarithmic(axes, 0.93, end)
    axes.set_ylim(-0.02, 1.03)
    axes.set_xlabel("time, as a multiple of the fastest planner's")
    axes.set_ylabel("share of scenes")
    heading(figure, "Performance profile: time to come within 1 % of the optimum")
    legend(figure, planners, PROFILE_NOTE.format(scenes=counted(ratios.shape[1], "scene")))
    return figure


def _logarithmic(axes: Axes, low: float, high: float) -> None:
    logarithmic_time(axes, low, high)
    rules(axes)
