"""Whether the files that a store's rows name are still the scenes that they ran on."""

import warnings
from contextlib import closing
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

import pandas as pd

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene, main_file
from suite.scenes.scene import Scene, scene_fingerprint
from suite.scenes.source_files import files_digest
from suite.store.connection import explained, open_for_reading
from suite.store.read import read_runs
from suite.store.record import Cell
from suite.store.row_names import rows_in_words
from suite.store.scenes import read_queries
from suite.store.schema import has_table


class Change(StrEnum):
    """What became of the file of a scene."""

    GONE = "gone"
    UNREADABLE = "unreadable"
    CHANGED = "changed"


@dataclass(frozen=True, slots=True)
class FileChange:
    """A file of a scene, or of several turned or grown, that is not any more what rows ran on.

    file : the one that they name.
    change : what became of it.
    rows : how many ran on it as it was.
    kept : how many of them have it in the store, and need no file.
    """

    file: str
    change: Change
    rows: int
    kept: int

    def as_text(self) -> str:
        """A line for people."""
        verb = {
            Change.GONE: "is gone",
            Change.UNREADABLE: "can't be read any more",
            Change.CHANGED: "has changed",
        }[self.change]
        text = f"{self.file} {verb} since {rows_in_words(self.rows)} ran on it"
        if self.kept == self.rows:
            return f"{text}; the store keeps it as it was"
        lost = self.rows - self.kept
        return (
            f"{text}; of {rows_in_words(lost)} the store does not keep it: put it back, and give "
            "the same `kbga-bench run` again"
        )


def changed_files(store: Path, runs: pd.DataFrame) -> list[FileChange]:
    """The scenes of rows whose files are gone or hold another scene now.

    Scenes that are drawn from a seed have no file. One whose files have the bytes that they had is
    not read: this is asked while runs are measured.

    Parameters
    ----------
    store : Path
    runs : DataFrame
        Rows of it, as :func:`suite.store.read.read_runs` gives them.

    Returns
    -------
    list of FileChange
        In the order of the rows.
    """
    queries = read_queries(store)
    digests = _digests_of_files(store)
    known = runs.merge(queries[["scene", "scene_hash", "query", "digest"]], how="left")
    found: dict[tuple[str, Change], list[pd.DataFrame]] = {}
    for source, rows in known.groupby("scene_source", sort=False):
        file = main_file(str(source))
        if file is not None:
            for change, those in _changed_rows(str(source), file, rows, digests).items():
                found.setdefault((str(file), change), []).append(those)
    return [_counted(file, change, pd.concat(parts)) for (file, change), parts in found.items()]


def changed_file(store: Path, cell: Cell) -> FileChange | None:
    """What became of the file of a row's scene; None if it is what it was."""
    runs = read_runs(store)
    return next(iter(changed_files(store, runs[runs["key"] == cell.key])), None)


def _counted(file: str, change: Change, rows: pd.DataFrame) -> FileChange:
    return FileChange(file, change, len(rows), int(rows["digest"].notna().sum()))


def _changed_rows(
    source: str, file: Path, rows: pd.DataFrame, digests: dict[Any, Any]
) -> dict[Change, pd.DataFrame]:
    """Of the rows of a source, those that did not run on what it is now, by what became of it."""
    if not file.exists():
        return {Change.GONE: rows}
    now = files_digest(source)
    then = rows["digest"].map(digests)
    suspects = rows[then.isna() | (then != now)]
    if suspects.empty:
        return {}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene = load_scene(source)
    except SceneError:
        return {Change.UNREADABLE: suspects}
    asked = suspects[["query", "scene_hash"]].drop_duplicates()
    other = {
        (query, fingerprint)
        for query, fingerprint in asked.itertuples(index=False, name=None)
        if not _is_the_same(scene, query, fingerprint)
    }
    pairs = zip(suspects["query"], suspects["scene_hash"], strict=True)
    return {Change.CHANGED: suspects[[pair in other for pair in pairs]]} if other else {}


def _is_the_same(scene: Scene, query: str, fingerprint: str) -> bool:
    try:
        return scene_fingerprint(scene, scene.query(query)) == fingerprint
    except SceneError:
        return False


def _digests_of_files(store: Path) -> dict[Any, Any]:
    """Of the documents of the scenes, the hash of the files that they were read from."""
    with closing(open_for_reading(store)) as connection, explained(store):
        if not has_table(connection, "scenes"):
            return {}
        return dict(connection.execute("SELECT digest, files FROM scenes"))
