"""Pictures of the scenes with the best path of each planner."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from suite.errors import KbgaBenchError
from suite.report.html.appearance import PLANNERS_AT_MOST, Appearance, appearance
from suite.report.html.drawing import Drawing, Place, draw
from suite.report.html.evidence import Evidence
from suite.report.rows import cheapest, feasible, is_of_map

SCENES_AT_MOST = 40
"""A page of more is not looked at."""

WIDEST, THINNEST = 15.0, 4.0
"""Of the first planner's line and of the last one's, which lies above all others."""


@dataclass(frozen=True, slots=True, eq=False)
class BestPath:
    """The cheapest path of a planner in a scene.

    look, width : of its line; the width also multiplies the dashes.
    d : the line; None without a path.
    cost, gap : metres and a share; None if not known, or not finite.
    solved, runs : how many runs found a path, of how many.
    """

    planner: str
    look: Appearance
    width: float
    d: str | None
    cost: float | None
    gap: float | None
    solved: int
    runs: int

    @property
    def dasharray(self) -> str:
        """Dashes in proportion to the width."""
        return " ".join(
            f"{float(part) * self.width / 3:.0f}" for part in self.look.dasharray.split()
        )


@dataclass(frozen=True, slots=True, eq=False)
class ScenePicture:
    """A scene of the page.

    number : names its drawing in the page.
    drawing : None if the scene can't be drawn; then ``reason`` says why.
    ends : where start and goal are in the drawing.
    optimum : metres; None if there is none.
    paths : of each planner that ran there.
    """

    number: int
    name: str
    drawing: Drawing | None
    reason: str
    ends: tuple[Place, ...]
    optimum: float | None
    paths: Sequence[BestPath]

    @property
    def alt(self) -> str:
        """What the picture shows, in words."""
        found = [
            f"{path.planner} {path.cost:.2f} m" for path in self.paths if path.cost is not None
        ]
        shown = f"Best paths: {', '.join(found)}." if found else "No planner found a path."
        return f"Map of the scene {self.name}. {shown}"


def scene_pictures(evidence: Evidence) -> tuple[list[ScenePicture], int]:
    """The scenes but the maps, and how many more there are than a page should have.

    Parameters
    ----------
    evidence : Evidence
    """
    # Those of the newest rows: a scene that changed since its rows were made is not drawn.
    runs = evidence.steps.runs
    groups = list(runs[~is_of_map(runs)].groupby("place", sort=False))
    shown = [
        _picture(number, str(name), group, evidence)
        for number, (name, group) in enumerate(groups[:SCENES_AT_MOST])
    ]
    return shown, max(len(groups) - SCENES_AT_MOST, 0)


def _picture(number: int, name: str, runs: pd.DataFrame, evidence: Evidence) -> ScenePicture:
    optimum = runs["optimum"].max()
    drawing, ends, reason = _drawing(runs.iloc[0], evidence)
    return ScenePicture(
        number,
        name,
        drawing,
        reason,
        ends,
        None if pd.isna(optimum) else float(optimum),
        best_paths(runs, drawing, evidence),
    )


def _drawing(
    row: "pd.Series[Any]", evidence: Evidence
) -> tuple[Drawing | None, tuple[Place, ...], str]:
    try:
        scene, query = evidence.scenes.of(row.to_dict())
    except KbgaBenchError as error:
        return None, (), f"It can't be drawn: {error}"
    drawing = draw(scene)
    return drawing, drawing.ends(query), ""


def best_paths(
    runs: pd.DataFrame, drawing: Drawing | None, evidence: Evidence, widest: float = WIDEST
) -> list[BestPath]:
    """The cheapest path of each planner in the runs of one query."""
    groups = list(runs.groupby("variant", sort=False))[:PLANNERS_AT_MOST]
    widths = np.linspace(widest, THINNEST, max(len(groups), 2)).round(1)
    found = []
    for width, (planner, group) in zip(widths, groups, strict=False):
        best = cheapest(group)
        path = None if best is None else evidence.paths.get(best["key"])
        found.append(
            BestPath(
                str(planner),
                appearance(evidence.planners[str(planner)]),
                float(width),
                None if path is None or drawing is None else drawing.outline(path),
                None if best is None else float(best["cost"]),
                None if best is None or not np.isfinite(best["gap"]) else float(best["gap"]),
                len(feasible(group)),
                len(group),
            )
        )
    return found
