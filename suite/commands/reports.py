"""Commands about what is in a store: tables, compare, export, results, report.

Floors above the planner interface are imported inside the commands: pandas and matplotlib take
longer to import than ``list`` takes to answer.
"""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from suite.commands.options import StoreArgument
from suite.commands.output import say
from suite.report.kinds import FigureFormat, Part, TableFormat

ReferenceOption = Annotated[
    str | None,
    typer.Option(
        metavar="PLANNER",
        help="Compare the others with this one; default: kbga, or else the first.",
    ),
]


class ExportFormat(StrEnum):
    """Files that rows can be exported to."""

    PARQUET = "parquet"
    CSV = "csv"
    OMPL_LOG = "ompl-log"
    PLANNER_ARENA = "planner-arena"
    SCENES = "scenes"


def tables(
    store: StoreArgument,
    style: Annotated[TableFormat, typer.Option("--format", help="How to print them.")] = (
        TableFormat.TABLE
    ),
    output: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write a file for each table instead.")
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Only this table; repeatable.")
    ] = None,
    reference: ReferenceOption = None,
) -> None:
    """Print the tables of a store: a summary, comparisons, and the paper's figures beside ours.

    Tables of the rows behind another table come as CSV, and otherwise only if --only asks for them;
    a last line names them. LaTeX needs the packages booktabs, graphicx and longtable.

    Example: kbga-bench tables out/paper.db --format markdown

    Example: kbga-bench tables out/paper.db --only summary --only ranking
    """
    from suite.report.all_tables import read_tables
    from suite.report.formats import render
    from suite.report.results_folder import write_tables
    from suite.report.table import named

    found = named(read_tables(store, reference), only or [])
    hides = style is not TableFormat.CSV and not only
    hidden = [table.name for table in found if table.detail and hides]
    shown = [table for table in found if table.name not in hidden]
    if output is not None:
        for path in write_tables(shown, output, style):
            say(path)
    else:
        say("\n".join(render(table, style) for table in shown), nl=False)
    if hidden:
        text = f"Left out, but with --only or --format csv: {', '.join(hidden)}."
        say(f"\n{text}", err=output is not None or style is not TableFormat.TABLE)


def compare(
    old: Annotated[Path, typer.Argument(metavar="OLD", help="Result store of before.")],
    new: Annotated[Path, typer.Argument(metavar="NEW", help="Result store of after.")],
    times: Annotated[
        bool, typer.Option("--times", help="Let times decide too: of one quiet machine.")
    ] = False,
    style: Annotated[TableFormat, typer.Option("--format", help="How to print it.")] = (
        TableFormat.TABLE
    ),
) -> None:
    """Compare two stores of the same matrix: what is shown to be better, and what worse.

    Exit code 1 if something is shown to be worse, 0 otherwise. A difference that so few runs can't
    show is called "not shown", and the last line says how many runs would do.

    Example: kbga-bench compare before.db after.db
    """
    import numpy as np

    from suite.report.formats import render
    from suite.report.tables.versions import BOOTSTRAP_SEED, compare_versions
    from suite.store.read import read_runs

    rng = np.random.default_rng(BOOTSTRAP_SEED)
    found = compare_versions(read_runs(old), read_runs(new), rng, with_times=times)
    say(render(found.table, style), nl=False)
    say(f"\n{found.summary()}", err=style is not TableFormat.TABLE)
    raise typer.Exit(1 if found.worse else 0)


def export(
    store: StoreArgument,
    target: Annotated[
        Path, typer.Argument(metavar="DIR|FILE", help="Folder, or file of planner-arena.")
    ],
    to: Annotated[ExportFormat, typer.Option(help="Kind of files.")] = ExportFormat.PARQUET,
) -> None:
    """Export the rows of a store, or its scenes.

    parquet, csv: runs, events, traces, paths, a file each. ompl-log: a log of OMPL's benchmarks for
    each query. planner-arena: the database that Planner Arena reads, made of these logs. scenes: a
    scene file of each scene, as its rows ran on it.

    Example: kbga-bench export out/paper.db rows --to csv
    """
    if to in (ExportFormat.PARQUET, ExportFormat.CSV):
        from suite.report.export.files import export_rows

        files = export_rows(store, target, to.value)
    elif to is ExportFormat.SCENES:
        from suite.report.export.scenes import write_scenes

        files = write_scenes(store, target)
    else:
        from suite.report.export.ompl_log import write_ompl_logs, write_planner_arena

        is_log = to is ExportFormat.OMPL_LOG
        files = write_ompl_logs(store, target) if is_log else [write_planner_arena(store, target)]
    for path in files:
        say(path)


def results(
    store: StoreArgument,
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Where to; made if missing.")],
    leave_out: Annotated[
        list[Part] | None,
        typer.Option(help="Rows, or pictures of these kinds, that are not written; repeatable."),
    ] = None,
    figures: Annotated[
        FigureFormat, typer.Option(help="Kind of the figures; pdf and svg are vectors.")
    ] = FigureFormat.PNG,
) -> None:
    """Make a results folder: tables, rows, figures of scenes and studies, and the manifest.

    Example: kbga-bench results out/paper.db results/paper-static --leave-out traces
    """
    from suite.report.results_folder import write_results

    for path in write_results(store, directory, leave_out=set(leave_out or ()), figures=figures):
        say(path)


def report(
    store: StoreArgument,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Page to write: .html.")
    ] = Path("report.html"),
    reference: ReferenceOption = None,
) -> None:
    """Write a report: one page with tables, charts and pictures that opens without a network.

    Example: kbga-bench report out/paper.db -o report.html
    """
    from suite.report.html.page import write_report

    write_report(store, output, reference=reference)
    say(output)
