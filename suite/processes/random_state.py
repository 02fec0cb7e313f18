"""The generators of random numbers that a process shares: for plugins that draw from them."""

import random

import numpy as np
from numpy.random import mtrand


def seed_globals(seed: int) -> None:
    """Seed the global generators of ``random`` and numpy: who draws from them still repeats itself.

    Parameters
    ----------
    seed : int
        Not negative, of any size.
    """
    random.seed(seed)
    # Of the kind that numpy starts with: a plugin's own np.random.seed then still works.
    mtrand.set_bit_generator(np.random.MT19937(np.random.SeedSequence(seed)))
