"""A single run as ``plan`` and ``simulate`` ask for it: its cell, and its record in other words."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from statistics import median
from typing import Any

from suite.errors import KbgaBenchError, SceneError
from suite.geometry.coordinates import printed
from suite.harness.prepared import planner_class, prepared_scene
from suite.harness.queries import ALL
from suite.planner import Budget, PlanStatus
from suite.plugins.discovery import planner_info
from suite.plugins.settings import make_settings
from suite.scenes.exact import shortest_path
from suite.scenes.frozen import refuse_moving
from suite.scenes.scene import Scene, scene_fingerprint
from suite.seeds import check_seed
from suite.simulation.record import from_data
from suite.simulation.run import Simulation
from suite.simulation.settings import world_settings
from suite.simulation.view import is_turn
from suite.store.record import Cell, RunRecord, World
from suite.typed import plain

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
        0 to 2^63 - 1.
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
    check_seed(seed)
    scene = prepared_scene(source)
    if world is None:
        _refuse_moving(scene)
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
        settings=plain(make_settings(found, settings or {})),
        budget=budget or Budget(),
        seed=seed,
        world=world,
    )


_POINT = re.compile(r"\s*[-+.0-9eE]+\s*,\s*[-+.0-9eE]+\s*")


def _refuse_moving(scene: Scene) -> None:
    refuse_moving(
        scene,
        "Let a robot drive through it with `simulate`, or take it as it is at a time, standing "
        "still, with --at, in seconds.",
    )


def query_names(
    source: str, query: str | None = None, start: str | None = None, goal: str | None = None
) -> list[str]:
    """The queries that the options of a command ask for.

    Parameters
    ----------
    source : str
        Catalogue name or file of the scene.
    query : str, optional
        A name, or ``all``. Default: the first of the scene.
    start, goal : str, optional
        ``x,y`` in metres, both or neither, in place of a name.

    Raises
    ------
    KbgaBenchError
        If they don't go together, or the scene has none of that name.
    """
    scene = prepared_scene(source)
    if start is not None or goal is not None:
        return [scene.query(_between(query, start, goal)).name]
    if query == ALL and scene.queries:
        return [each.name for each in scene.queries]
    return [scene.query(None if query == ALL else query).name]


def _between(query: str | None, start: str | None, goal: str | None) -> str:
    """The name of the query from a start to a goal."""
    if start is None or goal is None or query is not None:
        raise KbgaBenchError(
            "--start and --goal are given together, and in place of --query: "
            "--start 1,2 --goal 8.5,4."
        )
    for option, text in (("--start", start), ("--goal", goal)):
        if not _POINT.fullmatch(text):
            raise KbgaBenchError(f"{option} {text}: write x,y in metres, as {option} 1.5,-2.")
    return f"{start}:{goal}".replace(" ", "")


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
    return World("", plain(world_settings(prepared_scene(source), overrides)), cold)


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
    return {
        "scene": record.cell.scene,
        "query": record.cell.query,
        "moved": list(_moved(record)),
        **_asked_and_answered(record),
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
        "prepare_s": record.prepare_s,
        "exact_s": record.exact_s,
        "events": [[event.wall_s, event.cost] for event in record.improvements],
        "path": None if record.path is None else record.path.tolist(),
    }


def simulation_as_data(record: RunRecord) -> dict[str, Any]:
    """What came of a simulated run, as plain data for JSON.

    Returns
    -------
    dict
        What :func:`suite.simulation.record.as_data` gives, and whose run it was.
    """
    told = _asked_and_answered(record)
    return {"variant": record.cell.variant, **told, **(record.simulation or {})}


def _asked_and_answered(record: RunRecord) -> dict[str, Any]:
    cell = record.cell
    return {
        "planner": cell.planner,
        "seed": cell.seed,
        "settings": dict(cell.settings),
        "budget": cell.budget_as_dict,
        "status": str(record.status),
        "reason": record.reason,
    }


def exact_as_data(source: str, query: str | None = None) -> dict[str, Any]:
    """The exact shortest path of a query, as plain data for JSON.

    Returns
    -------
    dict
        ``status`` is solved, infeasible, or refused where an end is not free, for a ``reason``;
        ``optimum`` and ``path`` are null without a path. ``moved`` is by how many metres start and
        goal were moved to free space.

    Raises
    ------
    SceneError
        If the scene is dynamic, or has no such query.
    """
    scene = prepared_scene(source)
    _refuse_moving(scene)
    wanted = scene.query(query)
    asked = {"scene": scene.name, "query": wanted.name, "moved": list(wanted.moved)}
    if wanted.blocked is not None:
        nothing = {"optimum": None, "path": None, "checks": 0}
        return asked | {"status": str(PlanStatus.REFUSED), "reason": wanted.blocked} | nothing
    found = shortest_path(scene, wanted)
    return {
        **asked,
        "status": str(PlanStatus.INFEASIBLE if found.path is None else PlanStatus.SOLVED),
        "reason": None,
        "optimum": None if found.path is None else found.length,
        "path": None if found.path is None else found.path.tolist(),
        "checks": found.checks,
    }


def exact_as_text(found: Mapping[str, Any]) -> str:
    """What :func:`exact_as_data` gives, in a few lines for people."""
    lines = [exact_as_line(found), *_moved_in_words(found["moved"])]
    if found["path"] is not None:
        lines.append("  path  " + " ".join(printed(x, y) for x, y in found["path"]))
    return "\n".join(lines)


def exact_as_line(found: Mapping[str, Any]) -> str:
    """What :func:`exact_as_data` gives, on one line and without the path."""
    label = f"{found['scene']} / {found['query']}"
    if found["reason"] is not None:
        return f"{label}: {found['status']}, {found['reason']}"
    if found["path"] is None:
        return f"{label}: infeasible, there is no path."
    return f"{label}: {found['optimum']:.9g} m"


def exact_summary(found: Sequence[Mapping[str, Any]]) -> str:
    """How many of several queries have a path, on one line."""
    return _counted([one["status"] for one in found])


def summary(records: Sequence[RunRecord]) -> str:
    """How the runs of several queries ended, and how far from the optimum, on one line."""
    gaps = [record.gap for record in records if record.gap is not None]
    text = _counted([str(record.status) for record in records])
    if not gaps:
        return text
    return f"{text} Gap: median {100.0 * median(gaps):.3f} %, worst {100.0 * max(gaps):.3f} %."


def _counted(statuses: Sequence[str]) -> str:
    told = ", ".join(f"{number} {status}" for status, number in Counter(statuses).items())
    return f"{len(statuses)} {'query' if len(statuses) == 1 else 'queries'}: {told}."


def _moved_in_words(moved: Sequence[float]) -> list[str]:
    return [
        f"  moved        the {end} by {by:.9g} m, to free space"
        for end, by in zip(("start", "goal"), moved, strict=True)
        if by > 0.0
    ]


def as_line(record: RunRecord) -> str:
    """What came of a run, on one line for people."""
    words = [str(record.status)]
    if record.cost is not None:
        words.append(f"{record.cost:.3f} m")
    if record.gap is not None:
        words.append(f"gap {100.0 * record.gap:.3f} %")
    if record.wall_s is not None:
        words.append(f"{1e3 * record.wall_s:.2f} ms")
    if record.reason is not None:
        words.append(record.reason)
    return f"{record.cell.label}: {', '.join(words)}"


def _moved(record: RunRecord) -> tuple[float, float]:
    """Metres by which start and goal of a run were moved to free space."""
    try:
        return prepared_scene(record.cell.scene_source).query(record.cell.query).moved
    except SceneError:  # that it is not as it was, or not there any more, the row says
        return 0.0, 0.0


def as_text(record: RunRecord) -> str:
    """What came of a run, in a few lines for people."""
    lines = [f"{record.cell.label}: {record.status}", *_moved_in_words(_moved(record))]
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
        waypoints = " ".join(printed(x, y) for x, y in record.path)
        lines.append(f"  path         {waypoints}")
    return "\n".join(lines)


def simulation_of(record: RunRecord) -> Simulation | None:
    """The simulation that a record holds; None if it never began."""
    if record.simulation is None:
        return None
    return from_data(prepared_scene(record.cell.scene_source), record.simulation)


def simulation_as_text(record: RunRecord, *, updates: bool = False) -> str:
    """What came of a simulated run, in a few lines for people.

    Parameters
    ----------
    record : RunRecord
    updates : bool
        Show all updates, and not only those at which something happened.
    """
    data = record.simulation
    if data is None:
        return as_text(record)
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


def succeeded(record: RunRecord) -> bool:
    """Whether a run ended with an accepted path, or with the proof that there is none."""
    return record.status in PlanStatus.SUCCESSES


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
        or is_turn(old["cost"], new["cost"], speed * (new["time"] - old["time"]))
    ]


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
