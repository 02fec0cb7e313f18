"""Lattice numbers are places, and edits move nodes with all that is known of them."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from kbga.encoding import (
    NODE,
    Population,
    close_columns,
    contains,
    copy_chromosome,
    empty_population,
    forget,
    make_lattice,
    node_x,
    node_y,
    open_column,
    path_of,
    set_node,
)
from tests.kbga.laboratory import all_near_nodes, laboratory, scene_of

BOUNDS = [
    (0.0, 0.0, 100.0, 100.0),
    (0.0, 0.0, 10.0, 1.0),
    (-3.5, 20.0, 4.1, 20.7),
    (0.1, 0.1, 0.7, 0.8),
    (-1e4, -1e4, -9e3, 1e4),
]


@pytest.mark.parametrize("bounds", BOUNDS)
@pytest.mark.parametrize("resolution", [2, 3, 7, 100])
def test_a_lattice_number_and_its_place_tell_the_same(bounds, resolution):
    lattice = make_lattice(bounds, resolution)
    columns, count = lattice.columns, lattice.columns * lattice.rows
    for node in {0, 1, columns - 1, columns, 2 * columns - 1, count // 2, count - 1} & {
        *range(count)
    }:
        column = (node_x(lattice, node) - bounds[0]) / lattice.unit
        row = (node_y(lattice, node) - bounds[1]) / lattice.unit
        assert column == pytest.approx(round(column), abs=1e-6)
        assert round(row) * columns + round(column) == node


@pytest.mark.parametrize("bounds", BOUNDS)
@pytest.mark.parametrize("resolution", [2, 3, 7, 100])
def test_units_are_squares_and_as_many_as_the_resolution_squared(bounds, resolution):
    lattice = make_lattice(bounds, resolution)
    area = (bounds[2] - bounds[0]) * (bounds[3] - bounds[1])
    assert lattice.unit**2 * resolution**2 == pytest.approx(area)
    sides = bounds[2] - bounds[0], bounds[3] - bounds[1]
    for side, lines in zip(sides, (lattice.columns, lattice.rows), strict=True):
        assert -1e-6 < side / lattice.unit - (lines - 1) < 1.0


def test_a_room_that_is_turned_keeps_its_unit():
    room = shapely.affinity.rotate(shapely.box(0, 0, 100, 100), 33)
    assert make_lattice(room.bounds, 100, room.area).unit == pytest.approx(1.0)


def test_nodes_outside_a_turned_room_do_not_exist():
    room = shapely.affinity.rotate(shapely.box(0, 0, 10, 10), 33)
    lab = laboratory(scene_of(room=room, ends=((5, 5), (6, 6))), resolution=20)
    lattice, places = lab.problem.lattice, lab.problem.places
    x = lattice.x0 + lattice.unit * (places % lattice.columns)
    y = lattice.y0 + lattice.unit * (places // lattice.columns)
    assert shapely.intersects_xy(room, x, y).all()
    assert len(places) == pytest.approx(400, abs=40)
    assert len(places) < lattice.columns * lattice.rows
    drawn = {gene for i in range(10) for gene in lab.genes(i)}
    assert drawn <= set(places.tolist())


@pytest.mark.parametrize("bounds", [b for b in BOUNDS if b[2] - b[0] == b[3] - b[1]])
@pytest.mark.parametrize("resolution", [2, 3, 7, 100])
def test_the_lattice_of_a_square_room_ends_exactly_on_the_border(bounds, resolution):
    lattice = make_lattice(bounds, resolution)
    first, last = 0, (resolution + 1) ** 2 - 1
    corners = [node_x(lattice, first), node_y(lattice, first)]
    corners += [node_x(lattice, last), node_y(lattice, last)]
    assert tuple(corners) == bounds


def test_nodes_are_numbered_row_by_row_from_the_lower_left():
    lattice = make_lattice((10.0, 20.0, 12.0, 28.0), 4)
    places = [(node_x(lattice, n), node_y(lattice, n)) for n in range(27)]
    assert (lattice.columns, lattice.rows) == (3, 9)
    assert places[:4] == [(10.0, 20.0), (11.0, 20.0), (12.0, 20.0), (10.0, 21.0)]
    assert places[26] == (12.0, 28.0)


@given(st.integers(0, 100), st.integers(0, 100))
def test_a_node_on_a_wall_stays_on_the_wall(column, row):
    lattice = make_lattice((0.0, 0.0, 10.0, 10.0), 100)
    node = row * 101 + column
    # 0.1 * 3 is not 0.3: drawn as decimals, the wall would lie beside the node.
    assert (node_x(lattice, node), node_y(lattice, node)) == (column / 10, row / 10)


def test_start_and_goal_keep_their_natural_coordinates():
    ends = ((0.123456789, 0.7), (9.87654321, 3.3))
    lab = laboratory(scene_of(ends=ends), resolution=3)
    for i in range(10):
        path = path_of(lab.population, i)
        assert (tuple(path[0]), tuple(path[-1])) == ends
        assert len(path) == len(lab.genes(i)) + 2


def filled(count: int = 2, size: int = 4, columns: int = 8) -> Population:
    """Chromosomes with different bytes in every record."""
    rng = np.random.default_rng(0)
    population = empty_population(count, columns)
    for name in NODE.names or ():
        field = population.nodes[name]
        field[:] = rng.integers(1, 10**6, field.shape)
    population.chromosomes["intermediate"] = size
    population.chromosomes["cost"] = rng.random(count)
    population.chromosomes["infeasible"] = 3
    return population


def rows(population: Population, i: int) -> list:
    size = population.chromosomes["intermediate"][i]
    return [node.tobytes() for node in population.nodes[i, : size + 2]]


def test_copying_keeps_all_records():
    source, target = filled(), empty_population(3, 8)
    copy_chromosome(source, 1, target, 2)
    assert target.chromosomes[2] == source.chromosomes[1]
    assert rows(target, 2) == rows(source, 1)
    assert not target.nodes[:2].view(np.uint8).any()


def test_a_copy_is_independent_of_its_source():
    source, target = filled(), empty_population(2, 8)
    copy_chromosome(source, 0, target, 0)
    before = rows(target, 0)
    source.nodes["x"] = -1.0
    assert rows(target, 0) == before


@pytest.mark.parametrize("column", [1, 3, 5])
def test_opening_and_closing_a_column_moves_whole_records(column):
    population = filled()
    before, other = rows(population, 0), rows(population, 1)
    open_column(population, 0, column)
    after = rows(population, 0)
    assert len(after) == len(before) + 1
    assert after[:column] + after[column + 1 :] == before
    close_columns(population, 0, column, 1)
    assert rows(population, 0) == before
    assert rows(population, 1) == other


def test_closing_columns_removes_just_those():
    population = filled()
    before = rows(population, 0)
    close_columns(population, 0, 2, 3)
    assert rows(population, 0) == before[:2] + before[5:]


def test_contains_looks_at_intermediate_nodes_only():
    population = filled()
    genes = population.nodes["gene"][0].tolist()
    assert [contains(population.nodes, 0, 4, g) for g in genes[:6]] == [False] + [True] * 4 + [
        False
    ]


def test_a_node_is_put_where_its_number_says_and_forgetting_clears_its_flags():
    population = filled()
    lattice = make_lattice((0.0, 0.0, 10.0, 10.0), 10)
    set_node(population.nodes, 0, 2, 25, lattice)
    node = population.nodes[0, 2]
    assert (node["gene"], node["x"], node["y"]) == (25, 3.0, 2.0)
    forget(population.nodes, 0, 2, 3)
    assert population.nodes["settled"][0, 1:5].astype(bool).tolist() == [True, False, False, True]
    assert population.nodes["needed"][0, 1:5].astype(bool).tolist() == [True, False, False, True]


def test_nodes_on_the_walls_of_a_decimal_scene_are_free():
    walls = scene_of(
        shapely.box(0.3, 0.3, 0.6, 0.7), room=shapely.box(0, 0, 1, 1), ends=((0, 0), (1, 1))
    )
    lab = laboratory(walls, resolution=10)
    near = all_near_nodes(lab.problem)
    assert {3 * 11 + 3, 3 * 11 + 6, 7 * 11 + 3, 7 * 11 + 6} <= set(near)  # the four corners
