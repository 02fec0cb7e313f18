"""The command ``kbga-bench``: its commands, and how it ends."""

import sys
import warnings
from collections.abc import Callable
from contextlib import nullcontext
from importlib.metadata import version as version_of
from typing import Annotated

import typer

from suite.commands import planners, reports, runs, scenes
from suite.commands.output import apart
from suite.errors import KbgaBenchError
from suite.processes.farewell import ending
from suite.processes.output import end_quietly, show_warning

app = typer.Typer(
    name="kbga-bench",
    help="Benchmark suite for 2D robot path planning: KBGA, OMPL's planners, a plain GA and an "
    "exact solver on shared scenes, judged by one referee.",
    epilog="Start with: kbga-bench list scenes; kbga-bench plan zigzag --planner kbga --seed 1",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode="markdown",
)

COMMANDS: dict[str, Callable[..., None]] = {
    "list": scenes.list_command,
    "import": scenes.import_map,
    "generate": scenes.generate,
    "exact": scenes.exact,
    "plan": planners.plan,
    "simulate": planners.simulate,
    "check": planners.check,
    "warm-up": planners.warm_up,
    "new-planner": planners.new_planner,
    "run": runs.run,
    "merge": runs.merge,
    "status": runs.status,
    "rerun": runs.rerun,
    "tables": reports.tables,
    "compare": reports.compare,
    "export": reports.export,
    "results": reports.results,
    "report": reports.report,
}
for name, command in COMMANDS.items():
    app.command(name)(apart(command))


def _say_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"kbga-bench {version_of('kbga-bench')}")
        raise typer.Exit


@app.callback()
def _before_commands(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_say_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the command; errors that users can mend are one line and exit code 2."""
    warnings.showwarning = show_warning
    end_quietly()
    # Called by anybody else, as by tests, the process is not ours to end.
    is_own = sys._getframe(1).f_globals.get("__name__") == "__main__"
    with ending(_note) if is_own else nullcontext():
        try:
            app(prog_name=app.info.name)
        except KbgaBenchError as error:
            typer.echo(f"kbga-bench: error: {_one_line(error)}", err=True)
            sys.exit(2)


def _note(text: str) -> None:
    typer.echo(f"kbga-bench: note: {text}", err=True)


def _one_line(text: object) -> str:
    return " ".join(str(text).split())
