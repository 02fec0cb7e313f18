"""Commands about matrices and their stores: run, merge, status, rerun.

Floors above the planner interface are imported inside the commands: pandas and matplotlib take
longer to import than ``list`` takes to answer.
"""

import sys
from contextlib import nullcontext
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from suite.commands.options import (
    PluginOption,
    StoreArgument,
    TextFormat,
    TextStyle,
    use_plugins,
)
from suite.commands.output import print_json, say


class Where(StrEnum):
    """Where runs are run; see :mod:`suite.harness.cluster.executors`."""

    LOCAL = "local"
    DASK = "dask"


def run(
    matrix: Annotated[
        str, typer.Argument(metavar="MATRIX", help="Name in the catalogue, or path of a file.")
    ],
    store: Annotated[Path, typer.Option(metavar="FILE", help="Result store; made if missing.")],
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Runs at a time; default: one per physical core.")
    ] = None,
    executor: Annotated[
        Where, typer.Option(help="Where: on this machine, or on the workers of a dask cluster.")
    ] = Where.LOCAL,
    address: Annotated[
        str | None, typer.Option(metavar="URL", help="Of the dask scheduler: tcp://host:port.")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Only the first two seeds.")] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Run what is there again too, and replace its rows.")
    ] = False,
    only_failed: Annotated[
        bool,
        typer.Option(
            "--only-failed",
            help="Run what is missing, and again the rows that failed: invalid, error, crashed, "
            "timed_out or out_of_memory. Not those without a path: exhausted, infeasible, refused.",
        ),
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
    patience: Annotated[
        float,
        typer.Option(
            min=0.0,
            envvar="KBGA_BENCH_PATIENCE",
            metavar="SECONDS",
            help="On a busy machine: wait so long in all for free cores, with runs that wall time "
            "ends, and then run contended rows again for so long; 0: neither.",
        ),
    ] = 60.0,
    maps: Annotated[
        list[Path] | None,
        typer.Option(metavar="FOLDER", help="Add the maps of a folder to the scenes; repeatable."),
    ] = None,
    plugin: PluginOption = None,
) -> None:
    """Run what a store still lacks of a matrix, each run in a process of its own.

    It can be stopped at any time and started again: only the runs in flight are lost. At the end
    some runs of planners with a population are done again, outside any clock, to keep it.

    A run that had no core for itself is contended: no table compares its times, nor what came of it
    if wall time ended it. Such rows are run again, a few times each; what is still contended stays.

    Exit code 0 if all is done, 1 if rows of other stores differ that should be the same bit for
    bit (see `merge`), 130 after Ctrl-C, 143 after SIGTERM.

    Example: kbga-bench run paper-static --store out/paper.db --jobs 2

    Example: kbga-bench run real-maps --maps my_maps --store out/maps.db

    Example: kbga-bench run paper-static --store out/paper.db --executor dask --address tcp://n1:8786
    """
    from suite.harness.matrix import load_matrix
    from suite.harness.progress import Display
    from suite.harness.repeat import repeat_contended
    from suite.harness.run import Which, run_matrix
    from suite.harness.snapshots import keep_snapshots
    from suite.processes.endings import ending_tidily
    from suite.store.write import open_store

    use_plugins(plugin)
    if (executor is Where.DASK) != (address is not None):
        raise typer.BadParameter(
            "Give --executor dask and --address together.", param_hint="--address"
        )
    if force and only_failed:
        raise typer.BadParameter("Give one of --force and --only-failed.", param_hint="--force")
    which = Which.ALL if force else Which.FAILED if only_failed else Which.MISSING
    wanted = load_matrix(matrix, maps=maps or [])
    if dry_run:
        from suite.harness.forecast import forecast_matrix

        with _executor(address) as cluster:
            at_a_time = cluster.slots() if cluster and jobs is None else jobs
        told = forecast_matrix(wanted, store, jobs=at_a_time, quick=quick, which=which)
        say(told.as_text())
        return
    with ending_tidily(), _executor(address) as cluster, open_store(store) as opened:
        clean = _merge_into(opened, merge or [])
        try:
            with Display(wanted.name) as display:
                end = run_matrix(
                    wanted,
                    opened,
                    jobs=jobs,
                    quick=quick,
                    which=which,
                    patience_s=patience,
                    executor=cluster,
                    on_progress=display,
                )
                end = repeat_contended(
                    wanted,
                    opened,
                    end,
                    patience_s=patience,
                    jobs=jobs,
                    quick=quick,
                    executor=cluster,
                    on_progress=display,
                )
            kept = keep_snapshots(wanted, opened, most=snapshots)
        except KeyboardInterrupt as interrupt:
            say(
                "Stopped. All finished runs are kept; to go on, give the same command again.",
                err=True,
            )
            for note in getattr(interrupt, "__notes__", ()):
                say(note, err=True)
            raise typer.Exit(getattr(interrupt, "exit_code", 130)) from None
    say(" ".join(filter(None, (end.summary(), kept.summary()))))
    raise typer.Exit(0 if clean else 1)


