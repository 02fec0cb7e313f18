"""What rows are of: places, maps, and queries that can't be asked."""

import pytest

from suite.harness.cell import refused
from suite.report.rows import (
    QUERIES_APART,
    blocked_note,
    is_blocked,
    is_of_map,
    maps_note,
    places,
    with_queries_together,
)
from suite.scenes.catalogue import load_scene
from tests.suite.harness.records import make_cell
from tests.suite.report.map_rows import asked, blocked
from tests.suite.report.study_rows import runs_of

LONG = "12.345678,4.5:20.125,9.25"


def town(queries: int):
    return runs_of(*[asked("kbga", f"q{i}", 101.0) for i in range(queries)])


def test_a_few_queries_are_places_of_their_own_and_many_are_one_map():
    few, many = town(QUERIES_APART), town(QUERIES_APART + 1)
    assert list(places(few)) == [f"town/q{i}" for i in range(QUERIES_APART)]
    assert set(places(many)) == {"town"}
    assert not is_of_map(few).any()
    assert is_of_map(many).all()


def test_a_scene_of_one_query_is_named_by_itself():
    assert list(places(town(1))) == ["town"]


def test_long_names_of_queries_are_shortened_where_they_stay_apart():
    runs = runs_of(asked("kbga", LONG, 101.0), asked("kbga", "gate", 101.0))
    assert list(places(runs)) == ["town/12.35,4.5:20.12,9.25", "town/gate"]
    nearly = LONG.replace("12.345678", "12.345679")
    runs = runs_of(asked("kbga", LONG, 101.0), asked("kbga", nearly, 101.0))
    assert list(places(runs)) == [f"town/{LONG}", f"town/{nearly}"]


def test_queries_of_a_map_go_under_one_name_and_others_keep_theirs():
    assert set(with_queries_together(town(5))["query"]) == {"5 queries"}
    assert list(with_queries_together(town(2))["query"]) == ["q0", "q1"]


def test_a_query_that_no_planner_could_be_asked_is_blocked():
    runs = runs_of(asked("kbga", "a", 101.0), blocked("kbga", "b"), blocked("prm", "b"))
    assert list(is_blocked(runs)) == [False, True, True]
    assert blocked_note(runs).startswith("Left out: 2 rows of 1 query that can't be asked")
    assert blocked_note(runs[:1]) == ""


def test_what_the_harness_writes_of_a_blocked_query_is_known_here():
    query = load_scene("zigzag@radius=0.5").query("-5,-5:50,50")
    assert query.blocked is not None
    row = refused(make_cell(query=query.name), query.blocked)
    assert is_blocked(runs_of(row)).all()


@pytest.mark.parametrize(
    "other",
    [
        asked("prm", "b", 101.0),  # was asked, so it could be
        blocked("prm", "b", reason="the goal is too far for me"),
        blocked("prm", "b", reason="no scene with holes, please"),
    ],
)
def test_a_refusal_of_a_planner_is_not_a_blocked_query(other):
    assert not is_blocked(runs_of(blocked("kbga", "b"), other)).any()


def test_a_planner_that_refuses_a_scene_alone_is_not_taken_for_a_blocked_query():
    assert not is_blocked(runs_of(blocked("kbga", "b", reason="no scenes with holes"))).any()
    assert not is_blocked(runs_of(blocked("kbga", "b", reason="start and goal are near"))).any()


def test_tables_that_put_the_queries_together_say_so():
    assert "1 map" in maps_note(town(5))
    assert maps_note(town(2)) == ""
