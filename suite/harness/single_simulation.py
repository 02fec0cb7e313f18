"""A single simulated run as ``kbga-bench simulate`` asks for it, and what came of it."""

from collections.abc import Mapping
from itertools import pairwise
from statistics import median
from typing import Any

from suite.harness import single
from suite.harness.prepared import prepared_scene
from suite.planner import PlanStatus
from suite.simulation.record import from_data, settings_as_data
from suite.simulation.run import Simulation
from suite.simulation.settings import world_settings
from suite.store.record import RunRecord, World

TURN_M = 1.0
"""A way ahead that becomes longer or shorter by more is news, metres."""


def world_for(
    source: str, overrides: Mapping[str, Any] | None = None, *, cold: bool = False
) -> World:
    """The world of a single run.

    Parameters
    ----------
    source : str
        Catalogue name or file of the scene.
    overrides : mapping, optional
        Fields of WorldSettings that are not to be as the scene wants them; None leaves one.
    cold : bool
        Plan afresh at every update, though the planner has a replanner of its own.

    Raises
    ------
    SceneError
        If scene or settings can't be used.
    """
    settings = world_settings(prepared_scene(source), overrides)
    return World("", settings_as_data(settings), cold)


def simulation_of(record: RunRecord) -> Simulation | None:
    """The simulation that a record holds; None if it never began."""
    if record.simulation is None:
        return None
    return from_data(prepared_scene(record.cell.scene_source), record.simulation)


def as_data(record: RunRecord) -> dict[str, Any]:
    """What came of a run, as plain data for JSON.

    Returns
    -------
    dict
        What :func:`suite.simulation.record.as_data` gives, and whose run it was.
    """
    cell = record.cell
    return {
        "planner": cell.planner,
        "variant": cell.variant,
        "seed": cell.seed,
        "settings": dict(cell.settings),
        "budget": cell.budget_as_dict,
        "status": str(record.status),
        "reason": record.reason,
        **(record.simulation or {}),
    }


def as_text(record: RunRecord, *, updates: bool = False) -> str:
    """What came of a run, in a few lines for people.

    Parameters
    ----------
    record : RunRecord
    updates : bool
        Show all updates, and not only those at which something happened.
    """
    data = record.simulation
    if data is None:
        return single.as_text(record)
    hits = ", ".join(_hit_as_text(hit) for hit in data["hits"]) or "never"
    gates = ", ".join(f"{gate['gate']} at {gate['time']:.2f} s" for gate in data["gates"])
    lines = [
        f"{record.cell.label}: {data['outcome']}",
        f"  hit          {hits}",
        f"  openings     {gates or 'none'}",
        f"  time         {data['time']:.2f} s, of which {data['waiting_time']:.2f} s waiting",
        f"  length       {data['length']:.3f} m{_exact_length(record)}",
        f"  replans      {len(data['replans'])}{_latencies(data['replans'])}",
    ]
    shown = data["replans"] if updates else _eventful(data)
    lines += [_replan_as_text(replan) for replan in shown]
    others = len(data["replans"]) - len(shown)
    if others:
        lines.append(f"    and {others} more at which nothing else happened (--updates shows all)")
    return "\n".join(lines)


def unhurt(record: RunRecord) -> bool:
    """Whether the robot came to the goal and was never hit."""
    return record.status is PlanStatus.SOLVED


def _eventful(data: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """The first update, and those at which something happened that had not just happened before.

    That is: the answer is of another kind, the way ahead became longer or shorter, an obstacle was
    detected, or what is known began to change.
    """
    replans, speed = data["replans"], data["world"]["speed"]
    detections = set(data["detected"].values())
    return replans[:1] + [
        new
        for old, new in pairwise(replans)
        if new["status"] != old["status"]
        or new["time"] in detections
        or (new["changed"] and not old["changed"])
        or _is_turn(old, new, speed)
    ]


def _is_turn(old: Mapping[str, Any], new: Mapping[str, Any], speed: float) -> bool:
    """Whether a path is longer or shorter than what was left of the one before."""
    if old["cost"] is None or new["cost"] is None:
        return old["cost"] is not new["cost"]
    left = old["cost"] - speed * (new["time"] - old["time"])
    return bool(abs(new["cost"] - left) > TURN_M)


def _hit_as_text(hit: Mapping[str, Any]) -> str:
    x, y = hit["place"]
    return f"by {hit['obstacle']} at {hit['time']:.2f} s in ({x:.3f}, {y:.3f})"


def _exact_length(record: RunRecord) -> str:
    if record.optimum is None:
        return ""
    return f" (with the exact shortest path of each update {record.optimum:.3f} m)"


def _latencies(replans: list[Mapping[str, Any]]) -> str:
    known = [1e3 * r["latency_s"] for r in replans if r["latency_s"] is not None]
    return f", median {median(known):.2f} ms, worst {max(known):.2f} ms" if known else ""


def _replan_as_text(replan: Mapping[str, Any]) -> str:
    cost = "" if replan["cost"] is None else f"  {replan['cost']:.3f} m"
    optimum = "" if replan["optimum"] is None else f"  (optimum {replan['optimum']:.3f} m)"
    latency = "" if replan["latency_s"] is None else f"  {1e3 * replan['latency_s']:.2f} ms"
    news = "  new" if replan["changed"] else ""
    return f"    {replan['time']:7.2f} s  {replan['status']}{latency}{cost}{optimum}{news}"
