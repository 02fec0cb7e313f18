"""The interactive charts: how the gap falls, and how soon runs come near the optimum.

Python computes the lines, of medians and quartiles only; plotly draws them in the browser.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from suite.report.figures.convergence import CLOCKS, counted_groups, gap_bands, grid_over
from suite.report.figures.runtime import CLOCKS as ECDF_CLOCKS
from suite.report.figures.runtime import TARGETS
from suite.report.figures.style import LEAST_GAP, gap_scale, gap_text, plain_number
from suite.report.html.appearance import PLANNERS_AT_MOST, Appearance, appearance
from suite.report.html.scenes import SCENES_AT_MOST
from suite.report.statistics.anytime import Steps, first_within, only
from suite.report.statistics.clock import WALL, by_the_clock
from suite.report.statistics.inference import Array

HIGHEST = 1e6
"""Per cent: stands for no path, above every chart."""

DIGITS = 4
POINTS = 120
"""Places on the horizontal axis of shares."""

LINES_AT_MOST = 480
"""Scenes times planners of a chart: the page must stay small enough to be sent."""

ALL_SCENES = "all scenes"
INK, RULES = "#1b1f24", "#d8dee4"


@dataclass(frozen=True, slots=True, eq=False)
class Chart:
    """A chart that shows one scene on one clock at a time, for some planners.

    scenes, clocks, planners : what there is to choose from; clocks from name to label.
    lines : plotly's traces as plain data, with the ``scene``, ``clock`` and ``planner`` of each.
    layouts : plotly's layout for each clock.
    left_out : number of scenes that the page has no room for.
    """

    scenes: list[str]
    clocks: dict[str, str]
    planners: list[str]
    lines: list[dict[str, Any]]
    layouts: dict[str, Any]
    left_out: int

    @property
    def data(self) -> dict[str, Any]:
        """What the browser needs."""
        return {"lines": self.lines, "layouts": self.layouts}


def convergence_chart(steps: Steps, planners: dict[str, int]) -> Chart | None:
    """Median gap and its quartiles over time, generations and checks; None without any path.

    Parameters
    ----------
    steps : Steps
    planners : mapping from name to number
    """
    scenes, few, left_out = _shown(steps, planners)
    wanted = steps.runs["place"].isin(scenes) & steps.runs["variant"].isin(few)
    drawn = only(steps, wanted.to_numpy(dtype=bool))
    lines: list[dict[str, Any]] = []
    layouts = {}
    for clock, (_, label, unit, shift) in CLOCKS.items():
        groups = counted_groups(drawn, clock)
        shown = drawn.clocks[clock][drawn.optimum[drawn.run] > 0.0] + shift
        if not groups or not (np.isfinite(shown) & (shown > 0.0)).any():
            continue
        grid = grid_over(shown)
        bands = gap_bands(drawn, clock, grid - shift, groups)
        for (scene, planner), band in bands.items():
            look = appearance(planners[planner])
            lines += [
                {"scene": scene, "clock": clock, "planner": planner, "trace": trace}
                for trace in _band_traces(planner, look, grid * unit, 100.0 * band)
            ]
        layouts[clock] = _gap_layout(label, grid * unit, bands.values())
    labels = {clock: label for clock, (_, label, *_) in CLOCKS.items()}
    return _chart(lines, layouts, labels, planners, left_out)


def ecdf_chart(steps: Steps, planners: dict[str, int]) -> Chart | None:
    """Share of runs and targets that are reached, over time and checks; None without any path.

    Parameters
    ----------
    steps : Steps
    planners : mapping from name to number
    """
    scenes, few, left_out = _shown(steps, planners)
    groups = _columns(steps, scenes, few)
    lines: list[dict[str, Any]] = []
    layouts = {}
    for clock, (label, unit) in ECDF_CLOCKS.items():
        reached = unit * np.array([first_within(steps, clock, target) for target in TARGETS])
        finite = reached[np.isfinite(reached) & (reached > 0.0)]
        if not len(finite):
            continue
        grid = np.geomspace(0.8 * finite.min(), max(1.25 * finite.max(), 10 * finite.min()), POINTS)
        timed = by_the_clock(steps.runs) if clock == WALL else np.ones(len(steps.runs), bool)
        for (scene, planner), columns in groups.items():
            mine = reached[:, columns[timed[columns]]]
            trace = _ecdf_trace(planner, appearance(planners[planner]), grid, mine)
            if trace is not None:
                lines.append({"scene": scene, "clock": clock, "planner": planner, "trace": trace})
        layouts[clock] = _share_layout(label, grid)
    labels = {clock: label for clock, (label, _) in ECDF_CLOCKS.items()}
    return _chart(lines, layouts, labels, planners, left_out)


def _chart(
    lines: list[dict[str, Any]],
    layouts: dict[str, Any],
    labels: dict[str, str],
    planners: dict[str, int],
    left_out: int,
) -> Chart | None:
    if not lines:
        return None
    drawn = {line["planner"] for line in lines}
    return Chart(
        list(dict.fromkeys(line["scene"] for line in lines)),
        {clock: labels[clock] for clock in layouts},
        [planner for planner in planners if planner in drawn],
        lines,
        layouts,
        left_out,
    )


def _shown(steps: Steps, planners: dict[str, int]) -> tuple[list[str], list[str], int]:
    """Scenes and planners to choose from, and the number of scenes that there is no room for."""
    few = [name for name, number in planners.items() if number < PLANNERS_AT_MOST]
    scenes = list(steps.runs.loc[~np.isnan(steps.optimum), "place"].drop_duplicates())
    room = min(SCENES_AT_MOST, LINES_AT_MOST // max(len(few), 1))
    return scenes[:room], few, max(len(scenes) - room, 0)


def _columns(
    steps: Steps, scenes: list[str], planners: list[str]
) -> dict[tuple[str, str], NDArray[np.int64]]:
    """Numbers of the runs of each planner, in all scenes with an optimum and in each shown one."""
    known = steps.runs[~np.isnan(steps.optimum) & steps.runs["variant"].isin(planners)]
    found = {
        (ALL_SCENES, str(name)): group.index.to_numpy()
        for name, group in known.groupby("variant", sort=False)
    }
    if known["place"].nunique() < 2:
        return found
    groups = known[known["place"].isin(scenes)].groupby(["place", "variant"], sort=False)
    return found | {(str(s), str(v)): group.index.to_numpy() for (s, v), group in groups}


def _band_traces(planner: str, look: Appearance, x: Array, band: Array) -> list[dict[str, Any]]:
    """Quartiles and median of one planner, from where half of its runs have a path."""
    low, middle, high = np.clip(band, LEAST_GAP, HIGHEST)
    began = np.isfinite(band[0])
    if not began.any():
        return []
    kept = began & _corners(low, middle, high)
    places = _rounded(x[kept])
    has_path = np.isfinite(band[1])
    return [
        _edge(look) | {"x": places, "y": _rounded(low[kept])},
        _edge(look, fill="tonexty") | {"x": places, "y": _rounded(high[kept])},
        _line(planner, look, x[has_path], middle[has_path], band[1][has_path]),
    ]


def _ecdf_trace(
    planner: str, look: Appearance, grid: Array, reached: Array
) -> dict[str, Any] | None:
    """Share of a planner's runs and targets that is reached; None if it did not count."""
    mine = np.sort(reached[~np.isnan(reached)])
    if not len(mine):
        return None
    share = 100.0 * np.searchsorted(mine, grid, side="right") / len(mine)
    return _line(planner, look, grid, share, share)


