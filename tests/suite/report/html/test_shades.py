"""Letters are read on every colour of the scale, and a worse number is darker."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex

from suite.report.figures.style import NOTHING, colouring
from suite.report.html.cells import sheet
from suite.report.html.shades import contrast, ink_on, shaded
from suite.report.table import Table


def test_the_rule_of_contrast_is_that_of_the_standard():
    # Published examples: grey #767676 is the lightest that passes on white.
    assert contrast("#767676", "#ffffff") == pytest.approx(4.54, abs=0.005)
    assert contrast("#777777", "#ffffff") < 4.5
    assert contrast("#ffffff", "#767676") == contrast("#767676", "#ffffff")


def test_on_every_colour_of_the_scale_the_letters_are_read():
    colours, _ = colouring(np.array([1.0]), 0.01)
    grounds = [to_hex(colours(share)) for share in np.linspace(0.0, 1.0, 256)]
    assert min(contrast(ink_on(ground), ground) for ground in [*grounds, NOTHING]) >= 4.5


def test_worse_is_darker_what_is_missing_is_grey_and_other_columns_stay():
    texts = pd.DataFrame({"planner": ["a", "b", "c"], "zigzag": ["0.00", "50", "0 of 2"]})
    numbers = pd.DataFrame({"zigzag": [0.0, 50.0, np.nan]})
    found = shaded(sheet(Table("gaps", "Gaps", texts)), numbers, 0.01)
    assert [row[0].style for row in found.rows] == [""] * 3
    grounds = [row[1].style.split(";")[0].removeprefix("background:") for row in found.rows]
    light, dark, grey = (contrast(ground, "#000000") for ground in grounds)
    assert light > dark
    assert grounds[2] == NOTHING
    assert grey > dark
