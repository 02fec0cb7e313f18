"""Commands about scenes: list, import, generate, exact.

Floors above the planner interface are imported inside the commands: pandas and matplotlib take
longer to import than ``list`` takes to answer.
"""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from suite.commands.options import (
    AtOption,
    GoalOption,
    PluginOption,
    QueryOption,
    RadiusOption,
    SceneArgument,
    SnapOption,
    StartOption,
    TextFormat,
    TextStyle,
    use_plugins,
)
from suite.commands.output import print_file, print_json, print_rows, say
from suite.scenes.maps.options import Unknown


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


def list_command(
    what: Annotated[What, typer.Argument(help="What to list.")],
    plugin: PluginOption = None,
    style: Annotated[ListFormat, typer.Option("--format", help="For people or programs.")] = (
        ListFormat.TABLE
    ),
) -> None:
    """List what there is: scenes, planners or matrices; as JSON with the paths of their files.

    Any scene may be modified where it is named, by what stands behind an @: zigzag@turn=17 is
    turned by 17 degrees, zigzag@shift=0.37:-0.2 moved (metres), zigzag@scale=1.5 larger, and
    zigzag@twin=3 turned and moved at random, by the seed 3; zigzag@turn=17,shift=0.37 is both.
    Controls are scenes as they were once drawn, with corners on many lattices.

    Example: kbga-bench list planners --format json
    """
    from suite.commands import listing

    # To read them loads the plugin interface, which the other lists answer without.
    if plugin or what is What.PLANNERS:
        use_plugins(plugin)
    all_of, for_people = {
        What.SCENES: (listing.scenes_listing, listing.scene_for_people),
        What.PLANNERS: (listing.planners_listing, listing.planner_for_people),
        What.MATRICES: (listing.matrices_listing, listing.matrix_for_people),
    }[what]
    rows = all_of()
    if style is ListFormat.JSON:
        print_json(rows)
    else:
        print_rows([for_people(row) for row in rows])


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
    from suite.scenes.geojson import check_scene_file, write_scene
    from suite.scenes.moving import moving
    from suite.scenes.scattered import scattered

    if (obstacles is None) != (generator is Generator.MOVING):
        rule = "Leave it out" if generator is Generator.MOVING else "Give it"
        raise typer.BadParameter(f"{rule} for {generator} scenes.", param_hint="--obstacles")
    check_scene_file(output)
    write_scene(moving(seed) if obstacles is None else scattered(obstacles, seed), output)
    say(output)


def import_map(
    source: Annotated[
        str, typer.Argument(metavar="MAP", help="A map's file; modified, if you like.")
    ],
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="FILE", help="Scene file: .geojson or .json."),
    ],
    unknown: Annotated[
        Unknown | None, typer.Option(help="What cells of an occupancy grid are that say nothing.")
    ] = None,
    resolution: Annotated[
        float | None, typer.Option(metavar="M", help="Metres of a pixel.")
    ] = None,
    threshold: Annotated[
        float | None,
        typer.Option(metavar="SHARE", help="Share of black, 0 to 1, from which it is an obstacle."),
    ] = None,
    layer: Annotated[
        str | None, typer.Option(metavar="NAME", help="The one to read, of a file of several.")
    ] = None,
    simplify: Annotated[
        float | None,
        typer.Option(
            metavar="M",
            help="Metres by which an obstacle may grow, to have fewer vertices; none shrinks.",
        ),
    ] = None,
    scale: Annotated[
        float | None, typer.Option(metavar="F", help="Metres of a unit of the map.")
    ] = None,
    radius: RadiusOption = None,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Read a map of another format, and write it as a scene file, with the queries beside it.

    It understands ROS map_server (.yaml), images (.png, .pgm, ...), Moving AI's grids (.map,
    .scen), polygon meshes (.mesh), SVG drawings, well-known text (.wkt), GeoJSON whose features
    have no role, and, with the extra gdal, shapefiles, GeoPackages, DXF and more.

    To run on a map, no scene file is needed: plan, exact and a matrix take MAP itself, with the
    options of this command behind an @: tb3.yaml@radius=0.2,unknown=free. A map's coordinates are
    taken for metres, y up.

    Example: kbga-bench import warehouse.svg --scale 0.5 -o warehouse.geojson

    Example: kbga-bench import tb3.yaml --unknown free --radius 0.2 -o tb3.geojson
    """
    from dataclasses import asdict

    from suite.errors import SceneError
    from suite.scenes.catalogue import load_scene
    from suite.scenes.geojson import check_scene_file, write_scene
    from suite.scenes.modifiers import split_modifiers, with_modifiers
    from suite.scenes.summary import summary_of, summary_text

    check_scene_file(output)
    if output.resolve() == Path(split_modifiers(source)[0]).resolve():
        raise SceneError(f"{output}: is the map itself. Name another file.")
    name = with_modifiers(
        source,
        unknown=unknown,
        resolution=resolution,
        threshold=threshold,
        layer=layer,
        simplify=simplify,
        scale=scale,
        radius=radius,
    )
    scene = load_scene(name)
    found = summary_of(scene)
    write_scene(scene, output)
    if style is TextFormat.JSON:
        print_json({"scene": scene.name, "hash": scene.hash, **asdict(found)})
    else:
        say(f"{scene.name}: {summary_text(found)}")
    print_file(output, style)


def exact(
    scene: SceneArgument,
    query: QueryOption = None,
    start: StartOption = None,
    goal: GoalOption = None,
    radius: RadiusOption = None,
    snap: SnapOption = False,
    at: AtOption = None,
    style: TextStyle = TextFormat.TEXT,
) -> None:
    """Compute the exact shortest path of a scene, or say that there is none.

    Exit code 1 if an end of a query is not free, 0 otherwise.

    Example: kbga-bench exact maze --format json

    Example: kbga-bench exact maze --radius 0.5 --start 10,20 --goal 45,80
    """
    from suite.harness.single import (
        exact_as_data,
        exact_as_line,
        exact_as_text,
        exact_summary,
        query_names,
    )
    from suite.scenes.modifiers import with_modifiers

    source = with_modifiers(scene, radius=radius, at=at, snap=snap)
    found = [exact_as_data(source, name) for name in query_names(source, query, start, goal)]
    if style is TextFormat.JSON:
        print_json(found if query == "all" else found[0])
    elif query == "all":
        say("\n".join([*map(exact_as_line, found), exact_summary(found)]))
    else:
        say(exact_as_text(found[0]))
    raise typer.Exit(1 if any(one["reason"] is not None for one in found) else 0)
