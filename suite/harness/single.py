"""A single run as ``kbga-bench plan`` asks for it: its cell, and its record as plain data."""

from collections.abc import Iterable, Mapping
from typing import Any

from suite.errors import KbgaBenchError
from suite.harness.prepared import planner_class, prepared_scene
from suite.planner import Budget, PlanStatus
from suite.plugins.discovery import planner_info
from suite.plugins.settings import make_settings, settings_as_dict
from suite.scenes.exact import shortest_path
from suite.scenes.scene import scene_fingerprint
from suite.store.record import Cell, RunRecord, World

COLD = "-cold"
"""What the name of a planner that is made to plan afresh ends in; part of its random stream."""


def cell_for(
    source: str,
    planner: str,
    *,
    seed: int,
    query: str | None = None,
    settings: Mapping[str, Any] | None = None,
    budget: Budget | None = None,
    world: World | None = None,
) -> Cell:
    """The cell of a single run; its variant, and so its random stream, is called as the planner.

    One that is made to plan afresh in its world has a name of its own.

    Parameters
    ----------
    source : str
        Catalogue name or file of the scene.
    planner : str
        Name of the plugin.
    seed : int
        0 or more.
    query : str, optional
        Default: the first of the scene.
    settings : mapping, optional
        Values or texts; what is left out keeps its default.
    budget : Budget, optional
        Default: no limit but the planner's own.
    world : World, optional
        Of a run that is simulated.

    Raises
    ------
    KbgaBenchError
        If any of it can't be used; nothing has been run then.
    """
    scene = prepared_scene(source)
    wanted = scene.query(query)
    found = planner_class(planner)
    plugin = planner_info(planner)
    return Cell(
        scene=scene.name,
        scene_source=source,
        scene_hash=scene_fingerprint(scene, wanted),
        query=wanted.name,
        variant=planner + COLD if world is not None and world.cold else planner,
        planner=planner,
        distribution=plugin.distribution,
        version=plugin.version,
        settings=settings_as_dict(make_settings(found, settings or {})),
        budget=budget or Budget(),
        seed=seed,
        world=world,
    )


def parse_settings(pairs: Iterable[str]) -> dict[str, str]:
    """Settings from texts ``key=value``.

    Raises
    ------
    KbgaBenchError
        If one has no ``=``, or a key comes twice.

    Examples
    --------
    >>> parse_settings(["population_size=40", "penalty = 2.5"])
    {'population_size': '40', 'penalty': '2.5'}
    """
    settings: dict[str, str] = {}
    for pair in pairs:
        key, equals, value = (part.strip() for part in pair.partition("="))
        if not (key and equals):
            raise KbgaBenchError(f"--set {pair}: write it as key=value.")
        if key in settings:
            raise KbgaBenchError(f"--set {pair}: {key} is set twice.")
        settings[key] = value
    return settings


def as_data(record: RunRecord) -> dict[str, Any]:
    """What came of a run, as plain data for JSON.

    Returns
    -------
    dict
        ``events`` are [seconds of wall time, cost], ``path`` is [[x, y], ...] or null.
    """
    cell = record.cell
    return {
        "scene": cell.scene,
        "query": cell.query,
        "planner": cell.planner,
        "seed": cell.seed,
        "settings": dict(cell.settings),
        "budget": cell.budget_as_dict,
        "status": str(record.status),
        "reason": record.reason,
        "cost": record.cost,
        "claimed_cost": record.claimed_cost,
        "optimum": record.optimum,
        "gap": record.gap,
        "clearance": record.clearance,
        "generations": record.generations,
        "generation_of_best": record.generation_of_best,
        "collision_checks": record.checks,
        "computed_checks": record.computed_checks,
        "wall_s": record.wall_s,
        "cpu_s": record.cpu_s,
        "contended": record.contended,
        "time_to_best_s": record.time_to_best_s,
        "events": [[event.wall_s, event.cost] for event in record.improvements],
        "path": None if record.path is None else record.path.tolist(),
    }


def exact_as_data(source: str, query: str | None = None) -> dict[str, Any]:
    """The exact shortest path of a query, as plain data for JSON.

    Returns
    -------
    dict
        ``status`` is solved or infeasible; ``optimum`` and ``path`` are null without a path.
    """
    scene = prepared_scene(source)
    wanted = scene.query(query)
    found = shortest_path(scene, wanted)
    return {
        "scene": scene.name,
        "query": wanted.name,
        "status": str(PlanStatus.INFEASIBLE if found.path is None else PlanStatus.SOLVED),
        "optimum": None if found.path is None else found.length,
        "path": None if found.path is None else found.path.tolist(),
        "checks": found.checks,
    }


def exact_as_text(found: Mapping[str, Any]) -> str:
    """What :func:`exact_as_data` gives, in a few lines for people."""
    if found["path"] is None:
        return f"{found['scene']} / {found['query']}: infeasible, there is no path."
    waypoints = " ".join(f"({x:g}, {y:g})" for x, y in found["path"])
    return f"{found['scene']} / {found['query']}: {found['optimum']:.9g} m\n  path  {waypoints}"


def as_text(record: RunRecord) -> str:
    """What came of a run, in a few lines for people."""
    lines = [f"{record.cell.label}: {record.status}"]
    if record.reason is not None:
        lines.append(f"  reason       {record.reason}")
    if record.cost is not None:
        lines.append(f"  cost         {record.cost:.3f} m")
    if record.optimum is not None:
        lines.append(f"  optimum      {record.optimum:.3f} m")
    if record.gap is not None:
        lines.append(f"  gap          {100.0 * record.gap:.3f} %")
    if record.generations is not None:
        best = record.generation_of_best
        found = "" if best is None else f", the best found in number {best}"
        lines.append(f"  generations  {record.generations}{found}")
    if record.checks is not None:
        computed = record.computed_checks
        memory = "" if computed is None else f", {computed} of them computed, the rest from memory"
        lines.append(f"  checks       {record.checks}{memory}")
    if record.wall_s is not None:
        best_s = record.time_to_best_s
        found = "" if best_s is None else f", the best found after {1e3 * best_s:.2f} ms"
        lines.append(f"  time         {1e3 * record.wall_s:.2f} ms{found}")
    if record.cpu_s is not None:
        waited = "; it waited for the processor" if record.contended else ""
        lines.append(f"  CPU time     {1e3 * record.cpu_s:.2f} ms{waited}")
    if record.path is not None:
        waypoints = " ".join(f"({x:g}, {y:g})" for x, y in record.path)
        lines.append(f"  path         {waypoints}")
    return "\n".join(lines)


def succeeded(record: RunRecord) -> bool:
    """Whether a run ended with an accepted path, or with the proof that there is none."""
    return record.status in (PlanStatus.SOLVED, PlanStatus.INFEASIBLE)
