"""A GA with crossover and mutation only: KBGA's machinery with the knowledge switched off.

Paper section IV: "we only keep crossover and mutation operators, and shut off all the other
operators", with the mutation rate that served it best (Table 1). Representation, evaluation,
selection and elitism are those of KBGA, so that the difference is the knowledge alone.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from kbga.plugin import KBGAPlanner
from kbga.settings import KBGASettings
from suite.planner import Abilities, Budget, Plan, Planner, Recorder
from suite.scenes.scene import Query, Scene


@dataclass(frozen=True, slots=True)
class PlainGASettings:
    """Parameters of the plain GA; the others are KBGA's defaults.

    mutation_probability : per chromosome (paper Table 1: 0.5, the best of those tried). The same
        search gives 0.7 in this suite, see results/mutation-rate: 16 of 20 paths on zigzag.
    crossover_probability : per pair of parents (paper III: 0.9).
    initial_nodes : most intermediate nodes of a chromosome in the first population, as for KBGA.
    penalty : the constant C of Eq. (1), as for KBGA.
    max_generations : the paper's plain GA found its best at generation 346 on average.
    stagnation : generations without a better path before it stops, once it has one (ours: far
        more than KBGA's, so that the plain GA never loses by stopping early).
    """

    mutation_probability: float = 0.7
    crossover_probability: float = 0.9
    initial_nodes: int = 8
    penalty: float = 140.0
    max_generations: int = 500
    stagnation: int = 200

    def __post_init__(self) -> None:
        self.as_kbga()

    def as_kbga(self) -> KBGASettings:
        """The same as settings of KBGA with repair, deletion and improvement switched off."""
        return KBGASettings(
            mutation_probability=self.mutation_probability,
            crossover_probability=self.crossover_probability,
            repair_probability=0.0,
            deletion_probability=0.0,
            improvement_probability=0.0,
            initial_nodes=self.initial_nodes,
            penalty=self.penalty,
            max_generations=self.max_generations,
            stagnation=self.stagnation,
        )


class PlainGAPlanner(Planner[PlainGASettings]):
    """The GA without specialised operators that the paper compares with."""

    name = "plain-ga"
    Settings = PlainGASettings
    abilities: ClassVar[Abilities] = KBGAPlanner.abilities

    def plan(
        self,
        scene: Scene,
        query: Query,
        budget: Budget,
        rng: np.random.Generator,
        recorder: Recorder,
    ) -> Plan:
        """Evolve by crossover and mutation until a stop criterion or the budget ends the run."""
        return KBGAPlanner(self.settings.as_kbga()).plan(scene, query, budget, rng, recorder)

    def warm_up(self) -> None:
        """Compile the kernels, or load them."""
        KBGAPlanner().warm_up()
