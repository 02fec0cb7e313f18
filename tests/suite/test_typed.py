"""Plain data as values of types: what fits, and what is said of what does not."""

import json
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType
from typing import Annotated, Any, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import Meta, Struct

from suite.typed import MisfitError, dataclass_of, in_words, plain, typed

Share = Annotated[float, Meta(ge=0.0, le=1.0, description="a share from 0 to 1")]


class Gear(Enum):
    SLOW = "slow"
    FAST = "fast"


class Wheel(Struct, frozen=True, forbid_unknown_fields=True):
    radius: float
    grip: Share = 1.0
    gear: Gear = Gear.SLOW


class Cart(Struct, frozen=True, forbid_unknown_fields=True):
    wheels: Annotated[list[Wheel | str], Meta(min_length=1, description="wheels, one at least")]
    extras: dict[str, Any] = {}
    horses: int | None = None
    size: tuple[float, float] | None = None


@dataclass(frozen=True)
class Rope:
    length: float
    strands: int | None = 3

    def __post_init__(self) -> None:
        if self.length == 0.0:
            raise ValueError("no rope")


def test_what_fits_is_converted():
    cart = typed({"wheels": [{"radius": 1, "gear": "fast"}, "spare"], "horses": 2}, Cart)
    assert cart == Cart([Wheel(1.0, gear=Gear.FAST), "spare"], horses=2)
    assert isinstance(cart.wheels[0].radius, float)


@pytest.mark.parametrize(
    ("data", "keys", "said"),
    [
        (3, (), "it is 3. Give a table."),
        ({}, (), "'wheels' is missing: give wheels, one at least."),
        ({"wheels": []}, ("wheels",), "wheels is []. Give wheels, one at least."),
        ({"wheels": ["a"], "hoses": 2}, (), "unknown key 'hoses'. It may have: wheels, extras, "),
        ({"wheels": ["a"], "hoses": 2}, (), " Did you mean 'horses'?"),
        ({"wheels": ["a"], "horses": 1.5}, ("horses",), "horses is 1.5. Give a whole number."),
        ({"wheels": ["a"], "horses": True}, ("horses",), "horses is True. Give a whole number."),
        ({"wheels": [3]}, ("wheels", 0), "wheels is 3. Give a table or a string."),
        ({"wheels": ["a", {}]}, ("wheels", 1), "'radius' is missing: give a number."),
        ({"wheels": ["a"], "size": [1, "2"]}, ("size", 1), "size is '2'. Give a number."),
        (
            {"wheels": [{"radius": 1, "grip": 2}]},
            ("wheels", 0, "grip"),
            "grip is 2. Give a share from 0 to 1.",
        ),
        (
            {"wheels": [{"radius": 1, "gear": "back"}]},
            ("wheels", 0, "gear"),
            "gear is 'back'. Give one of 'slow', 'fast'.",
        ),
        ({"wheels": ["a"], "extras": []}, ("extras",), "extras is []. Give a table."),
    ],
)
def test_what_does_not_fit_is_told_with_its_place_and_what_to_give(data, keys, said):
    with pytest.raises(MisfitError) as caught:
        typed(data, Cart)
    assert caught.value.keys == keys
    assert said in str(caught.value)


def test_a_dataclass_is_built_of_the_fields_that_are_given():
    assert dataclass_of({"length": 2}, Rope) == Rope(2.0, 3)
    assert dataclass_of({"length": 2, "strands": None}, Rope).strands is None


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (
            {"lenght": 2},
            "unknown key 'lenght'. It may have: length, strands. Did you mean",
        ),
        ({"length": "2"}, "length is '2'. Give a number."),
        ({"length": 2, "strands": 1.5}, "strands is 1.5. Give a whole number."),
    ],
)
def test_a_dataclass_takes_no_other_field_and_no_other_type(data, said):
    with pytest.raises(MisfitError) as caught:
        dataclass_of(data, Rope)
    assert said in str(caught.value)


def test_the_check_of_the_dataclass_itself_has_the_last_word():
    with pytest.raises(ValueError, match="no rope"):
        dataclass_of({"length": 0}, Rope)


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        (int | None, "a whole number or none"),
        (None | str | bool, "a string or true or false or none"),
        (Literal["b", "a"], "one of 'a', 'b'"),
        (tuple[int, float], "a list (a whole number, a number)"),
        (tuple[float, ...], "a list (a number, ...)"),
        (Share, "a share from 0 to 1"),
        (Gear, "one of 'slow', 'fast'"),
        (Rope, "a table"),
    ],
)
def test_types_have_words(kind, words):
    assert in_words(kind) == words


PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["wheels", "radius", "grip", "gear", "x"]), inner)
    ),
    max_leaves=8,
)


@given(PLAIN)
def test_whatever_is_read_it_fits_or_one_error_says_where(data):
    try:
        typed(data, Cart)
    except MisfitError as error:
        found = error
    else:
        return
    place = data
    for key in found.keys:
        place = place[key]
    assert str(found).endswith((".", "?"))


@dataclass
class Spot:
    place: tuple[float, float]
    gear: Gear = Gear.SLOW
    size: float | None = None


@pytest.mark.parametrize(
    ("value", "wanted"),
    [
        (Spot((1.0, 2.0)), {"place": [1.0, 2.0], "gear": "slow", "size": None}),
        ((Spot((0.0, 0.0)),), [{"place": [0.0, 0.0], "gear": "slow", "size": None}]),
        (MappingProxyType({"rate": np.float64(0.5)}), {"rate": 0.5}),
        (np.array([[1.0, 2.0]]), [[1.0, 2.0]]),
        ({"nested": {"deep": (Gear.FAST,)}}, {"nested": {"deep": ["fast"]}}),
    ],
)
def test_a_value_as_plain_data_is_what_json_gives_back(value, wanted):
    assert plain(value) == wanted
    assert json.loads(json.dumps(plain(value))) == wanted
