"""The files that figures are written to; the same figure gives the same bytes."""

import io
from pathlib import Path

import matplotlib.pyplot as plt
import PIL.Image
from matplotlib.figure import Figure

from suite.errors import check_file, writing
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
        with writing(file):
            if suffix == ".png":
                file.write_bytes(as_png(figure))
            else:
                with plt.rc_context({"svg.hashsalt": "kbga-bench"}):
                    figure.savefig(file, metadata=dated.get(suffix))
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
