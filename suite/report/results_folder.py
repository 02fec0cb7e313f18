"""A results folder, made from a store: tables, rows, figures, and the manifest."""

import hashlib
import json
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from suite.errors import StoreError, writing
from suite.report.all_tables import read_tables
from suite.report.export.files import export_rows, made_folder, need_pyarrow
from suite.report.figures.comparison import comparison_figures
from suite.report.figures.convergence import convergence_figures
from suite.report.figures.files import save
from suite.report.figures.maps import HardQuery, map_figures, plot_map
from suite.report.figures.overview import overview_figures
from suite.report.figures.ranks import rank_figures
from suite.report.figures.replanning import plot_replanning
from suite.report.figures.runtime import runtime_figures
from suite.report.figures.scene import plot_scene_results
from suite.report.figures.simulation import plot_snapshots
from suite.report.figures.studies import study_figures
from suite.report.figures.style import LINES, heading, numbered
from suite.report.formats import render
from suite.report.kinds import FigureFormat, Part, TableFormat
from suite.report.optima import check_optima
from suite.report.paper.pictures import paper_pictures
from suite.report.rows import cheapest, feasible, is_blocked, is_of_map, is_simulated, newest
from suite.report.statistics.anytime import Steps, steps_of
from suite.report.statistics.clock import fair
from suite.report.statistics.over_queries import hardest, only_maps, query_measures
from suite.report.table import Table
from suite.report.tables.alignment import without_repeats
from suite.scenes.scene import Query, Scene
from suite.simulation.record import from_data
from suite.store.read import (
    read_events,
    read_paths,
    read_replans,
    read_runs,
    read_sessions,
    read_simulation,
    read_snapshots,
)
from suite.store.scenes import KeptScenes

MANIFEST = "manifest.json"

LONG = 150_000
"""Bytes of a table of the rows behind another one, from which on it is a long one."""

REPLANNING = "replanning"
"""Name of the figure of simulated runs."""


def write_results(
    store: Path,
    directory: Path,
    *,
    leave_out: Collection[Part] = (),
    figures: FigureFormat = FigureFormat.PNG,
) -> list[Path]:
    """Make a results folder from a store; the same store gives the same bytes.

    Tables of the rows behind another table are CSV only, for nobody reads hundreds of lines. There
    are figures of each study and of how the planners compare, and one of the best paths for each
    scene, where a reader can still tell them apart.

    Parameters
    ----------
    store : Path
    directory : Path
        Made if it is missing; files of the same names are replaced.
    leave_out : collection of Part
        Rows that are not written, for they are too many, and pictures. The manifest names them.
    figures : FigureFormat

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    KbgaBenchError
        If the store holds no runs, neither keeps a scene of them nor finds it in its file, or a
        file can't be written.
    """
    need_pyarrow()
    runs = read_runs(store)
    if runs.empty:
        raise StoreError(f"{store}: it holds no runs yet. `kbga-bench run` fills it.")
    current = newest(runs)
    check_optima(current)
    shown = fair(without_repeats(current[~is_blocked(current)]))
    kept = KeptScenes(store)
    scenes = _scenes(shown, kept)
    folder = made_folder(directory)
    tables = read_tables(store)
    files = write_tables([t for t in tables if not t.detail], folder, TableFormat.MARKDOWN)
    longest = LONG if Part.LONG_TABLES in leave_out else inf
    files += write_tables(
        [t for t in tables if not _is_longer(t, longest)], folder, TableFormat.CSV
    )
    rows = made_folder(folder / "rows")
    files += export_rows(store, rows, "parquet", leave_out=leave_out, names_only=True)
    for name, figure in _figures(store, shown, kept, scenes, leave_out):
        file = folder / f"{name}{figures.suffix}"
        save(figure, file)
        files.append(file)
    manifest = folder / MANIFEST
    made = _manifest(store, runs, folder, files, leave_out)
    with writing(manifest):
        manifest.write_text(json.dumps(made, indent=2) + "\n", encoding="utf-8")
    return [*files, manifest]


def _is_longer(table: Table, longest: float) -> bool:
    """Whether a table of the rows behind another one has more than so many bytes as CSV."""
    return table.detail and len(render(table, TableFormat.CSV).encode()) > longest


def write_tables(tables: Sequence[Table], directory: Path, style: TableFormat) -> list[Path]:
    """Write each table to a file of its name.

    Raises
    ------
    KbgaBenchError
        If a file can't be written.
    """
    folder = made_folder(directory)
    files = []
    for table in tables:
        file = folder / f"{table.name}{style.suffix}"
        with writing(file):
            file.write_text(render(table, style), encoding="utf-8")
        files.append(file)
    return files


def _scenes(runs: pd.DataFrame, kept: KeptScenes) -> list[tuple[Scene, Query]]:
    """Scenes and queries of the runs, as they were when these were made."""
    wanted = runs.drop_duplicates(["scene", "query", "scene_hash"])
    return [kept.of(row) for row in wanted.to_dict("records")]


