import pytest

from suite.errors import did_you_mean


@pytest.mark.parametrize(
    ("word", "words", "meant"),
    [
        ("temp", ["steps", "temperature"], "temperature"),
        ("zigzag2", ["maze", "zigzag"], "zigzag"),
        ("kbga-fin", ["kbga", "kbga-fine"], "kbga-fine"),
        ("Maze", ["maze"], "maze"),
        ("zigzga", ["maze", "zigzag"], "zigzag"),
        ("rrtstar", ["ompl-rrt", "ompl-rrtstar"], "ompl-rrtstar"),
    ],
)
def test_the_name_that_was_meant_is_hinted_at(word, words, meant):
    assert did_you_mean(word, words) == f" Did you mean '{meant}'?"


@pytest.mark.parametrize(
    ("word", "words"), [("temp", ["steps"]), ("x", ["xylophone"]), ("door", []), ("", ["maze"])]
)
def test_no_name_is_hinted_at_where_none_is_near(word, words):
    assert did_you_mean(word, words) == ""
