"""One simulated run, in this process: a planner that plans again and again as its robot drives."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from statistics import median
from typing import Any

import numpy as np

from suite.harness.prepared import prepared_scene
from suite.planner import Plan, PlanAfresh, Planner, PlanStatus, Recorder, Replanner
from suite.referee.clock import Clock
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene
from suite.simulation.record import as_data
from suite.simulation.run import Replan, Simulation, simulate
from suite.simulation.settings import Charge, WorldSettings
from suite.store.gap import gap_of
from suite.store.record import RunRecord, World, canonical_json
from suite.typed import dataclass_of

_FAILURES = (PlanStatus.ERROR, PlanStatus.INVALID)
"""Ends of a single plan that are the planner's fault, whatever the world did."""


def simulated(blank: RunRecord, planner: Planner, rng: np.random.Generator) -> RunRecord:
    """Let a planner guide its robot through the world of a cell, and say what came of it.

    Parameters
    ----------
    blank : RunRecord
        Of a cell with a world; what it says beside is kept.
    planner : Planner
        Warmed up.
    rng : Generator
        Of the whole run.

    Returns
    -------
    RunRecord
        ``solved`` if the robot came to the goal unhurt, ``invalid`` if it was hit, ``exhausted``
        if it did not arrive in time. Its details are medians over the plans.
    """
    cell = blank.cell
    if cell.world is None:
        raise ValueError("the cell has no world.")
    scene = prepared_scene(cell.scene_source)
    replanner = PlanAfresh(planner, rng) if cell.world.cold else planner.replanner(rng)
    settings = dataclass_of(cell.world.settings, WorldSettings)
    # The world is computed in the same process and never sleeps: who waited there waited anywhere.
    with Clock(Recorder()) as clock:
        done = simulate(scene, scene.query(cell.query), replanner, settings, cell.budget)
    status, reason = _verdict(done)
    optimum = exact_length(cell.scene_source, cell.query, cell.world)
    cost = done.trajectory.length if status is PlanStatus.SOLVED else None
    return replace(
        blank,
        status=status,
        reason=reason,
        cost=cost,
        optimum=optimum,
        gap=None if cost is None else gap_of(cost, optimum),
        generations=_total(r.generations for r in done.replans),
        checks=_total(r.checks for r in done.replans),
        computed_checks=_computed(done.replans),
        contended=clock.contended,
        wall_s=_total(r.latency_s for r in done.replans),
        details=_medians([r.details for r in done.replans]),
        path=done.trajectory.xy,
        simulation=as_data(done),
    )


def exact_length(source: str, query: str, world: World) -> float | None:
    """Length of the way of a robot that follows the exact shortest path of each update, metres.

    It plans in no time. What it does not know yet may lead it astray, as it does everybody; so
    another robot may be luckier and go a shorter way.

    Returns
    -------
    float or None
        None if that robot does not arrive, or is hit.
    """
    return _exact_length(source, query, canonical_json(world.settings))


@lru_cache(maxsize=64)
def _exact_length(source: str, query: str, settings: str) -> float | None:
    scene = prepared_scene(source)
    world = replace(dataclass_of(json.loads(settings), WorldSettings), charge=Charge.ZERO)
    done = simulate(scene, scene.query(query), _Exact(), world)
    return done.trajectory.length if done.reached and not done.hits else None


def _verdict(done: Simulation) -> tuple[PlanStatus, str | None]:
    """How the run ended, in the words of all runs, and why if not well."""
    if done.hits:
        hit = done.hits[0]
        more = f", and {len(done.hits) - 1} more" if len(done.hits) > 1 else ""
        return PlanStatus.INVALID, f"hit by {hit.obstacle} at {hit.time:.6g} s{more}."
    if done.reached:
        return PlanStatus.SOLVED, None
    failed = [replan for replan in done.replans if replan.status in _FAILURES]
    if failed:
        return PlanStatus(failed[-1].status), failed[-1].reason
    return PlanStatus.EXHAUSTED, f"not at the goal after {done.trajectory.end:g} s."


def _total(values: Iterable[Any]) -> Any:
    """The sum of what is known; None if nothing is."""
    known = [value for value in values if value is not None]
    return sum(known) if known else None


def _computed(replans: Sequence[Replan]) -> int | None:
    """Checks that were computed in all; None if no plan answered any from memory."""
    if all(replan.computed_checks is None for replan in replans):
        return None
    counts = (r.checks if r.computed_checks is None else r.computed_checks for r in replans)
    return sum(count or 0 for count in counts)


def _medians(details: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """The median of each number over the plans that gave it."""
    names = dict.fromkeys(name for given in details for name in given)
    return {name: median(given[name] for given in details if name in given) for name in names}


class _Exact(Replanner):
    """The exact shortest path, at each update anew."""

    def begin(self, scene: Scene, query: Query, *_: Any) -> Plan:
        path = shortest_path(scene, query).path
        return Plan(PlanStatus.INFEASIBLE if path is None else PlanStatus.SOLVED, path)

    def update(self, scene: Scene, query: Query, *_: Any) -> Plan:
        return self.begin(scene, query)
