"""Planners that draw from the global generators repeat themselves all the same."""

import random

import numpy as np
import pytest

from suite.processes.random_state import seed_globals

# ruff: noqa: NPY002

pytestmark = pytest.mark.usefixtures("own_generators")


@pytest.fixture
def own_generators():
    """What is seeded here is put back afterwards."""
    python, numpy = random.getstate(), np.random.get_state()
    yield
    random.setstate(python)
    np.random.set_state(numpy)


def drawn() -> tuple[float, float]:
    return random.random(), np.random.random()


def after(seed: int) -> tuple[float, float]:
    seed_globals(seed)
    return drawn()


@pytest.mark.parametrize("seed", [0, 1, 2**130])
def test_one_seed_gives_one_stream_of_both_generators(seed):
    assert after(seed) == after(seed)
    assert drawn() != after(seed)


def test_another_seed_gives_another_stream_of_both():
    one, other = after(1), after(2)
    assert one[0] != other[0]
    assert one[1] != other[1]


def test_a_plugin_can_still_seed_numpy_by_itself():
    seed_globals(5)
    np.random.seed(7)
    assert np.random.random() == np.random.RandomState(7).random()
