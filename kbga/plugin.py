"""KBGA behind the plugin interface of ``suite.planner``."""

from collections.abc import Callable
from dataclasses import replace
from math import inf
from typing import ClassVar

import numpy as np
import shapely

from kbga.algorithm import KBGA
from kbga.memory import FIRST_SLOTS, empty_memory, with_room
from kbga.settings import KBGAPlusSettings, KBGASettings
from suite.planner import Abilities, Budget, Plan, Planner, PlanStatus, Recorder, Replanner
from suite.scenes.reach import no_way
from suite.scenes.scene import Query, Scene, make_scene, scene_at


class KBGAPlanner(Planner[KBGASettings]):
    """The knowledge-based genetic algorithm of Hu and Yang, as their paper has it."""

    name = "kbga"
    Settings: ClassVar[type[KBGASettings]] = KBGASettings
    abilities: ClassVar[Abilities] = Abilities(
        anytime=True,
        budgets=frozenset({"wall_s", "cpu_s", "generations", "checks"}),
        population=True,
    )

    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,
        rng: np.random.Generator,
        recorder: Recorder,
    ) -> Plan:
        """Evolve until a stop criterion of the settings or the budget ends the run.

        Without a feasible path, the claimed cost is that of the best infeasible one, penalties
        included, as the paper's Table 1 has it for the GA without specialised operators.
        The trace has a row per generation: best, mean, feasible_share, diversity and checks.
        A budget of checks or time ends the run at once, also within a generation.
        """
        if self.settings.proves and (reason := no_way(scene, query)):
            return Plan(PlanStatus.INFEASIBLE, checks=0, computed_checks=0, reason=reason)
        ga = KBGA(scene, query, self.settings, rng, budget.checks)
        return evolved(ga, budget, recorder)

    def replanner(self, rng: np.random.Generator) -> Replanner:
        """KBGA that keeps its population from plan to plan.

        Its lattice lies over the room: what is free changes, and chromosomes are lattice numbers.
        """
        return KBGAReplanner(replace(self.settings, lattice_over="room"), rng)

    def warm_up(self) -> None:
        """Compile the kernels, or load them, on a scene that makes every operator work.

        Those of these settings: what pulls paths taut is loaded for nobody else.
        """
        scene = make_scene(
            "warm-up",
            shapely.box(0.0, 0.0, 10.0, 10.0),
            [shapely.box(4.0, 0.0, 6.0, 7.7)],  # its corners lie off the lattice
            {"main": ((1.0, 1.0), (9.0, 1.0))},
        )
        settings = replace(
            self.settings, resolution=10, population_size=10, max_generations=10, stagnation=10
        )
        KBGA(scene, scene.query(), settings, np.random.default_rng(0))
        settings = replace(settings, corner_nodes=False)  # at corners nothing would be pulled taut
        ga = KBGA(scene, scene.query(), settings, np.random.default_rng(0))
        ga.run(lambda ga, _: ga.report().generation < 10)
        # Another object, so that the environment has changed.
        ga.go_on(scene_at(scene, 0.0), np.array([2.0, 2.0]))
        with_room(empty_memory(), FIRST_SLOTS)  # a run as short as this needs no larger table


class KBGAPlusPlanner(KBGAPlanner):
    """KBGA with what we found to make it better: see :class:`kbga.settings.KBGAPlusSettings`."""

    name = "kbga-plus"
    Settings = KBGAPlusSettings


class KBGAReplanner(Replanner):
    """KBGA in a dynamic environment (paper II-D): the population lives on from update to update."""

    def __init__(self, settings: KBGASettings, rng: np.random.Generator) -> None:
        self._settings = settings
        self._rng = rng
        self._ga: KBGA | None = None

    def begin(self, scene: Scene, query: Query, budget: Budget, recorder: Recorder) -> Plan:
        """Evolve a first population."""
        self._ga = KBGA(scene, query, self._settings, self._rng, budget.checks)
        return evolved(self._ga, budget, recorder)

    def update(self, scene: Scene, query: Query, budget: Budget, recorder: Recorder) -> Plan:
        """Go on with the population, in what is known now and from where the robot is."""
        if self._ga is None:
            return self.begin(scene, query, budget, recorder)
        self._ga.go_on(scene, query.start, budget.checks)
        return evolved(self._ga, budget, recorder)


def evolved(ga: KBGA, budget: Budget, recorder: Recorder) -> Plan:
    """Evolve within a budget and tell the recorder of it; what came of it as a plan."""

    def improved(ga: KBGA) -> None:
        recorder.improved(ga.best_cost, generation=ga.generation, checks=ga.checks)

    def follow(ga: KBGA, _: bool) -> bool:
        if recorder.wants_snapshot(ga.generation):
            recorder.snapshot(ga.generation, ga.paths(), ga.best_path)
        report = ga.report()
        recorder.describe_generation(
            {
                "generation": report.generation,
                "best": report.best,
                "mean": report.mean,
                "feasible_share": report.feasible_share,
                "diversity": report.diversity,
                "checks": report.checks,
            }
        )
        return budget.generations is None or ga.generation < budget.generations

    path = ga.run(follow, improved, left=seconds_left(budget, recorder))
    found = path is not None
    return Plan(
        PlanStatus.SOLVED if found else PlanStatus.EXHAUSTED,
        path,
        claimed_cost=ga.best_cost if found else ga.lowest_cost,
        generations=ga.generation,
        generation_of_best=ga.generation_of_best if found else ga.generation_of_lowest,
        checks=ga.checks,
        computed_checks=ga.computed_checks,
    )


def seconds_left(budget: Budget, recorder: Recorder) -> Callable[[], float] | None:
    """What tells the seconds that are left of a budget; None if it has none of time."""
    if budget.wall_s is None and budget.cpu_s is None:
        return None
    wall_s, cpu_s = (inf if s is None else s for s in (budget.wall_s, budget.cpu_s))
    return lambda: min(wall_s - recorder.wall_s(), cpu_s - recorder.cpu_s())
