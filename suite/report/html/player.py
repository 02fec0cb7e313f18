"""What the player steps through: the populations of some runs, generation by generation."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from suite.planner import Snapshot
from suite.report.html.drawing import Drawing
from suite.report.html.evidence import Evidence
from suite.report.html.scenes import ScenePicture
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
    optimum : metres; None if not known.
    frames : for each generation what the browser shows: number ``g``, outlines ``d`` of the
        population and ``best`` of the best path so far, ``cost`` of it (metres), the population's
        size ``n``, mean cost ``mean`` (metres, penalties included) and ``share`` of feasible paths.
    """

    label: str
    scene: int
    view_box: str
    optimum: float | None
    frames: list[dict[str, Any]]

    @property
    def data(self) -> dict[str, Any]:
        """What the browser needs."""
        return {
            "label": self.label,
            "scene": self.scene,
            "viewBox": self.view_box,
            "optimum": self.optimum,
            "frames": self.frames,
        }

    @property
    def size(self) -> int:
        """Characters of the outlines, nearly all of what the run takes in the page."""
        return sum(len(frame["d"]) + len(frame["best"]) for frame in self.frames)


def played_runs(evidence: Evidence, pictures: list[ScenePicture]) -> tuple[list[PlayedRun], int]:
    """The runs of which the store has populations, and how many of them the page has no room for.

    Parameters
    ----------
    evidence : Evidence
    pictures : list of ScenePicture
        A run is played on the drawing of its scene.
    """
    drawn = {picture.name: picture for picture in pictures if picture.drawing is not None}
    runs = evidence.steps.runs
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


def _played(row: dict[Any, Any], picture: ScenePicture, evidence: Evidence) -> PlayedRun:
    key = str(row["key"])
    trace = read_trace(evidence.store, key)
    measures = trace.set_index("generation") if "generation" in trace else pd.DataFrame()
    drawing = picture.drawing
    assert drawing is not None
    return PlayedRun(
        f"{row['variant']} on {row['place']}, seed {row['seed']}",
        picture.number,
        drawing.view_box,
        picture.optimum,
        [_frame(shown, drawing, measures) for shown in evidence.snapshots[key]],
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
