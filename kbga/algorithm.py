"""KBGA as an object: set up on a scene, evolved generation by generation (paper II-D, Fig. 5)."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from kbga.encoding import empty_population, path_of
from kbga.evolution import Rates, best_feasible, first_population, next_generation
from kbga.measures import GenerationReport, measure
from kbga.operators.detour import make_scratch
from kbga.problem import make_problem
from kbga.settings import KBGASettings
from suite.scene import Query, Scene


class KBGA:
    """The knowledge-based genetic algorithm on one query of a scene.

    Parameters
    ----------
    scene : Scene
    query : Query
    settings : KBGASettings
    rng : numpy.random.Generator
        The only source of randomness.

    Attributes
    ----------
    population : Population
        The current parents; the random first population after construction.
    generation : int
        Generations done.
    best_path : (n, 2) float64, metres, the best feasible path so far; None before there is one.
    best_cost : float, its length, metres; infinite before there is one.
    generation_of_best : int, the generation in which it was found.
    lowest_cost : float, the lowest cost of any chromosome so far, penalties included, metres: the
        paper's best_sofar, which need not be feasible.
    generation_of_lowest : int, the generation in which it was found.
    """

    def __init__(
        self, scene: Scene, query: Query, settings: KBGASettings, rng: np.random.Generator
    ) -> None:
        self.settings = settings
        self._rng = rng
        self._problem = make_problem(scene.arrangement, scene.bounds, settings.resolution)
        # Of one type each: an int among the floats would have the kernels compiled once more.
        self._rates = Rates(
            float(settings.crossover_probability),
            float(settings.mutation_probability),
            float(settings.repair_probability),
            float(settings.deletion_probability),
            float(settings.improvement_probability),
            int(settings.tournament_size),
            float(settings.penalty),
            int(settings.repair_candidates),
            int(settings.improvement_radius),
            int(settings.rounds),
        )
        self.population = empty_population(settings.population_size, settings.max_nodes)
        self._children = empty_population(settings.population_size, settings.max_nodes)
        self._scratch = make_scratch()
        self._counter = np.zeros(1, np.int64)
        self.generation = 0
        self.best_path: NDArray[np.float64] | None = None
        self.best_cost = float("inf")
        self.generation_of_best = 0
        self.lowest_cost = float("inf")
        self.generation_of_lowest = 0
        first_population(
            self.population,
            query.start,
            query.goal,
            int(settings.initial_nodes),
            self._problem,
            self._rates.penalty,
            rng,
            self._counter,
        )
        self._take_best()

    @property
    def checks(self) -> int:
        """Collision checks of a segment against the scene so far."""
        return int(self._counter[0])

    @property
    def stagnant(self) -> bool:
        """Whether the best path has stood unchanged for as long as the settings allow."""
        return (
            self.best_path is not None
            and self.generation - self.generation_of_best >= self.settings.stagnation
        )

    def step(self) -> bool:
        """Do one generation; whether it found a better feasible path."""
        next_generation(
            self.population,
            self._children,
            self._scratch,
            self._problem,
            self._rates,
            self._rng,
            self._counter,
        )
        self.population, self._children = self._children, self.population
        self.generation += 1
        return self._take_best()

    def _take_best(self) -> bool:
        chromosomes = self.population.chromosomes
        lowest = float(chromosomes["cost"].min())
        if lowest < self.lowest_cost:
            self.lowest_cost = lowest
            self.generation_of_lowest = self.generation
        best = best_feasible(self.population)
        if best < 0 or not chromosomes["cost"][best] < self.best_cost:
            return False
        self.best_path = path_of(self.population, best)
        self.best_cost = float(chromosomes["cost"][best])
        self.generation_of_best = self.generation
        return True

    def report(self) -> GenerationReport:
        """Measures of the current population."""
        best, mean, feasible_share, diversity = measure(self.population)
        return GenerationReport(self.generation, best, mean, feasible_share, diversity, self.checks)

    def paths(self) -> list[NDArray[np.float64]]:
        """All paths of the current population, each (n, 2), metres."""
        return [path_of(self.population, i) for i in range(len(self.population.nodes))]

    def run(
        self,
        on_generation: Callable[["KBGA", bool], bool] | None = None,
    ) -> NDArray[np.float64] | None:
        """Evolve until a stop criterion holds; the best feasible path, or None.

        Parameters
        ----------
        on_generation : callable, optional
            Called with this object and whether the best path improved, for the first population
            and after each generation. Evolution ends when it returns False.
        """
        going = on_generation is None or on_generation(self, self.best_path is not None)
        while going and self.generation < self.settings.max_generations and not self.stagnant:
            improved = self.step()
            going = on_generation is None or on_generation(self, improved)
        return self.best_path
