"""What the benchmarks of planners share: scenes, seeds, and a recorder that ends a run in time."""

from functools import cache

import numpy as np

from suite.planner import Budget, Plan, Planner, Recorder
from suite.plugins.discovery import load_planner
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Scene

SCENES = (
    "unstructured",
    "maze",
    "zigzag",
    "double_u",
    "clustered",
    "obstacles_20",
    "obstacles_30",
    "obstacles_40",
)
"""The eight of the paper."""

OURS = ("kbga", "kbga-plus")
"""The planners that are compared with the others: the paper's, and ours."""

OMPL_PLANNERS = (
    "ompl-rrtstar",
    "ompl-prmstar",
    "ompl-informedrrtstar",
    "ompl-sorrtstar",
    "ompl-bitstar",
    "ompl-aorrtc",
    "ompl-shortcut",
)

TUNED: dict[str, dict[str, float]] = {
    "ompl-rrtstar": {"range": 10.0, "k_nearest": False},
    "ompl-prmstar": {"slice_growth": 0.3},
    "ompl-informedrrtstar": {"range": 10.0, "k_nearest": False},
    "ompl-sorrtstar": {"range": 10.0, "k_nearest": False},
    "ompl-bitstar": {"samples_per_batch": 1000},
    "ompl-aorrtc": {"range": 5.0},
    "ompl-shortcut": {"rope": 2.0},
}
"""The settings of each that did best on the scenes of the matrix ompl-tuning, by its rule."""

RIVALS = (*OMPL_PLANNERS, *(f"{name}-tuned" for name in TUNED))

SEEDS = 20

WALL_S = 1.0
"""How long a run may look for a path within 1 %: a hundred times the goal for KBGA's whole run."""

NEAR = 1.01
"""Within 1 % of the exact optimum."""


class UntilNear(Recorder):
    """Says that all time is up as soon as a path of the wanted cost is known, which ends the run.

    Improvements carry the true time.
    """

    def __init__(self, cost: float) -> None:
        super().__init__()
        self.cost = cost
        self.near_s: float | None = None

    def improved(self, cost, *, generation=None, checks=None) -> None:
        super().improved(cost, generation=generation, checks=checks)
        if self.near_s is None and cost <= self.cost:
            self.near_s = self.improvements[-1].wall_s

    def wall_s(self) -> float:
        return super().wall_s() if self.near_s is None else float("inf")


@cache
def scene(name: str) -> Scene:
    """A scene with everything computed that belongs to it and not to a run."""
    found = load_scene(name)
    _ = found.arrangement
    return found


@cache
def optimum(name: str) -> float:
    return shortest_path(scene(name), scene(name).query()).length


def planner(name: str, **settings: float) -> Planner:
    """A planner by its name, or one of OMPL's with its tuned settings: ``ompl-rrtstar-tuned``."""
    plain = name.removesuffix("-tuned")
    found = load_planner(plain)
    if plain != name:
        settings = TUNED[plain] | settings
    made = found(found.Settings(**settings))
    made.warm_up()
    return made


def plan(
    of: Planner,
    name: str,
    seed: int,
    budget: Budget | None = None,
    recorder: Recorder | None = None,
) -> Plan:
    """One run; the clock starts immediately before it."""
    where, rng, recorder = scene(name), np.random.default_rng(seed), recorder or Recorder()
    query = where.query()
    recorder.start_clock()
    return of.plan(where, query, budget or Budget(), rng, recorder)
