"""The plugin interface: everything that a planner sees of the suite, in one file.

A planner is a class with one method, ``plan``. It is found by an entry point of the group
``kbga_bench.planners`` and run by the harness in a process of its own::

    class StraightLine(Planner):
        name = "straight-line"

        def plan(self, scene, query, budget, rng, recorder):
            path = np.array([query.start, query.goal])
            return Plan(PlanStatus.SOLVED, path)

The harness calls ``warm_up`` outside the clock, then ``plan`` inside it; a referee judges the path
afterwards, outside the clock, and believes nothing that the plan claims.

In a dynamic scene the robot plans again and again as it moves. Every planner can: it plans afresh
each time. One that keeps what it knows from one time to the next overrides ``replanner``.
"""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum, nonmember
from typing import Any, ClassVar, Generic

import numpy as np
from numpy.typing import NDArray
from typing_extensions import TypeVar

from suite.errors import ContractError
from suite.scenes.scene import Query, Scene

INTERFACE = 1
"""Version of what this file promises; it rises when a planner written for it would break."""


LARGEST_COUNT = 2**63 - 1
"""Of generations and checks: what a row of a store can hold."""


class PlanStatus(StrEnum):
    """How a run ended, in a word."""

    SOLVED = "solved"
    """A path that the referee accepts."""
    INFEASIBLE = "infeasible"
    """The planner knows that there is no path."""
    EXHAUSTED = "exhausted"
    """The budget or the planner's own stop criterion ended the run without a path."""
    REFUSED = "refused"
    """The planner said beforehand, with a reason, that it can't do this."""
    INVALID = "invalid"
    """The referee rejected the path."""
    ERROR = "error"
    """The planner raised an exception or broke the contract."""
    CRASHED = "crashed"
    """The process of the run died."""
    TIMED_OUT = "timed_out"
    """The harness ended the run at its hard limit."""
    OUT_OF_MEMORY = "out_of_memory"
    """The run needed more memory than it was given."""

    CLAIMABLE = nonmember((SOLVED, INFEASIBLE, EXHAUSTED))
    """What a planner may say of its own run."""
    SUCCESSES = nonmember((SOLVED, INFEASIBLE))
    """A path that the referee accepts, or the right answer that there is none."""
    FAILURES = nonmember((INVALID, ERROR, CRASHED, TIMED_OUT, OUT_OF_MEMORY))
    """Ends that ask for somebody to look; ``run --only-failed`` does them again."""


@dataclass(frozen=True, slots=True)
class Budget:
    """What a run may use; None means no limit. A planner keeps those that it can count."""

    wall_s: float | None = None
    """Seconds of wall time."""
    generations: int | None = None
    """Generations, or iterations, for planners that iterate."""
    checks: int | None = None
    """Questions whether a segment is free, asked of the scene. One that a planner answers from what
    it remembers is a question too: checks mean the same for everybody."""
    cpu_s: float | None = None
    """Seconds of CPU time of the run's process, all its threads together, as ``recorder.cpu_s()``
    counts them. A busy machine stretches the run, and leaves it as much."""

    def __post_init__(self) -> None:
        for name in ("wall_s", "generations", "checks", "cpu_s"):
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise ContractError(f"budget: {name} is {value}. It must be above 0, or left out.")
            if value is not None and name in ("generations", "checks") and value > LARGEST_COUNT:
                raise ContractError(
                    f"budget: {name} is {value}. It must be {LARGEST_COUNT} or less, or left out."
                )


@dataclass(frozen=True, slots=True)
class Abilities:
    """What a planner can do."""

    anytime: bool = False
    """It reports improvements while it runs."""
    deterministic: bool = False
    """It uses no randomness at all."""
    exact: bool = False
    """A ``SOLVED`` path is the shortest one, and it knows when there is none."""
    budgets: frozenset[str] = frozenset()
    """The fields of :class:`Budget` that it keeps."""
    population: bool = False
    """It shows the recorder its population, whenever that asks for a snapshot."""


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """What a planner returns."""

    status: PlanStatus
    """SOLVED, INFEASIBLE or EXHAUSTED; the other words are the harness's."""
    path: NDArray[np.float64] | None = None
    """(n, 2), metres. First row the start, last row the goal. None without a path."""
    claimed_cost: float | None = None
    """The planner's own idea of the path's length, metres."""
    generations: int | None = None
    """Generations or iterations until the run ended."""
    generation_of_best: int | None = None
    """The one in which the returned path was first found."""
    checks: int | None = None
    """Questions asked whether a segment is free, as a budget of checks counts them."""
    details: Mapping[str, float] = field(default_factory=dict)
    """Any further numbers that the planner wants to keep with its row."""
    computed_checks: int | None = None
    """Those checks that were computed; the others were answered from memory. None for a planner
    that remembers none: all of them."""
    reason: str | None = None
    """Why there is no path, in a sentence that is kept with the row; None with a path, or if the
    planner can't tell."""


