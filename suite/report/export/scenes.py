"""The scenes of a store as files: for GIS tools, and for whoever has lost a file that rows name."""

import re
from dataclasses import replace
from pathlib import Path

from suite.errors import StoreError
from suite.report.export.files import made_folder
from suite.scenes.geojson import write_scene
from suite.scenes.scene import Scene
from suite.store.read import read_runs
from suite.store.scenes import KeptScenes

_NOT_IN_NAMES = re.compile(r"[^\w@=.,+-]+")


def write_scenes(store: Path, directory: Path) -> list[Path]:
    """Write each scene that the rows of a store ran on as a scene file.

    A grown scene is written with its grown obstacles: it is planned in without a radius. Queries
    that were blocked are left out, for no scene file has such.

    Parameters
    ----------
    store : Path
    directory : Path
        Made if it is missing.

    Returns
    -------
    list of Path
        The files, named after the scenes; of two scenes of one name the later one has its hash too.

    Raises
    ------
    StoreError
        If the store can't be read or keeps no scene, or a file can't be written.
    """
    kept = KeptScenes(store)
    rows = read_runs(store).drop_duplicates(["scene", "scene_hash", "query"]).to_dict("records")
    scenes = {id(scene): scene for scene, _ in (kept.of(row) for row in rows if kept.keeps(row))}
    if not scenes:
        raise StoreError(
            f"{store}: it keeps no scenes. Run its matrix again with this kbga-bench: it keeps "
            "those of the rows that are there."
        )
    folder = made_folder(directory)
    files: list[Path] = []
    for scene in scenes.values():
        name = _NOT_IN_NAMES.sub("_", scene.name)
        file = folder / f"{name}.geojson"
        if file in files:
            file = folder / f"{name}-{scene.hash}.geojson"
        if file not in files:
            write_scene(_as_drawn(scene), file)
            files.append(file)
    return files


def _as_drawn(scene: Scene) -> Scene:
    return replace(scene, queries=tuple(q for q in scene.queries if q.blocked is None))
