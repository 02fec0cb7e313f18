# ruff: noqa: ARG002, NPY002 (planners take what the contract gives, and some misuse it)
"""Planners that wander, sleep, wait and count: runs that differ, and that take time."""

import gc
import os
import time
import types
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from suite.planner import Abilities, Plan, PlanStatus

from .base import Base


@dataclass(frozen=True)
class WandererSettings:
    reach: float = 1.0


class Wanderer(Base):
    """Goes by a random place: its path is its random stream."""

    name = "wanderer"
    Settings = WandererSettings
    abilities = Abilities(budgets=frozenset({"generations"}))

    def plan(self, scene, query, budget, rng, recorder):
        by = query.start + self.settings.reach * rng.random(2)
        path = np.array([query.start, by, query.start, *self.path(scene, query)[1:]])
        recorder.improved(100.0, generation=1, checks=2)
        recorder.improved(50.0, generation=3, checks=4)
        recorder.describe_generation({"best": 50.0, "mean": 60.0})
        return Plan(
            PlanStatus.SOLVED, path, claimed_cost=1.0, generations=5, generation_of_best=3, checks=9
        )


class Careless(Base):
    """Draws from the global generator."""

    name = "careless"

    def plan(self, scene, query, budget, rng, recorder):
        by = query.start + np.random.random(2)
        path = np.array([query.start, by, query.start, *self.path(scene, query)[1:]])
        return Plan(PlanStatus.SOLVED, path)


class Salted(Base):
    """Goes by a place that the hash of a string decides."""

    name = "salted"

    def plan(self, scene, query, budget, rng, recorder):
        by = query.start + np.random.default_rng(abs(hash("north"))).random(2)
        path = np.array([query.start, by, query.start, *self.path(scene, query)[1:]])
        return Plan(PlanStatus.SOLVED, path)


class CountsLateImports(Base):
    """Says how many modules of the suite were loaded after the fork server was warmed."""

    name = "counts-late-imports"

    def plan(self, scene, query, budget, rng, recorder):
        # The server takes what it has loaded out of the collector's sight.
        seen = [o for o in gc.get_objects() if isinstance(o, types.ModuleType)]
        late = sum(module.__name__.startswith("suite.") for module in seen)
        return Plan(PlanStatus.SOLVED, self.path(scene, query), details={"late": late})


class Sleeper(Base):
    name = "sleeper"

    def misbehave(self):
        time.sleep(0.15)


@dataclass(frozen=True)
class LingersSettings:
    file: str = "pid"
    seconds: float = 4.0


class Lingers(Base):
    """Says in a file which process it is, and sleeps."""

    name = "lingers"
    Settings = LingersSettings

    def misbehave(self):
        Path(self.settings.file).write_text(f"{os.getpid()}.")
        time.sleep(self.settings.seconds)


@dataclass(frozen=True)
class DrowsySettings:
    folder: str = "."


def _have_a_core(recorder):
    """Let this process's clocks go alike from now on, as they do where nobody else wants a core."""
    spent, began = time.process_time(), recorder.started
    time.process_time = lambda: spent + time.perf_counter() - began


class Drowsy(Base):
    """Sleeps when it is run first, as if the machine were busy, and then is awake on an idle one,
    however busy it is."""

    name = "drowsy"
    Settings = DrowsySettings
    abilities = Abilities(budgets=frozenset({"wall_s", "cpu_s"}))

    def plan(self, scene, query, budget, rng, recorder):
        mark = Path(self.settings.folder) / f"{rng.integers(10**9)}.mark"
        if not mark.exists():
            time.sleep(0.1)
            mark.touch()
        else:
            _have_a_core(recorder)
        return Plan(PlanStatus.SOLVED, self.path(scene, query), checks=7, computed_checks=3)
