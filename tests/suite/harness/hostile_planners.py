# ruff: noqa: ARG002, NPY002 (planners take what the contract gives, and some misuse it)
"""Planners that behave as badly as strangers' may, and some that behave well.

The fixture ``hostile`` makes a distribution of them, with metadata like any installed package's.
"""

import ctypes
import gc
import os
import signal
import sys
import time
import types
from dataclasses import dataclass

import numpy as np
import shapely

from suite.exact import shortest_path
from suite.planner import Plan, Planner, PlanStatus
from suite.scene import make_scene


class _Base(Planner):
    def warm_up(self):
        scene = make_scene("tiny", shapely.box(0, 0, 1, 1), [], {"main": ((0, 0), (1, 1))})
        shortest_path(scene, scene.query())

    def path(self, scene, query):
        return shortest_path(scene, query).path

    def plan(self, scene, query, budget, rng, recorder):
        self.misbehave()
        return Plan(PlanStatus.SOLVED, self.path(scene, query))

    def misbehave(self):
        pass


@dataclass(frozen=True)
class WandererSettings:
    reach: float = 1.0


class Wanderer(_Base):
    """Goes by a random place: its path is its random stream."""

    name = "wanderer"
    Settings = WandererSettings

    def plan(self, scene, query, budget, rng, recorder):
        by = query.start + self.settings.reach * rng.random(2)
        path = np.array([query.start, by, query.start, *self.path(scene, query)[1:]])
        recorder.improved(100.0, generation=1, checks=2)
        recorder.improved(50.0, generation=3, checks=4)
        recorder.describe_generation({"best": 50.0, "mean": 60.0})
        return Plan(
            PlanStatus.SOLVED, path, claimed_cost=1.0, generations=5, generation_of_best=3, checks=9
        )


class Careless(_Base):
    """Draws from the global generator."""

    name = "careless"

    def plan(self, scene, query, budget, rng, recorder):
        by = query.start + np.random.random(2)
        path = np.array([query.start, by, query.start, *self.path(scene, query)[1:]])
        return Plan(PlanStatus.SOLVED, path)


class CountsLateImports(_Base):
    """Says how many modules of the suite were loaded after the fork server was warmed."""

    name = "counts-late-imports"

    def plan(self, scene, query, budget, rng, recorder):
        # The server takes what it has loaded out of the collector's sight.
        seen = [o for o in gc.get_objects() if isinstance(o, types.ModuleType)]
        late = sum(module.__name__.startswith("suite.") for module in seen)
        return Plan(PlanStatus.SOLVED, self.path(scene, query), details={"late": late})


class Sleeper(_Base):
    name = "sleeper"

    def misbehave(self):
        time.sleep(0.15)


class Raises(_Base):
    name = "raises"

    def misbehave(self):
        raise RuntimeError("no luck today")


class SystemExits(_Base):
    name = "system-exits"

    def misbehave(self):
        sys.exit(3)


class Exits(_Base):
    name = "exits"

    def misbehave(self):
        os.write(2, b"going down\n")
        os._exit(3)


class Segfaults(_Base):
    name = "segfaults"

    def misbehave(self):
        ctypes.string_at(0)


class Hangs(_Base):
    name = "hangs"

    def misbehave(self):
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        while True:
            pass


class HangsInC(_Base):
    """Keeps the GIL."""

    name = "hangs-in-c"

    def misbehave(self):
        ctypes.PyDLL(None).sleep(60)


class HangsInWarmUp(_Base):
    name = "hangs-in-warm-up"

    def warm_up(self):
        time.sleep(60)


class ExitsInWarmUp(_Base):
    name = "exits-in-warm-up"

    def warm_up(self):
        os._exit(4)


class Forks(_Base):
    """Leaves a child that lives longer, and holds all pipes open."""

    name = "forks"

    def misbehave(self):
        if os.fork() == 0:
            time.sleep(60)
            os._exit(0)


class Prints(_Base):
    name = "prints"

    def misbehave(self):
        for _ in range(100):
            os.write(1, b"x" * 65536)
            os.write(2, b"y" * 65536)


class ReturnsNone(_Base):
    name = "returns-none"

    def plan(self, scene, query, budget, rng, recorder):
        return None


class ReturnsNoPath(_Base):
    name = "returns-no-path"

    def path(self, scene, query):
        return None


class ReturnsNaN(_Base):
    name = "returns-nan"

    def path(self, scene, query):
        return np.array([query.start, [np.nan, 1.0], query.goal])


class ReturnsText(_Base):
    name = "returns-text"

    def path(self, scene, query):
        return "left, then right"


class Cheats(_Base):
    """Goes straight on."""

    name = "cheats"

    def path(self, scene, query):
        return np.array([query.start, query.goal])


class SaysCrashed(_Base):
    name = "says-crashed"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.CRASHED)


class GivesUp(_Base):
    name = "gives-up"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.EXHAUSTED, claimed_cost=1234.5, generations=7, generation_of_best=2)


class ClaimsInfeasible(_Base):
    name = "claims-infeasible"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.INFEASIBLE)


class Refuses(_Base):
    name = "refuses"

    def refuse(self, scene, query, budget):
        return "not on a Monday"


class EatsMemory(_Base):
    name = "eats-memory"

    def misbehave(self):
        raise MemoryError
