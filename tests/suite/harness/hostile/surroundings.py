# ruff: noqa: ARG002, NPY002 (planners take what the contract gives, and some misuse it)
"""Planners that write where they should not, and change the process they are in."""

import gc
import io
import os
import random
import signal
import sys
import threading
import time
from pathlib import Path

import numba
import numpy as np
import psutil

from suite.planner import Plan, PlanStatus

from .base import HANG_S, Base


class Prints(Base):
    """100 MB to standard output, and as much to standard error."""

    name = "prints"

    def misbehave(self):
        for _ in range(100):
            os.write(1, b"x" * 1_000_000)
            os.write(2, b"y" * 1_000_000)


class TakesStandardOutput(Base):
    """Prints as Python does and as C does, and then puts something else there."""

    name = "takes-standard-output"

    def misbehave(self):
        print("iteration 1")  # noqa: T201
        os.write(1, b"iteration 2\n")
        sys.stdout = io.StringIO()


class PrintsIntoPipes(Base):
    """Into every descriptor that is open for writing."""

    name = "prints-into-pipes"

    def misbehave(self):
        for descriptor in range(3, 256):
            try:
                os.write(descriptor, b"garbage, and not a little of it\n")
            except OSError:
                continue


class PrintsALittleIntoPipes(Base):
    """So that a reader waits for more."""

    name = "prints-a-little-into-pipes"

    def misbehave(self):
        for descriptor in range(3, 256):
            try:
                os.write(descriptor, b"\0\1")
            except OSError:
                continue
        while True:
            pass


class ClosesDescriptors(Base):
    name = "closes-descriptors"

    def misbehave(self):
        os.closerange(0, 256)


class LeavesThreads(Base):
    """Not daemonic: Python would wait for them."""

    name = "leaves-threads"

    def misbehave(self):
        for _ in range(3):
            threading.Thread(target=time.sleep, args=(HANG_S,)).start()


class ChangesSignals(Base):
    name = "changes-signals"

    def misbehave(self):
        for number in set(signal.Signals) - {signal.SIGKILL, signal.SIGSTOP}:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())


class ChangesTheWorld(Base):
    """All that a process has of its own, and the next run must not notice."""

    name = "changes-the-world"

    def misbehave(self):
        np.random.seed(1)
        np.random.random(7)
        random.seed(1)
        os.chdir("/")
        os.environ.clear()
        os.environ["OMP_NUM_THREADS"] = "64"
        os.umask(0o777)
        sys.path.clear()
        np.seterr(all="raise")
        gc.disable()
        np.pi = 3.0


class LooksAround(Base):
    """Says in its details what it finds, for the tests."""

    name = "looks-around"

    def plan(self, scene, query, budget, rng, recorder):
        np.ones((400, 400)) @ np.ones((400, 400))
        details = {
            "random": random.random(),
            "numpy_random": np.random.random(),
            "folder": hash(str(Path.cwd())),
            "environment": hash(tuple(sorted(os.environ.items()))),
            "pi": np.pi,
            "cores": len(os.sched_getaffinity(0)),
            "core": min(os.sched_getaffinity(0)),
            "numba_threads": numba.get_num_threads(),
            "threads": psutil.Process().num_threads(),
        }
        return Plan(PlanStatus.SOLVED, self.path(scene, query), details=details)
