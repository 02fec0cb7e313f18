"""A simulation that has ended as plain data, for JSON and the store, and back again."""

from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from suite.scenes.scene import Scene
from suite.simulation.hits import Hit
from suite.simulation.run import Course, Outcome, Replan, Simulation
from suite.simulation.settings import Charge, WorldSettings
from suite.simulation.trajectory import Crossing, make_trajectory
from suite.simulation.world import World


def settings_as_data(settings: WorldSettings) -> dict[str, Any]:
    """All fields of world settings, as plain data.

    Examples
    --------
    >>> settings_as_data(WorldSettings(speed=5.0))["charge"]
    'measured'
    """
    return {**asdict(settings), "charge": settings.charge.value}


def settings_from_data(data: Mapping[str, Any]) -> WorldSettings:
    """World settings out of plain data."""
    return WorldSettings(**{**data, "charge": Charge(data["charge"])})


def as_data(run: Simulation) -> dict[str, Any]:
    """What came of a run.

    Returns
    -------
    dict
        ``trajectory`` is [[t, x, y], ...]; times are simulated seconds, but for ``latency_s``.
        Places and paths are metres.
    """
    way = run.trajectory
    return {
        "scene": run.scene.name,
        "query": run.query.name,
        "world": settings_as_data(run.settings),
        "outcome": run.outcome.value,
        "reached": run.reached,
        "hits": [{**asdict(hit), "place": list(hit.place)} for hit in run.hits],
        "opening": run.opening,
        "gates": [asdict(gate) for gate in run.gates],
        "detected": dict(run.detected),
        "time": way.end,
        "length": way.length,
        "waiting_time": way.waiting_s,
        "trajectory": np.column_stack([way.times, way.xy]).tolist(),
        "courses": [{"time": course.time, "path": _listed(course.path)} for course in run.courses],
        "replans": [_replan_as_data(replan) for replan in run.replans],
    }


def from_data(scene: Scene, data: Mapping[str, Any]) -> Simulation:
    """The run that plain data tells of.

    Parameters
    ----------
    scene : Scene
        The one that was simulated, as it was loaded.
    data : mapping
        As :func:`as_data` gives it.
    """
    settings = settings_from_data(data["world"])
    return Simulation(
        scene=World(scene, settings).scene,
        query=scene.query(data["query"]),
        settings=settings,
        outcome=Outcome(data["outcome"]),
        trajectory=make_trajectory(data["trajectory"]),
        replans=tuple(_replan_from_data(replan) for replan in data["replans"]),
        courses=tuple(Course(c["time"], _array(c["path"])) for c in data["courses"]),
        detected=dict(data["detected"]),
        hits=tuple(Hit(**{**hit, "place": tuple(hit["place"])}) for hit in data["hits"]),
        gates=tuple(Crossing(**gate) for gate in data["gates"]),
    )


def _replan_as_data(replan: Replan) -> dict[str, Any]:
    data = {field.name: getattr(replan, field.name) for field in fields(replan)}
    lists = {"place": replan.place.tolist(), "path": _listed(replan.path)}
    return {**data, **lists, "details": dict(replan.details)}


def _replan_from_data(data: Mapping[str, Any]) -> Replan:
    return Replan(**{**data, "place": np.array(data["place"]), "path": _array(data["path"])})


def _listed(path: NDArray[np.float64] | None) -> list[list[float]] | None:
    return None if path is None else path.tolist()


def _array(path: Any) -> NDArray[np.float64] | None:
    return None if path is None else np.array(path, dtype=np.float64)
