"""Colour and line of each planner, the same in all pictures of the page.

The hues are Okabe and Ito's, the light ones darkened until each stands out from white by 3 to 1, as
WCAG 2.1 asks of graphics. Planners that share a colour differ in their dashes.
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

PLANNERS_AT_MOST = len(COLOURS) * len(DASHES)
"""More can't be told apart."""


@dataclass(frozen=True, slots=True)
class Appearance:
    """How the lines of a planner look.

    colour : as CSS has it.
    dash : as plotly calls it.
    dasharray : as SVG has it.
    """

    colour: str
    dash: str
    dasharray: str


def appearance(number: int) -> Appearance:
    """How the lines of the planner of a number look.

    Examples
    --------
    >>> appearance(0)
    Appearance(colour='#d55e00', dash='solid', dasharray='')
    >>> len({appearance(i) for i in range(PLANNERS_AT_MOST)}) == PLANNERS_AT_MOST
    True
    """
    colours = len(COLOURS)
    dash, dasharray = DASHES[(number + number // colours) % len(DASHES)]
    return Appearance(COLOURS[number % colours], dash, dasharray)