def _figures(
    store: Path,
    current: pd.DataFrame,
    kept: KeptScenes,
    scenes: list[tuple[Scene, Query]],
    leave_out: Collection[Part],
) -> Iterator[tuple[str, Figure]]:
    """The figures that are wanted, each with the name of its file."""
    planned, driven = current[~is_simulated(current)], current[is_simulated(current)]
    paths, steps = read_paths(store), steps_of(planned, read_events(store))
    yield from study_figures(planned).items()
    if Part.COMPARISONS not in leave_out:
        yield from _comparisons(steps)
    on_maps = set(planned.loc[is_of_map(planned), "scene"])
    apart = [(scene, query) for scene, query in scenes if scene.name not in on_maps]
    if Part.PAPER_PICTURES not in leave_out:
        yield from paper_pictures(planned, paths, read_snapshots(store), apart).items()
    if Part.SCENE_PICTURES not in leave_out:
        yield from _scene_figures(planned, paths, apart)
    yield from _map_figures(only_maps(steps), paths, scenes, leave_out)
    if not driven.empty:
        yield REPLANNING, plot_replanning(driven, read_replans(store))
        yield from _snapshot_sheets(driven, store, kept)


def _comparisons(steps: Steps) -> Iterator[tuple[str, Figure]]:
    """How the planners compare."""
    yield from overview_figures(steps).items()
    yield from convergence_figures(steps).items()
    yield from runtime_figures(steps).items()
    yield from comparison_figures(steps).items()
    yield from rank_figures(steps).items()


def _scene_figures(
    runs: pd.DataFrame, paths: dict[str, Any], scenes: list[tuple[Scene, Query]]
) -> Iterator[tuple[str, Figure]]:
    """The best paths of each scene, where a reader can still tell them apart."""
    for scene, query in scenes:
        here = runs[(runs["scene"] == scene.name) & (runs["query"] == query.name)]
        if here.empty or here["variant"].nunique() > len(LINES):
            continue
        best, labels = _best_paths(here, paths)
        several = len(scene.queries) > 1
        name = f"{scene.name}-{query.name}" if several else scene.name
        yield name, plot_scene_results(scene, query, best, labels=labels)


def _map_figures(
    steps: Steps,
    paths: Mapping[str, NDArray[np.float64]],
    scenes: list[tuple[Scene, Query]],
    leave_out: Collection[Part],
) -> Iterator[tuple[str, Figure]]:
    """All queries as marks, and each map once, with its hardest queries."""
    if steps.runs.empty:
        return
    runs, measures = steps.runs, query_measures(steps)
    planners = numbered(runs["variant"])
    yield from map_figures(measures, planners).items()
    asked = {(scene.name, query.name): (scene, query) for scene, query in scenes}
    for place, here in measures.groupby("place", sort=False):
        names = hardest(here)
        if not names or len(planners) > len(LINES) or Part.SCENE_PICTURES in leave_out:
            continue
        on_map = runs[runs["place"] == place]
        hard = [
            HardQuery(
                asked[(str(place), name)][1], _best_paths(on_map[on_map["query"] == name], paths)[0]
            )
            for name in names
        ]
        scene = asked[(str(place), names[0])][0]
        yield scene.name, plot_map(scene, hard, planners, here["query"].nunique())


def _snapshot_sheets(
    runs: pd.DataFrame, store: Path, kept: KeptScenes
) -> Iterator[tuple[str, Figure]]:
    """A sheet of the first run of the first planner in each world."""
    for row in runs.drop_duplicates(["scene_source", "world"]).to_dict("records"):
        scene, _ = kept.of(row)
        data = read_simulation(store, row["key"])
        figure = plot_snapshots(from_data(scene, data))
        heading(figure, f"{data['scene']}, {row['world']}: {row['variant']}")
        yield f"{data['scene']}-{_slug(row['world'])}", figure


def _slug(text: str) -> str:
    """A text as a part of a file's name."""
    return "-".join(re.findall(r"[a-z0-9]+", text.lower()))


def _best_paths(
    runs: pd.DataFrame, paths: Mapping[str, NDArray[np.float64]]
) -> tuple[dict[str, NDArray[np.float64] | None], dict[str, str]]:
    """The cheapest path of each planner in the runs of one query, and its line in the legend."""
    best: dict[str, NDArray[np.float64] | None] = {}
    labels = {}
    for variant, group in runs.groupby("variant", sort=False):
        name, row = str(variant), cheapest(group)
        cost = "no path" if row is None else f"{row['cost']:.2f} m"
        best[name] = None if row is None else paths[row["key"]]
        labels[name] = f"{name}: {cost} ({len(feasible(group))} of {len(group)} runs)"
    return best, labels


def _manifest(
    store: Path,
    runs: pd.DataFrame,
    folder: Path,
    files: Sequence[Path],
    leave_out: Collection[Part],
) -> dict[str, Any]:
    sessions = read_sessions(store)
    matrices = list(dict.fromkeys(session["matrix"] for session in sessions))
    in_files = runs["scene_source"].map(lambda source: Path(source).name != source)
    maps = " --maps MAPS" if (is_of_map(runs) & in_files).any() else ""
    commands = [f"kbga-bench run {matrix}{maps} --store STORE" for matrix in matrices]
    options = "".join(f" --leave-out {kind}" for kind in sorted(leave_out))
    return {
        "made_by": [*commands, f"kbga-bench results STORE {folder.name}{options}"],
        "runs": len(runs),
        "by_status": {str(k): int(v) for k, v in runs["status"].value_counts().items()},
        "planners": list(runs["variant"].unique()),
        "scenes": list(runs["scene"].unique()),
        "seeds": int(runs["seed"].nunique()),
        "sessions": sessions,
        "sha256": {
            str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
            for file in files
        },
    }
