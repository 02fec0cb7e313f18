"""Colour and line of each planner, the same in all pictures of the page.

The hues are Okabe and Ito's, the light ones darkened until each stands out from white by 3 to 1, as
WCAG 2.1 asks of graphics. Planners that share a colour differ in their dashes and marks.
"""

from dataclasses import dataclass

COLOURS = ("#d55e00", "#0072b2", "#00805e", "#a8558a", "#9a6a00", "#55606b")

DASHES = (
    ("solid", ""),
    ("dash", "9 4"),
    ("dashdot", "9 3 2 3"),
    ("longdashdot", "14 3 2 3"),
    ("longdash", "14 4"),
    ("dot", "2 3"),
)
"""As plotly calls them, and as SVG has them, in widths of a thin line."""

MARKS = (
    ("circle", "M-4 0A4 4 0 1 1 4 0A4 4 0 1 1 -4 0Z"),
    ("diamond", "M-5 0L0 -5L5 0L0 5Z"),
    ("square", "M-3.6 -3.6H3.6V3.6H-3.6Z"),
    ("triangle-up", "M-4.6 3.6L0 -4.6L4.6 3.6Z"),
    ("cross", "M-4.5 -1.5H-1.5V-4.5H1.5V-1.5H4.5V1.5H1.5V4.5H-1.5V1.5H-4.5Z"),
    ("triangle-down", "M-4.6 -3.6L0 4.6L4.6 -3.6Z"),
)
"""As plotly calls them, and as SVG has them, about the place that they mark."""

PLANNERS_AT_MOST = len(COLOURS) * len(DASHES)
"""More can't be told apart."""


@dataclass(frozen=True, slots=True)
class Appearance:
    """How the lines and the marks of a planner look.

    colour : as CSS has it.
    dash, symbol : as plotly calls them.
    dasharray, mark : as SVG has them.
    """

    colour: str
    dash: str
    dasharray: str
    symbol: str
    mark: str


def appearance(number: int) -> Appearance:
    """How the lines and marks of the planner of a number look.

    Examples
    --------
    >>> appearance(0).colour, appearance(0).dash, appearance(0).symbol
    ('#d55e00', 'solid', 'circle')
    >>> len({appearance(i) for i in range(PLANNERS_AT_MOST)}) == PLANNERS_AT_MOST
    True
    """
    colours = len(COLOURS)
    dash, dasharray = DASHES[(number + number // colours) % len(DASHES)]
    symbol, mark = MARKS[number // colours % len(MARKS)]
    return Appearance(COLOURS[number % colours], dash, dasharray, symbol, mark)
