"""The files that figures are written to; the same figure gives the same bytes."""

import io
from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import PIL.Image
from matplotlib.figure import Figure

from suite.errors import KbgaBenchError
from suite.report.figures.style import RASTER_COLOURS, RASTER_DPI
from suite.report.kinds import FigureFormat


def check_figure_file(file: Path) -> None:
    """Refuse a file that a figure can't be written to, before anything is run for it.

    Raises
    ------
    KbgaBenchError
        If its kind is unknown or its folder is missing.
    """
    check_file(file, "figures", [kind.suffix for kind in FigureFormat])


def check_file(file: Path, what: str, suffixes: Sequence[str]) -> None:
    """Refuse a file of a kind that these things can't be, or in a folder that there is not.

    Raises
    ------
    KbgaBenchError
    """
    if file.suffix.lower() not in suffixes:
        raise KbgaBenchError(f"{file}: {what} are {', '.join(suffixes)}. Name such a file.")
    if not file.parent.is_dir():
        raise KbgaBenchError(f"{file}: there is no folder {file.parent}. Make it first.")


def save(figure: Figure, file: Path) -> None:
    """Write a figure and let go of it; the same figure gives the same bytes.

    Raises
    ------
    KbgaBenchError
        If the file can't be written.
    """
    dated = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}
    suffix = file.suffix.lower()
    try:
        if suffix == ".png":
            file.write_bytes(as_png(figure))
        else:
            with plt.rc_context({"svg.hashsalt": "kbga-bench"}):
                figure.savefig(file, metadata=dated.get(suffix))
    except OSError as error:
        raise KbgaBenchError(f"{file}: can't be written ({error.strerror}).") from error
    finally:
        plt.close(figure)


def as_png(figure: Figure) -> bytes:
    """Draw a figure and let go of it; the same figure gives the same bytes."""
    drawn, small = io.BytesIO(), io.BytesIO()
    try:
        figure.savefig(drawn, format="png", dpi=RASTER_DPI)
    finally:
        plt.close(figure)
    with PIL.Image.open(drawn) as image:
        image.convert("RGB").quantize(RASTER_COLOURS).save(small, format="png", optimize=True)
    return small.getvalue()
