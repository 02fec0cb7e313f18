"""Probabilities of the operators, and their tuning while a run goes on (future work in paper V).

The paper leaves open how. Ours is the simplest of adaptive operator selection: each generation an
operator earns the share of its firings that made a chromosome cost less, and its probability moves
towards its earnings relative to the best earner's (probability matching with a floor; Goldberg
1990, Thierens 2005).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kbga.settings import KBGASettings
from suite.jit import kernel


class Rates(NamedTuple):
    """The settings that the compiled code reads; see :class:`kbga.settings.KBGASettings`."""

    crossover: float
    mutation: float
    repair: float
    deletion: float
    improvement: float
    tournament_size: int
    penalty: float
    repair_candidates: int
    repair_limit: float
    repair_must_help: bool
    improvement_radius: int
    rounds: int
    one_operator: bool
    remembers: bool


def rates_of(settings: KBGASettings) -> Rates:
    """What the compiled code reads of the settings."""
    # Of one type each: an int among the floats would have the kernels compiled once more.
    return Rates(
        float(settings.crossover_probability),
        float(settings.mutation_probability),
        float(settings.repair_probability),
        float(settings.deletion_probability),
        float(settings.improvement_probability),
        int(settings.tournament_size),
        float(settings.penalty),
        int(settings.repair_candidates),
        float(settings.repair_limit),
        bool(settings.repair_must_help),
        int(settings.improvement_radius),
        int(settings.rounds),
        bool(settings.one_operator),
        bool(settings.remembers),
    )


CROSSOVER, MUTATION, REPAIR, DELETION, IMPROVEMENT = range(5)
"""The operators: rows of a tally, and fields of :class:`Rates`."""

FIRED, HELPED = range(2)
"""Columns of a tally: how often an operator was fired, and how often the cost was lower after."""

FLOOR = 0.1
"""No probability falls below this, for an operator that never fires can't show that it helps."""

CEILING = 0.9
"""What the best earner's probability moves to: the paper's for all operators but mutation."""


def empty_tally() -> NDArray[np.int64]:
    """A tally of nothing yet: (5, 2) int64."""
    return np.zeros((5, 2), np.int64)


@kernel
def note(tally: np.ndarray, operator: int, known: float, new: float) -> None:
    """Note that an operator was fired, and whether the cost is lower than before."""
    tally[operator, FIRED] += 1
    tally[operator, HELPED] += new < known


def tuned(rates: Rates, tally: NDArray[np.int64], adaptation_rate: float) -> Rates:
    """The probabilities for the next generation.

    Parameters
    ----------
    rates : Rates
        An operator of probability 0 is switched off, and stays so. One that was not fired, as no
        chromosome called for it, keeps its probability.
    tally : (5, 2) int64
        Of the generation that has ended.
    adaptation_rate : float, in [0, 1]
        How much of the way to its target a probability goes at once.
    """
    fired = tally[:, FIRED]
    earned = tally[:, HELPED] / np.maximum(fired, 1)
    best = earned.max()
    if best == 0.0:
        return rates
    target = FLOOR + (CEILING - FLOOR) * earned / best
    now = np.array(rates[: len(target)])
    judged = (now > 0.0) & (fired > 0)
    moved = np.where(judged, now + adaptation_rate * (target - now), now)
    return rates._replace(**dict(zip(Rates._fields, moved.tolist(), strict=False)))
