"""The scenes that a store keeps: those of its rows, as they were planned in."""

from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd
import shapely

from suite.errors import SceneError, StoreError
from suite.scenes.catalogue import load_scene, scene_as_it_was
from suite.scenes.kept import SUFFIX, unpack_scene
from suite.scenes.scene import Query, Scene, scene_fingerprint
from suite.store.connection import explained, open_for_reading
from suite.store.read import read_runs
from suite.store.record import Cell
from suite.store.schema import has_table

_NAME = ["scene", "scene_hash", "query"]
"""What a row says of its query, by which that is found."""

_ENDS = ["start_x", "start_y", "goal_x", "goal_y", "stratum"]


class KeptScenes:
    """The scenes of a store's rows, each read once.

    Parameters
    ----------
    store : Path
        It is only read. Scenes of rows of an older kbga-bench, which kept none, are loaded from
        their files.
    """

    def __init__(self, store: Path) -> None:
        queries = read_queries(store)
        names = queries[_NAME].itertuples(index=False, name=None)
        self._store = store
        self._digests = dict(zip(names, queries["digest"], strict=True))
        self._scenes: dict[str | None, Scene] = {}
        self._load = cache(load_scene)  # a map has hundreds of queries, and takes a while

    def keeps(self, row: Mapping[Any, Any]) -> bool:
        """Whether the store keeps the scene of a row."""
        return self.digest(row) is not None

    def digest(self, row: Mapping[Any, Any]) -> str | None:
        """What the document of a row's scene is kept by; None if the store keeps none."""
        return self._digests.get(tuple(row[name] for name in _NAME))

    def of(self, row: Mapping[Any, Any]) -> tuple[Scene, Query]:
        """The scene and the query of a row, as it was made.

        Parameters
        ----------
        row : mapping
            scene, scene_hash, query and scene_source of it are read.

        Raises
        ------
        StoreError
            If what the store keeps is damaged.
        SceneError
            If it keeps none, and the file is gone or has changed.
        """
        if not self.keeps(row):
            return self._of_file(row)
        scene = self.drawn(row)
        query = scene.query(row["query"])
        if scene_fingerprint(scene, query) != row["scene_hash"]:
            raise StoreError(
                f"{self._store}: the scene that it keeps as {scene.name} is none of its rows'."
            )
        return scene, query

    def drawn(self, row: Mapping[Any, Any]) -> Scene:
        """The scene of a row, whatever its query: nothing is arranged to look for that.

        Raises
        ------
        StoreError
            If the store does not keep it, or it is damaged.
        """
        digest = self.digest(row)
        if digest not in self._scenes:
            self._scenes[digest] = self._read(row)
        return self._scenes[digest]

    def document(self, row: Mapping[Any, Any]) -> bytes:
        """The document of the scene of a row, as :mod:`suite.scenes.kept` describes it.

        Raises
        ------
        StoreError
            If the store does not keep it.
        """
        with closing(open_for_reading(self._store)) as connection, explained(self._store):
            found = connection.execute(
                "SELECT document FROM scenes WHERE digest = ?", (self.digest(row),)
            ).fetchone()
        if found is None:
            raise StoreError(f"{self._store}: the scene {row['scene']} of its rows is not in it.")
        document: bytes = found[0]
        return document

    def _read(self, row: Mapping[Any, Any]) -> Scene:
        try:
            return unpack_scene(self.document(row), str(self._store))
        except SceneError as error:
            raise StoreError(
                f"{error} Take a copy of the store, or run the matrix into a new one."
            ) from error

    def _of_file(self, row: Mapping[Any, Any]) -> tuple[Scene, Query]:
        try:
            asked = (row["scene_source"], row["query"], row["scene_hash"])
            return scene_as_it_was(*asked, load=self._load)
        except SceneError as error:
            raise SceneError(
                f"{error} The row is of a kbga-bench that did not keep scenes in the store: once "
                "its matrix is run again on the scene as it was, the store needs no file."
            ) from error


