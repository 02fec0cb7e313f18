"""A store of a map with many queries, written by hand: what a report of it costs.

``python -m tests.perf.many_queries FOLDER [QUERIES [PLANNERS]]`` writes the map and the store,
makes the report, and prints its size and the CPU time that it took. No planner is run: each query
has its exact optimum, and each planner the exact path with a bend that makes it longer. Nobody
asked whether the bends are free.
"""

import resource
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray

from suite.planner import Improvement, PlanStatus
from suite.report.html.page import write_report
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.geojson import write_scene
from suite.scenes.scene import Query, Scene, make_scene, scene_fingerprint
from suite.store.record import RunRecord
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

BASE = "scattered_100"
STEPS = 8
"""Improvements that a run reports."""
BLOCKED = 0.02
"""Share of further queries that can't be asked."""
SESSION = {"matrix": "many-queries", "started_at": "2026-01-01T00:00:00+00:00", "host": "nowhere"}


def write_map(file: Path, queries: int, rng: np.random.Generator) -> Scene:
    """A scattered scene with so many queries, between places drawn evenly from its free space."""
    base = load_scene(BASE)
    ends = _free_points(base, 2 * queries, rng).reshape(queries, 2, 2)
    named = {"{:.3f},{:.3f}:{:.3f},{:.3f}".format(*pair.ravel()): tuple(pair) for pair in ends}
    scene = make_scene("yard", base.workspace, base.obstacles, named)
    write_scene(scene, file)
    return load_scene(str(file))


def _free_points(scene: Scene, number: int, rng: np.random.Generator) -> NDArray[np.float64]:
    xmin, ymin, xmax, ymax = scene.bounds
    solid = scene.arrangement.solid.buffer(0.01)
    shapely.prepare(solid)
    points = rng.uniform((xmin, ymin), (xmax, ymax), (4 * number, 2)).round(3)
    free = ~shapely.intersects_xy(solid, points[:, 0], points[:, 1])
    inside = shapely.contains_xy(scene.workspace.buffer(-0.01), points[:, 0], points[:, 1])
    return points[free & inside][:number]


def records(scene: Scene, planners: int, rng: np.random.Generator) -> Iterator[RunRecord]:
    """A row for each query and planner; the later the planner, the worse and the slower it is."""
    for query in scene.queries:
        exact = shortest_path(scene, query)
        if exact.path is None:
            continue
        hard = float(rng.exponential())
        for planner in range(planners):
            yield _record(scene, query, exact.path, planner, hard, rng)
    for number in range(int(BLOCKED * len(scene.queries))):
        for planner in range(planners):
            yield _blocked(scene, number, planner)


def _record(
    scene: Scene,
    query: Query,
    exact: NDArray[np.float64],
    planner: int,
    hard: float,
    rng: np.random.Generator,
) -> RunRecord:
    cell = _cell(scene, query.name, planner, scene_fingerprint(scene, query))
    optimum = _length(exact)
    took = 0.002 * (1 + planner) * (1.0 + hard) * float(rng.lognormal(0.0, 0.5))
    if hard * rng.uniform() > 6.0 / (1 + planner):
        nothing = dict.fromkeys(("cost", "gap", "claimed_cost", "time_to_best_s", "cpu_to_best_s"))
        return make_record(
            cell, **nothing, status=PlanStatus.EXHAUSTED, optimum=optimum, wall_s=took, cpu_s=took,
            improvements=(), trace=(), path=None, claim_differs=None,
        )  # fmt: skip
    gap = 0.0 if planner == 0 else 0.002 * planner * hard * float(rng.lognormal(0.0, 1.0))
    path = exact if gap == 0.0 else _bent(exact, optimum * (1.0 + gap))
    cost = max(_length(path), optimum)
    times = took * np.geomspace(0.1, 0.9, STEPS)
    costs = cost + optimum * 0.3 * np.linspace(1.0, 0.0, STEPS) ** 3
    reports = tuple(
        Improvement(t, t, float(c), i, 50 * (i + 1))
        for i, (t, c) in enumerate(zip(times.tolist(), costs, strict=True))
    )
    return make_record(
        cell, cost=cost, claimed_cost=cost, optimum=optimum, gap=cost / optimum - 1.0, path=path,
        wall_s=took, cpu_s=took, time_to_best_s=float(times[-1]), cpu_to_best_s=float(times[-1]),
        clearance=float(rng.exponential(0.3)), turning=float(rng.gamma(3.0)), trace=(),
        segments=len(path) - 1, improvements=reports, started_at=SESSION["started_at"],
    )  # fmt: skip


def _blocked(scene: Scene, number: int, planner: int) -> RunRecord:
    nothing = dict.fromkeys(
        ("cost", "gap", "claimed_cost", "optimum", "wall_s", "time_to_best_s", "cpu_s",
         "cpu_to_best_s", "generations", "generation_of_best", "checks", "path", "claim_differs")
    )  # fmt: skip
    cell = _cell(scene, f"{number},-1:1,1", planner, f"blocked {number}")
    reason = f"yard, start of query '{number},-1:1,1': lies outside the workspace."
    return make_record(
        cell, **nothing, status=PlanStatus.REFUSED, reason=reason, improvements=(), trace=()
    )


def _cell(scene: Scene, query: str, planner: int, fingerprint: str):
    name = f"planner-{planner}"
    return make_cell(
        scene=scene.name, scene_source=str(scene.path), scene_hash=fingerprint, query=query,
        variant=name, planner=name,
    )  # fmt: skip


def _bent(path: NDArray[np.float64], length: float) -> NDArray[np.float64]:
    """The path with a corner beside the middle of its longest segment, to be so long."""
    sides = np.diff(path, axis=0)
    lengths = np.hypot(*sides.T)
    i = int(lengths.argmax())
    longer = length - _length(path) + lengths[i]
    across = np.array([-sides[i, 1], sides[i, 0]]) / lengths[i]
    off = 0.5 * np.sqrt(longer**2 - lengths[i] ** 2)
    return np.insert(path, i + 1, path[i] + 0.5 * sides[i] + off * across, axis=0)


def _length(path: NDArray[np.float64]) -> float:
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def write_many(folder: Path, queries: int, planners: int) -> Path:
    """Write the map and the store into a folder; the file of the store."""
    rng = np.random.default_rng(14)
    scene = write_map(folder / "yard.geojson", queries, rng)
    store = folder / "many.db"
    with open_store(store) as writer:
        writer.begin_session(SESSION)
        for record in records(scene, planners, rng):
            writer.add(record)
    return store


def _cpu_s() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def measure(folder: Path, queries: int, planners: int) -> str:
    """Make a report of the folder's store, which is written if it is missing; what it cost."""
    store, page = folder / "many.db", folder / "many.html"
    if not store.exists():
        write_many(folder, queries, planners)
    begin = _cpu_s()
    write_report(store, page)
    size = page.stat().st_size / 1e6
    took = _cpu_s() - begin
    return f"{queries} queries x {planners} planners: {size:.2f} MB, {took:.1f} s of CPU time"


if __name__ == "__main__":
    given = [int(text) for text in sys.argv[2:]]
    sys.stdout.write(measure(Path(sys.argv[1]), *[*given, *(1000, 8)[len(given) :]]) + "\n")
