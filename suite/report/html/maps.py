"""Panels of maps, scenes of many queries: the map with its hardest queries, and all as a scatter.

Python computes the marks; plotly draws them in the browser, for the planners that are chosen there.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
import plotly.graph_objects as go

from suite.errors import KbgaBenchError
from suite.report.figures.maps import seen_bounds
from suite.report.figures.style import LEAST_GAP, gap_scale, plain_number
from suite.report.html.appearance import PLANNERS_AT_MOST, Appearance, appearance
from suite.report.html.cells import Sheet, sheet
from suite.report.html.charts import gap_axis, plain_layout, short
from suite.report.html.drawing import Drawing, Place, draw
from suite.report.html.evidence import Evidence
from suite.report.html.scenes import BestPath, best_paths
from suite.report.statistics.inference import Array
from suite.report.statistics.over_queries import HARDEST_RULE, hardest, only_maps, query_measures
from suite.report.table import Table
from suite.report.words import fixed, query_label

MAPS_AT_MOST = 24
"""A page of more is not looked at."""

MARKS_AT_MOST = 12_000
"""Of a scatter: a browser takes seconds to draw more."""

MANY = 300
"""Marks of a planner from which they are drawn smaller."""

ABOVE = 4.0
"""How far the axis goes on above the largest gap, for the queries without path."""

LOGARITHMIC_FROM = 20.0
"""Of the longest query over the shortest, from which the axis of lengths is logarithmic."""

HARDEST_NOTE = f"The hardest: {HARDEST_RULE}. Gaps (%) are means over the seeds."
TABLE_NOTE = "What the columns say stands below the table of all maps, among the tables."


@dataclass(frozen=True, slots=True, eq=False)
class HardQuery:
    """One of the hardest queries of a map.

    number : from 1, written beside its start and in the table.
    ends : where start and goal are in the drawing.
    paths : the best of each planner.
    """

    number: int
    label: str
    ends: tuple[Place, Place]
    paths: Sequence[BestPath]


@dataclass(frozen=True, slots=True, eq=False)
class MapPanel:
    """A map of the page.

    number : names its drawing in the page.
    drawing : None if the scene can't be drawn; then ``reason`` says why.
    queries : number of those that were asked.
    hard : the hardest queries; none without a drawing.
    table, hardest : what the planners did over all queries, and on the hardest.
    looks : of the planners that ran here.
    scatter : what the browser needs to draw the marks; None without any optimum.
    left_out : number of queries without a mark, for there is no room.
    """

    number: int
    name: str
    drawing: Drawing | None
    reason: str
    queries: int
    hard: Sequence[HardQuery]
    table: Sheet | None
    hardest: Sheet
    looks: dict[str, Appearance]
    scatter: dict[str, Any] | None
    left_out: int

    @property
    def alt(self) -> str:
        """What the map shows, in words."""
        return (
            f"Map of {self.name} with {len(self.hard)} of its {self.queries} queries, the hardest, "
            "and the best paths of the planners. The table of the hardest queries says the same."
        )


def map_panels(evidence: Evidence, number: int) -> tuple[list[MapPanel], int]:
    """The maps, and how many more there are than a page should have.

    Parameters
    ----------
    evidence : Evidence
    number : int
        Of the first one's drawing.
    """
    steps = only_maps(evidence.steps)
    if steps.runs.empty:
        return [], 0
    groups = list(query_measures(steps).groupby("place", sort=False))
    runs = dict(list(steps.runs.groupby("place", sort=False)))
    panels = [
        _panel(number + i, str(place), measures, runs[place], evidence)
        for i, (place, measures) in enumerate(groups[:MAPS_AT_MOST])
    ]
    return panels, len(groups) - len(panels)


def _panel(
    number: int, name: str, measures: pd.DataFrame, runs: pd.DataFrame, evidence: Evidence
) -> MapPanel:
    shown = hardest(measures)
    planners = [
        planner
        for planner in dict.fromkeys(measures["variant"])
        if evidence.planners[planner] < PLANNERS_AT_MOST
    ]
    looks = {planner: appearance(evidence.planners[planner]) for planner in planners}
    drawing, hard, reason = _drawn(runs, shown, evidence)
    marks, left_out = _marks(measures, looks, shown)
    return MapPanel(
        number,
        name,
        drawing,
        reason,
        measures["query"].nunique(),
        hard,
        _table(number, name, evidence),
        sheet(Table(f"hardest-{number}", f"The hardest queries of {name}",
                    _hardest_frame(measures, shown, planners), HARDEST_NOTE)),
        looks,
        marks,
        left_out,
    )  # fmt: skip


def _drawn(
    runs: pd.DataFrame, shown: list[str], evidence: Evidence
) -> tuple[Drawing | None, list[HardQuery], str]:
    try:
        scene, first = evidence.scenes.of(runs.iloc[0].to_dict())
        here = {name: runs[runs["query"] == name] for name in shown}
        found = {name: evidence.scenes.of(rows.iloc[0].to_dict()) for name, rows in here.items()}
    except KbgaBenchError as error:
        return None, [], f"It can't be drawn: {error}"
    asked = {name: query for name, (its, query) in found.items() if its.hash == scene.hash}
    drawing = draw(scene, seen_bounds(scene, list(asked.values()) or [first]))
    hard = [
        HardQuery(
            shown.index(name) + 1,
            query_label(name),
            drawing.ends(query),
            best_paths(here[name], drawing, evidence, widest=10.0),
        )
        for name, query in asked.items()
    ]
    return drawing, hard, ""


def _table(number: int, name: str, evidence: Evidence) -> Sheet | None:
    """The rows of this map of the table of all maps."""
    for table in evidence.tables:
        if table.name == "maps":
            frame = table.frame[table.frame["scene"] == name].drop(columns="scene")
            title = f"Planners on {name}, over its queries"
            return sheet(
                replace(table, name=f"map-{number}", title=title, frame=frame, note=TABLE_NOTE)
            )
    return None


def _hardest_frame(measures: pd.DataFrame, shown: list[str], planners: list[str]) -> pd.DataFrame:
    rows = []
    for i, name in enumerate(shown):
        here = measures[measures["query"] == name]
        cells = {row["variant"]: _gap_cell(row) for row in here.to_dict("records")}
        gaps = {planner: cells.get(planner, "") for planner in planners}
        optimum = float(here["optimum"].max())
        rows.append({"no.": i + 1, "query": query_label(name), "optimum (m)": optimum} | gaps)
    return pd.DataFrame(rows, columns=["no.", "query", "optimum (m)", *planners])


def _gap_cell(row: Mapping[Any, Any]) -> str:
    if not row["found"]:
        return "no path"
    some = f" ({row['found']} of {row['runs']})" if row["found"] < row["runs"] else ""
    return f"{fixed(100.0 * row['gap'])}{some}"


def _marks(
    measures: pd.DataFrame, looks: dict[str, Appearance], shown: list[str]
) -> tuple[dict[str, Any] | None, int]:
    """Gap over length of each query and planner: names and lengths once, gaps for each planner."""
    known = measures[measures["optimum"] > 0.0]
    lengths = known.groupby("query", sort=False)["optimum"].max().sort_values()
    if lengths.empty:
        return None, 0
    every = -(-len(lengths) * len(looks) // MARKS_AT_MOST)
    kept = lengths.iloc[::every] if every > 1 else lengths
    kept = lengths[lengths.index.isin([*kept.index, *shown])]
    gap = 100.0 * known.pivot(index="query", columns="variant", values="gap")  # noqa: PD010
    asked = known.pivot(index="query", columns="variant", values="runs")  # noqa: PD010
    gap, asked = gap.loc[kept.index], asked.loc[kept.index]
    (low, edge), ticks = gap_scale(gap.to_numpy())
    numbers = {name: i + 1 for i, name in enumerate(shown)}
    data = {
        "lengths": [short(length) for length in kept.tolist()],
        "names": [query_label(str(name)) for name in kept.index],
        "hard": [numbers.get(str(name), 0) for name in kept.index],
        "planners": [
            {
                "trace": _mark_style(planner, look, len(kept)),
                # False: was not asked; None: found no path.
                "gaps": [
                    (short(g) if np.isfinite(g) else None) if there else False
                    for g, there in zip(gap[planner], asked[planner].notna(), strict=True)
                ],
            }
            for planner, look in looks.items()
            if planner in gap
        ],
        "least": LEAST_GAP,
        "noPath": edge * ABOVE**0.5,
        "layout": _layout(kept.to_numpy(), (low, edge * ABOVE), ticks),
    }
    return data, len(lengths) - len(kept)


def _mark_style(planner: str, look: Appearance, marks: int) -> dict[str, Any]:
    size = 7 if marks < MANY else 4
    marker = {"color": look.colour, "symbol": look.symbol, "size": size, "opacity": 0.65}
    trace = go.Scatter(name=planner, mode="markers", marker=marker)
    hover = {"hovertemplate": "%{text}<br>%{x} m, %{customdata}"}
    return dict(trace.to_plotly_json()) | hover


def _layout(lengths: Array, ends: tuple[float, float], ticks: list[float]) -> dict[str, Any]:
    low, high = float(lengths[0]), float(lengths[-1])
    x_axis: dict[str, Any] = {"title": {"text": "length of the shortest path (m)"}}
    if high > LOGARITHMIC_FROM * low:
        decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)))
        places = np.outer(decades, (1.0, 2.0, 5.0)).ravel()
        x_axis |= {
            "type": "log",
            "tickvals": places.tolist(),
            "ticktext": [plain_number(place) for place in places],
        }
    y_axis = gap_axis(ends, ticks)
    y_axis["tickvals"] = [*ticks, ends[1] * ABOVE**-0.5]
    y_axis["ticktext"] = [*y_axis["ticktext"], "no path"]
    layout = plain_layout(x_axis, y_axis, "closest")
    # The numbers of the hardest stand above.
    return layout | {"margin": layout["margin"] | {"t": 28}}
