# ruff: noqa: ARG002, NPY002 (planners take what the contract gives, and some misuse it)
"""Planners that behave as badly as strangers' may, and some that behave well.

The fixture ``hostile`` makes a distribution of them, with metadata like any installed package's.
"""

import ctypes
import gc
import io
import os
import random
import signal
import sys
import threading
import time
import types
from dataclasses import dataclass
from pathlib import Path

import numba
import numpy as np
import psutil
import shapely

from suite.planner import Abilities, Improvement, Plan, Planner, PlanStatus
from suite.scenes.exact import shortest_path
from suite.scenes.scene import make_scene

HANG_S = 3600.0
"""Longer than any test waits: whoever hangs so long is ended by others, or the test fails."""


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


class Careless(_Base):
    """Draws from the global generator."""

    name = "careless"

    def plan(self, scene, query, budget, rng, recorder):
        by = query.start + np.random.random(2)
        path = np.array([query.start, by, query.start, *self.path(scene, query)[1:]])
        return Plan(PlanStatus.SOLVED, path)


class Salted(_Base):
    """Goes by a place that the hash of a string decides."""

    name = "salted"

    def plan(self, scene, query, budget, rng, recorder):
        by = query.start + np.random.default_rng(abs(hash("north"))).random(2)
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


@dataclass(frozen=True)
class DrowsySettings:
    folder: str = "."


def _have_a_core(recorder):
    """Let this process's clocks go alike from now on, as they do where nobody else wants a core."""
    spent, began = time.process_time(), recorder.started
    time.process_time = lambda: spent + time.perf_counter() - began


class Drowsy(_Base):
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


class Raises(_Base):
    name = "raises"

    def misbehave(self):
        raise RuntimeError("no luck today")


class RaisesBaseException(_Base):
    """What ``except Exception`` does not catch."""

    name = "raises-base-exception"

    def misbehave(self):
        raise GeneratorExit


class Interrupts(_Base):
    name = "interrupts"

    def misbehave(self):
        raise KeyboardInterrupt


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
        ctypes.PyDLL(None).sleep(int(HANG_S))


@numba.njit("int64(int64)", nogil=False)
def _endless(number):
    while number >= 0:
        number = (number + 1) % 1000
    return number


class HangsInKernel(_Base):
    """Keeps the GIL too, and sees no signal that Python handles."""

    name = "hangs-in-kernel"

    def misbehave(self):
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        _endless(1)


class HangsInWarmUp(_Base):
    name = "hangs-in-warm-up"

    def warm_up(self):
        time.sleep(HANG_S)


class ExitsInWarmUp(_Base):
    name = "exits-in-warm-up"

    def warm_up(self):
        os._exit(4)


class Forks(_Base):
    """Leaves a child that lives longer, and holds all pipes open."""

    name = "forks"

    def misbehave(self):
        if os.fork() == 0:
            time.sleep(HANG_S)
            os._exit(0)


def _go_away(then=lambda: time.sleep(HANG_S)):
    """A daemon, as the book has it: fork, leave session and terminal, fork again, let go."""
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            os.closerange(0, 256)
            then()
        os._exit(0)


class Daemonizes(_Base):
    name = "daemonizes"

    def misbehave(self):
        _go_away()
        os.wait()


class DaemonizesInWarmUp(_Base):
    """And so in the fork server, too."""

    name = "daemonizes-in-warm-up"

    def warm_up(self):
        super().warm_up()
        _go_away()


class DaemonizesAndDies(_Base):
    name = "daemonizes-and-dies"

    def misbehave(self):
        _go_away()
        os.wait()
        ctypes.string_at(0)


class DaemonizesAndHangs(_Base):
    name = "daemonizes-and-hangs"

    def misbehave(self):
        _go_away()
        while True:
            pass


class LeavesItsSessionAndHangs(_Base):
    """In a child that keeps all descriptors."""

    name = "leaves-its-session-and-hangs"

    def misbehave(self):
        if os.fork() == 0:
            os.setsid()
            time.sleep(HANG_S)
        while True:
            pass


class KillsItsParent(_Base):
    name = "kills-its-parent"

    def misbehave(self):
        os.kill(os.getppid(), signal.SIGKILL)
        time.sleep(HANG_S)


class ComesBackTwice(_Base):
    """Forks, and lets the child go on as if it were the planner."""

    name = "comes-back-twice"

    def misbehave(self):
        os.fork()


class Prints(_Base):
    """100 MB to standard output, and as much to standard error."""

    name = "prints"

    def misbehave(self):
        for _ in range(100):
            os.write(1, b"x" * 1_000_000)
            os.write(2, b"y" * 1_000_000)


class TakesStandardOutput(_Base):
    """Prints as Python does and as C does, and then puts something else there."""

    name = "takes-standard-output"

    def misbehave(self):
        print("iteration 1")  # noqa: T201
        os.write(1, b"iteration 2\n")
        sys.stdout = io.StringIO()


