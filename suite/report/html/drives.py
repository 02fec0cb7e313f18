"""Sheets of snapshots of simulated runs: one for each scene and world."""

import base64
from dataclasses import dataclass

from suite.errors import KbgaBenchError
from suite.report.figures.files import as_png
from suite.report.figures.simulation import plot_snapshots
from suite.report.html.evidence import Evidence
from suite.report.rows import places
from suite.simulation.record import from_data
from suite.store.read import read_simulation

SHEETS_AT_MOST = 24


@dataclass(frozen=True, slots=True)
class DriveSheet:
    """A simulated run as a picture.

    image : data URI of a PNG; empty if it can't be drawn, and then ``reason`` says why.
    """

    title: str
    alt: str
    image: str
    reason: str = ""


def drive_sheets(evidence: Evidence) -> tuple[list[DriveSheet], int]:
    """A sheet of the first simulated run in each world, and how many worlds have none.

    Parameters
    ----------
    evidence : Evidence
    """
    driven = evidence.driven
    first = driven.assign(place=places(driven)).drop_duplicates(["scene_source", "place", "world"])
    shown = first[:SHEETS_AT_MOST].to_dict("records")
    sheets = []
    for row in shown:
        title = f"{row['scene']}, {row['world']}: {row['variant']}, seed {row['seed']}"
        alt = (
            f"Snapshots of a robot that drives through {row['scene']} ({row['world']}), guided by "
            f"{row['variant']}: the run ended as {row['status']}."
        )
        try:
            scene, _ = evidence.scenes.of(row)
            data = read_simulation(evidence.store, row["key"])
        except KbgaBenchError as error:
            sheets.append(DriveSheet(title, alt, "", f"It can't be drawn: {error}"))
            continue
        drawn = as_png(plot_snapshots(from_data(scene, data)))
        sheets.append(DriveSheet(title, alt, _uri(drawn)))
    return sheets, len(first) - len(shown)


def _uri(png: bytes) -> str:
    return f"data:image/png;base64,{base64.b64encode(png).decode()}"
