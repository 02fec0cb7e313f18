"""What is to be run, and what came of it: the two nouns that harness, store and reports share."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from suite.planner import Budget, Improvement, PlanStatus, Snapshot
from suite.scenes.scene import DEFAULT_QUERY
from suite.typed import plain

MOST_LETTERS = 10_000
"""Of the reason of a row: a traceback has a tenth of them."""


@dataclass(frozen=True, slots=True, eq=False)
class World:
    """The world that a robot drives through while the planner plans again and again.

    name : of these settings, in tables.
    settings : all fields of :class:`suite.simulation.settings.WorldSettings`, as plain data.
    cold : plan afresh at every update, though the planner may have a replanner of its own.
    """

    name: str
    settings: Mapping[str, Any]
    cold: bool = False


@dataclass(frozen=True, eq=False)
class Cell:
    """One run that is wanted: a query of a scene, a planner variant, a budget and a seed.

    scene : name of the scene; part of the random stream.
    scene_source : what :func:`suite.scenes.catalogue.load_scene` takes: a catalogue name or a path.
    scene_hash : :func:`suite.scenes.scene.scene_fingerprint` of the scene and the query.
    query : name of the query.
    variant : name of the planner with these settings; part of the random stream.
    planner : name of the plugin.
    distribution, version : the package that the plugin comes from.
    settings : all settings of the planner, as plain data.
    budget : what the run may use; in a dynamic world each single plan.
    seed : int, 0 or more.
    world : of a run that is simulated; None if the scene stands still and is planned in once.
    position : place in its matrix; tables keep that order. The outcome does not depend on it.
    """

    scene: str
    scene_source: str
    scene_hash: str
    query: str
    variant: str
    planner: str
    distribution: str
    version: str
    settings: Mapping[str, Any]
    budget: Budget
    seed: int
    world: World | None = None
    position: int = 0

    @property
    def label(self) -> str:
        """Short name of the cell for people."""
        world = self.world.name if self.world is not None else ""
        query = self.query if self.query != DEFAULT_QUERY else ""
        parts = (self.scene, query, world, self.variant, f"seed {self.seed}")
        return " / ".join(filter(None, parts))

    @property
    def time_counts(self) -> bool:
        """Whether the outcome depends on how fast the machine is: no two runs need be the same.

        So it is if the budget is of time, or if the time that planning takes moves the world on.
        """
        return self.load_counts or self.budget.cpu_s is not None

    @property
    def load_counts(self) -> bool:
        """Whether the outcome depends on what else the machine does: a busy one has less to give.

        So it does where wall time ends the run or moves the world on; not where CPU time does.
        """
        is_charged = self.world is not None and self.world.settings.get("charge") == "measured"
        return is_charged or self.budget.wall_s is not None

    @property
    def budget_as_dict(self) -> dict[str, float | int | None]:
        """The budget as plain data."""
        budget = self.budget
        data: dict[str, float | int | None] = {
            # 1 and 1.0 are the same budget; a store knows the second only.
            "wall_s": None if budget.wall_s is None else float(budget.wall_s),
            "generations": budget.generations,
            "checks": budget.checks,
        }
        # Only where it is given: the keys of rows that were made before there was such a budget
        # stay what they are.
        return data if budget.cpu_s is None else data | {"cpu_s": float(budget.cpu_s)}

    @cached_property
    def key(self) -> str:
        """Hash of everything that the outcome depends on: the row's identity in a store.

        The names of scene, query and variant are in it because they choose the random stream.
        """
        content: list[Any] = [
            self.scene_hash,
            self.scene,
            self.query,
            self.variant,
            self.planner,
            self.version,
            self.settings,
            self.budget_as_dict,
            self.seed,
        ]
        if self.world is not None:
            content.append(plain(self.world))
        return short_hash(content)


@dataclass(frozen=True, slots=True, eq=False)
class RunRecord:
    """One run that was attempted.

    In a simulated run the path is the way that the robot went: cost is its length, optimum the
    length that it would have if the robot had followed the exact shortest path at each update;
    generations, checks and seconds are the sums over all plans.

    cell : what was run.
    status : how it ended.
    reason : why it ended so, where that is not plain: a refusal, the referee's objection, what the
        planner says of there being no path, the end of a traceback.
    cost : the referee's length of the path, metres; None without an accepted path.
    claimed_cost : the planner's own cost, metres, whatever it means by it.
    claim_differs : whether the claim of an accepted path is not what the referee measured.
    optimum : length of the exact shortest path, metres; None if there is no path.
    gap : cost / optimum - 1.
    clearance : distance of the accepted path from the nearest obstacle, metres.
    segments : number of segments of the accepted path.
    turning : sum of the angles by which the accepted path turns, radians.
    generations, generation_of_best : in all, and until the final best was first found.
    checks : questions asked whether a segment is free of the scene's obstacles.
    computed_checks : those of them that were computed and not answered from memory; None if the
        planner remembers none: all of them.
    wall_s, cpu_s : seconds that ``plan`` took.
    time_to_best_s, cpu_to_best_s : seconds until the final best was first found.
    load : load average of the machine when the run began, last minute.
    contended : whether ``plan`` waited for the processor: wall time above CPU time by a tenth. Then
        its times say as much of the machine as of the planner, and so does what came of it if it
        was ended by the clock.
    attempts : how often it was run, for want of a processor of its own; this is the record of the
        first run that had one, or else of the first of all.
    prepare_s : CPU seconds that it took to load and arrange the scene, before any clock, in the
        process that did it for this run: its own, or the one that it was forked from, where one
        preparation serves all runs of the scene.
    exact_s : CPU seconds that the exact optimum of the query took, likewise; it is made once.
    host : name of the machine.
    started_at : date and time, ISO 8601, UTC.
    improvements : what the planner reported while it ran.
    trace : a row of measures for each generation that the planner described.
    path : (n, 2) float64, metres, as the planner returned it; None if it returned none.
    details : further numbers that the planner gave.
    stderr : the last lines that the process wrote there, if the run failed.
    simulation : of a simulated run, as :func:`suite.simulation.record.as_data` gives it.
    snapshots : of the generations that were asked for; none in a measured run.
    """

    cell: Cell
    status: PlanStatus
    reason: str | None = None
    cost: float | None = None
    claimed_cost: float | None = None
    claim_differs: bool | None = None
    optimum: float | None = None
    gap: float | None = None
    clearance: float | None = None
    segments: int | None = None
    turning: float | None = None
    generations: int | None = None
    generation_of_best: int | None = None
    checks: int | None = None
    computed_checks: int | None = None
    wall_s: float | None = None
    time_to_best_s: float | None = None
    cpu_s: float | None = None
    cpu_to_best_s: float | None = None
    load: float | None = None
    contended: bool | None = None
    attempts: int | None = 1
    prepare_s: float | None = None
    exact_s: float | None = None
    host: str | None = None
    started_at: str | None = None
    improvements: tuple[Improvement, ...] = ()
    trace: tuple[Mapping[str, float], ...] = ()
    path: NDArray[np.float64] | None = None
    details: Mapping[str, float] = field(default_factory=dict)
    stderr: str = ""
    simulation: Mapping[str, Any] | None = None
    snapshots: tuple[Snapshot, ...] = ()

    def __post_init__(self) -> None:
        if self.reason is not None and len(self.reason) > MOST_LETTERS:
            object.__setattr__(self, "reason", _shortened(self.reason))


def _shortened(text: str) -> str:
    """The two ends of a text, of which an exception may have megabytes."""
    half = MOST_LETTERS // 2
    return f"{text[:half]} [...] {text[-half:]}"


def canonical_json(value: Any) -> str:
    """JSON with sorted keys and no spaces: equal values give equal text.

    Examples
    --------
    >>> canonical_json({"b": 1, "a": [2.0, None]})
    '{"a":[2.0,null],"b":1}'
    """
    return json.dumps(value, sort_keys=True, separators=(",", ":"), default=str)


def short_hash(value: Any) -> str:
    """Hash of plain data: 32 hexadecimal digits, the same on every machine.

    Examples
    --------
    >>> short_hash({"b": 1, "a": 2}) == short_hash({"a": 2, "b": 1})
    True
    """
    return hashlib.sha256(canonical_json(value).encode()).hexdigest()[:32]
