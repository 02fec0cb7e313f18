"""A population on a lattice scene, operators at hand, and everything that must hold of it.

Fresh evaluations come from the kernel; that the kernel is right is for `test_evaluation.py` to
say, with shapely as oracle.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from kbga.counter import make_counter
from kbga.draws import Draws, left_of, make_draws, refill
from kbga.encoding import (
    GOAL,
    NEEDED,
    START,
    Population,
    empty_population,
    path_of,
)
from kbga.evaluation import evaluate_segment
from kbga.evolution import best_feasible, first_population, next_children
from kbga.memory import empty_memory
from kbga.operators.crossover import crossover
from kbga.operators.deletion import delete
from kbga.operators.detour import Scratch
from kbga.operators.improvement import improve
from kbga.operators.mutation import mutate
from kbga.operators.repair import repair, scratch_for
from kbga.problem import Problem, make_problem, near_count, near_node
from kbga.selection import keep_elite
from kbga.settings import KBGAPlusSettings, KBGASettings
from kbga.tuning import Rates, empty_tally, rates_of
from suite.geometry.kernels import first_collision
from suite.scenes.scene import Query, Scene, make_scene
from tests.suite.geometry.lattice import Rng, random_solid

BLOCK = 20_000
"""Random numbers that are at hand for whatever is done at once."""

ROOM = shapely.box(0, 0, 10, 10)
ENDS = ((1.0, 1.0), (9.0, 9.0))


def scene_of(*obstacles: Polygon, room: Polygon = ROOM, ends: tuple = ENDS) -> Scene:
    return make_scene("drawn", room, obstacles, {"main": ends})


def random_scene(rng: Rng) -> Scene:
    """Obstacles on a small lattice that touch, overlap and meet the border; free ends."""
    room, obstacles = random_solid(rng)
    xmin, ymin, xmax, ymax = (int(v) for v in room.bounds)
    grid = [(float(x), float(y)) for x in range(xmin, xmax + 1) for y in range(ymin, ymax + 1)]
    closed = shapely.union_all([*obstacles, room.envelope.buffer(1.0).difference(room)])
    free = [p for p in grid if not shapely.contains_xy(closed, *p)]
    if not free:
        return random_scene(rng)
    start, goal = (free[int(k)] for k in rng.integers(0, len(free), 2))
    return make_scene("lattice", room, obstacles, {"main": (start, goal)})


@dataclass
class Laboratory:
    """Parents, children and whatever the operators want to be handed."""

    query: Query
    settings: KBGASettings
    problem: Problem
    rates: Rates
    rng: Rng
    draws: Draws
    population: Population
    children: Population
    scratch: Scratch
    counter: NDArray[np.int64]
    tally: NDArray[np.int64]

    def fresh_draws(self) -> Draws:
        """Random numbers, enough for anything that is done at once."""
        if left_of(self.draws) < len(self.draws.values) // 2:
            refill(self.draws, self.rng)
        return self.draws

    def mutate(self, i: int) -> bool:
        draws = self.fresh_draws()
        return mutate(self.population, i, self.problem, self.rates.penalty, draws, self.counter)

    def repair(self, i: int) -> bool:
        return repair(
            self.population,
            i,
            self.scratch,
            self.problem,
            self.rates,
            self.fresh_draws(),
            self.counter,
        )

    def delete(self, i: int) -> bool:
        return delete(
            self.population,
            i,
            self.scratch,
            self.problem,
            self.rates,
            self.fresh_draws(),
            self.counter,
        )

    def improve(self, i: int) -> bool:
        return improve(
            self.population,
            i,
            self.scratch,
            self.problem,
            self.rates,
            self.fresh_draws(),
            self.counter,
        )

    def cross(self, i: int, j: int, c: int, d: int) -> bool:
        """Children c and d of parents i and j; the parents stay as they are."""
        return crossover(
            self.population,
            i,
            j,
            self.children,
            c,
            d,
            self.problem,
            self.rates.penalty,
            self.fresh_draws(),
            self.counter,
        )

    def next_generation(self) -> None:
        """As :meth:`kbga.algorithm.KBGA.step` does it."""
        count = len(self.population.chromosomes)
        best = self.best_feasible_cost(self.population, 0, count)
        made = 0
        while made < count:
            before, made = made, self.make_children(made, best)
            best = min(best, self.best_feasible_cost(self.children, before, made))
        keep_elite(self.population, self.children)
        self.population, self.children = self.children, self.population

    def make_children(self, first: int, best: float) -> int:
        """Children from place ``first`` on, until one is feasible and costs less than ``best``."""
        return next_children(
            self.population,
            self.children,
            first,
            len(self.population.chromosomes),
            best,
            self.scratch,
            self.problem,
            self.rates,
            self.fresh_draws(),
            self.counter,
            self.tally,
        )

    def best_feasible_cost(self, population: Population, first: int, last: int) -> float:
        best = best_feasible(population, first, last)
        return float(population.chromosomes["cost"][best]) if best >= 0 else np.inf

    def genes(self, i: int) -> list[int]:
        """Intermediate nodes of chromosome i."""
        return genes_of(self.population, i)

    def cost(self, i: int) -> float:
        return float(self.population.chromosomes["cost"][i])

    def is_feasible(self, i: int) -> bool:
        return bool(self.population.chromosomes["infeasible"][i] == 0)


def near_nodes(problem: Problem, group: int) -> list[int]:
    """Free lattice nodes next to the corners of an obstacle group."""
    count = near_count(group, problem)
    return [int(near_node(group, n, problem)) for n in range(count)]


def all_near_nodes(problem: Problem) -> list[int]:
    """Those of all groups, and of the frame."""
    return [n for g in range(len(problem.arrays.groups)) for n in near_nodes(problem, g)]


def genes_of(population: Population, i: int) -> list[int]:
    size = int(population.chromosomes["intermediate"][i])
    return population.nodes["gene"][i, 1 : size + 1].tolist()


def laboratory(scene: Scene, seed: int = 0, **settings: float) -> Laboratory:
    """A first population on a scene, with any of KBGAPlusSettings, which use operators fully."""
    chosen = KBGAPlusSettings(**{"resolution": 10, "population_size": 10, **settings})
    rates = rates_of(chosen)
    query = scene.query()
    rng = np.random.default_rng(seed)
    problem = make_problem(
        scene.arrangement,
        scene.bounds,
        chosen.resolution,
        room=scene.workspace,
        reach=chosen.repair_reach,
    )
    made = Laboratory(
        query=query,
        settings=chosen,
        problem=problem,
        rates=rates,
        rng=rng,
        draws=make_draws(rng, 2 * BLOCK),
        population=empty_population(chosen.population_size, chosen.max_nodes),
        children=empty_population(chosen.population_size, chosen.max_nodes),
        scratch=scratch_for(problem, chosen),
        counter=make_counter(),
        tally=empty_tally(),
    )
    first_population(
        made.population,
        query.start,
        query.goal,
        chosen.initial_nodes,
        round(chosen.informed_share * chosen.population_size),
        made.scratch,
        made.problem,
        rates,
        made.fresh_draws(),
        made.counter,
    )
    return made


def with_paths(lab: Laboratory, *paths: list[tuple[float, float]]) -> Laboratory:
    """The same laboratory with its first chromosomes replaced by lattice nodes of our choice."""
    nodes, chromosomes = lab.population
    lattice = lab.problem.lattice
    for i, path in enumerate(paths):
        places = [lab.query.start, *path, lab.query.goal]
        row = nodes[i]
        row[:] = np.zeros(1, row.dtype)
        for k, (x, y) in enumerate(places):
            column, line = (x - lattice.x0) / lattice.unit, (y - lattice.y0) / lattice.unit
            row["gene"][k] = round(line) * lattice.columns + round(column)
            row["x"][k], row["y"][k] = x, y
        row["gene"][0], row["gene"][len(path) + 1] = START, GOAL
        fresh = evaluated(lab, row[: len(places)])
        row[: len(places)] = fresh
        segments = fresh[:-1]
        chromosomes["intermediate"][i] = len(path)
        chromosomes["infeasible"][i] = (segments["depth"] > 0).sum()
        chromosomes["cost"][i] = sum_of_costs(segments, lab.rates.penalty)
    return lab


def sum_of_costs(segments: np.ndarray, penalty: float) -> float:
    """Eq. (1), summed in the order of the path."""
    total = 0.0
    for length, depth in zip(segments["length"].tolist(), segments["depth"].tolist(), strict=True):
        total += length + depth * penalty
    return total


def evaluated(lab: Laboratory, row: np.ndarray) -> np.ndarray:
    """The nodes of one chromosome as a fresh evaluation of its genes and places finds them."""
    fresh = empty_population(1, max(2, len(row))).nodes
    for name in ("gene", "x", "y"):
        fresh[name][0, : len(row)] = row[name]
    for k in range(len(row) - 1):
        evaluate_segment(fresh, 0, k, lab.problem.arrays, empty_memory(), make_counter())
    return fresh[0, : len(row)]


def detour(lab: Laboratory, before: np.void, gene: int, after: np.void) -> np.ndarray:
    """Two segments over a lattice node, evaluated."""
    row = empty_population(1, 3).nodes
    row[0, 0], row[0, 2] = before, after
    row["gene"][0, 1] = gene
    row["x"][0, 1], row["y"][0, 1] = place_of(lab, gene)
    return evaluated(lab, row[0])[:2]


def place_of(lab: Laboratory, gene: int) -> tuple[float, float]:
    """Coordinates of a lattice number, as the scene's grid of 1e-9 m has them."""
    lattice = lab.problem.lattice
    x = np.round(lattice.x0 + lattice.unit * (gene % lattice.columns), 9)
    y = np.round(lattice.y0 + lattice.unit * (gene // lattice.columns), 9)
    return float(x), float(y)


def check(lab: Laboratory, population: Population | None = None) -> None:
    """Everything that must hold of a population, whatever was done to it."""
    population = lab.population if population is None else population
    for i in range(len(population.nodes)):
        check_chromosome(lab, population, i)
    best = best_feasible(population, 0, len(population.nodes))
    if best >= 0:
        assert first_collision(path_of(population, best), lab.problem.arrays) == -1


def check_chromosome(lab: Laboratory, population: Population, i: int) -> None:
    chromosome = population.chromosomes[i]
    size = int(chromosome["intermediate"])
    assert size + 2 <= population.nodes.shape[1]
    row = population.nodes[i, : size + 2]
    genes = row["gene"].tolist()
    assert (genes[0], genes[-1]) == (START, GOAL)
    assert (row["x"][0], row["y"][0]) == tuple(lab.query.start)
    assert (row["x"][-1], row["y"][-1]) == tuple(lab.query.goal)
    places = [place_of(lab, gene) for gene in genes[1:-1]]
    assert list(zip(row["x"][1:-1].tolist(), row["y"][1:-1].tolist(), strict=True)) == places
    assert all(0 <= gene < len(lab.problem.usable) for gene in genes[1:-1])
    assert len(set(genes)) == len(genes), "a lattice node occurs twice"
    check_records(lab, chromosome, row)
    for k in range(1, size + 1):
        check_flags(lab, row, k)


def check_records(lab: Laboratory, chromosome: np.void, row: np.ndarray) -> None:
    """What is recorded equals what a fresh evaluation finds, bit for bit."""
    segments, fresh = row[:-1], evaluated(lab, row)[:-1]
    for name in ("length", "depth", "hit_count"):
        assert segments[name].tolist() == fresh[name].tolist(), name
    for known, found in zip(segments, fresh, strict=True):
        count = int(found["hit_count"])
        assert known["hits"][:count].tolist() == found["hits"][:count].tolist()
    assert chromosome["infeasible"] == (fresh["depth"] > 0.0).sum()
    assert chromosome["cost"] == sum_of_costs(fresh, lab.rates.penalty)


def check_flags(lab: Laboratory, row: np.ndarray, k: int) -> None:
    """A flag says the truth: trying again would find no benefit."""
    before, node, after = row[k - 1], row[k], row[k + 1]
    if node["settled"]:
        genes = set(row["gene"].tolist())
        for gene in neighbours(lab, int(node["gene"])):
            new = detour(lab, before, gene, after)
            gain = before["length"] + node["length"] - new["length"].sum()
            free = (new["depth"] == 0.0).all()
            assert gene in genes or not free or gain < 2e-9, "settled, and could be improved"
    if node["needed"]:
        cut = evaluated(lab, row[[k - 1, k + 1]])[0]
        assert cut["depth"] > 0.0, "needed, and could be deleted from a feasible path"
        if node["needed"] == NEEDED:
            penalty = lab.rates.penalty
            known = sum(float(n["length"] + n["depth"] * penalty) for n in (before, node))
            assert cut["length"] + cut["depth"] * penalty >= known - 1e-9


def neighbours(lab: Laboratory, gene: int) -> list[int]:
    columns, rows = lab.problem.lattice.columns, lab.problem.lattice.rows
    column, line = gene % columns, gene // columns
    return [
        j * columns + i
        for i in range(max(0, column - 1), min(columns, column + 2))
        for j in range(max(0, line - 1), min(rows, line + 2))
        if (i, j) != (column, line)
    ]
