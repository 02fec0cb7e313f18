"""A single run as ``kbga-bench simulate`` asks for it, and what came of it as plain data."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from statistics import median
from typing import Any
from zlib import crc32

import numpy as np

from suite.dynamic.settings import WorldSettings, world_settings
from suite.dynamic.simulate import Simulation, simulate
from suite.errors import KbgaBenchError
from suite.harness.cell import build_planner, prepared_scene
from suite.planner import Budget, PlanAfresh, Replanner
from suite.scene import Query, Scene

COLD = "-cold"
"""What the name of a planner that is made to plan afresh ends in; part of its random stream."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is to be run.

    scene : catalogue name or file.
    planner : name of the plugin.
    seed : 0 or more.
    query : its name; None for the first.
    cold : plan afresh at every update, though the planner has a replanner of its own.
    settings : of the planner; what is left out keeps its default.
    world : fields of WorldSettings that are not to be as the scene wants them.
    budget : of each single plan.
    """

    scene: str
    planner: str
    seed: int = 0
    query: str | None = None
    cold: bool = False
    settings: Mapping[str, Any] | None = None
    world: Mapping[str, Any] | None = None
    budget: Budget = field(default_factory=Budget)

    @property
    def variant(self) -> str:
        """Name of the planner as it is used."""
        return self.planner + (COLD if self.cold else "")


def run_single(wanted: Wanted) -> Simulation:
    """Run it here and now, warmed up.

    Raises
    ------
    KbgaBenchError
        If scene, planner or settings can't be used, or the planner refuses.
    """
    scene = prepared_scene(wanted.scene)
    query = scene.query(wanted.query)
    settings = world_settings(scene, wanted.world)
    replanner = _replanner(wanted, scene, query)
    return simulate(scene, query, replanner, settings, wanted.budget)


def stream(scene: str, query: str, variant: str, seed: int) -> np.random.Generator:
    """The random stream of a run, as :func:`suite.harness.cell.stream` draws it."""
    return np.random.default_rng([seed, crc32(f"{scene}/{query}/{variant}".encode())])


def _replanner(wanted: Wanted, scene: Scene, query: Query) -> Replanner:
    planner = build_planner(wanted.planner, wanted.settings or {})
    refusal = planner.refuse(scene, query, wanted.budget)
    if refusal is not None:
        raise KbgaBenchError(f"{wanted.planner} refuses: {refusal}")
    planner.warm_up()
    rng = stream(scene.name, query.name, wanted.variant, wanted.seed)
    return PlanAfresh(planner, rng) if wanted.cold else planner.replanner(rng)


def as_data(wanted: Wanted, run: Simulation) -> dict[str, Any]:
    """What came of a run, as plain data for JSON.

    Returns
    -------
    dict
        ``trajectory`` is [[t, x, y], ...]; times are simulated seconds, but for ``latency_s``.
    """
    way = run.trajectory
    return {
        "scene": run.scene.name,
        "query": run.query.name,
        "planner": wanted.planner,
        "variant": wanted.variant,
        "seed": wanted.seed,
        "world": _world(run.settings),
        "outcome": str(run.outcome),
        "reached": run.reached,
        "hits": [asdict(hit) for hit in run.hits],
        "opening": run.opening,
        "gates": [asdict(gate) for gate in run.gates],
        "time": way.end,
        "length": way.length,
        "waiting_time": way.waiting_s,
        "trajectory": np.column_stack([way.times, way.xy]).tolist(),
        "replans": [
            {
                "time": replan.time,
                "place": replan.place.tolist(),
                "changed": replan.changed,
                "status": replan.status,
                "reason": replan.reason,
                "latency_s": replan.latency_s,
                "cost": replan.cost,
                "optimum": replan.optimum,
                "generations": replan.generations,
                "collision_checks": replan.checks,
                "path": None if replan.path is None else replan.path.tolist(),
            }
            for replan in run.replans
        ],
    }


def _world(settings: WorldSettings) -> dict[str, Any]:
    return {key: getattr(settings, key) for key in WorldSettings.__slots__} | {
        "charge": str(settings.charge)
    }


def as_text(wanted: Wanted, run: Simulation) -> str:
    """What came of a run, in a few lines for people."""
    way = run.trajectory
    hits = (
        "never"
        if not run.hits
        else ", ".join(
            f"by {hit.obstacle} at {hit.time:.2f} s in ({hit.place[0]:.3f}, {hit.place[1]:.3f})"
            for hit in run.hits
        )
    )
    gates = ", ".join(f"{gate.gate} at {gate.time:.2f} s" for gate in run.gates) or "none"
    lines = [
        f"{run.scene.name} / {wanted.variant} / seed {wanted.seed}: {run.outcome}",
        f"  hit          {hits}",
        f"  openings     {gates}",
        f"  time         {way.end:.2f} s, of which {way.waiting_s:.2f} s waiting",
        f"  length       {way.length:.3f} m",
        f"  replans      {len(run.replans)}{_latencies(run)}",
    ]
    lines += [_replan_as_text(replan) for replan in as_data(wanted, run)["replans"]]
    return "\n".join(lines)


def _latencies(run: Simulation) -> str:
    known = [1e3 * r.latency_s for r in run.replans if r.latency_s is not None]
    return f", median {median(known):.2f} ms, worst {max(known):.2f} ms" if known else ""


def _replan_as_text(replan: Mapping[str, Any]) -> str:
    cost = "" if replan["cost"] is None else f"  {replan['cost']:.3f} m"
    optimum = "" if replan["optimum"] is None else f"  (optimum {replan['optimum']:.3f} m)"
    latency = "" if replan["latency_s"] is None else f"  {1e3 * replan['latency_s']:.2f} ms"
    news = "  new" if replan["changed"] else ""
    return f"    {replan['time']:7.2f} s  {replan['status']}{latency}{cost}{optimum}{news}"


def unhurt(run: Simulation) -> bool:
    """Whether the robot came to the goal and was never hit."""
    return run.reached and not run.hits
