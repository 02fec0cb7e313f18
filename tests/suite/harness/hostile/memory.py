"""Planners that take more memory than they may."""

import os
import time

import numpy as np

from .base import HANG_S, Base, go_away


class EatsMemory(Base):
    name = "eats-memory"

    def misbehave(self):
        raise MemoryError


def _eat():
    """As fast as the processor fills pages, in C: Python's part in it is small."""
    eaten = []
    while True:
        eaten.append(np.ones(1 << 24))


class EatsAllMemory(Base):
    name = "eats-all-memory"

    def misbehave(self):
        os.write(2, b"hungry\n")
        _eat()


class LetsADaemonEat(Base):
    """Sits by while a process that left it takes the memory."""

    name = "lets-a-daemon-eat"

    def misbehave(self):
        go_away(_eat)
        time.sleep(HANG_S)


class EatsInWarmUp(Base):
    name = "eats-in-warm-up"

    def warm_up(self):
        _eat()
