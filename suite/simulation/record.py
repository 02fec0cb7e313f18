"""A simulation that has ended as plain data, for JSON and the store, and back again."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from suite.scenes.scene import Scene
from suite.simulation.hits import Hit
from suite.simulation.run import Course, Outcome, Replan, Simulation
from suite.simulation.settings import WorldSettings
from suite.simulation.trajectory import Crossing, make_trajectory
from suite.simulation.world import World
from suite.typed import dataclass_of, plain


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
        "world": plain(run.settings),
        "outcome": run.outcome.value,
        "reached": run.reached,
        "hits": plain(run.hits),
        "opening": run.opening,
        "gates": plain(run.gates),
        "detected": dict(run.detected),
        "time": way.end,
        "length": way.length,
        "waiting_time": way.waiting_s,
        "trajectory": np.column_stack([way.times, way.xy]).tolist(),
        "courses": plain(run.courses),
        "replans": plain(run.replans),
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
    settings = dataclass_of(data["world"], WorldSettings)
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


def _replan_from_data(data: Mapping[str, Any]) -> Replan:
    return Replan(**{**data, "place": np.array(data["place"]), "path": _array(data["path"])})


def _array(path: Any) -> NDArray[np.float64] | None:
    return None if path is None else np.array(path, dtype=np.float64)