class PrintsIntoPipes(_Base):
    """Into every descriptor that is open for writing."""

    name = "prints-into-pipes"

    def misbehave(self):
        for descriptor in range(3, 256):
            try:
                os.write(descriptor, b"garbage, and not a little of it\n")
            except OSError:
                continue


class PrintsALittleIntoPipes(_Base):
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


class ClosesDescriptors(_Base):
    name = "closes-descriptors"

    def misbehave(self):
        os.closerange(0, 256)


class LeavesThreads(_Base):
    """Not daemonic: Python would wait for them."""

    name = "leaves-threads"

    def misbehave(self):
        for _ in range(3):
            threading.Thread(target=time.sleep, args=(HANG_S,)).start()


class ChangesSignals(_Base):
    name = "changes-signals"

    def misbehave(self):
        for number in set(signal.Signals) - {signal.SIGKILL, signal.SIGSTOP}:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())


class ChangesTheWorld(_Base):
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


class LooksAround(_Base):
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


class ChangesTheScene(_Base):
    name = "changes-the-scene"

    def plan(self, scene, query, budget, rng, recorder):
        query.goal[:] = query.start
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))


class MovesTheGoal(_Base):
    """Not by mistake."""

    name = "moves-the-goal"

    def plan(self, scene, query, budget, rng, recorder):
        query.goal.setflags(write=True)
        query.goal[:] = query.start + 0.1
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))


class ChangesObstacles(_Base):
    name = "changes-obstacles"

    def plan(self, scene, query, budget, rng, recorder):
        scene.obstacles = ()
        return Plan(PlanStatus.SOLVED, np.array([query.start, query.goal]))


class ReturnsNone(_Base):
    name = "returns-none"

    def plan(self, scene, query, budget, rng, recorder):
        return None


class Generates(_Base):
    """Its plan is a generator function, by one ``yield`` too many."""

    name = "generates"

    def plan(self, scene, query, budget, rng, recorder):
        yield Plan(PlanStatus.SOLVED, self.path(scene, query))


class ReturnsAGenerator(_Base):
    name = "returns-a-generator"

    def path(self, scene, query):
        return (point for point in (query.start, query.goal))


class ReturnsAWrongShape(_Base):
    name = "returns-a-wrong-shape"

    def path(self, scene, query):
        return np.zeros((4, 3))


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
    """And needs no time to get ready."""

    name = "gives-up"

    def warm_up(self):
        pass

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


def _eat():
    """As fast as the processor fills pages, in C: Python's part in it is small."""
    eaten = []
    while True:
        eaten.append(np.ones(1 << 24))


class EatsAllMemory(_Base):
    name = "eats-all-memory"

    def misbehave(self):
        os.write(2, b"hungry\n")
        _eat()


class LetsADaemonEat(_Base):
    """Sits by while a process that left it takes the memory."""

    name = "lets-a-daemon-eat"

    def misbehave(self):
        _go_away(_eat)
        time.sleep(HANG_S)


class EatsInWarmUp(_Base):
    name = "eats-in-warm-up"

    def warm_up(self):
        _eat()


class ReportsAsNumpyDoes(_Base):
    """Hands over what sums and means of arrays are: other types, and NaN before the first path."""

    name = "reports-as-numpy-does"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.describe_generation({"best": np.inf, "mean": np.float32("nan"), "n": np.int64(1)})
        recorder.improved(np.float32(50.0), generation=np.int64(1), checks=np.int32(2))
        count = np.int64(3)
        return Plan(PlanStatus.SOLVED, self.path(scene, query), None, count, count, count)


class ReportsNan(_Base):
    name = "reports-nan"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.improved(float("nan"))
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


class DescribesInWords(_Base):
    name = "describes-in-words"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.describe_generation({"phase": "repair"})
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


class Backdates(_Base):
    """Writes its improvements itself, from before the run."""

    name = "backdates"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.improvements.append(Improvement(-1.0, 0.0, 50.0, None, None))
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


class RestartsTheClock(_Base):
    """Begins to count when its preparations are over."""

    name = "restarts-the-clock"

    def plan(self, scene, query, budget, rng, recorder):
        recorder.start_clock()
        return Plan(PlanStatus.SOLVED, self.path(scene, query))


class CountsBeyondMeasure(_Base):
    name = "counts-beyond-measure"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.SOLVED, self.path(scene, query), checks=10**30)


class ComputesMoreThanItAsks(_Base):
    name = "computes-more-than-it-asks"

    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.SOLVED, self.path(scene, query), checks=3, computed_checks=4)


class SaysHalfACharacter(_Base):
    """Names a file whose name is not text."""

    name = "says-half-a-character"

    def misbehave(self):
        raise RuntimeError(os.fsdecode(b"no \xff file"))


class WrongSignature(_Base):
    name = "wrong-signature"

    def plan(self, scene, query):
        return Plan(PlanStatus.EXHAUSTED)


class NewerInterface(_Base):
    name = "newer-interface"
    interface = 2


class NoPlan(Planner):
    name = "no-plan"
