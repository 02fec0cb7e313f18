"""Rows by the names that people give them."""

import pytest

from suite.errors import StoreError
from suite.planner import Budget
from suite.store.record import World
from suite.store.row_names import LEAST_DIGITS, cell_of
from suite.store.write import open_store
from tests.suite.harness.records import make_cell, make_record

PLAIN = make_cell(seed=3)
IN_TWO_QUERIES = [make_cell(scene="hall", query=query) for query in ("main", "back")]
IN_TWO_WORLDS = [make_cell(scene="door", world=World(name, {})) for name in ("slow", "fast")]


@pytest.fixture
def file(tmp_path):
    with open_store(tmp_path / "s.db") as store:
        store.begin_session({})
        for cell in (PLAIN, *IN_TWO_QUERIES, *IN_TWO_WORLDS):
            store.add(make_record(cell))
    return tmp_path / "s.db"


@pytest.mark.parametrize(
    ("name", "cell"),
    [
        ("zigzag/kbga/3", PLAIN),
        (PLAIN.label, PLAIN),
        (" zigzag/ main /kbga / seed 3", PLAIN),
        (PLAIN.key, PLAIN),
        (PLAIN.key[:LEAST_DIGITS], PLAIN),
        ("hall/back/kbga/0", IN_TWO_QUERIES[1]),
        (IN_TWO_QUERIES[1].label, IN_TWO_QUERIES[1]),
        ("door/fast/kbga/0", IN_TWO_WORLDS[1]),
        ("door/main/slow/kbga/0", IN_TWO_WORLDS[0]),
        (IN_TWO_WORLDS[0].label, IN_TWO_WORLDS[0]),
    ],
)
def test_a_row_is_found_by_its_scene_planner_and_seed_its_label_or_its_key(file, name, cell):
    assert cell_of(file, name).key == cell.key


@pytest.mark.parametrize("name", ["hall/kbga/0", "door/kbga/0"])
def test_a_name_of_two_rows_is_an_error_that_lists_both(file, name):
    two = IN_TWO_QUERIES if name.startswith("hall") else IN_TWO_WORLDS
    with pytest.raises(StoreError, match=f"2 rows are called '{name}'") as caught:
        cell_of(file, name)
    for cell in two:
        assert f"{cell.label} ({cell.key[:8]})" in str(caught.value)


@pytest.mark.parametrize("name", ["zigzag/kbga/4", "zigzag/rrt/3", "hall/side/kbga/0", "a/b"])
def test_a_name_of_no_row_is_an_error_that_lists_what_there_is(file, name):
    with pytest.raises(StoreError, match=f"no row is called '{name}'") as caught:
        cell_of(file, name)
    assert "scenes: zigzag, hall, door; worlds: slow, fast; planners: kbga; seeds: 3, 0." in str(
        caught.value
    )


@pytest.mark.parametrize("key", ["", "abc", "zzzzzz"])
def test_a_key_of_no_row_is_an_error(file, key):
    with pytest.raises(StoreError, match=f"no row has a key that begins with '{key}'"):
        cell_of(file, key)


def test_a_key_of_several_rows_is_an_error(file, monkeypatch):
    monkeypatch.setattr("suite.store.row_names.LEAST_DIGITS", 0)
    with pytest.raises(StoreError, match="5 rows are called ''"):
        cell_of(file, "")


def test_an_empty_store_says_so(tmp_path):
    with open_store(tmp_path / "e.db"):
        pass
    with pytest.raises(StoreError, match="It has no rows"):
        cell_of(tmp_path / "e.db", "zigzag/kbga/0")


def test_a_budget_in_whole_seconds_names_the_same_row_as_in_a_store(tmp_path):
    cell = make_cell(budget=Budget(wall_s=2))
    with open_store(tmp_path / "s.db") as store:
        store.begin_session({})
        store.add(make_record(cell))
    assert cell_of(tmp_path / "s.db", "zigzag/kbga/0").key == cell.key
