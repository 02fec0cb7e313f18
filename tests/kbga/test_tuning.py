"""Tuning of the operators' probabilities: within bounds, and towards what each of them achieves."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kbga.settings import KBGASettings
from kbga.tuning import (
    CEILING,
    CROSSOVER,
    DELETION,
    FLOOR,
    IMPROVEMENT,
    MUTATION,
    REPAIR,
    Rates,
    empty_tally,
    note,
    rates_of,
    tuned,
)

OPERATORS = {
    CROSSOVER: "crossover",
    MUTATION: "mutation",
    REPAIR: "repair",
    DELETION: "deletion",
    IMPROVEMENT: "improvement",
}
PAPER = rates_of(KBGASettings())
SHARE = st.floats(0.0, 1.0)
ROUNDING = 1e-12


def tally_of(*counts: tuple[int, int]) -> np.ndarray:
    """Fired and helped, of crossover, mutation, repair, deletion and improvement."""
    return np.array(counts, dtype=np.int64)


def probabilities(rates: Rates) -> list[float]:
    return [getattr(rates, name) for name in OPERATORS.values()]


@st.composite
def tallies(draw: st.DrawFn) -> np.ndarray:
    fired = draw(st.lists(st.integers(0, 10**6), min_size=5, max_size=5))
    return tally_of(*((n, draw(st.integers(0, n))) for n in fired))


def test_an_operator_s_row_of_the_tally_is_its_place_among_the_rates():
    for operator, name in OPERATORS.items():
        assert Rates._fields[operator] == name


def test_a_firing_helped_if_the_cost_is_lower_after():
    tally = empty_tally()
    for known, new in ((5.0, 4.0), (5.0, 5.0), (5.0, 6.0)):
        note(tally, REPAIR, known, new)
    assert tally.tolist() == [[0, 0], [0, 0], [3, 1], [0, 0], [0, 0]]


@given(st.lists(SHARE, min_size=5, max_size=5), tallies(), SHARE)
def test_probabilities_stay_probabilities_whatever_the_tally(now, tally, rate):
    rates = PAPER._replace(**dict(zip(OPERATORS.values(), now, strict=True)))
    after = tuned(rates, tally, rate)
    for old, new in zip(now, probabilities(after), strict=True):
        assert 0.0 <= new <= 1.0
        assert min(old, FLOOR) - ROUNDING <= new <= max(old, CEILING) + ROUNDING
        assert (new == 0.0) == (old == 0.0), "what is off stays off, and nothing else goes off"
    assert after[5:] == rates[5:], "the rest of the settings stays"
    assert all(type(p) is float for p in probabilities(after)), "or the kernels compile again"


@given(st.lists(SHARE, min_size=5, max_size=5), tallies())
def test_at_a_rate_of_0_nothing_changes(now, tally):
    rates = PAPER._replace(**dict(zip(OPERATORS.values(), now, strict=True)))
    assert tuned(rates, tally, 0.0) == rates


def test_where_nothing_helped_nothing_changes():
    assert tuned(PAPER, tally_of(*[(10, 0)] * 5), 0.5) == PAPER
    assert tuned(PAPER, empty_tally(), 0.5) == PAPER


def test_the_best_earner_tends_to_the_ceiling_and_one_that_never_helps_to_the_floor():
    rates = PAPER
    for _ in range(200):
        rates = tuned(rates, tally_of((10, 0), (40, 20), (10, 5), (8, 2), (10, 0)), 0.1)
    wanted = [FLOOR, CEILING, CEILING, (FLOOR + CEILING) / 2, FLOOR]
    assert probabilities(rates) == pytest.approx(wanted)


def test_at_a_rate_of_1_a_probability_is_at_its_target_at_once():
    rates = tuned(PAPER, tally_of((10, 0), (10, 1), (10, 2), (10, 4), (10, 0)), 1.0)
    assert probabilities(rates) == pytest.approx([0.1, 0.3, 0.5, 0.9, 0.1])


def test_an_operator_that_nothing_called_for_keeps_its_probability():
    rates = tuned(PAPER, tally_of((10, 1), (10, 1), (0, 0), (10, 1), (10, 1)), 0.5)
    assert rates.repair == PAPER.repair
