"""The command ``kbga-bench``: parses, calls, prints.

Floors above the planner interface are imported inside the commands: pandas and matplotlib take
longer to import than ``list`` takes to answer.
"""

import json
import sys
import warnings
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from suite.errors import KbgaBenchError
from suite.quiet import end_quietly

app = typer.Typer(
    name="kbga-bench",
    help="Benchmark suite for 2D robot path planning: KBGA, OMPL's planners, a plain GA and an "
    "exact solver on shared scenes, judged by one referee.",
    epilog="Start with: kbga-bench list scenes; kbga-bench plan zigzag --planner kbga --seed 1",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
    rich_markup_mode="markdown",
)


class What(StrEnum):
    """What can be listed."""

    SCENES = "scenes"
    PLANNERS = "planners"
    MATRICES = "matrices"


class ListFormat(StrEnum):
    """How a list is printed."""

    TABLE = "table"
    JSON = "json"


class Generator(StrEnum):
    """What scenes can be drawn from a seed."""

    SCATTERED = "scattered"
    MOVING = "moving"


class TextFormat(StrEnum):
    """How a single result is printed."""

    TEXT = "text"
    JSON = "json"


class Charge(StrEnum):
    """What simulated time planning takes; see :class:`suite.dynamic.settings.Charge`."""

    MEASURED = "measured"
    ZERO = "zero"


class TableFormat(StrEnum):
    """How tables are printed; see :class:`suite.report.table.Format`."""

    TABLE = "table"
    CSV = "csv"
    MARKDOWN = "markdown"
    LATEX = "latex"


class ExportFormat(StrEnum):
    """Files that rows can be exported to."""

    PARQUET = "parquet"
    CSV = "csv"
    OMPL_LOG = "ompl-log"
    PLANNER_ARENA = "planner-arena"


class Rows(StrEnum):
    """Rows that a results folder can do without, once its tables and figures are made."""

    EVENTS = "events"
    TRACES = "traces"
    PATHS = "paths"


SceneArgument = Annotated[
    str, typer.Argument(metavar="SCENE", help="Name in the catalogue, or path of a scene file.")
]
StoreArgument = Annotated[Path, typer.Argument(metavar="STORE", help="Result store (SQLite).")]
PlannerOption = Annotated[str, typer.Option(help="Name of the planner; see `list planners`.")]
SeedOption = Annotated[int, typer.Option(min=0, help="Of the random stream.")]
QueryOption = Annotated[str | None, typer.Option(help="Name of the query; default: the first.")]
SettingsOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="A setting of the planner; repeatable."),
]
TextStyle = Annotated[TextFormat, typer.Option("--format", help="For people or programs.")]


@app.command("list")
def list_command(
    what: Annotated[What, typer.Argument(help="What to list.")],
    style: Annotated[ListFormat, typer.Option("--format", help="For people or programs.")] = (
        ListFormat.TABLE
    ),
) -> None:
    """List what there is: scenes, planners or matrices.

    Example: kbga-bench list planners --format json
    """
    from suite import listing

    rows = {
        What.SCENES: listing.scenes_listing,
        What.PLANNERS: listing.planners_listing,
        What.MATRICES: listing.matrices_listing,
    }[what]()
    if style is ListFormat.JSON:
        _print_json(rows)
    else:
        _print_rows(rows)