@dataclass(frozen=True, slots=True)
class Improvement:
    """A better path was found."""

    wall_s: float
    """Seconds of wall time since the clock started."""
    cpu_s: float
    """Seconds of CPU time since then."""
    cost: float
    """Its length, metres."""
    generation: int | None
    checks: int | None


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """A population as it was in one generation."""

    generation: int
    """The first population is number 0."""
    paths: tuple[NDArray[np.float64], ...]
    """Each (n, 2), metres."""
    best: NDArray[np.float64] | None = None
    """The best feasible path so far; None without one."""


class Recorder:
    """Takes what a planner reports while it runs, and stamps it with the run's one clock.

    Parameters
    ----------
    snapshot_of : callable
        Whether a snapshot of a generation is wanted. In measured runs none is: it takes time.
    """

    def __init__(self, *, snapshot_of: Callable[[int], bool] = lambda _: False) -> None:
        self.improvements: list[Improvement] = []
        """Costs falling."""
        self.trace: list[dict[str, float]] = []
        """One row for each generation that the planner chose to describe."""
        self.snapshots: list[Snapshot] = []
        """Of the generations that were asked for."""
        self.wants_snapshot = snapshot_of
        self.start_clock()

    def start_clock(self) -> None:
        """Set the clock to zero. The harness calls it, immediately before ``plan``.

        ``started`` is what ``time.perf_counter`` said then.
        """
        self.started = time.perf_counter()
        self._cpu = time.process_time()

    def wall_s(self) -> float:
        """Seconds of wall time since the clock started."""
        return time.perf_counter() - self.started

    def cpu_s(self) -> float:
        """Seconds of CPU time of this process since the clock started."""
        return time.process_time() - self._cpu

    def improved(
        self, cost: float, *, generation: int | None = None, checks: int | None = None
    ) -> None:
        """Report that a path of this cost (metres) is now the best. Ignored unless it is better."""
        if not self.improvements or cost < self.improvements[-1].cost:
            self.improvements.append(
                Improvement(self.wall_s(), self.cpu_s(), float(cost), generation, checks)
            )

    def describe_generation(self, measures: Mapping[str, float]) -> None:
        """Add one row to the trace, such as best, mean, feasible share and diversity."""
        self.trace.append(dict(measures))

    def snapshot(
        self,
        generation: int,
        paths: Sequence[NDArray[np.float64]],
        best: NDArray[np.float64] | None = None,
    ) -> None:
        """Show a population. Ask ``wants_snapshot(generation)`` before: this ignores the others."""
        if self.wants_snapshot(generation):
            copies = tuple(np.array(path, dtype=np.float64) for path in paths)
            best = None if best is None else np.array(best, dtype=np.float64)
            self.snapshots.append(Snapshot(generation, copies, best))


@dataclass(frozen=True, slots=True)
class NoSettings:
    """Settings of a planner that has none."""


SettingsT = TypeVar("SettingsT", default=Any)
"""Of a planner's settings: in ``class Walk(Planner[WalkSettings])`` self.settings has that type."""


