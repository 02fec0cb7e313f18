"""Colours behind the numbers of a table, as in the overview picture: darker is worse."""

from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.colors import to_hex, to_rgb

from suite.report.figures.style import NOTHING, colouring
from suite.report.html.cells import Sheet

INKS = ("#000000", "#ffffff")


def shaded(sheet: Sheet, numbers: pd.DataFrame, least: float) -> Sheet:
    """The sheet with a colour behind each number, and letters that are read on it.

    Parameters
    ----------
    sheet : Sheet
    numbers : DataFrame of float64
        Of the same rows, for some of its columns; nan where there is no number.
    least : float
        What is less has the colour of this.
    """
    colours, norm = colouring(numbers.to_numpy(dtype=np.float64), least)
    rows = []
    for cells, values in zip(sheet.rows, numbers.to_dict("records"), strict=True):
        row = []
        for name, cell in zip(sheet.columns, cells, strict=True):
            number = values.get(name)
            if number is None:
                row.append(cell)
                continue
            ground = NOTHING if np.isnan(number) else to_hex(colours(norm(max(number, least))))
            row.append(replace(cell, style=f"background:{ground};color:{ink_on(ground)}"))
        rows.append(row)
    return replace(sheet, rows=rows)


def ink_on(ground: str) -> str:
    """Black or white, whichever stands out more; it is always above 4.5 to 1.

    Examples
    --------
    >>> ink_on("#fde725"), ink_on("#440154")
    ('#000000', '#ffffff')
    """
    return max(INKS, key=lambda ink: contrast(ink, ground))


def contrast(one: str, other: str) -> float:
    """How much two colours stand out from each other, 1 to 21, by the rule of WCAG 2.

    Examples
    --------
    >>> contrast("#000000", "#ffffff")
    21.0
    """
    dark, light = sorted((_luminance(one), _luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def _luminance(colour: str) -> float:
    """Relative luminance of an sRGB colour, 0 to 1."""
    channels = np.array(to_rgb(colour))
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    return float(linear @ (0.2126, 0.7152, 0.0722))
