"""Improvement (paper II-C): move a node of a feasible path to a better place nearby."""

import numpy as np

from kbga.draws import Draws, draw
from kbga.encoding import Population, contains, forget, is_crossing, set_node
from kbga.evaluation import is_free_segment, sum_up
from kbga.operators.detour import Scratch, bring_shortest_forward, list_candidate
from kbga.problem import Problem, is_known_usable
from kbga.tuning import Rates
from suite.jit import kernel

# The eight neighbours of a node, by columns and rows.
_COLUMNS = (1, 1, 0, -1, -1, -1, 0, 1)
_ROWS = (0, 1, 1, 1, 0, -1, -1, -1)

# A gain below this is rounding, and a search that followed it need not end. Share of a unit.
_LEAST_GAIN = 1e-9


@kernel
def _move(
    nodes: np.ndarray,
    i: int,
    size: int,
    k: int,
    step: int,
    scratch: Scratch,
    problem: Problem,
    counter: np.ndarray,
) -> bool:
    """Move node k by ``step`` lattice units to the neighbour that shortens the path most.

    Whether it moved.
    """
    lattice, arrays, memory = problem.lattice, problem.arrays, problem.memory
    columns, rows = lattice.columns, lattice.rows
    trial, candidates = scratch.nodes, scratch.candidates
    column, row = nodes[i, k].gene % columns, nodes[i, k].gene // columns
    trial[0, 0] = nodes[i, k - 1]
    trial[0, 2] = nodes[i, k + 1]
    limit = nodes[i, k - 1].length + nodes[i, k].length - _LEAST_GAIN * lattice.unit
    count = 0
    for neighbour in range(8):
        new_column = column + step * _COLUMNS[neighbour]
        new_row = row + step * _ROWS[neighbour]
        if 0 <= new_column < columns and 0 <= new_row < rows:
            listed = list_candidate(scratch, count, new_row * columns + new_column, lattice)
            count = listed if candidates[count].length < limit else count
    for c in range(count):
        bring_shortest_forward(candidates, c, count)
        gene = candidates[c].gene
        if not is_known_usable(gene, problem) or contains(nodes, i, size, gene):
            continue
        set_node(trial, 0, 1, gene, lattice)
        if is_free_segment(trial, 0, 0, arrays, memory, counter) and is_free_segment(
            trial, 0, 1, arrays, memory, counter
        ):
            nodes[i, k - 1] = trial[0, 0]
            nodes[i, k] = trial[0, 1]
            return True
    return False


@kernel
def _is_crowded(nodes: np.ndarray, i: int, size: int, k: int, columns: int) -> bool:
    """Whether a lattice neighbour of node k is in the path already, elsewhere than beside k.

    It may be a better place, and may leave the path later without anything changing beside k.
    """
    column, row = nodes[i, k].gene % columns, nodes[i, k].gene // columns
    for m in range(1, size + 1):
        if (
            abs(m - k) > 1
            and abs(nodes[i, m].gene % columns - column) <= 1
            and abs(nodes[i, m].gene // columns - row) <= 1
        ):
            return True
    return False


@kernel
def _random_node(nodes: np.ndarray, i: int, size: int, draws: Draws) -> int:
    """Column of a random intermediate node that is not known to be settled; 0 if there is none."""
    count = 0
    for k in range(1, size + 1):
        count += not nodes[i, k].settled
    if count == 0:
        return 0
    left = int(draw(draws) * count)
    k = 1
    while nodes[i, k].settled or left > 0:
        left -= not nodes[i, k].settled
        k += 1
    return k


@kernel
def improve(
    population: Population,
    i: int,
    scratch: Scratch,
    problem: Problem,
    rates: Rates,
    draws: Draws,
    counter: np.ndarray,
) -> bool:
    """Improve a random node of chromosome i if that is feasible; whether the node moved.

    One step to the best neighbour; or a pattern search over the neighbours: steps that help are
    doubled, up to ``improvement_radius`` lattice units, others halved, until a step of one unit
    does not help. A node without a better neighbour is settled until a neighbour changes. One at
    the corner of an obstacle has no neighbours, and stays.
    """
    size = population.chromosomes[i].intermediate
    if population.chromosomes[i].infeasible > 0:
        return False
    nodes = population.nodes
    k = _random_node(nodes, i, size, draws)
    if k == 0:
        return False
    if not is_crossing(problem.lattice, nodes[i, k].gene):
        nodes[i, k].settled = 1
        return False
    step = 1
    moved = False
    while step > 0:
        if _move(nodes, i, size, k, step, scratch, problem, counter):
            moved = True
            if rates.improvement_radius == 0:
                break
            step = min(2 * step, rates.improvement_radius)
        else:
            step //= 2
    if moved:
        forget(nodes, i, k - 1, k + 1)
        sum_up(population, i, rates.penalty)
    if (
        rates.remembers
        and step == 0
        and not _is_crowded(nodes, i, size, k, problem.lattice.columns)
    ):
        nodes[i, k].settled = 1
    return moved
