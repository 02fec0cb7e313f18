"""Arguments and options that several commands share."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from suite import seeds


class TextFormat(StrEnum):
    """How a single result is printed."""

    TEXT = "text"
    JSON = "json"


SceneArgument = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="Name in the catalogue, or path of a scene file; modified, if you like: "
        "zigzag@turn=17,shift=0.37, my.geojson@twin=3.",
    ),
]
StoreArgument = Annotated[Path, typer.Argument(metavar="STORE", help="Result store (SQLite).")]
PlannerOption = Annotated[str, typer.Option(help="Name of the planner; see `list planners`.")]
SeedOption = Annotated[int, typer.Option(min=0, max=seeds.MOST, help="Of the random stream.")]
QueryOption = Annotated[
    str | None,
    typer.Option(
        metavar="NAME",
        help="Name of the query, or x,y:x,y; `all` for each in turn. Default: the first.",
    ),
]
StartOption = Annotated[
    str | None,
    typer.Option(metavar="X,Y", help="Start anywhere, metres; with --goal, in place of --query."),
]
GoalOption = Annotated[
    str | None, typer.Option(metavar="X,Y", help="Goal anywhere, metres; with --start.")
]
RadiusOption = Annotated[
    float | None,
    typer.Option(
        min=0.0, metavar="METRES", help="Of the robot: obstacles grow by it, the room shrinks."
    ),
]
SnapOption = Annotated[
    bool, typer.Option("--snap", help="Move ends that are not free to the nearest place that is.")
]
AtOption = Annotated[
    float | None,
    typer.Option(
        min=0.0, metavar="SECONDS", help="A dynamic scene as it is at that time, standing still."
    ),
]
SettingsOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="A setting of the planner; repeatable."),
]
PluginOption = Annotated[
    list[str] | None,
    typer.Option(
        "--plugin",
        metavar="FILE",
        help="Planners in FILE.py, or one as FILE.py:CLASS or MODULE:CLASS, without installing "
        "them; repeatable.",
    ),
]
WallOption = Annotated[float | None, typer.Option(help="Budget of a plan: seconds of wall time.")]
CpuOption = Annotated[
    float | None,
    typer.Option(help="Budget of a plan: seconds of CPU time, on any machine load."),
]
GenerationsOption = Annotated[
    int | None, typer.Option(help="Budget of a plan: generations or iterations.")
]
ChecksOption = Annotated[
    int | None, typer.Option(help="Budget of a plan: collision checks, as questions asked.")
]
TextStyle = Annotated[TextFormat, typer.Option("--format", help="For people or programs.")]


def use_plugins(references: list[str] | None) -> None:
    """Make the planners of ``--plugin`` known to this process and those that it starts."""
    from suite.plugins.from_file import name_plugins

    name_plugins(references or [])