class Planner(ABC, Generic[SettingsT]):
    """Base of all planners. Subclasses set ``name`` and write ``plan``."""

    name: ClassVar[str]
    """The word under which users ask for it; the entry point has the same name."""
    Settings: ClassVar[type[Any]] = NoSettings
    """A frozen dataclass whose fields all have defaults."""
    abilities: ClassVar[Abilities] = Abilities()
    """What it can do."""
    version_files: ClassVar[tuple[str, ...]] = ()
    """Files that belong to its version as its code does, such as weights: names beside the module,
    or of whole folders, written out as a tuple of strings. Rows of others are not rows of it."""
    interface: ClassVar[int] = INTERFACE
    """The version of this file that it is written for. Say it in a plugin that is installed by
    others: one for another version is then refused, with that reason."""

    def __init__(self, settings: SettingsT | None = None) -> None:
        self.settings: SettingsT = self.Settings() if settings is None else settings
        if not isinstance(self.settings, self.Settings):
            raise ContractError(
                f"{self.name}: settings are {type(settings).__name__}, "
                f"not {self.Settings.__name__}."
            )

    @abstractmethod
    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,
        rng: np.random.Generator,
        recorder: Recorder,
    ) -> Plan:
        """Look for a short path from start to goal.

        Parameters
        ----------
        scene : Scene
            The room and its obstacles as shapely polygons (``scene.workspace``,
            ``scene.obstacles[0].polygon``), its box (``scene.bounds``), and arrays for the
            kernels: ``suite.geometry.kernels.first_collision(path, scene.arrays)`` is -1 if a
            path is free, and otherwise the number of its first segment that is not.
        query : Query
            Start and goal, (2,) float64, metres.
        budget : Budget
            What the run may use.
        rng : numpy.random.Generator
            The only source of randomness.
        recorder : Recorder
            To be told of each better path.

        Returns
        -------
        Plan
        """

    def warm_up(self) -> None:
        """Compile and import whatever the first ``plan`` would; called outside the clock."""

    def replanner(self, rng: np.random.Generator) -> "Replanner":
        """Something that plans anew while the robot moves; by default it plans afresh each time.

        Parameters
        ----------
        rng : numpy.random.Generator
            The only source of randomness, for the whole run.
        """
        return PlanAfresh(self, rng)

    def refuse(  # the default refuses nothing
        self,
        scene: Scene,  # noqa: ARG002
        query: Query,  # noqa: ARG002
        budget: Budget,  # noqa: ARG002
    ) -> str | None:
        """A sentence that says why this planner can't do this run; None if it can.

        Budgets need not be looked at: see :func:`refusal`.
        """
        return None


def refusal(planner: Planner, scene: Scene, query: Query, budget: Budget) -> str | None:
    """Why a run is not begun, in a sentence; None if it is.

    A planner is not asked where it keeps none of the limits that it is given: it would have more
    than those beside it, and nobody would know. Wall time is watched by the harness.

    Parameters
    ----------
    planner : Planner
    scene, query, budget : as :meth:`Planner.plan` takes them.
    """
    limits = ("generations", "checks", "cpu_s")
    given = [name for name in limits if getattr(budget, name) is not None]
    kept = planner.abilities.budgets
    if budget.wall_s is not None or not given or kept.intersection(given):
        return planner.refuse(scene, query, budget)
    instead = (
        f"Give one that it keeps: {', '.join(sorted(kept))}" if kept else "It keeps none: give none"
    )
    return f"{planner.name} keeps no budget of {' or '.join(given)}. {instead}."


class Replanner(ABC):
    """Plans anew while the robot moves: one object for one run. The clock surrounds each call.

    Both methods take what :meth:`Planner.plan` takes. The scene is static, as the robot knows it
    at that moment; the query leads from where the robot is to the goal, which stays the same.
    """

    @abstractmethod
    def begin(self, scene: Scene, query: Query, budget: Budget, recorder: Recorder) -> Plan:
        """Make the first plan. Called once, before any update."""

    @abstractmethod
    def update(self, scene: Scene, query: Query, budget: Budget, recorder: Recorder) -> Plan:
        """Plan from where the robot is now, in what it knows now.

        ``scene`` is the same object as in the call before if nothing that the robot knows has
        changed. Without a path in the plan, the robot keeps its old one if that is free, or waits.
        """


class PlanAfresh(Replanner):
    """Any planner as a replanner: each time it plans as if for the first time.

    Parameters
    ----------
    planner : Planner
    rng : numpy.random.Generator
        Its stream goes on from plan to plan.
    """

    def __init__(self, planner: Planner, rng: np.random.Generator) -> None:
        self._planner = planner
        self._rng = rng

    def begin(self, scene: Scene, query: Query, budget: Budget, recorder: Recorder) -> Plan:
        """Plan."""
        return self._planner.plan(scene, query, budget, self._rng, recorder)

    def update(self, scene: Scene, query: Query, budget: Budget, recorder: Recorder) -> Plan:
        """Plan afresh."""
        return self._planner.plan(scene, query, budget, self._rng, recorder)
