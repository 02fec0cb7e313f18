"""One run, in this process: warm up, start the clock, plan, stop the clock, ask the referee."""

import traceback
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from suite.errors import ContractError, PluginError
from suite.geometry.tolerances import COST_CLAIM_RELATIVE
from suite.harness.prepared import (
    build_planner,
    exact_optimum,
    optimum_cpu_s,
    prepared_scene,
    referee,
    scene_cpu_s,
    stream,
)
from suite.harness.provenance import host_name, load_average
from suite.harness.simulated_cell import simulated
from suite.planner import Plan, PlanStatus, Recorder, refusal
from suite.referee.claims import improvements, plain_plan, trace
from suite.referee.clock import Clock
from suite.scenes.catalogue import scene_as_it_was
from suite.scenes.scene import Query, scene_fingerprint
from suite.store.gap import gap_of
from suite.store.record import Cell, RunRecord

TRACEBACK_LINES = 12
"""Enough for the exception and the frames of the planner that raised it."""


def run_cell(
    cell: Cell,
    *,
    recorder: Recorder | None = None,
    before_plan: Callable[[], None] = lambda: None,
) -> RunRecord:
    """Run one cell here and now, and judge what comes of it.

    Parameters
    ----------
    cell : Cell
    recorder : Recorder, optional
        To be read by the caller afterwards, for snapshots.
    before_plan : callable
        Called when everything is ready, just before the clock starts.

    Returns
    -------
    RunRecord
        Always: what a planner raises or returns by mistake is a row.
    """
    blank = _blank(cell)
    try:
        return _run(cell, blank, recorder or Recorder(), before_plan)
    except MemoryError:
        return replace(blank, status=PlanStatus.OUT_OF_MEMORY, reason=_last_lines())
    except PluginError as error:
        return replace(blank, reason=str(error))  # a whole sentence: no traceback adds to it
    except (Exception, SystemExit):
        # Other people's code: whatever it raises is an outcome of its run, and no reason to stop.
        return replace(blank, reason=_last_lines())


def attempt_cell(cell: Cell) -> RunRecord:
    """Run one cell as :func:`run_cell` does, but let pass whatever is raised: for a debugger."""
    return _run(cell, _blank(cell), Recorder(), lambda: None)


def refused(cell: Cell, reason: str) -> RunRecord:
    """The record of a run that is not begun, for a reason that no planner need be asked about."""
    return replace(_blank(cell), status=PlanStatus.REFUSED, reason=reason)


def _blank(cell: Cell) -> RunRecord:
    """The record of a run that has not begun."""
    return RunRecord(
        cell,
        PlanStatus.ERROR,
        host=host_name(),
        load=load_average(),
        started_at=datetime.now(UTC).isoformat(timespec="seconds"),
    )


def _run(
    cell: Cell, blank: RunRecord, recorder: Recorder, before_plan: Callable[[], None]
) -> RunRecord:
    scene, query = scene_as_it_was(
        cell.scene_source, cell.query, cell.scene_hash, load=prepared_scene
    )
    if query.blocked is not None:
        return refused(cell, query.blocked)
    blank = replace(blank, prepare_s=scene_cpu_s(cell.scene_source))
    planner = build_planner(cell.planner, cell.settings)
    planner.warm_up()
    reason = refusal(planner, scene, query, cell.budget)
    if reason is not None:
        return replace(blank, status=PlanStatus.REFUSED, reason=str(reason))
    rng = stream(cell)
    before_plan()
    if cell.world is not None:
        return simulated(blank, planner, rng)
    with Clock(recorder) as clock:
        plan = planner.plan(scene, query, cell.budget, rng, recorder)
    measured = replace(
        blank,
        wall_s=clock.wall_s,
        cpu_s=clock.cpu_s,
        contended=clock.contended,
        optimum=exact_optimum(cell.scene_source, cell.query),
        exact_s=optimum_cpu_s(cell.scene_source, cell.query),
    )
    try:
        # Arrays are read-only, but numpy lets their owner change that.
        if scene_fingerprint(scene, query) != cell.scene_hash:
            raise ContractError("plan changed the start or the goal in place.")
        if clock.restarted:
            raise ContractError("plan started the clock anew. That is for the harness to do.")
        reports = improvements(recorder, clock.wall_s)
        measured = replace(measured, improvements=reports, trace=trace(recorder))
        return _judged(query, measured, plain_plan(plan))
    except ContractError as error:
        return replace(measured, reason=str(error))


def _with_plan(record: RunRecord, plan: Plan) -> RunRecord:
    """The record with what the planner says of its run; nothing of it is judged yet."""
    best = record.improvements[-1] if record.improvements else None
    generation_of_best = plan.generation_of_best
    if generation_of_best is None and best is not None:
        generation_of_best = best.generation
    return replace(
        record,
        status=plan.status,
        reason=plan.reason,
        claimed_cost=plan.claimed_cost,
        generations=plan.generations,
        generation_of_best=generation_of_best,
        checks=plan.checks,
        computed_checks=plan.computed_checks,
        details=plan.details,
        path=_as_path(plan.path),
        # A planner that reports nothing found its best when it ended.
        time_to_best_s=record.wall_s if best is None else best.wall_s,
        cpu_to_best_s=record.cpu_s if best is None else best.cpu_s,
    )


def _judged(query: Query, measured: RunRecord, plan: Plan) -> RunRecord:
    record = _with_plan(measured, plan)
    if record.status is PlanStatus.INFEASIBLE and record.optimum is not None:
        reason = f"claims that there is no path; the shortest has {record.optimum:.6g} m."
        return replace(record, status=PlanStatus.INVALID, reason=reason)
    if record.status is not PlanStatus.SOLVED:
        return replace(record, time_to_best_s=None, cpu_to_best_s=None)
    verdict = referee(record.cell.scene_source).judge(query, plan.path)
    if verdict.length is None:
        return replace(record, status=PlanStatus.INVALID, reason=verdict.reason)
    cost = verdict.length
    claim = record.claimed_cost
    return replace(
        record,
        cost=cost,
        clearance=verdict.clearance,
        segments=verdict.segments,
        turning=verdict.turning,
        gap=gap_of(cost, record.optimum),
        claim_differs=claim is not None and abs(claim - cost) > COST_CLAIM_RELATIVE * cost,
    )


def _as_path(path: Any) -> NDArray[np.float64] | None:
    """A copy of the path, if it has the shape of one; the referee says what is wrong otherwise."""
    try:
        xy = np.array(path, dtype=np.float64)
    except (TypeError, ValueError):
        return None
    return xy if xy.ndim == 2 and xy.shape[1] == 2 else None


def _last_lines() -> str:
    lines = traceback.format_exc().strip().splitlines()
    return "\n".join(lines[-TRACEBACK_LINES:])
