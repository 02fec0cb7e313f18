"""Settings refuse what makes no sense, and say which and why."""

import re
from dataclasses import FrozenInstanceError, fields

import numpy as np
import pytest

from kbga.encoding import FINEST
from kbga.settings import KBGAPlusSettings, KBGASettings

WHOLE = {
    "population_size": 2,
    "resolution": 2,
    "max_nodes": 2,
    "initial_nodes": 1,
    "tournament_size": 1,
    "repair_candidates": 0,
    "repair_reach": 0,
    "improvement_radius": 0,
    "rounds": 1,
    "max_generations": 1,
    "stagnation": 1,
}
PROBABILITIES = [f.name for f in fields(KBGASettings) if f.name.endswith("_probability")]
SHARES = [*PROBABILITIES, "informed_share", "adaptation_rate"]
NAN, INF = float("nan"), float("inf")


def test_the_defaults_are_those_of_the_paper():
    chosen = KBGASettings()
    assert (chosen.population_size, chosen.resolution) == (50, 100)
    assert chosen.mutation_probability == 0.2
    others = [getattr(chosen, p) for p in PROBABILITIES if "mutation" not in p]
    assert others == [0.9] * 4


def test_kbga_plus_differs_from_the_paper_in_what_its_docstring_lists_and_in_nothing_else():
    plus, paper = KBGAPlusSettings(), KBGASettings()
    own = [f.name for f in fields(paper) if getattr(plus, f.name) != getattr(paper, f.name)]
    described = re.findall(r"^    (\w+) : ", KBGAPlusSettings.__doc__ or "", re.MULTILINE)
    assert own == described


@pytest.mark.parametrize("name", ["repair_must_help", "one_operator", "remembers"])
def test_a_choice_of_yes_or_no_takes_nothing_else(name):
    assert getattr(KBGASettings(**{name: True}), name) is True
    for bad in (1, "yes", None):
        with pytest.raises(ValueError, match=f"^{name} is {bad!r}; it must be true or false$"):
            KBGASettings(**{name: bad})


def test_what_generations_needed_counts_is_one_of_two_words():
    with pytest.raises(ValueError, match="it must be 'best' or 'stop'"):
        KBGASettings(generations_counted="all")


@pytest.mark.parametrize("name", WHOLE)
def test_a_number_below_its_least_is_refused_with_name_and_range(name):
    least = WHOLE[name]
    assert getattr(KBGASettings(**{name: least}), name) == least
    for bad in (least - 1, -5):
        with pytest.raises(ValueError, match=rf"^{name} is {bad}; .* {least} or more$"):
            KBGASettings(**{name: bad})


@pytest.mark.parametrize("name", WHOLE)
@pytest.mark.parametrize("bad", [10.5, 50.0, NAN, INF, "50", None, True, np.True_, [50]])
def test_what_counts_must_be_a_whole_number(name, bad):
    with pytest.raises(ValueError, match="it must be a whole number") as error:
        KBGASettings(**{name: bad})
    assert str(error.value).startswith(f"{name} is {bad!r}; ")


def test_a_numpy_integer_is_a_whole_number():
    assert KBGASettings(population_size=np.int64(7)).population_size == 7


@pytest.mark.parametrize("name", SHARES)
def test_a_probability_lies_between_0_and_1_both_allowed(name):
    for good in (0.0, 1.0, 0, 1):
        assert getattr(KBGASettings(**{name: good}), name) == good
    for bad in (-0.01, 1.01, NAN, INF):
        with pytest.raises(ValueError, match=rf"^{name} is {bad}; it must lie in \[0, 1\]$"):
            KBGASettings(**{name: bad})


WRONG = ["0.5", None, True, False, np.True_, [0.5], np.array([0.5, 0.5]), 1j]


@pytest.mark.parametrize("name", SHARES)
@pytest.mark.parametrize("bad", WRONG)
def test_a_probability_is_a_number(name, bad):
    with pytest.raises(ValueError, match=r"it must lie in \[0, 1\]$") as error:
        KBGASettings(**{name: bad})
    assert str(error.value).startswith(f"{name} is {bad!r}; ")


@pytest.mark.parametrize("bad", WRONG)
def test_a_penalty_is_a_number(bad):
    with pytest.raises(ValueError, match=r"^penalty is .*; it must be 0 or more, and finite$"):
        KBGASettings(penalty=bad)


def test_numpy_numbers_are_numbers():
    chosen = KBGASettings(penalty=np.float32(2.5), mutation_probability=np.float64(0.5))
    assert (chosen.penalty, chosen.mutation_probability) == (2.5, 0.5)


@pytest.mark.parametrize("bad", [-1.0, INF, NAN])
def test_a_penalty_is_finite_and_not_negative(bad):
    with pytest.raises(ValueError, match=f"^penalty is {bad}; it must be 0 or more, and finite$"):
        KBGASettings(penalty=bad)
    assert KBGASettings(penalty=0.0).penalty == 0.0


@pytest.mark.parametrize("bad", [*WRONG, 0, 0.0, -1.0, -INF, NAN])
def test_a_repair_limit_is_a_number_above_0(bad):
    with pytest.raises(ValueError, match=r"^repair_limit is .*; it must be above 0$") as error:
        KBGASettings(repair_limit=bad)
    assert str(error.value).startswith(f"repair_limit is {bad!r}; ")


@pytest.mark.parametrize("good", [1e-9, 1, 2.5, INF])
def test_a_repair_limit_may_be_infinite(good):
    assert KBGASettings(repair_limit=good).repair_limit == good


def test_a_resolution_has_a_finest():
    assert KBGASettings(resolution=FINEST).resolution == FINEST
    with pytest.raises(ValueError, match=r"^resolution is 20001; it must be at most 20000$"):
        KBGASettings(resolution=FINEST + 1)


def test_a_misspelt_setting_is_a_type_error():
    with pytest.raises(TypeError, match="populaton_size"):
        KBGASettings(populaton_size=40)  # type: ignore[call-arg]


def test_settings_do_not_change():
    with pytest.raises(FrozenInstanceError):
        KBGASettings().rounds = 3  # type: ignore[misc]
