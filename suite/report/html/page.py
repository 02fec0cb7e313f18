"""The report as one file: everything that it shows is in it, and nothing is fetched.

The same store gives the same bytes: no time, no random name, nothing of the machine that made it.
"""

import base64
import gzip
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from suite.errors import check_file, writing
from suite.report.html.appearance import appearance
from suite.report.html.cells import sheet
from suite.report.html.charts import convergence_chart, ecdf_chart
from suite.report.html.drives import drive_sheets
from suite.report.html.evidence import Evidence, read_evidence
from suite.report.html.failures import failures_table, full_reasons
from suite.report.html.maps import map_panels
from suite.report.html.missing import missing_table
from suite.report.html.overview import headline, overview_sheets
from suite.report.html.player import played_runs
from suite.report.html.provenance import provenance_tables
from suite.report.html.scenes import scene_pictures

SUFFIXES = (".html", ".htm")
SCRIPTS = ("tables.js", "plotly.js", "charts.js", "maps.js", "player.js")


def write_report(store: Path, file: Path, *, reference: str | None = None) -> None:
    """Write the report of a store.

    Parameters
    ----------
    store : Path
        It is only read.
    file : Path
        Replaced if it is there.
    reference : str, optional
        The planner that the statistics compare the others with; default: kbga, or else the first.

    Raises
    ------
    KbgaBenchError
        If the store can't be read, the file can't be written, or no run is of the reference.
    """
    check_file(file, "reports", SUFFIXES)
    page = render_report(read_evidence(store, reference))
    with writing(file):
        file.write_text(page, encoding="utf-8")


def render_report(evidence: Evidence) -> str:
    """The page.

    Parameters
    ----------
    evidence : Evidence
    """
    charts = {
        "convergence": convergence_chart(evidence.steps, evidence.planners),
        "ecdf": ecdf_chart(evidence.steps, evidence.planners),
    }
    pictures, pictures_left_out = scene_pictures(evidence)
    maps, maps_left_out = map_panels(evidence, len(pictures))
    played, played_left_out = played_runs(evidence, [*pictures, *maps])
    drives, drives_left_out = drive_sheets(evidence)
    return (
        _environment()
        .get_template("page.html.j2")
        .render(
            store=evidence.store.name,
            headline=headline(evidence),
            overview=overview_sheets(evidence),
            pictures=pictures,
            pictures_left_out=pictures_left_out,
            maps=maps,
            maps_left_out=maps_left_out,
            charts=charts,
            planned=not evidence.steps.runs.empty or evidence.runs.empty,
            looks={name: appearance(number) for name, number in evidence.planners.items()},
            played=played,
            played_left_out=played_left_out,
            drives=drives,
            drives_left_out=drives_left_out,
            tables=[sheet(table) for table in evidence.tables if table.on_page],
            in_files=[table.name for table in evidence.tables if not table.on_page],
            failures=sheet(failures_table(evidence.runs)),
            reasons=full_reasons(evidence.runs),
            missing=sheet(missing_table(evidence, [*pictures, *maps])),
            provenance=[sheet(table) for table in provenance_tables(evidence)],
            style=Markup(_text("style.css")),
            scripts=[Markup(_text(name)) for name in SCRIPTS],
            plotly=_packed_plotly() if any(charts.values()) or maps else None,
        )
    )


@cache
def _packed_plotly() -> str:
    """Plotly's script, compressed: two thirds of the page would be it."""
    # The time in a gzip file would make another page each time.
    return base64.b64encode(gzip.compress(get_plotlyjs().encode(), mtime=0)).decode()


@cache
def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(_text),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    compact: dict[str, Any] = {"separators": (",", ":"), "allow_nan": False, "ensure_ascii": False}
    environment.policies["json.dumps_kwargs"] = compact
    return environment


def _text(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")
