"""The rows of a store as files that any data tool reads."""

from collections.abc import Callable, Collection
from importlib.util import find_spec
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from suite.errors import StoreError, writing
from suite.store.read import (
    read_events,
    read_paths,
    read_replans,
    read_runs,
    read_simulations,
    read_traces,
)

OF_SIMULATIONS = ("simulations", "replans")
"""Files that only stores of simulated runs have."""

COMPRESSION: Final = "zstd"
"""A quarter less than parquet's usual one, and read by the same libraries."""

LEVEL: Final = 19
"""Of the compression: slow to write, and as fast to read."""


def export_rows(
    store: Path,
    directory: Path,
    kind: str,
    *,
    leave_out: Collection[str] = (),
    names_only: bool = False,
) -> list[Path]:
    """Write runs, events, traces and paths, simulations and replans, a file each.

    Parameters
    ----------
    store : Path
    directory : Path
        Made if it is missing.
    kind : str
        ``parquet`` or ``csv``.
    leave_out : collection of str
        Kinds of rows that are not written: ``events``, ``traces``, ``paths``.
    names_only : bool
        Whether a scene's file is named without its folder: rows that are published say nothing of
        the machine.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    StoreError
        If the store can't be read, or the files can't be written.
    """
    if kind == "parquet":
        need_pyarrow()
    readers: dict[str, Callable[[Path], pd.DataFrame]] = {
        "runs": read_runs,
        "events": read_events,
        "traces": read_traces,
        "paths": paths_frame,
        "simulations": read_simulations,
        "replans": read_replans,
    }
    folder = made_folder(directory)
    files = []
    for name, read in readers.items():
        if name in leave_out:
            continue
        frame = read(store)
        if frame.empty and name in OF_SIMULATIONS:
            continue
        if names_only and "scene_source" in frame:
            frame = frame.assign(scene_source=[Path(s).name for s in frame["scene_source"]])
        file = folder / f"{name}.{kind}"
        with writing(file, StoreError):
            if kind == "parquet":
                _write_parquet(frame, file)
            else:
                frame.to_csv(file, index=False, lineterminator="\n")
        files.append(file)
    return files


def _write_parquet(frame: pd.DataFrame, file: Path) -> None:
    """Write rows as small as they get.

    Of times and lengths hardly two are alike, but their first bytes are: kept together, they make
    a file of events a third smaller.
    """
    split = [c for c in frame.select_dtypes("float64") if frame[c].nunique() > 0.5 * len(frame)]
    frame.to_parquet(
        file,
        index=False,
        compression=COMPRESSION,
        compression_level=LEVEL,
        use_byte_stream_split=split,
        use_dictionary=[column for column in frame if column not in split],
    )


def need_pyarrow() -> None:
    """Say how to install what writes parquet, if it is missing.

    Raises
    ------
    StoreError
        If it is. It is large, and all but ``results`` and ``export`` do without.
    """
    if find_spec("pyarrow") is None:
        raise StoreError(
            "parquet needs the package pyarrow. Install it with: "
            'pip install "kbga-bench[parquet]"; or use `export --to csv`, which does without.'
        )


def paths_frame(store: Path) -> pd.DataFrame:
    """The paths of a store, a row for each waypoint: key, number, x, y."""
    paths = sorted(read_paths(store).items())
    if not paths:
        return pd.DataFrame(columns=["key", "number", "x", "y"])
    lengths = [len(xy) for _, xy in paths]
    points = np.concatenate([xy for _, xy in paths])
    return pd.DataFrame(
        {
            "key": np.repeat([key for key, _ in paths], lengths),
            "number": np.concatenate([np.arange(length) for length in lengths]),
            "x": points[:, 0],
            "y": points[:, 1],
        }
    )


def made_folder(directory: Path) -> Path:
    """A folder, made if it is missing.

    Raises
    ------
    StoreError
        If it can't be made.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreError(f"{directory}: can't be made a folder ({error.strerror}).") from error
    return directory
