"""Commands that run one planner: plan, simulate, check, warm-up, new-planner.

Floors above the planner interface are imported inside the commands: pandas and matplotlib take
longer to import than ``list`` takes to answer.
"""

from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from suite.commands.options import (
    AtOption,
    ChecksOption,
    CpuOption,
    GenerationsOption,
    GoalOption,
    PlannerOption,
    PluginOption,
    QueryOption,
    RadiusOption,
    SceneArgument,
    SeedOption,
    SettingsOption,
    SnapOption,
    StartOption,
    TextFormat,
    TextStyle,
    WallOption,
    use_plugins,
)
from suite.commands.output import print_file, print_json, say, working

if TYPE_CHECKING:
    from suite.store.record import Cell, RunRecord


class Charge(StrEnum):
    """What simulated time planning takes; see :class:`suite.simulation.settings.Charge`."""

    MEASURED = "measured"
    ZERO = "zero"


def plan(
    scene: SceneArgument,
    planner: PlannerOption,
    seed: SeedOption = 0,
    query: QueryOption = None,
    start: StartOption = None,
    goal: GoalOption = None,
    radius: RadiusOption = None,
    snap: SnapOption = False,
    at: AtOption = None,
    settings: SettingsOption = None,
    plugin: PluginOption = None,
    wall_s: WallOption = None,
    cpu_s: CpuOption = None,
    generations: GenerationsOption = None,
    checks: ChecksOption = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the run: .png, .pdf or .svg.")
    ] = None,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Run one planner once, here and now, and say what came of it.

    With `--query all` once for each query of the scene, on a line each.

    Exit code 0 if it found a path or proved that there is none, 1 otherwise, for any query.

    Example: kbga-bench plan zigzag --planner kbga --seed 7 --generations 60 --plot zigzag.png

    Example: kbga-bench plan maze --planner kbga-plus --radius 0.5 --start 10,20 --goal 45,80
    """
    from suite.harness.cell import run_cell
    from suite.harness.single import (
        as_data,
        as_line,
        as_text,
        cell_for,
        parse_settings,
        query_names,
        succeeded,
    )
    from suite.planner import Budget, Recorder
    from suite.scenes.modifiers import with_modifiers

    use_plugins(plugin)
    source = with_modifiers(scene, radius=radius, at=at, snap=snap)
    cells = [
        cell_for(
            source,
            planner,
            seed=seed,
            query=name,
            settings=parse_settings(settings or []),
            budget=Budget(wall_s, generations, checks, cpu_s),
        )
        for name in query_names(source, query, start, goal)
    ]
    if query == "all":
        if plot is not None:
            raise typer.BadParameter("It draws one run: name a query.", param_hint="--plot")
        raise _after_each(cells, as_line, as_data, succeeded, style)
    [cell] = cells
    # Of the first population only: more would slow down the run that is timed.
    recorder = Recorder(snapshot_of=lambda generation: plot is not None and generation == 0)
    if plot is not None:
        from suite.report.figures.files import check_figure_file

        check_figure_file(plot)
    record = run_cell(cell, recorder=recorder)
    if plot is not None:
        from suite.report.figures.run import draw_record

        draw_record(record, recorder.snapshots, plot)
    if style is TextFormat.JSON:
        print_json(as_data(record))
    else:
        say(as_text(record))
    if plot is not None:
        print_file(plot, style)
    raise typer.Exit(0 if succeeded(record) else 1)


def _after_each(
    cells: "list[Cell]",
    as_line: "Callable[[RunRecord], str]",
    as_data: "Callable[[RunRecord], dict[str, Any]]",
    is_good: "Callable[[RunRecord], bool]",
    style: TextFormat,
) -> typer.Exit:
    """Run several cells, say what came of each and of all, and give the code to exit with."""
    from suite.harness.cell import run_cell
    from suite.harness.single import summary

    records = []
    for cell in cells:
        records.append(run_cell(cell))
        if style is TextFormat.TEXT:
            say(as_line(records[-1]))
    if style is TextFormat.JSON:
        print_json([as_data(record) for record in records])
    else:
        say(summary(records))
    return typer.Exit(0 if all(map(is_good, records)) else 1)


def check(
    planners: Annotated[
        list[str] | None,
        typer.Argument(metavar="PLANNER...", help="Names of planners; see `list planners`."),
    ] = None,
    every: Annotated[
        bool, typer.Option("--all", help="All that are installed; what is unavailable is named.")
    ] = False,
    settings: SettingsOption = None,
    plugin: PluginOption = None,
    limit_s: Annotated[
        float, typer.Option(min=1.0, help="Seconds after which a rule that hangs is ended.")
    ] = 30.0,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Check that planners keep the plugin contract, rule by rule.

    Exit code 0 if they do, 1 if a rule is broken, or if one that was named is unavailable; what to
    do about it stands with each rule.

    Example: kbga-bench check kbga --set population_size=20

    Example: kbga-bench check kbga ompl-rrtstar
    """
    from suite.conformance.check import check as apply_rules
    from suite.conformance.wording import as_data, as_text, broken
    from suite.harness.single import parse_settings
    from suite.plugins.discovery import planner_names

    use_plugins(plugin)
    names = planners or []
    if every == bool(names):
        raise typer.BadParameter("Give names of planners, or --all.")
    if settings and len(names) != 1:
        raise typer.BadParameter("It is for one planner: check that by itself.", param_hint="--set")
    if len(names) != 1:
        kept = _check_several(planner_names() if every else names, limit_s, style, lenient=every)
        raise typer.Exit(0 if kept else 1)
    results = apply_rules(names[0], parse_settings(settings or []), limit_s)
    if style is TextFormat.JSON:
        print_json(as_data(names[0], results))
    else:
        say(as_text(names[0], results))
    raise typer.Exit(1 if broken(results) else 0)


