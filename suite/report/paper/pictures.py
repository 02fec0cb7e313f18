"""The paper's pictures of static environments, from the rows of a store (Figs. 6 to 10, and 13).

How KBGA comes to a path: its first population, the best of it, the best paths of several
generations, the last one. The different routes of several runs. What a GA finds that lacks the
specialised operators, or crossover and mutation. Metres, x right, y up.
"""

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from suite.paper.reported import KBGA, PLAIN_GA, WITHOUT_CROSSOVER_AND_MUTATION
from suite.planner import Snapshot
from suite.report.figures.scene import draw_ends, draw_obstacles, draw_room
from suite.report.figures.style import LABEL, LINES, POPULATION, SMALLEST, height_for, label_metres
from suite.report.rows import cheapest, feasible
from suite.scenes.homotopy import Word, routes_of
from suite.scenes.scene import Query, Scene

EVOLUTIONS = {"unstructured": 6, "maze": 7, "zigzag": 8, "double_u": 9}
"""Scenes, and the figures of the paper that show how KBGA comes to their paths."""

ROUTES = ("clustered", 10)
WITHOUT = ("zigzag", 13)

MOST_ROUTES = 4
GENERATIONS_SHOWN = 4
PANEL = 2.9
"""Width of a panel, inches."""
HEADS = 0.6
"""Height of a panel's title and axis, inches."""

Paths = Mapping[str, NDArray[np.float64]]


def paper_pictures(
    runs: pd.DataFrame,
    paths: Paths,
    snapshots: Mapping[str, Sequence[Snapshot]],
    scenes: Sequence[tuple[Scene, Query]],
) -> dict[str, Figure]:
    """The pictures that these runs can answer, by the name of their file.

    Parameters
    ----------
    runs : DataFrame
        Of one version of each scene, as :func:`suite.store.read.read_runs` gives them.
    paths : mapping from key to (n, 2) float64, metres
    snapshots : mapping from key to the generations of a run
    scenes : sequence of (Scene, Query)
        Of these runs.
    """
    figures = {}
    for scene, query in scenes:
        here = runs[(runs["scene"] == scene.name) & (runs["query"] == query.name)]
        ours = feasible(here[here["variant"] == KBGA])
        if scene.name in EVOLUTIONS:
            shown = ours[ours["key"].isin(snapshots.keys())]
            if len(shown):
                row = shown.iloc[0]
                figures[f"paper-fig-{EVOLUTIONS[scene.name]}-{scene.name}"] = plot_evolution(
                    scene, query, snapshots[row["key"]], paths[row["key"]], row["cost"]
                )
        if scene.name == ROUTES[0] and len(ours) > 1:
            best = best_of_routes(scene, ours, paths)
            figures[f"paper-fig-{ROUTES[1]}-{scene.name}"] = plot_routes(scene, query, best)
        if scene.name == WITHOUT[0]:
            crippled = _best_of(here, (PLAIN_GA, WITHOUT_CROSSOVER_AND_MUTATION), paths)
            if crippled:
                figures[f"paper-fig-{WITHOUT[1]}-{scene.name}"] = plot_routes(
                    scene, query, crippled
                )
    return figures


def plot_evolution(
    scene: Scene,
    query: Query,
    generations: Sequence[Snapshot],
    last: NDArray[np.float64],
    cost: float,
) -> Figure:
    """Draw how a population came to its path: (a) to (d), as in the paper's Fig. 6.

    Parameters
    ----------
    scene : Scene
    query : Query
    generations : sequence of Snapshot
        The first population first.
    last : (n, 2) float64, metres
        The path that came out.
    cost : float
        Its length, metres.
    """
    figure, grid = _panels(scene, query, 4)
    first = generations[0]
    grid[0].add_collection(LineCollection(first.paths, colors=POPULATION, linewidths=0.6))
    grid[0].set_title(f"(a) first population, {len(first.paths)} paths", fontsize=LABEL)
    _draw(grid[1], least_inside(scene, first.paths))
    grid[1].set_title("(b) the one of it least in obstacles", fontsize=LABEL)
    lines = [
        grid[2].plot(*path.T, color=colour, linestyle=style, linewidth=1.6, label=f"{number}")[0]
        for (number, path), (colour, style) in zip(_milestones(generations), LINES, strict=False)
    ]
    grid[2].set_title("(c) best paths of generations", fontsize=LABEL)
    if lines:
        grid[2].legend(handles=lines, fontsize=SMALLEST, framealpha=0.85, handlelength=2.6)
    _draw(grid[3], last)
    grid[3].set_title(f"(d) final path: {cost:.2f} m", fontsize=LABEL)
    return figure


