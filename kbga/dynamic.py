"""A population in a changed environment, and with a robot that moves (paper II-D, III-D).

The population is kept. Its start is moved to where the robot is, everything is evaluated anew, and
if the environment changed, mutation at a high rate makes the population diverse again.
"""

import numpy as np

from kbga.draws import Draws, draw
from kbga.encoding import (
    START,
    Lattice,
    Population,
    close_columns,
    distance_to_segment,
    forget,
    nearest_crossing,
    set_node,
)
from kbga.evaluation import evaluate_segment, sum_up
from kbga.operators.mutation import mutate
from kbga.problem import Problem
from kbga.tuning import Rates
from suite.jit import kernel


@kernel
def restart(
    population: Population,
    x: float,
    y: float,
    problem: Problem,
    penalty: float,
    counter: np.ndarray,
) -> None:
    """Let all chromosomes begin at a new start (x, y), and evaluate them in their environment.

    Nodes that the robot has passed are dropped (ours): those before the place where it is nearest
    to the path. The path that it follows so stays the same from where it is.
    """
    nodes = population.nodes
    for i in range(nodes.shape[0]):
        passed = _nearest_segment(nodes, i, population.chromosomes[i].intermediate, x, y)
        close_columns(population, i, 1, passed)
        nodes[i, 0].gene, nodes[i, 0].x, nodes[i, 0].y = START, x, y
        size = population.chromosomes[i].intermediate
        forget(nodes, i, 0, size + 1)
        for k in range(size + 1):
            evaluate_segment(nodes, i, k, problem.arrays, problem.memory, counter)
        sum_up(population, i, penalty)


@kernel
def _nearest_segment(nodes: np.ndarray, i: int, size: int, x: float, y: float) -> int:
    """The segment of chromosome i that is nearest to a place; of several, the last."""
    nearest = 0
    least = np.inf
    for k in range(size + 1):
        ax, ay = nodes[i, k].x, nodes[i, k].y
        bx, by = nodes[i, k + 1].x, nodes[i, k + 1].y
        away = distance_to_segment(x, y, ax, ay, bx, by)
        if away <= least:
            nearest, least = k, away
    return nearest


def renumber_corners(population: Population, before: Lattice, lattice: Lattice) -> None:
    """Give nodes at corners of obstacles the numbers that these have in a changed environment.

    One whose corner is no longer there moves to the nearest crossing of the lattice (ours).

    Parameters
    ----------
    population : Population
        To be evaluated after.
    before, lattice : Lattice
        Of the environment as it was and as it is, with the same crossings.
    """
    crossings = lattice.columns * lattice.rows
    if not len(before.corners):
        return
    numbers = {(x, y): crossings + n for n, (x, y) in enumerate(lattice.corners.tolist())}
    nodes = population.nodes
    columns = np.arange(nodes.shape[1]) <= population.chromosomes["intermediate"][:, None]
    for i, k in np.argwhere((nodes["gene"] >= crossings) & columns):
        x, y = float(nodes["x"][i, k]), float(nodes["y"][i, k])
        gene = numbers.get((x, y))
        if gene is None:
            set_node(nodes, i, k, nearest_crossing(lattice, x, y), lattice)
        else:
            nodes["gene"][i, k] = gene


def most_draws_of_disturbance(population_size: int) -> int:
    """Random numbers that a disturbance takes at most: whether, where, and what, for each."""
    return 3 * population_size


@kernel
def disturb(
    population: Population,
    spared: int,
    probability: float,
    problem: Problem,
    rates: Rates,
    draws: Draws,
    counter: np.ndarray,
) -> None:
    """Apply mutation with a high probability to all chromosomes but one: the best stays as it is.

    So a change of the environment that does not concern the best path leaves it unchanged.
    """
    for i in range(population.chromosomes.size):
        if i != spared and draw(draws) < probability:
            mutate(population, i, problem, rates.penalty, draws, counter)