def _line(planner: str, look: Appearance, x: Array, y: Array, told: Array) -> dict[str, Any]:
    """A line at y, of which a reader who points at it is told the true numbers."""
    # With every place on the axis, not the steps alone: numbers are shown where there is a point.
    numbers = {"x": _rounded(x), "y": _rounded(y), "customdata": _rounded(told)}
    return _style(planner, look) | numbers


@cache
def _style(planner: str, look: Appearance) -> dict[str, Any]:
    # Without its numbers: plotly would look at each of them several times, and copy all.
    trace = go.Scatter(
        name=planner,
        mode="lines",
        line={"color": look.colour, "dash": look.dash, "width": 2, "shape": "hv"},
        hovertemplate="%{customdata:.3~g} %",
    )
    return dict(trace.to_plotly_json())


@cache
def _edge(look: Appearance, fill: str = "none") -> dict[str, Any]:
    trace = go.Scatter(
        mode="lines",
        line={"width": 0, "shape": "hv", "color": look.colour},
        fill=fill,
        fillcolor=_see_through(look.colour),
        hoverinfo="skip",
    )
    return dict(trace.to_plotly_json())


def _gap_layout(label: str, x: Array, bands: Iterable[Array]) -> dict[str, Any]:
    medians = 100.0 * np.array([band[1] for band in bands])
    return _layout(label, x, gap_axis(*gap_scale(medians)))