def read_queries(store: Path) -> pd.DataFrame:
    """The queries that rows asked of kept scenes.

    Returns
    -------
    DataFrame
        scene, scene_hash, query, digest (of the scene's document), start_x, start_y, goal_x, goal_y
        (metres), stratum. Empty, if the store is of a kbga-bench that kept none.
    """
    with closing(open_for_reading(store)) as connection, explained(store):
        if not has_table(connection, "queries"):
            return pd.DataFrame(columns=[*_NAME, "digest", *_ENDS])
        return pd.read_sql_query("SELECT * FROM queries ORDER BY scene, query", connection)


def ends_of_rows(store: Path, runs: pd.DataFrame | None = None) -> pd.DataFrame:
    """From where to where each row was asked to go, and the stratum of its query.

    Parameters
    ----------
    store : Path
    runs : DataFrame, optional
        Rows of it, as :func:`suite.store.read.read_runs` gives them; default: all.

    Returns
    -------
    DataFrame
        Of the index of ``runs``: start_x, start_y, goal_x, goal_y (metres; nan where the store
        keeps no scene of the row), stratum (None where there is none).
    """
    rows = read_runs(store) if runs is None else runs
    found = rows[_NAME].merge(read_queries(store), on=_NAME, how="left").set_axis(rows.index)
    ends = found[_ENDS].astype(dict.fromkeys(_ENDS[:-1], "float64"))
    return ends.assign(
        stratum=ends["stratum"].astype("object").where(ends["stratum"].notna(), None)
    )


def sizes_of_scenes(store: Path, runs: pd.DataFrame) -> pd.DataFrame:
    """How large the scenes are that rows ran on.

    Parameters
    ----------
    store : Path
    runs : DataFrame
        Rows of it, as :func:`suite.store.read.read_runs` gives them.

    Returns
    -------
    DataFrame
        A row for each scene that the store keeps, in the order of its first row, and another one
        for each other geometry of that name: scene, vertices and obstacles that it was drawn with,
        free_share (of the workspace's area, at time 0). None of a scene that can't be read.
    """
    kept = KeptScenes(store)
    found: dict[tuple[str, str], dict[str, Any]] = {}
    for row in runs.drop_duplicates(_NAME)[_NAME].to_dict("records"):
        digest = kept.digest(row)
        if digest is None or (row["scene"], digest) in found:
            continue
        try:
            scene = kept.drawn(row)
        except StoreError:  # the report says so where it would draw it
            continue
        found[row["scene"], digest] = {"scene": row["scene"]} | _size(scene)
    return pd.DataFrame(found.values(), columns=["scene", "vertices", "obstacles", "free_share"])


def _size(scene: Scene) -> dict[str, Any]:
    # Without the arrangement, which takes as long as preparing the scene did.
    solid = shapely.union_all([obstacle.polygon for obstacle in scene.at_first.obstacles])
    return {
        "vertices": scene.vertex_count,
        "obstacles": len(scene.obstacles),
        "free_share": 1.0 - solid.area / scene.workspace.area,
    }


@contextmanager
def scene_at_hand(store: Path, cell: Cell) -> Iterator[Cell]:
    """A cell that is run on the scene as its store keeps it, whatever became of the file.

    Parameters
    ----------
    store : Path
    cell : Cell
        Of one of its rows.

    Yields
    ------
    Cell
        With another source of the scene, as long as the context lasts; with its own, if the store
        keeps no scene of it.

    Raises
    ------
    SceneError
        If the store keeps none, and the file is gone or has changed.
    """
    row = {name: getattr(cell, name) for name in (*_NAME, "scene_source")}
    kept = KeptScenes(store)
    if not kept.keeps(row):
        kept.of(row)
        yield cell
        return
    with TemporaryDirectory(prefix="kbga-bench-") as folder:
        file = Path(folder, f"scene{SUFFIX}")
        file.write_bytes(kept.document(row))
        yield replace(cell, scene_source=str(file))
