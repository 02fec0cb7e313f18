"""Pictures of the studies: what a setting, an operator or the number of obstacles changes."""

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from suite.report.figures import style
from suite.report.tables.ablation import NOTHING, ablation
from suite.report.tables.glance import glance
from suite.report.tables.studies import RESOLUTION, STUDIES, Study, obstacles, of_kbga_plus, sweep

PAPER = {"color": "black", "linestyle": "--", "marker": "x", "markersize": 7, "linewidth": 1.4}

AXIS_LABELS = {
    "feasible (%)": "feasible runs (%)",
    "gap mean (%)": "mean gap (%)",
    "gen to best mean": "generations to best",
    "cost with penalties over optimum": "cost with penalties\n(multiples of optimum)",
}
NO_PATH: dict[str, Any] = {
    "facecolor": "white",
    "edgecolor": "#a0a0a0",
    "hatch": "//",
    "linewidth": 0,
}
"""White alone would look like no gap."""

COLUMNS = 4
"""Scenes side by side."""

PALEST = 0.05
"""Per cent: the lower end of the colours. What is below is as good as the optimum."""


def study_figures(runs: pd.DataFrame) -> dict[str, Figure]:
    """The figures of the studies that these runs can answer, by the name of their file.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    """
    figures = {}
    for study in STUDIES:
        frame = sweep(runs, study)
        if study is RESOLUTION and not frame.empty:
            # A line for each scene has room for one planner.
            frame = frame[~of_kbga_plus(frame)]
        if not frame.empty:
            plot = plot_resolution if study is RESOLUTION else plot_sweep
            figures[f"study-{study.name}"] = plot(frame, study)
    ablated = ablation(runs)
    if not ablated.empty:
        figures["study-ablation"] = plot_ablation(ablated)
    counted = obstacles(runs)
    if not counted.empty:
        figures["study-obstacles"] = plot_obstacles(counted)
    return figures