def _executor(address: str | None) -> Any:
    """A cluster's executor; None, if no address is given, for threads of this process."""
    if address is None:
        return nullcontext()
    from suite.harness.cluster.executors import connect

    return connect(address)


def merge(
    store: Annotated[Path, typer.Argument(metavar="STORE", help="Result store; made if missing.")],
    sources: Annotated[list[Path], typer.Argument(metavar="FROM...", help="Stores to take in.")],
) -> None:
    """Take the rows of other stores into one, as when several machines ran parts of a matrix.

    A row that is there with another outcome stays, and the other one is kept beside it. Exit code 1
    if such rows should be the same bit for bit; 0 otherwise, also where rows differ whose time
    counts (a budget of wall time, or planning that is charged for in a simulation).

    Example: kbga-bench merge all.db machine-1.db machine-2.db
    """
    from suite.store.write import open_store

    with open_store(store) as opened:
        clean = _merge_into(opened, sources)
    raise typer.Exit(0 if clean else 1)


def _merge_into(store: Any, sources: list[Path]) -> bool:
    """Merge, say what came of it, and return whether nothing differs that should not."""
    from suite.store.merge import merge

    done = merge(store, sources)
    for one in done:
        say(one.as_text())
    return not any(one.alarming for one in done)


def status(store: StoreArgument, style: TextStyle = TextFormat.TEXT) -> None:
    """Say how far a store is, also while another process is writing to it.

    Example: kbga-bench status out/paper.db --format json
    """
    from suite.store.status import as_text
    from suite.store.status import status as status_of

    found = status_of(store)
    if style is TextFormat.JSON:
        print_json(found)
    else:
        say(as_text(found))


def rerun(
    store: StoreArgument,
    row: Annotated[
        str,
        typer.Argument(
            metavar="ROW",
            help="SCENE/PLANNER/SEED, or SCENE/QUERY/PLANNER/SEED and SCENE/WORLD/PLANNER/SEED "
            "where there are several; or the row's key, or its beginning.",
        ),
    ],
    debug: Annotated[
        bool, typer.Option("--pdb", help="Enter the debugger where an exception is raised.")
    ] = False,
    plugin: PluginOption = None,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Repeat one row from its own record, in this process, and compare the paths.

    It runs on the scene as the store keeps it, whatever became of the scene's file. The store is
    not changed. Exit code 0 if the path is the same bit for bit, or may differ because
    the row's budget was of time; 1 otherwise.

    Example: kbga-bench rerun out/paper.db zigzag/kbga/7
    """
    from suite.harness.cell import attempt_cell, run_cell
    from suite.harness.rerun import compare
    from suite.harness.single import as_data, as_text
    from suite.store.row_names import cell_of
    from suite.store.scene_files import changed_file
    from suite.store.scenes import scene_at_hand
    from suite.typed import plain

    use_plugins(plugin)
    cell = cell_of(store, row)
    with scene_at_hand(store, cell) as at_hand:
        if debug:
            import pdb

            try:
                record = attempt_cell(at_hand)
            except Exception:
                pdb.post_mortem(sys.exc_info()[2])
                raise typer.Exit(1) from None
        else:
            record = run_cell(at_hand)
    found, change = compare(store, record), changed_file(store, cell)
    if style is TextFormat.JSON:
        told = {"key": cell.key, **plain(found), "scene_file": change and change.change.value}
        print_json({**as_data(record), **told})
    else:
        lines = [as_text(record), found.words, *([change.as_text()] if change else [])]
        say("\n  ".join(lines))
    raise typer.Exit(0 if found.same or not found.must_be_same else 1)