@app.command()
def generate(
    generator: Annotated[Generator, typer.Argument(help="Kind of scene.")],
    output: Annotated[Path, typer.Option(metavar="FILE", help="Scene file: .geojson or .json.")],
    obstacles: Annotated[
        int | None,
        typer.Option(help="Number of scattered obstacles, counted as convex parts."),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Another seed gives another scene.")] = 0,
) -> None:
    """Draw a scene from a seed and write it to a file.

    Without a file, `scattered_300-7` names the same scene wherever a scene is asked for, and
    `moving-7` the one of moving obstacles.

    Example: kbga-bench generate scattered --obstacles 300 --seed 7 --output s300.geojson
    """
    from suite.scene_file import check_scene_file, write_scene
    from suite.scenes.moving import moving
    from suite.scenes.scattered import scattered

    if (obstacles is None) != (generator is Generator.MOVING):
        rule = "Leave it out" if generator is Generator.MOVING else "Give it"
        raise typer.BadParameter(f"{rule} for {generator} scenes.", param_hint="--obstacles")
    check_scene_file(output)
    write_scene(moving(seed) if obstacles is None else scattered(obstacles, seed), output)
    typer.echo(output)


@app.command()
def exact(
    scene: SceneArgument,
    query: QueryOption = None,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Compute the exact shortest path of a scene, or say that there is none.

    Example: kbga-bench exact maze --format json
    """
    from suite.harness.single import exact_as_data, exact_as_text

    found = exact_as_data(scene, query)
    if style is TextFormat.JSON:
        _print_json(found)
    else:
        typer.echo(exact_as_text(found))


@app.command()
def plan(
    scene: SceneArgument,
    planner: PlannerOption,
    seed: SeedOption = 0,
    query: QueryOption = None,
    settings: SettingsOption = None,
    wall_s: Annotated[float | None, typer.Option(help="Budget: seconds of wall time.")] = None,
    generations: Annotated[
        int | None, typer.Option(help="Budget: generations or iterations.")
    ] = None,
    checks: Annotated[int | None, typer.Option(help="Budget: collision checks.")] = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the run: .png, .pdf or .svg.")
    ] = None,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Run one planner once, here and now, and say what came of it.

    Exit code 0 if it found a path or proved that there is none, 1 otherwise.

    Example: kbga-bench plan zigzag --planner kbga --seed 7 --generations 60 --plot zigzag.png
    """
    from suite.harness.cell import run_cell
    from suite.harness.single import as_data, as_text, cell_for, parse_settings, succeeded
    from suite.planner import Budget, Recorder

    cell = cell_for(
        scene,
        planner,
        seed=seed,
        query=query,
        settings=parse_settings(settings or []),
        budget=Budget(wall_s, generations, checks),
    )
    # Of the first population only: more would slow down the run that is timed.
    recorder = Recorder(snapshot_of=lambda generation: plot is not None and generation == 0)
    if plot is None:
        record = run_cell(cell, recorder=recorder)
    else:
        from suite.report.figures import check_figure_file
        from suite.report.run_figure import draw_record

        check_figure_file(plot)
        record = run_cell(cell, recorder=recorder)
        draw_record(record, recorder.snapshots, plot)
    if style is TextFormat.JSON:
        _print_json(as_data(record))
    else:
        typer.echo(as_text(record))
    raise typer.Exit(0 if succeeded(record) else 1)


@app.command()
def simulate(
    scene: SceneArgument,
    planner: PlannerOption,
    seed: SeedOption = 0,
    query: QueryOption = None,
    settings: SettingsOption = None,
    cold: Annotated[
        bool, typer.Option("--cold", help="Plan afresh at every update, whatever the planner can.")
    ] = False,
    speed: Annotated[float | None, typer.Option(help="Of the robot, metres per second.")] = None,
    interval: Annotated[float | None, typer.Option(help="Seconds between updates.")] = None,
    sensing_range: Annotated[
        float | None, typer.Option(help="Metres within which unknown obstacles are detected.")
    ] = None,
    obstacle_speed_factor: Annotated[
        float | None, typer.Option(help="All obstacles move so many times as fast.")
    ] = None,
    time_limit: Annotated[
        float | None, typer.Option(help="Simulated seconds after which the run ends.")
    ] = None,
    charge: Annotated[
        Charge, typer.Option(help="Simulated time that planning takes: its own, or none.")
    ] = Charge.MEASURED,
    wall_s: Annotated[float | None, typer.Option(help="Budget of each plan: seconds.")] = None,
    generations: Annotated[
        int | None, typer.Option(help="Budget of each plan: generations or iterations.")
    ] = None,
    checks: Annotated[
        int | None, typer.Option(help="Budget of each plan: collision checks.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw snapshots: .png, .pdf or .svg.")
    ] = None,
    animate: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it moving: .gif or .mp4.")
    ] = None,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Let a robot find its way through a dynamic scene, planning anew as it goes.

    Exit code 0 if it reached the goal and was never hit, 1 otherwise.

    Example: kbga-bench simulate door --planner kbga --seed 3 --speed 5 --animate door.gif
    """
    from suite.harness.cell import run_cell
    from suite.harness.single import cell_for, parse_settings
    from suite.harness.single_simulation import (
        as_data,
        as_text,
        simulation_of,
        unhurt,
        world_for,
    )
    from suite.planner import Budget

    if plot is not None:
        from suite.report.figures import check_figure_file

        check_figure_file(plot)
    if animate is not None:
        from suite.report.dynamic_figures import check_animation_file

        check_animation_file(animate)
    overrides = {
        "speed": speed,
        "interval": interval,
        "sensing_range": sensing_range,
        "obstacle_speed_factor": obstacle_speed_factor,
        "time_limit": time_limit,
        "charge": charge.value,
    }
    cell = cell_for(
        scene,
        planner,
        seed=seed,
        query=query,
        settings=parse_settings(settings or []),
        budget=Budget(wall_s, generations, checks),
        world=world_for(scene, overrides, cold=cold),
    )
    record = run_cell(cell)
    done = simulation_of(record) if plot is not None or animate is not None else None
    if done is not None and plot is not None:
        from suite.report.dynamic_figures import plot_snapshots
        from suite.report.figures import save

        save(plot_snapshots(done), plot)
    if done is not None and animate is not None:
        from suite.report.dynamic_figures import animate as write_animation

        write_animation(done, animate)
    if style is TextFormat.JSON:
        _print_json(as_data(record))
    else:
        typer.echo(as_text(record))
    raise typer.Exit(0 if unhurt(record) else 1)


@app.command()
def run(
    matrix: Annotated[
        str, typer.Argument(metavar="MATRIX", help="Name in the catalogue, or path of a file.")
    ],
    store: Annotated[Path, typer.Option(metavar="FILE", help="Result store; made if missing.")],
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Runs at a time; default: one per processor.")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Only the first two seeds.")] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Run what is there again too, and replace its rows.")
    ] = False,
    only_failed: Annotated[
        bool, typer.Option("--only-failed", help="Run again only the rows that failed.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Say what would run, and about how long; run nothing.")
    ] = False,
    merge: Annotated[
        list[Path] | None,
        typer.Option(metavar="STORE", help="First take in the rows of another store; repeatable."),
    ] = None,
    snapshots: Annotated[
        int,
        typer.Option(min=0, help="Keep the populations of so many runs, for the report's player."),
    ] = 40,
) -> None:
    """Run what a store still lacks of a matrix, each run in a process of its own.

    It can be stopped at any time and started again: only the runs in flight are lost. At the end
    some runs of planners with a population are done again, outside any clock, to keep it.

    Exit code 0 if all is done, 1 if rows of other stores are in conflict, 130 after Ctrl-C.

    Example: kbga-bench run paper-static --store out/paper.db --jobs 2
    """
    from suite.harness.display import Display
    from suite.harness.matrix import load_matrix
    from suite.harness.run import Which, run_matrix
    from suite.harness.snapshots import keep_snapshots
    from suite.store import open_store

    if force and only_failed:
        raise typer.BadParameter("Give one of --force and --only-failed.", param_hint="--force")
    which = Which.ALL if force else Which.FAILED if only_failed else Which.MISSING
    wanted = load_matrix(matrix)
    if dry_run:
        from suite.harness.forecast import forecast_matrix

        typer.echo(forecast_matrix(wanted, store, jobs=jobs, quick=quick, which=which).as_text())
        return
    with open_store(store) as opened:
        clean = _merge_into(opened, merge or [])
        try:
            with Display(wanted.name) as display:
                end = run_matrix(
                    wanted, opened, jobs=jobs, quick=quick, which=which, on_progress=display
                )
            kept = keep_snapshots(wanted, opened, most=snapshots)
        except KeyboardInterrupt:
            typer.echo(
                "Stopped. All finished runs are kept; to go on, give the same command again.",
                err=True,
            )
            raise typer.Exit(130) from None
    typer.echo(" ".join(filter(None, (end.summary(), kept.summary()))))
    raise typer.Exit(0 if clean else 1)


@app.command()
def merge(
    store: Annotated[Path, typer.Argument(metavar="STORE", help="Result store; made if missing.")],
    sources: Annotated[list[Path], typer.Argument(metavar="FROM...", help="Stores to take in.")],
) -> None:
    """Take the rows of other stores into one, as when several machines ran parts of a matrix.

    A row that is there with another outcome stays, and the other one is kept beside it. Exit code
    0 if there was no such conflict, 1 otherwise.

    Example: kbga-bench merge all.db machine-1.db machine-2.db
    """
    from suite.store import open_store

    with open_store(store) as opened:
        clean = _merge_into(opened, sources)
    raise typer.Exit(0 if clean else 1)


def _merge_into(store: Any, sources: list[Path]) -> bool:
    """Merge, say what came of it, and return whether there was no conflict."""
    from suite.merge import merge

    done = merge(store, sources)
    for one in done:
        typer.echo(one.summary())
        for key in one.conflicts:
            typer.echo(f"  row {key} has another outcome there; both are kept.")
    return not any(one.conflicts for one in done)


@app.command()
def status(store: StoreArgument, style: TextStyle = TextFormat.TEXT) -> None:
    """Say how far a store is, also while another process is writing to it.

    Example: kbga-bench status out/paper.db --format json
    """
    from suite.harness.status import as_text
    from suite.harness.status import status as status_of

    found = status_of(store)
    if style is TextFormat.JSON:
        _print_json(found)
    else:
        typer.echo(as_text(found))


@app.command()
def rerun(
    store: StoreArgument,
    row: Annotated[str, typer.Argument(metavar="ROW", help="Key of the row, or its beginning.")],
    debug: Annotated[
        bool, typer.Option("--pdb", help="Enter the debugger where an exception is raised.")
    ] = False,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Repeat one row from its own record, in this process, and compare the paths.

    The store is not changed. Exit code 0 if the path is the same bit for bit, or may differ because
    the row's budget was of time; 1 otherwise.

    Example: kbga-bench rerun out/paper.db 3f2a09
    """
    from suite.harness.cell import attempt_cell, run_cell
    from suite.harness.rerun import cell_of, compare
    from suite.harness.single import as_data, as_text

    cell = cell_of(store, row)
    if debug:
        import pdb

        try:
            record = attempt_cell(cell)
        except Exception:
            pdb.post_mortem(sys.exc_info()[2])
            raise typer.Exit(1) from None
    else:
        record = run_cell(cell)
    found = compare(store, record)
    if style is TextFormat.JSON:
        _print_json({**as_data(record), "key": cell.key, **found.as_dict})
    else:
        typer.echo(f"{as_text(record)}\n  {found.words}")
    raise typer.Exit(0 if found.same or not found.must_be_same else 1)


@app.command()
def tables(
    store: StoreArgument,
    style: Annotated[TableFormat, typer.Option("--format", help="How to print them.")] = (
        TableFormat.TABLE
    ),
    output: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write a file for each table instead.")
    ] = None,
) -> None:
    """Print the tables of a store: a summary, the paper's figures beside ours, and comparisons.

    As text, tables of the rows behind another table are left out; a last line names them.

    Example: kbga-bench tables out/paper.db --format markdown
    """
    from suite.report.results import read_tables, write_tables
    from suite.report.table import Format, render

    found = read_tables(store)
    if output is not None:
        for path in write_tables(found, output, Format(style)):
            typer.echo(path)
        return
    hidden = [table.name for table in found if table.detail and style is TableFormat.TABLE]
    shown = [render(table, Format(style)) for table in found if table.name not in hidden]
    if hidden:
        shown.append(f"Not printed, but written with --output: {', '.join(hidden)}.\n")
    typer.echo("\n".join(shown), nl=False)


@app.command()
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
    """Compare two stores of the same matrix: what got better, and what got worse.

    Exit code 0 if nothing got worse, 1 if something did.

    Example: kbga-bench compare before.db after.db
    """
    import numpy as np

    from suite.report.table import Format, render
    from suite.report.versions import BOOTSTRAP_SEED, compare_versions
    from suite.store import read_runs

    rng = np.random.default_rng(BOOTSTRAP_SEED)
    found = compare_versions(read_runs(old), read_runs(new), rng, with_times=times)
    typer.echo(render(found.table, Format(style)), nl=False)
    typer.echo(f"\n{found.summary()}", err=style is not TableFormat.TABLE)
    raise typer.Exit(1 if found.worse else 0)


@app.command()
def export(
    store: StoreArgument,
    target: Annotated[
        Path, typer.Argument(metavar="DIR|FILE", help="Folder, or file of planner-arena.")
    ],
    to: Annotated[ExportFormat, typer.Option(help="Kind of files.")] = ExportFormat.PARQUET,
) -> None:
    """Export the rows of a store.

    parquet, csv: runs, events, traces, paths, a file each. ompl-log: a log of OMPL's benchmarks for
    each query. planner-arena: the database that Planner Arena reads, made of these logs.

    Example: kbga-bench export out/paper.db rows --to csv
    """
    if to in (ExportFormat.PARQUET, ExportFormat.CSV):
        from suite.report.export import export_rows

        files = export_rows(store, target, to.value)
    else:
        from suite.report.ompl_log import write_ompl_logs, write_planner_arena

        is_log = to is ExportFormat.OMPL_LOG
        files = write_ompl_logs(store, target) if is_log else [write_planner_arena(store, target)]
    for path in files:
        typer.echo(path)


@app.command()
def results(
    store: StoreArgument,
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Where to; made if missing.")],
    leave_out: Annotated[
        list[Rows] | None,
        typer.Option(help="Rows that are not written, where they are too many; repeatable."),
    ] = None,
) -> None:
    """Make a results folder: tables, rows, figures of scenes and studies, and the manifest.

    Example: kbga-bench results out/paper.db results/paper-static --leave-out traces
    """
    from suite.report.results import write_results

    for path in write_results(store, directory, leave_out={kind.value for kind in leave_out or []}):
        typer.echo(path)


@app.command()
def report(
    store: StoreArgument,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Page to write: .html.")
    ] = Path("report.html"),
) -> None:
    """Write a report: one page with tables, charts and pictures that opens without a network.

    Example: kbga-bench report out/paper.db -o report.html
    """
    from suite.report.html.page import write_report

    write_report(store, output)
    typer.echo(output)


def main() -> None:
    """Run the command; errors that users can mend are one line and exit code 2."""
    warnings.showwarning = _show_warning
    end_quietly()
    try:
        app()
    except KbgaBenchError as error:
        typer.echo(f"kbga-bench: error: {_one_line(error)}", err=True)
        sys.exit(2)


def _one_line(text: object) -> str:
    return " ".join(str(text).split())


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    typer.echo(f"kbga-bench: warning: {_one_line(message)}", err=True)


def _print_json(value: Any) -> None:
    typer.echo(json.dumps(value, indent=2))


def _print_rows(rows: list[dict[str, Any]]) -> None:
    from tabulate import tabulate

    headers = list(rows[0]) if rows else []
    texts = [[_as_text(value) for value in row.values()] for row in rows]
    typer.echo(tabulate(texts, headers=headers, disable_numparse=True))


def _as_text(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(map(str, value))
    if isinstance(value, float):
        return f"{value:.3f}"
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return str(value)
