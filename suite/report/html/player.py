"""What the player steps through: the populations of some runs, generation by generation."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from suite.planner import Snapshot
from suite.report.html.drawing import Drawing, Place
from suite.report.html.evidence import Evidence
from suite.report.html.maps import MapPanel
from suite.report.html.scenes import ScenePicture
from suite.report.rows import is_of_map
from suite.report.words import query_label
from suite.scenes.scene import Query
from suite.store.read import read_trace

RUNS_AT_MOST = 40
CHARACTERS_AT_MOST = 3_000_000
"""Of all runs together: the page must stay small enough to be sent."""


@dataclass(frozen=True, slots=True, eq=False)
class PlayedRun:
    """A run that can be played.

    label : for the list to choose from.
    scene : number of the drawing below it.
    view_box : of that drawing.
    ends : where start and goal are in it.
    optimum : metres; None if not known.
    frames : for each generation what the browser shows: number ``g``, outlines ``d`` of the
        population and ``best`` of the best path so far, ``cost`` of it (metres), the population's
        size ``n``, mean cost ``mean`` (metres, penalties included) and ``share`` of feasible paths.
    """

    label: str
    scene: int
    view_box: str
    ends: tuple[Place, Place]
    optimum: float | None
    frames: list[dict[str, Any]]

    @property
    def data(self) -> dict[str, Any]:
        """What the browser needs."""
        return {
            "label": self.label,
            "scene": self.scene,
            "viewBox": self.view_box,
            "ends": self.ends,
            "optimum": self.optimum,
            "frames": self.frames,
        }

    @property
    def size(self) -> int:
        """Characters of the outlines, nearly all of what the run takes in the page."""
        return sum(len(frame["d"]) + len(frame["best"]) for frame in self.frames)


def played_runs(
    evidence: Evidence, pictures: Sequence[ScenePicture | MapPanel]
) -> tuple[list[PlayedRun], int]:
    """The runs of which the store has populations, and how many of them the page has no room for.

    Parameters
    ----------
    evidence : Evidence
    pictures : sequence of ScenePicture or MapPanel
        A run is played on the drawing of its scene.
    """
    drawn = {picture.name: picture for picture in pictures if picture.drawing is not None}
    runs = evidence.steps.runs.assign(
        length=evidence.steps.optimum, on_map=is_of_map(evidence.steps.runs)
    )
    wanted = runs[runs["key"].isin(list(evidence.snapshots)) & runs["place"].isin(list(drawn))]
    by_planner = wanted["variant"].map(evidence.planners)
    found: list[PlayedRun] = []
    room = CHARACTERS_AT_MOST
    for row in wanted.loc[by_planner.sort_values(kind="stable").index].to_dict("records"):
        run = _played(row, drawn[str(row["place"])], evidence)
        room -= run.size
        if room < 0 or len(found) == RUNS_AT_MOST:
            break
        found.append(run)
    return found, len(wanted) - len(found)


def _played(row: dict[Any, Any], picture: ScenePicture | MapPanel, evidence: Evidence) -> PlayedRun:
    key = str(row["key"])
    trace = read_trace(evidence.store, key)
    measures = trace.set_index("generation") if "generation" in trace else pd.DataFrame()
    drawing, snapshots = picture.drawing, evidence.snapshots[key]
    assert drawing is not None
    query = f", {query_label(row['query'])}" if row["on_map"] else ""
    # All paths of a run go from its start to its goal.
    path = snapshots[0].paths[0]
    return PlayedRun(
        f"{row['variant']} on {row['place']}{query}, seed {row['seed']}",
        picture.number,
        drawing.view_box,
        drawing.ends(Query(row["query"], path[0], path[-1])),
        None if np.isnan(row["length"]) else float(row["length"]),
        [_frame(shown, drawing, measures) for shown in snapshots],
    )


def _frame(snapshot: Snapshot, drawing: Drawing, measures: pd.DataFrame) -> dict[str, Any]:
    best = snapshot.best
    frame: dict[str, Any] = {
        "g": snapshot.generation,
        # Equal paths lie on each other.
        "d": "".join(dict.fromkeys(map(drawing.outline, snapshot.paths))),
        "best": "" if best is None else drawing.outline(best),
        "cost": None if best is None else round(float(np.hypot(*np.diff(best, axis=0).T).sum()), 3),
        "n": len(snapshot.paths),
    }
    for name, column in (("mean", "mean"), ("share", "feasible_share")):
        if column in measures and snapshot.generation in measures.index:
            frame[name] = round(float(measures[column][snapshot.generation]), 3)
    return frame