def plot_sweep(frame: pd.DataFrame, study: Study) -> Figure:
    """Draw two measures over a setting, scene by scene.

    Parameters
    ----------
    frame : DataFrame
        Of :func:`suite.report.tables.studies.sweep`.
    study : Study
        Its ``panels`` say which measures.
    """
    scenes = list(dict.fromkeys(frame["scene"]))
    families = list(dict.fromkeys(frame["family"]))
    columns = min(COLUMNS, len(scenes))
    blocks = -(-len(scenes) // columns)
    figure, grid = plt.subplots(
        2 * blocks,
        columns,
        figsize=(1.0 + 2.3 * columns, 0.8 + 3.6 * blocks),
        sharex=True,
        squeeze=False,
        layout="constrained",
    )
    for number, scene in enumerate(scenes):
        block, column = divmod(number, columns)
        here = frame[frame["scene"] == scene]
        for i, panel in enumerate(study.panels):
            axes = grid[2 * block + i, column]
            _draw_families(axes, here, families, panel)
            _arrange_values(axes, study, frame)
            axes.axvline(study.reference, color="black", linestyle=":", linewidth=1.0, zorder=1)
            if column == 0:
                axes.set_ylabel(AXIS_LABELS[panel], fontsize=style.LABEL)
            axes.tick_params(labelsize=style.SMALL)
        grid[2 * block, column].set_title(scene, fontsize=style.TITLE, pad=7)
        grid[2 * block + 1, column].set_xlabel(study.symbol, fontsize=style.LABEL)
        grid[2 * block + 1, column].tick_params(labelbottom=True)
    for column in range(len(scenes) % columns or columns, columns):
        grid[-1, column].set_visible(False)
        grid[-2, column].set_visible(False)
    style.heading(figure, f"{study.title} (dotted: {study.symbol} {study.reference:g})")
    if len(families) > 1:
        handles, labels = grid[0, 0].get_legend_handles_labels()
        style.legend_below(figure, handles=handles, labels=labels, ncols=2)
    return figure


def _draw_families(axes: Axes, here: pd.DataFrame, families: Sequence[str], panel: str) -> None:
    for i, family in enumerate(families):
        rows = here[here["family"] == family].sort_values("value")
        axes.plot(
            rows["value"], rows[panel], label=family, markersize=4, linewidth=1.4, **style.look(i)
        )
    if panel == "feasible (%)":
        axes.set_ylim(-4.0, 104.0)
        axes.set_yticks([0, 50, 100])
    elif here[panel].isna().all():
        axes.set_yticks([])
        axes.text(
            0.5,
            0.5,
            "no path",
            transform=axes.transAxes,
            ha="center",
            va="center",
            fontsize=style.LABEL,
        )
    else:
        lowest = 1.0 if panel == "cost with penalties over optimum" else 0.0
        above = 1.12 * max(here[panel].max() - lowest, 0.1)
        axes.set_ylim(lowest - 0.04 * above, lowest + above)
    style.rules(axes)


def _arrange_values(axes: Axes, study: Study, frame: pd.DataFrame) -> None:
    values = sorted(set(frame["value"]))
    if study.logarithmic:
        axes.set_xscale("log")
    shown = values if len(values) <= 5 else values[::2]
    style.ticks_at(axes.xaxis, shown)


def plot_resolution(frame: pd.DataFrame, study: Study) -> Figure:
    """Draw time and gap over the resolution; the paper's ratios beside those of its scene.

    Parameters
    ----------
    frame : DataFrame
        Of :func:`suite.report.tables.studies.sweep`.
    study : Study
    """
    figure, (time, gap) = plt.subplots(1, 2, figsize=(9.0, 4.6), layout="constrained")
    for i, (scene, here) in enumerate(frame.groupby("scene", sort=False)):
        has_paper = here["paper ratio"].notna().any()
        line = _marked(i) | ({"linewidth": 2.6, "zorder": 3} if has_paper else {"linewidth": 1.2})
        rows = here.sort_values("value")
        time.plot(rows["value"], rows["ratio total"], label=str(scene), **line)
        gap.plot(rows["value"], rows["gap mean (%)"], **line)
        if has_paper:
            time.plot(
                rows["value"], rows["paper ratio"], label=f"paper, {scene}", **PAPER, zorder=4
            )
    for axes in (time, gap):
        _arrange_values(axes, study, frame)
        axes.set_xlabel("resolution (lattice units per side)")
        style.rules(axes)
        # From 0, with room for the markers on it.
        axes.set_ylim(bottom=-0.03 * axes.get_ylim()[1])
    time.set_ylabel("cpu time of a run, ratio to resolution 100")
    gap.set_ylabel("mean gap to the exact optimum (%)")
    style.heading(figure, study.title)
    style.legend_below(figure, ncols=3, handlelength=3.4)
    return figure


def plot_obstacles(frame: pd.DataFrame) -> Figure:
    """Draw time, and time per check, over the number of obstacles; logarithmic axes.

    Parameters
    ----------
    frame : DataFrame
        Of :func:`suite.report.tables.studies.obstacles`.
    """
    figure, (time, check) = plt.subplots(1, 2, figsize=(9.0, 4.4), layout="constrained")
    x = frame["value"]
    time.plot(x, frame["ratio total"], label="a whole run", **_marked(0))
    time.plot(x, frame["ratio to best"], label="until the best was found", **_marked(1))
    time.plot(x, frame["paper ratio"], label="paper", **PAPER)
    time.set_ylabel("cpu time, ratio to 20 obstacles")
    time.legend(frameon=False, fontsize=style.LABEL, handlelength=3.4)
    check.plot(x, frame["cpu per check (us)"], **_marked(0))
    check.set_ylabel("cpu time of a run per collision check (µs)")
    for axes in (time, check):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("obstacles")
        style.ticks_at(axes.xaxis, sorted(set(x)))
        axes.tick_params(axis="x", labelsize=style.SMALL)
        style.rules(axes)
        _plain_logarithm(axes)
    style.heading(figure, "KBGA among more and more obstacles")
    return figure


def _plain_logarithm(axes: Axes) -> None:
    """Label round numbers, as far as the data reach; the fewer, the farther they reach."""
    low, high = (float(end) for end in axes.dataLim.intervaly)
    low, high = low / 1.25, high * 1.25
    steps = (1, 1.5, 2, 3, 4, 5, 6, 8) if high / low < 20 else (1, 2, 5)
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    ticks = [float(d * step) for d in decades for step in steps if low <= d * step <= high]
    axes.set_ylim(low, high)
    style.ticks_at(axes.yaxis, ticks)


def plot_ablation(frame: pd.DataFrame) -> Figure:
    """Draw the mean gap of each ablation and scene as a table of shades, with its numbers.

    Parameters
    ----------
    frame : DataFrame
        Of :func:`suite.report.tables.ablation.ablation`.
    """
    scenes = list(dict.fromkeys(frame["scene"]))
    names = list(dict.fromkeys(frame[["family", "value"]].itertuples(index=False, name=None)))
    cells = {
        (str(row["family"]), str(row["value"]), str(row["scene"])): row
        for row in frame.to_dict("records")
    }
    figure, axes = plt.subplots(
        figsize=(3.4 + 0.92 * len(scenes), 1.0 + 0.33 * len(names)), layout="constrained"
    )
    norm = LogNorm(PALEST, 100.0)
    gaps = np.full((len(names), len(scenes)), np.nan)
    for i, (family, off) in enumerate(names):
        for j, scene in enumerate(scenes):
            row = cells.get((str(family), str(off), scene))
            if row is None:
                continue
            if row["feasible"]:
                gaps[i, j] = min(max(float(row["gap mean (%)"]), PALEST), 100.0)
            else:
                axes.add_patch(Rectangle((j - 0.5, i - 0.5), 1, 1, **NO_PATH))
            _write_cell(axes, i, j, row, gaps[i, j], norm)
    style.heading(
        figure,
        "KBGA without some of its operators (n/m: runs that found a path; hatched: none did)",
    )
    image = axes.imshow(gaps, cmap="Greys", norm=norm, aspect="auto")
    axes.set_xticks(range(len(scenes)), scenes, fontsize=style.SMALL)
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(names)), _ablation_labels(names), fontsize=style.LABEL)
    style.separate_cells(axes, *gaps.shape, width=1.2)
    families = [str(family) for family, _ in names]
    for i in range(1, len(names)):
        if families[i] != families[i - 1]:
            axes.axhline(i - 0.5, color="black", linewidth=1.2)
    bar = figure.colorbar(image, ax=axes, shrink=0.7, pad=0.01)
    bar.set_label("mean gap to the exact optimum (%)", fontsize=style.LABEL)
    bar.ax.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    return figure


def _write_cell(axes: Axes, i: int, j: int, row: dict[Any, Any], gap: float, norm: LogNorm) -> None:
    dark = not np.isnan(gap) and float(norm(gap)) > 0.55
    axes.text(
        j,
        i,
        # The gap alone where all runs found a path, as nearly all do; else how many did.
        glance(row).replace(" of ", "/").replace(" (", "\n("),
        ha="center",
        va="center",
        fontsize=style.SMALLEST,
        linespacing=0.95,
        color="white" if dark else "black",
        bbox=None if row["feasible"] else {"facecolor": "white", "edgecolor": "none", "pad": 1},
    )


def _ablation_labels(names: Sequence[tuple[Any, ...]]) -> list[str]:
    """What is off; the first line of a family says also whose."""
    labels = []
    for i, (family, off) in enumerate(names):
        text = "whole" if off == NOTHING else f"without {off}"
        labels.append(text if i and names[i - 1][0] == family else f"{family}: {text}")
    return labels


def _marked(i: int) -> dict[str, Any]:
    return style.look(i) | {"markersize": 5}