def plot_routes(
    scene: Scene, query: Query, best: Mapping[str, tuple[NDArray[np.float64], float]]
) -> Figure:
    """Draw a path in each panel, under its name and cost.

    Parameters
    ----------
    scene : Scene
    query : Query
    best : mapping from a name to a path (n, 2), metres, and its length
    """
    figure, grid = _panels(scene, query, len(best))
    for axes, (name, (path, cost)) in zip(grid, best.items(), strict=False):
        _draw(axes, path)
        axes.set_title(f"{name}:\n{cost:.2f} m", fontsize=LABEL)
    return figure


def best_of_routes(
    scene: Scene, runs: pd.DataFrame, paths: Paths, most: int = MOST_ROUTES
) -> dict[str, tuple[NDArray[np.float64], float]]:
    """The shortest path of each route that runs took, the shortest route first.

    Two paths are of one route if one can be deformed into the other without passing an obstacle.

    Parameters
    ----------
    scene : Scene
    runs : DataFrame
        Feasible ones.
    paths : mapping from key to (n, 2) float64, metres
    most : int
        Routes.

    Returns
    -------
    dict
        From "(a), 17 of 20 runs" to path and length.
    """
    words = routes_of(scene, [paths[key] for key in runs["key"]])
    routes: dict[Word, list[tuple[float, str]]] = {}
    for word, key, cost in zip(words, runs["key"], runs["cost"], strict=True):
        routes.setdefault(word, []).append((float(cost), str(key)))
    ordered = sorted(routes.values(), key=min)[:most]
    return {
        f"({letter}), {len(members)} of {len(runs)} runs": (paths[min(members)[1]], min(members)[0])
        for letter, members in zip("abcdefgh", ordered, strict=False)
    }


def least_inside(scene: Scene, paths: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
    """The path of which the least is in obstacles; of several the shortest."""
    lines = [shapely.LineString(path) for path in paths]
    solid = shapely.union_all([o.polygon for o in scene.obstacles])
    inside = shapely.length(shapely.intersection(lines, solid))
    lengths = shapely.length(lines)
    return paths[int(np.lexsort([lengths, inside.round(9)])[0])]


def _milestones(generations: Sequence[Snapshot]) -> list[tuple[int, NDArray[np.float64]]]:
    """Some generations in which the best path became another one: the first, the last, between."""
    found: list[tuple[int, NDArray[np.float64]]] = []
    for snapshot in generations:
        if snapshot.best is None:
            continue
        if not found or not np.array_equal(found[-1][1], snapshot.best):
            found.append((snapshot.generation, snapshot.best))
    some = np.unique(np.linspace(0, len(found) - 1, min(GENERATIONS_SHOWN, len(found))).round())
    return [found[int(i)] for i in some]


def _best_of(
    runs: pd.DataFrame, variants: Sequence[str], paths: Paths
) -> dict[str, tuple[NDArray[np.float64], float]]:
    best = {}
    for variant in variants:
        mine = runs[runs["variant"] == variant]
        row = cheapest(mine)
        if row is not None:
            name = f"{variant.removeprefix('kbga-')}, best of {len(mine)}"
            best[name] = (paths[row["key"]], float(row["cost"]))
    return best


def _panels(scene: Scene, query: Query, count: int) -> tuple[Figure, list[Axes]]:
    columns = min(count, 2)
    rows = -(-count // columns)
    height = height_for(scene, PANEL) + HEADS
    figure, grid = plt.subplots(
        rows, columns, figsize=(PANEL * columns + 0.4, height * rows), layout="constrained",
        sharex=True, sharey=True, squeeze=False,
    )  # fmt: skip
    for axes in grid.flat[count:]:
        axes.set_visible(False)
    for axes in grid.flat[:count]:
        draw_room(axes, scene)
        draw_obstacles(axes, scene, 0.5)
        draw_ends(axes, query, 0.6)
        label_metres(axes)
    return figure, list(grid.flat[:count])


def _draw(axes: Axes, path: NDArray[np.float64]) -> None:
    axes.plot(*np.asarray(path).T, color=LINES[0][0], linewidth=1.8, marker=".", markersize=4)
