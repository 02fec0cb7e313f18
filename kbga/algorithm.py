"""KBGA as an object: set up on a scene, evolved generation by generation (paper II-D, Fig. 5)."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kbga.counter import ASKED, COMPUTED, LIMIT, is_spent, make_counter
from kbga.deadline import Deadline
from kbga.draws import LEAST_BLOCK, Draws, left_of, make_draws, refill
from kbga.dynamic import disturb, most_draws_of_disturbance, renumber_corners, restart
from kbga.encoding import Population, copy_chromosome, empty_population, path_of
from kbga.evolution import (
    best_feasible,
    first_population,
    most_draws_of_a_pair,
    most_draws_of_first_population,
    next_children,
)
from kbga.measures import GenerationReport, measure
from kbga.memory import empty_memory, with_room
from kbga.operators.repair import scratch_for
from kbga.problem import Problem, make_problem
from kbga.selection import keep_elite
from kbga.settings import KBGASettings
from kbga.taut import is_feasible, make_strings, pull_promising, rest_of
from kbga.trace import trace_of
from kbga.tuning import empty_tally, rates_of, tuned
from suite.scenes.exact import path_length
from suite.scenes.reach import reachable_bounds
from suite.scenes.scene import Query, Scene

if TYPE_CHECKING:
    import pandas as pd


class KBGA:
    """The knowledge-based genetic algorithm on one query of a scene.

    Parameters
    ----------
    scene : Scene
        See :func:`suite.scenes.scene.make_scene`.
    query : Query or its name, optional
        From where to where; by default the scene's first.
    settings : KBGASettings, optional
        By default those of the paper, and ours where it is silent.
    rng : numpy.random.Generator or seed, optional
        The only source of randomness; by default a fresh one, and each run another.
    checks : int, optional
        Questions whether a segment is free that may be asked; the run ends with the last.

    Raises
    ------
    SceneError
        If the scene has no query of that name.

    Attributes
    ----------
    population : Population
        The current parents; the random first population after construction.
    generation : int
        Generations done, or under way; since the last change of the environment or the start.
    best_path : (n, 2) float64, metres, the best feasible path so far; None before there is one.
    best_cost : float, its length, metres; infinite before there is one.
    generation_of_best : int, the generation in which it was found.
    lowest_cost : float, the lowest cost of any chromosome so far, penalties included, metres: the
        paper's best_sofar, which need not be feasible.
    generation_of_lowest : int, the generation in which it was found.

    Examples
    --------
    >>> import shapely
    >>> from suite.scenes.scene import make_scene
    >>> room, wall = shapely.box(0, 0, 10, 10), np.array([(4, 0), (6, 0), (6, 8), (4, 8)])
    >>> ga = KBGA(make_scene("one wall", room, [wall], ((1, 1), (9, 1))), rng=1)
    >>> ga.run().tolist()
    [[1.0, 1.0], [4.0, 8.0], [6.0, 8.0], [9.0, 1.0]]
    """

    def __init__(
        self,
        scene: Scene,
        query: Query | str | None = None,
        settings: KBGASettings | None = None,
        rng: np.random.Generator | int | None = None,
        checks: int | None = None,
    ) -> None:
        query = _query_of(scene, query)
        settings = KBGASettings() if settings is None else settings
        if not isinstance(settings, KBGASettings):
            raise TypeError(f"settings is a {type(settings).__name__}; give a KBGASettings")
        rng = np.random.default_rng(rng)  # a Generator stays itself
        self.settings = settings
        self._rng = rng
        self._scene = scene
        over_room = settings.lattice_over == "room"
        self._bounds = scene.bounds if over_room else reachable_bounds(scene, query)
        self._ends = np.array([query.start, query.goal])
        self._problem = self._problem_of(scene)
        self._rates = rates_of(settings)
        self.population = empty_population(settings.population_size, settings.max_nodes)
        self._children = empty_population(settings.population_size, settings.max_nodes)
        self._scratch = scratch_for(self._problem, settings)
        self._strings = make_strings()
        self._counter = make_counter(checks)
        self._tally = empty_tally()
        informed = round(settings.informed_share * settings.population_size)
        self._draws = make_draws(rng, self._block_size(informed))
        self.generation = 0
        self.best_path: NDArray[np.float64] | None = None
        self.best_cost = float("inf")
        self.generation_of_best = 0
        self._best_chromosome = empty_population(1, settings.max_nodes)
        self._least_cost = float("inf")
        self.lowest_cost = float("inf")
        self.generation_of_lowest = 0
        self._reports: dict[int, GenerationReport] = {}
        self._children_made = 0
        first_population(
            self.population,
            query.start,
            query.goal,
            int(settings.initial_nodes),
            informed,
            self._scratch,
            self._problem,
            self._rates,
            self._draws,
            self._counter,
        )
        self._take_best(self.population, 0, len(self.population.chromosomes))
        self._take_lowest()

    def _block_size(self, informed: int) -> int:
        """Random numbers to draw at once: enough for all that is done at once, and some pairs."""
        settings = self.settings
        first = most_draws_of_first_population(
            settings.population_size, settings.initial_nodes, informed, self._rates
        )
        disturbance = most_draws_of_disturbance(settings.population_size)
        return max(LEAST_BLOCK, first, disturbance, 4 * most_draws_of_a_pair(self._rates))

    def _refilled(self, most: int) -> Draws:
        """The random numbers, of which ``most`` at least are left."""
        if left_of(self._draws) < most:
            refill(self._draws, self._rng)
        return self._draws

    @property
    def checks(self) -> int:
        """Questions asked whether a segment is free, since the last change of the scene."""
        return int(self._counter[ASKED])

    @property
    def computed_checks(self) -> int:
        """Those of them that were computed: the others had been asked before."""
        return int(self._counter[COMPUTED])

    @property
    def is_spent(self) -> bool:
        """Whether no question may be asked any more."""
        return bool(is_spent(self._counter))

    @property
    def stagnant(self) -> bool:
        """Whether the best path has stood unchanged for as long as the settings allow."""
        return (
            self.best_path is not None
            and self.generation - self.generation_of_best >= self.settings.stagnation
        )

    def step(
        self,
        on_improvement: Callable[["KBGA"], object] | None = None,
        deadline: Deadline | None = None,
    ) -> bool:
        """Do one generation; whether it found a better feasible path.

        Parameters
        ----------
        on_improvement : callable, optional
            Called with this object for each better path, as soon as the child is there.
        deadline : Deadline, optional
            Looked at on the way; the generation stays half done where the time is over.
        """
        self.generation += 1
        improved = False
        self._renew()
        made, count = 0, self._size
        while made < count:
            last = count
            if deadline is not None:
                last = min(count, made + deadline.children_after(self._children_made))
                if last == made:  # the parents are the population
                    return improved
            before = made
            draws = self._refilled(most_draws_of_a_pair(self._rates))
            made = next_children(
                self.population,
                self._children,
                before,
                last,
                self._least_cost,
                self._scratch,
                self._problem,
                self._rates,
                draws,
                self._counter,
                self._tally,
            )
            self._children_made += made - before
            if self._take_best(self._children, before, made):
                improved = True
                if on_improvement is not None:
                    on_improvement(self)
            if self.is_spent:  # as where the time is over
                return improved
        keep_elite(self.population, self._children)
        self.population, self._children = self._children, self.population
        memory = with_room(self._problem.memory, self.computed_checks)
        self._problem = self._problem._replace(memory=memory)
        self._take_lowest()
        if self.settings.adaptation_rate > 0.0:
            self._rates = tuned(self._rates, self._tally, float(self.settings.adaptation_rate))
            self._tally[:] = 0
        return improved

    def _take_best(self, population: Population, first: int, last: int) -> bool:
        """Note the best feasible path among some chromosomes if it is a better one; whether."""
        best = best_feasible(population, first, last)
        path, cost = None, self.best_cost
        if best >= 0 and population.chromosomes["cost"][best] < self._least_cost:
            copy_chromosome(population, best, self._best_chromosome, 0)
            self._least_cost = float(population.chromosomes["cost"][best])
            if self._least_cost < cost:
                path, cost = path_of(population, best), self._least_cost
        if best >= 0 and self.settings.taut:
            pulled = self._pull_taut(population, first, last, cost)
            if pulled is not None:
                path, cost = pulled, path_length(pulled)
        if path is None:
            return False
        self.best_path, self.best_cost = path, cost
        self.generation_of_best = self.generation
        return True

    def _pull_taut(
        self, population: Population, first: int, last: int, known: float
    ) -> NDArray[np.float64] | None:
        """The shortest string of some chromosomes, if it is shorter than what is known."""
        limit = float(self.settings.taut) * known
        arrays = self._problem.arrays
        return pull_promising(
            population, first, last, limit, known, self._strings, arrays, self._counter
        )

    def _renew(self) -> None:
        """Let new random chromosomes take the places of some, once nothing better was found.

        A population that has converged has one route, and its children are that route's. The best
        chromosome stays.
        """
        count = round(self.settings.immigrants * self._size)
        if count == 0 or self.best_path is None or self.generation_of_best >= self.generation - 1:
            return
        settings, population = self.settings, self.population
        count = min(count, self._size - 1)
        best = int(population.chromosomes["cost"].argmin())
        if best < count:
            copy_chromosome(population, best, population, self._size - 1)
        first_population(
            Population(population.nodes[:count], population.chromosomes[:count]),
            self._ends[0],
            self._ends[1],
            int(settings.initial_nodes),
            0,
            self._scratch,
            self._problem,
            self._rates,
            self._refilled(
                most_draws_of_first_population(count, settings.initial_nodes, 0, self._rates)
            ),
            self._counter,
        )

    def _take_lowest(self) -> None:
        lowest = float(self.population.chromosomes["cost"].min())
        if lowest < self.lowest_cost:
            self.lowest_cost = lowest
            self.generation_of_lowest = self.generation

    def go_on(self, scene: Scene, start: NDArray[np.float64], checks: int | None = None) -> None:
        """Keep the population, in an environment that may have changed, for another start.

        All is evaluated anew, and mutated at a high rate if the scene is another object than
        before (paper II-D). Generations, checks and the best count from here on; call :meth:`run`
        to evolve.

        Parameters
        ----------
        scene : Scene
            With the workspace of the one before; the same object if nothing has changed.
        start : (2,) float64, metres
            Where the robot is.
        checks : int, optional
            Questions that may be asked from here on.

        Raises
        ------
        ValueError
            If the workspace is another one: the lattice would be, too.
        """
        if scene.bounds != self._scene.bounds:
            raise ValueError(f"the workspace is {scene.bounds}; it was {self._scene.bounds}")
        changed = scene is not self._scene
        self._scene = scene
        self._ends[0] = start
        rest = self._rest()
        self._keep_best_path()
        if changed:
            before = self._problem.lattice
            self._problem = self._problem_of(scene)
            renumber_corners(self.population, before, self._problem.lattice)
            self._scratch = scratch_for(self._problem, self.settings)
        else:  # segments that begin at the start are others now
            self._problem = self._problem._replace(memory=empty_memory())
        self._counter[:] = make_counter(checks)
        self.generation = self.generation_of_best = self.generation_of_lowest = 0
        self.best_path, self.best_cost, self.lowest_cost = None, float("inf"), float("inf")
        self._least_cost = float("inf")
        self._reports.clear()
        x, y = (float(v) for v in start)  # of one type each, whatever the array's
        penalty = self._rates.penalty
        restart(self.population, x, y, self._problem, penalty, self._counter)
        self._strings = make_strings()
        self._take_best(self.population, 0, self._size)
        if changed:
            self._disturb()
            self._take_best(self.population, 0, self._size)
        if rest is not None:
            self._keep_rest(rest)
        self._take_lowest()

    def _rest(self) -> NDArray[np.float64] | None:
        """What is left of the string that the robot follows; None if it follows no string."""
        if self.best_path is None or not self.settings.taut:
            return None
        return rest_of(self.best_path, self._ends[0])

    def _keep_rest(self, rest: NDArray[np.float64]) -> None:
        """Keep what is left of the string that the robot follows, if it is free and still best.

        No chromosome holds it: its bends lie off the lattice.
        """
        asked = len(rest) - 1
        if self.checks + asked > self._counter[LIMIT]:
            return
        self._counter[[ASKED, COMPUTED]] += asked
        length = path_length(rest)
        if length < self.best_cost and is_feasible(rest, self._problem.arrays):
            self.best_path, self.best_cost = rest, length

    def _keep_best_path(self) -> None:
        """Put the best feasible path first, at the cost of the worst: of equal ones it is taken.

        The population may have lost it to infeasible ones that cost less.
        """
        if self._least_cost == float("inf"):
            return
        worst = int(self.population.chromosomes["cost"].argmax())
        copy_chromosome(self.population, 0, self.population, worst)
        copy_chromosome(self._best_chromosome, 0, self.population, 0)

    def _disturb(self) -> None:
        best = best_feasible(self.population, 0, self._size)
        spared = int(self.population.chromosomes["cost"].argmin()) if best < 0 else best
        probability = float(self.settings.change_mutation_probability)
        disturb(
            self.population,
            spared,
            probability,
            self._problem,
            self._rates,
            self._refilled(most_draws_of_disturbance(self._size)),
            self._counter,
        )

    def _problem_of(self, scene: Scene) -> Problem:
        return make_problem(
            scene.arrangement,
            self._bounds,
            self.settings.resolution,
            room=scene.workspace if self._bounds == scene.bounds else None,
            coordinates=scene.coordinates,
            reach=int(self.settings.repair_reach),
            corner_nodes=self.settings.corner_nodes,
        )

    @property
    def _size(self) -> int:
        return len(self.population.chromosomes)

    def report(self) -> GenerationReport:
        """Measures of the current population."""
        best, mean, feasible_share, diversity = measure(self.population)
        return GenerationReport(self.generation, best, mean, feasible_share, diversity, self.checks)

    def paths(self) -> list[NDArray[np.float64]]:
        """All paths of the current population, each (n, 2), metres."""
        return [path_of(self.population, i) for i in range(len(self.population.nodes))]

    def trace(self) -> "pd.DataFrame":
        """A row for each generation that was traced: the fields of :class:`GenerationReport`.

        Raises
        ------
        RuntimeError
            If none was: it is ``run(trace=True)`` that traces.
        """
        if not self._reports:
            raise RuntimeError("no generation was traced; run with run(trace=True)")
        return trace_of(self._reports.values())

    def run(
        self,
        on_generation: Callable[["KBGA", bool], bool | None] | None = None,
        on_improvement: Callable[["KBGA"], object] | None = None,
        *,
        trace: bool = False,
        left: Callable[[], float] | None = None,
    ) -> NDArray[np.float64] | None:
        """Evolve until a stop criterion holds; the best feasible path, or None.

        Called again, it goes on from where it was ended.

        Parameters
        ----------
        on_generation : callable, optional
            Called with this object and whether the best path improved, for the first population
            and after each generation. Evolution ends when it returns False (not when it returns
            None, as a function does that only looks on).
        on_improvement : callable, optional
            Called with this object whenever there is a better path, also within a generation.
        trace : bool
            Keep a report of each generation, for :meth:`trace`.
        left : callable, optional
            The seconds that are left. Asked for within a generation too, so that evolution ends
            when they are over, and not some children later.

        Returns
        -------
        (n, 2) float64, metres, from start to goal; None if no feasible path was found.

        Examples
        --------
        Stop as soon as a path is good enough, and look at how it went:

        >>> import shapely
        >>> from suite.scenes.scene import make_scene
        >>> walls = [shapely.box(3, 0, 4, 8), shapely.box(6, 2, 7, 10)]
        >>> scene = make_scene("two walls", shapely.box(0, 0, 10, 10), walls, ((1, 1), (9, 9)))
        >>> ga = KBGA(scene, rng=1)
        >>> path = ga.run(lambda ga, improved: ga.best_cost > 24.0, trace=True)
        >>> ga.best_cost <= 24.0, ga.stagnant
        (True, False)
        >>> trace = ga.trace()
        >>> list(trace.columns)
        ['generation', 'best', 'mean', 'feasible_share', 'diversity', 'checks']
        >>> len(trace) == ga.generation + 1
        True
        """
        deadline = None if left is None else Deadline(left)
        improved = self.best_path is not None
        if improved and self.generation == 0 and on_improvement is not None:
            on_improvement(self)
        while True:
            if trace:
                self._reports[self.generation] = self.report()
            answer = None if on_generation is None else on_generation(self, improved)
            ended = answer is not None and not answer
            ended |= self.is_spent or self.stagnant or (left is not None and left() <= 0.0)
            if ended or self.generation >= self.settings.max_generations:
                return self.best_path
            improved = self.step(on_improvement, deadline)


def _query_of(scene: Scene, query: Query | str | None) -> Query:
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; make a Scene with make_scene")
    return query if isinstance(query, Query) else scene.query(query)
