"""Which rows a table speaks of: those of the newest version of each scene and variant.

A store keeps the rows of a scene, a setting or a planner that has changed since. Pooling them with
the new ones under one name would describe neither.
"""

import pandas as pd

_NAME = ["scene", "query", "world", "variant"]
_VERSION = [
    "scene_hash",
    "planner",
    "version",
    "settings",
    "world_settings",
    "cold",
    "budget_wall_s",
    "budget_generations",
    "budget_checks",
    "budget_cpu_s",
]


def newest(runs: pd.DataFrame) -> pd.DataFrame:
    """The rows whose scene, planner, settings and budget are the last ones run under their names.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        In the same order.
    """
    if runs.empty:
        return runs
    version = runs.groupby(_VERSION, dropna=False).ngroup()
    names = runs.groupby(_NAME, dropna=False).ngroup()
    started = runs["started_at"].fillna("")
    last = started.groupby(names).transform("max") == started
    current = version.where(last).groupby(names).transform("last")
    return runs[version == current]
