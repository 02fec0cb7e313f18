"""Random numbers for the compiled code, drawn from the run's generator in blocks.

A kernel that is handed a generator has to count references to it, and takes 14 us to unpack it,
each time that it is called. A block is an array like any other; and the numbers are those that the
generator would have given one by one.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from suite.jit import inlined_kernel, kernel

LEAST_BLOCK = 2048
"""Numbers that are drawn at once at the least: a generation takes about half as many."""


class Draws(NamedTuple):
    """A block of random numbers.

    values : (N,) float64, uniform in [0, 1).
    position : (1,) int64, of the next one.
    """

    values: NDArray[np.float64]
    position: NDArray[np.int64]


def make_draws(rng: np.random.Generator, size: int) -> Draws:
    """A full block."""
    return Draws(rng.random(size), np.zeros(1, np.int64))


def refill(draws: Draws, rng: np.random.Generator) -> None:
    """Fill the block up again. What is left of it comes first: no number is lost."""
    values, position = draws
    left = len(values) - int(position[0])
    values[:left] = values[len(values) - left :].copy()
    values[left:] = rng.random(len(values) - left)
    position[0] = 0


@kernel
def left_of(draws: Draws) -> int:
    """How many numbers are left."""
    return draws.values.size - draws.position[0]


@inlined_kernel
def draw(draws: Draws) -> float:
    """The next number. There must be one: whoever draws sees to it before, for all that follow."""
    position = draws.position[0]
    draws.position[0] = position + 1
    return draws.values[position]