def _check_several(names: list[str], limit_s: float, style: TextFormat, *, lenient: bool) -> bool:
    """Print each when it is done, and a line for each at the end; whether all is well."""
    from suite.conformance.check import check_each
    from suite.conformance.wording import as_text

    done = []
    for checked in check_each(names, limit_s):
        done.append(checked)
        if style is TextFormat.TEXT and checked.unavailable is None:
            say(f"{as_text(checked.planner, checked.results)}\n")
    if style is TextFormat.JSON:
        print_json([checked.as_data for checked in done])
    else:
        say("\n".join(checked.line for checked in done))
    return all(lenient if checked.kept is None else checked.kept for checked in done)


def warm_up(
    planners: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[PLANNER]...", help="Their names; default: all that are installed."
        ),
    ] = None,
    plugin: PluginOption = None,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Compile what planners need, and the exact solver, so that no later command has to.

    Once after an install or an update: with that in a container's image, its first `plan` starts
    at once. What is compiled already is only loaded.

    Example: kbga-bench warm-up

    Example: kbga-bench warm-up kbga kbga-plus
    """
    from suite.harness.warm_up import warm_up_each

    use_plugins(plugin)
    done = []
    with working("compiling"):
        for warmed in warm_up_each(planners or None):
            done.append(warmed)
            if style is TextFormat.TEXT:
                say(warmed.line)
    if style is TextFormat.JSON:
        print_json([warmed.as_data for warmed in done])
    raise typer.Exit(0 if all(warmed.is_well for warmed in done) else 1)


def new_planner(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Of the planner and its package: my-planner.")
    ],
    output: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Where to; default: a folder of that name.")
    ] = None,
) -> None:
    """Write a planner to start from: a package with a module, its metadata and a test.

    It keeps the contract as it is; see `check`.

    Example: kbga-bench new-planner my-planner --output my-planner
    """
    from suite.plugins.new_planner import write_new_planner

    files = write_new_planner(name, output)
    for file in files:
        say(file)
    say(f"Try it: kbga-bench check {name} --plugin {files[0]}")


def simulate(
    scene: SceneArgument,
    planner: PlannerOption,
    seed: SeedOption = 0,
    query: QueryOption = None,
    start: StartOption = None,
    goal: GoalOption = None,
    radius: RadiusOption = None,
    snap: SnapOption = False,
    settings: SettingsOption = None,
    plugin: PluginOption = None,
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
    wall_s: WallOption = None,
    cpu_s: CpuOption = None,
    generations: GenerationsOption = None,
    checks: ChecksOption = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw snapshots: .png, .pdf or .svg.")
    ] = None,
    animate: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it moving: .gif or .mp4.")
    ] = None,
    updates: Annotated[
        bool,
        typer.Option("--updates", help="Say all updates, not only those with something new."),
    ] = False,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Let a robot find its way through a dynamic scene, planning anew as it goes.

    With `--query all` once for each query of the scene, on a line each.

    Exit code 0 if it reached the goal and was never hit, 1 otherwise, for any query.

    Example: kbga-bench simulate door --planner kbga --seed 3 --speed 5 --animate door.gif
    """
    from suite.harness.cell import run_cell
    from suite.harness.single import (
        as_line,
        cell_for,
        parse_settings,
        query_names,
        simulation_as_data,
        simulation_as_text,
        simulation_of,
        unhurt,
        world_for,
    )
    from suite.planner import Budget
    from suite.scenes.modifiers import with_modifiers

    use_plugins(plugin)
    source = with_modifiers(scene, radius=radius, snap=snap)
    if plot is not None:
        from suite.report.figures.files import check_figure_file

        check_figure_file(plot)
    if animate is not None:
        from suite.report.figures.simulation import check_animation_file

        check_animation_file(animate)
    overrides = {
        "speed": speed,
        "interval": interval,
        "sensing_range": sensing_range,
        "obstacle_speed_factor": obstacle_speed_factor,
        "time_limit": time_limit,
        "charge": charge.value,
    }
    cells = [
        cell_for(
            source,
            planner,
            seed=seed,
            query=name,
            settings=parse_settings(settings or []),
            budget=Budget(wall_s, generations, checks, cpu_s),
            world=world_for(source, overrides, cold=cold),
        )
        for name in query_names(source, query, start, goal)
    ]
    if query == "all":
        if plot is not None or animate is not None:
            raise typer.BadParameter("Only one run is drawn: name a query.", param_hint="--query")
        raise _after_each(cells, as_line, simulation_as_data, unhurt, style)
    [cell] = cells
    record = run_cell(cell)
    if style is TextFormat.JSON:
        print_json(simulation_as_data(record))
    else:
        say(simulation_as_text(record, updates=updates))
    done = simulation_of(record) if plot is not None or animate is not None else None
    if done is not None and plot is not None:
        from suite.report.figures.files import save
        from suite.report.figures.simulation import plot_snapshots

        with working(f"drawing {plot}"):
            save(plot_snapshots(done), plot)
        print_file(plot, style)
    if done is not None and animate is not None:
        from suite.report.figures.simulation import animate as write_animation

        with working(f"drawing {animate}"):
            write_animation(done, animate)
        print_file(animate, style)
    raise typer.Exit(0 if unhurt(record) else 1)
