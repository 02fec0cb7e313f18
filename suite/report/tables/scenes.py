"""The scenes and maps that were run on: how large they are, and what comes before any clock."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from suite.report.rows import is_blocked
from suite.report.table import Table
from suite.report.words import counted, joined

NOTE = (
    "One row for each scene. vertices, obstacles: that it was drawn with; free: share of the "
    "workspace outside all obstacles, at time 0; queries: that were asked. The times are CPU time, "
    "outside every planner's clock: prepare: to load, arrange and mesh the scene, once for all its "
    "rows; exact: to find the optimum of a query, over the queries."
)


def scenes_table(runs: pd.DataFrame, sizes: pd.DataFrame) -> Table | None:
    """The table of scenes; None if the rows know nothing of what is in it.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    sizes : DataFrame
        As :func:`suite.store.scenes.sizes_of_scenes` gives it.
    """
    asked = runs[~is_blocked(runs)]
    sized = {row["scene"]: row for row in sizes.to_dict("records")}
    rows = [
        {"scene": scene} | _size(sized, scene) | _costs(group)
        for scene, group in asked.groupby("scene", sort=False)
    ]
    frame = pd.DataFrame(rows)
    if frame.empty or frame.drop(columns=["scene", "queries"]).isna().all(axis=None):
        return None
    unknown = int(frame["vertices"].isna().sum())
    left_out = f"The store keeps no drawing of {counted(unknown, 'scene')}." if unknown else ""
    title = "Scenes: their size, and what preparing them and their optima took"
    return Table("scenes", title, frame, joined(NOTE, left_out))


def _size(sized: Mapping[Any, Mapping[Any, Any]], scene: object) -> dict[str, Any]:
    row = sized.get(scene)
    if row is None:
        return {"vertices": pd.NA, "obstacles": pd.NA, "free (%)": float("nan")}
    return {
        "vertices": int(row["vertices"]),
        "obstacles": int(row["obstacles"]),
        "free (%)": 100.0 * float(row["free_share"]),
    }


def _costs(group: pd.DataFrame) -> dict[str, Any]:
    """What one scene took; of processes that each made it, the median."""
    exact = 1e3 * group.groupby("query", sort=False)["exact_s"].median()
    return {
        "queries": int(group["query"].nunique()),
        "prepare (ms)": 1e3 * float(group["prepare_s"].median()),
        "exact median (ms)": float(exact.median()),
        "exact worst (ms)": float(exact.max()),
    }
