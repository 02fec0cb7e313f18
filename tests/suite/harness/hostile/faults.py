# ruff: noqa: ARG002 (planners take what the contract gives, and some misuse it)
"""What the table of faults is made with: huge answers, and planners that go at the harness."""

import atexit
import os
import signal
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from suite.planner import Plan, PlanStatus

from .base import Base


class ImprovesWithoutEnd(Base):
    """A million times."""

    name = "improves-without-end"

    def plan(self, scene, query, budget, rng, recorder):
        for number in range(1_000_000):
            recorder.improved(2e6 - number)
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


def _staircase(query, points):
    """Round the wall of the tests' scene, by so many points."""
    corners = np.array([query.start, (1.0, 9.0), (9.0, 9.0), query.goal])
    at = np.linspace(0.0, 3.0, points)
    return np.column_stack([np.interp(at, range(4), corners[:, axis]) for axis in (0, 1)])


class GoesByAMillionPoints(Base):
    name = "goes-by-a-million-points"

    def path(self, scene, query):
        return _staircase(query, 1_000_000)


class SendsMegabytes(Base):
    """Its path has 100 of them: the points are few, and often repeated."""

    name = "sends-megabytes"

    def path(self, scene, query):
        return np.repeat(_staircase(query, 4), 1_562_500, axis=0)


class SendsTooMuch(Base):
    """More than the harness takes in one message: of points that are all the start."""

    name = "sends-too-much"

    def path(self, scene, query):
        return np.tile(query.start, (18_000_000, 1))


class ComplainsWithoutEnd(Base):
    """In 100 MB of words."""

    name = "complains-without-end"

    def misbehave(self):
        raise RuntimeError("no " * 33_000_000 + "luck")


class StartsManyThreads(Base):
    """500, which live longer than the plan."""

    name = "starts-many-threads"

    def misbehave(self):
        for _ in range(500):
            threading.Thread(target=time.sleep, args=(60,)).start()


class HangsAtExit(Base):
    name = "hangs-at-exit"

    def misbehave(self):
        atexit.register(time.sleep, 60)


class HangsAtExitOfTheServer(Base):
    """And so in the process that all runs are forked from."""

    name = "hangs-at-exit-of-the-server"

    def warm_up(self):
        super().warm_up()
        atexit.register(time.sleep, 60)


class LeavesAThreadInWarmUp(Base):
    """Not daemonic, so Python waits for it; in the process, too, that all runs are forked from."""

    name = "leaves-a-thread-in-warm-up"

    def warm_up(self):
        super().warm_up()
        threading.Thread(target=time.sleep, args=(60,)).start()


@dataclass(frozen=True)
class DeletesSettings:
    pattern: str = ""


class Deletes(Base):
    """Cleans up behind itself, and more than it made."""

    name = "deletes"
    Settings = DeletesSettings

    def misbehave(self):
        place = Path(self.settings.pattern)
        for file in sorted(place.parent.glob(place.name)):
            file.unlink(missing_ok=True)


class StopsItsParent(Base):
    name = "stops-its-parent"

    def misbehave(self):
        os.kill(os.getppid(), signal.SIGSTOP)


class StopsItself(Base):
    name = "stops-itself"

    def misbehave(self):
        os.kill(os.getpid(), signal.SIGSTOP)


class RecursesWithoutEnd(Base):
    name = "recurses-without-end"

    def misbehave(self):
        self.misbehave()


class OverflowsTheStack(Base):
    """Through C, with Python's guard taken off."""

    name = "overflows-the-stack"

    def misbehave(self):
        sys.setrecursionlimit(2**30)
        max([0], key=lambda _: self.misbehave())


class LeavesManyChildren(Base):
    name = "leaves-many-children"

    def misbehave(self):
        for _ in range(100):
            if os.fork() == 0:
                os.setsid()
                time.sleep(60)
                os._exit(0)


class AsksTheUser(Base):
    """Reads from the keyboard."""

    name = "asks-the-user"

    def misbehave(self):
        input("Which way? ")
