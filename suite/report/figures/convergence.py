"""Pictures of how runs get better while they run: gap over time, generations and checks."""

from collections.abc import Collection

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from suite.report.figures import style
from suite.report.figures.panels import PANELS_AT_MOST, PLANNERS_AT_MOST, scene_panels, title
from suite.report.statistics.anytime import Steps, gap_at, groups_of, only
from suite.report.statistics.clock import WALL, by_the_clock, untimed_note
from suite.report.statistics.inference import Array
from suite.report.words import joined

POINTS = 160
"""Places on the horizontal axis."""

OUT_OF_SIGHT = 1e9
"""Per cent: above every picture."""

CLOCKS = {
    "wall_s": ("time", "wall time (ms)", 1e3, 0.0),
    # The first population is generation 0: a logarithmic axis has no 0.
    "generation": ("generations", "generations or iterations + 1", 1.0, 1.0),
    "checks": ("checks", "collision checks", 1.0, 0.0),
}
"""What is drawn over: its name, the label of the axis, the unit, and what is added to have no 0."""

HOW_TO_READ = (
    "Line: median over all runs; band: quartiles. A run without a path yet counts as worse than "
    "any gap: a line begins when half of the runs have a path, and its band is closed above when "
    "three quarters have one. A run that has ended keeps its last path."
)


def convergence_figures(steps: Steps) -> dict[str, Figure]:
    """Gap over each clock that some planner counts, by the name of the file.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    dict from str to Figure
        None without an accepted path in a scene with an optimum, or with too many planners.
    """
    if steps.runs["variant"].nunique() > PLANNERS_AT_MOST:
        return {}
    measured = steps.optimum[steps.run] > 0.0
    return {
        f"convergence-{name}": plot_convergence(steps, clock)
        for clock, (name, *_) in CLOCKS.items()
        if np.isfinite(steps.clocks[clock][measured]).any() and counted_groups(steps, clock)
    }


def plot_convergence(steps: Steps, clock: str) -> Figure:
    """Draw the median gap and its quartiles over a clock, scene by scene.

    Parameters
    ----------
    steps : Steps
        With an accepted path in a scene with an optimum.
    clock : str
        Of :data:`CLOCKS`.
    """
    name, label, unit, shift = CLOCKS[clock]
    planners = style.numbered(steps.runs["variant"])
    scenes = list(dict.fromkeys(scene for scene, _ in counted_groups(steps, clock)))
    drawn = only(steps, steps.runs["place"].isin(scenes[:PANELS_AT_MOST]).to_numpy())
    groups = counted_groups(drawn, clock)
    grid = grid_over(drawn.clocks[clock] + shift)
    bands = gap_bands(drawn, clock, grid - shift, groups)
    panels = scene_panels(scenes)
    for (scene, planner), band in bands.items():
        _draw_band(panels.axes[scene], grid * unit, 100.0 * band, planners[planner])
    first = next(iter(panels.axes.values()))
    style.logarithmic_time(first, grid[0] * unit, grid[-1] * unit)
    style.logarithmic_gaps(first, 100.0 * np.array(list(bands.values())))
    title(panels, f"How the gap falls over {name}", label, len(scenes))
    counting = {planner for _, planner in groups}
    named = {planner: i for planner, i in planners.items() if planner in counting}
    left_out = untimed_note(steps.runs) if clock == WALL else ""
    silent = _silent(planners.keys() - counting, name)
    style.legend(panels.figure, named, joined(HOW_TO_READ + silent, left_out))
    return panels.figure


def _silent(planners: Collection[str], clock: str) -> str:
    """Who is not drawn, for it does not count; by time, for no run had a core for itself."""
    why = "contended" if clock == "time" else f"without a count of {clock}"
    return f" Not drawn, {why}: {', '.join(sorted(planners))}." if planners else ""


def counted_groups(steps: Steps, clock: str) -> dict[tuple[str, str], NDArray[np.int64]]:
    """Numbers of the runs of each scene with an optimum and planner that counts on this clock.

    Of a planner that never found a path nobody knows: it counts, and has no line.
    """
    counted = ~np.isnan(steps.clocks[clock])
    variants = steps.runs["variant"].to_numpy()
    silent = set(variants[steps.run[~counted]]) - set(variants[steps.run[counted]])
    # Where start and goal are one place there is no gap that an axis could show.
    wanted = (steps.optimum > 0.0) & ~np.isin(variants, list(silent))
    wanted[steps.run[~counted]] = False
    if clock == WALL:
        wanted &= by_the_clock(steps.runs)
    return groups_of(steps, wanted)


def grid_over(shown: Array) -> Array:
    """Places on the axis, evenly spaced on its logarithm, that hold all steps."""
    shown = shown[np.isfinite(shown) & (shown > 0.0)]
    low, high = float(shown.min()), float(shown.max())
    return np.geomspace(low, max(1.05 * high, 10.0 * low), POINTS)


def gap_bands(
    steps: Steps,
    clock: str,
    values: Array,
    groups: dict[tuple[str, str], NDArray[np.int64]],
) -> dict[tuple[str, str], Array]:
    """Quartiles of each group, (3, values), infinite where there is no path."""
    bands = {key: np.empty((3, len(values))) for key in groups}
    for i, value in enumerate(values):
        gap = gap_at(steps, clock, value)
        for key, rows in groups.items():
            bands[key][:, i] = quartiles(gap[rows])
    return bands


def quartiles(values: Array) -> Array:
    """Lower quartile, median and upper quartile, of values some of which may be infinite.

    Examples
    --------
    >>> quartiles(np.array([np.inf, 1.0, 2.0, 3.0, np.inf])).tolist()
    [2.0, 3.0, inf]
    """
    ordered = np.sort(values)
    last = len(ordered) - 1
    # Quartiles are not interpolated: half way between a number and infinity is none.
    middle = 0.5 * (ordered[last // 2] + ordered[last - last // 2])
    return np.array([ordered[last // 4], middle, ordered[last - last // 4]])


def _draw_band(axes: Axes, x: Array, band: Array, i: int) -> None:
    low, middle, high = np.maximum(band, style.LEAST_GAP)
    lines = style.look(i)
    began = np.isfinite(low)
    axes.fill_between(
        x[began],
        low[began],
        np.minimum(high[began], OUT_OF_SIGHT),
        color=lines["color"],
        alpha=0.15,
        linewidth=0,
        step="post",
    )
    axes.step(
        x,
        np.where(np.isfinite(middle), middle, np.nan),
        where="post",
        markersize=4,
        markevery=(4 * i, 32),
        linewidth=1.5,
        **lines,
    )