def gap_axis(ends: tuple[float, float], ticks: list[float]) -> dict[str, Any]:
    """A logarithmic axis of gaps, per cent; see :func:`suite.report.figures.style.gap_scale`."""
    return {
        "title": {"text": "gap to the optimum (%)"},
        "type": "log",
        "range": np.log10(ends).tolist(),
        "tickvals": ticks,
        "ticktext": [gap_text(tick) for tick in ticks],
    }


def _share_layout(label: str, x: Array) -> dict[str, Any]:
    return _layout(label, x, {"title": {"text": "runs and targets reached (%)"}, "range": [0, 102]})


def _layout(label: str, x: Array, y_axis: dict[str, Any]) -> dict[str, Any]:
    ends = [float(np.log10(x[0])), float(np.log10(x[-1]))]
    decades = 10.0 ** np.arange(np.ceil(ends[0]), np.floor(ends[1]) + 1)
    x_axis = {
        "title": {"text": label},
        "type": "log",
        "range": ends,
        "tickvals": decades.tolist(),
        "ticktext": [plain_number(decade) for decade in decades],
        "unifiedhovertitle": {"text": f"{label}: %{{x:.3~g}}"},
    }
    return plain_layout(x_axis, y_axis, "x unified")


def plain_layout(x_axis: dict[str, Any], y_axis: dict[str, Any], hover: str) -> dict[str, Any]:
    """How all charts of the page look, around two axes."""
    rules = {"gridcolor": RULES, "linecolor": INK, "zeroline": False, "automargin": True}
    layout = go.Layout(
        xaxis={**x_axis, **rules},
        yaxis={**y_axis, **rules},
        showlegend=False,
        hovermode=hover,
        dragmode=False,
        margin={"l": 56, "r": 12, "t": 12, "b": 48},
        font={"family": "system-ui, sans-serif", "size": 13, "color": INK},
        paper_bgcolor="white",
        plot_bgcolor="white",
        height=420,
    )
    return dict(layout.to_plotly_json())


def _corners(*rows: Array) -> NDArray[np.bool_]:
    """Where any of some step functions has a step, and the end: all that a line of steps needs."""
    changes = np.any([np.diff(row) != 0.0 for row in rows], axis=0)
    kept = np.concatenate([[True], changes])
    kept[-1] = True
    return kept


def _rounded(values: Array) -> list[float]:
    return list(map(short, values.tolist()))


def short(value: float) -> float:
    """A number with as many digits as a chart shows."""
    return float(f"{value:.{DIGITS}g}")


def _see_through(colour: str) -> str:
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return f"rgba({red},{green},{blue},0.14)"
